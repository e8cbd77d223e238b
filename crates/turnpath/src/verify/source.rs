//! The file that is measured: which kind it is, and how it is read.

use std::path::{Path, PathBuf};

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Section};
use turnpath_post::{PMAC_TIME_STEPS, PathReader, PmacFormat, PmacReader, ReadError, ReadPath};
use turnpath_recipe::Recipe;
use turnpath_verify::HalfDigits;

use crate::posts::{PMAC_EXTENSION, pmac_format};

/// A file of a tool path, which can be read more than once.
#[derive(Debug, Clone)]
pub struct SourceFile {
    /// Where it is.
    pub path: PathBuf,
    /// How it is laid out, if it is a program; a table otherwise.
    pub program: Option<PmacFormat>,
}

impl SourceFile {
    /// The file at `path`. What its name ends with says whether it is a program.
    pub fn new(path: &Path, recipe: &Recipe, compensates_nose: bool) -> Self {
        let extension = path.extension();
        let is_program = extension.is_some_and(|end| end.eq_ignore_ascii_case(PMAC_EXTENSION));
        Self {
            path: path.to_owned(),
            program: is_program.then(|| pmac_format(recipe, compensates_nose)),
        }
    }

    /// Opens the file at its beginning.
    pub fn open(&self) -> Result<Box<dyn ReadPath + Send + Sync>, ReadError> {
        Ok(match self.program {
            Some(format) => Box::new(PmacReader::open(&self.path, format)?),
            None => Box::new(PathReader::open(&self.path)?),
        })
    }

    /// The first row; `None` if there is none.
    pub fn first_row(&self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        self.open()?.next_point()
    }

    /// The last digit of its velocities, mm/s or deg/s; zero if it has all digits of a double.
    pub fn velocity_digit(&self) -> f64 {
        self.program.map_or(0.0, |format| {
            let per = if format.per_minute { 60.0 } else { 1.0 };
            one_in(format.velocity_decimals) / per
        })
    }

    /// Half of its last digits; zero if it has all digits of a double.
    pub fn half_digits(&self) -> HalfDigits {
        let Some(format) = self.program else {
            return HalfDigits::default();
        };
        let position = 0.5 * one_in(format.position_decimals);
        let velocity = 0.5 * self.velocity_digit();
        HalfDigits {
            time: 0.5 / PMAC_TIME_STEPS,
            position,
            angle: position * DEG,
            velocity,
            angular_velocity: velocity * DEG,
        }
    }
}

/// The last one of so many decimals.
fn one_in(decimals: u32) -> f64 {
    1.0 / 10u64.pow(decimals) as f64
}
