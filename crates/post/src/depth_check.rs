//! Checks the loop over depths around a path, as it stands in a program's text: the path is played as often as
//! the recipe says, each time by its step deeper, and the last time where it is.

use crate::fixed_point::ONE;
use crate::post::{DepthLoop, Dialect};
use crate::program_format::ProgramFormat;

/// The loop of a program, as far as it is read.
pub(crate) struct DepthCheck {
    found: Option<Box<dyn DepthLoop>>,
    place: Place,
}

/// Where the reader is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// No mark of a loop was read.
    Before,
    /// The loop has begun.
    Begun,
    /// It has ended.
    Ended,
}

impl DepthCheck {
    pub(crate) fn new(dialect: &dyn Dialect) -> Self {
        Self {
            found: dialect.depth_loop(),
            place: Place::Before,
        }
    }

    /// Takes the mark before the lines that begin the loop.
    pub(crate) fn begin(&mut self) -> Result<(), String> {
        if self.found.is_none() {
            return Err("turnpath knows no loop over depths of this controller".to_owned());
        }
        self.place = Place::Begun;
        Ok(())
    }

    /// Takes the mark before those that end it.
    pub(crate) fn end(&mut self) -> Result<(), String> {
        match self.place {
            Place::Begun => {
                self.place = Place::Ended;
                Ok(())
            }
            Place::Before | Place::Ended => {
                Err("a loop over depths ends that has not begun".to_owned())
            }
        }
    }

    /// Reads a line of either.
    pub(crate) fn read(&mut self, code: &str) -> Result<(), String> {
        let ends = self.place == Place::Ended;
        match &mut self.found {
            Some(found) if !code.is_empty() => found.read(code, ends),
            _ => Ok(()),
        }
    }

    /// Checks the loop, at the end of the path.
    pub(crate) fn finish(&self, format: &ProgramFormat) -> Result<(), String> {
        let expected = expected_shifts(format);
        let found = match (self.place, &self.found) {
            (Place::Before, _) | (_, None) => vec![0],
            (Place::Begun, _) => return Err("the loop over depths does not end".to_owned()),
            (Place::Ended, Some(found)) => found.shifts()?,
        };
        if found == expected {
            return Ok(());
        }
        let mm = |shift: Option<&i128>| *shift.unwrap_or(&0) as f64 / ONE as f64;
        Err(format!(
            "the path is played {} times, first {} mm and last {} mm above its place; by the recipe it is \
             played {} times, first {} mm above it",
            found.len(),
            mm(found.first()),
            mm(found.last()),
            expected.len(),
            mm(expected.first())
        ))
    }
}

/// The places of Z's zero each time that the path is played, in 10⁻¹² mm.
fn expected_shifts(format: &ProgramFormat) -> Vec<i128> {
    let Some(depths) = format.depths else {
        return vec![0];
    };
    let one = 10i128.pow(format.position_decimals);
    let left = (0..depths.count).rev();
    let shift = |left: i64| i128::from(left) * i128::from(depths.step) * (ONE / one);
    left.map(shift).collect()
}
