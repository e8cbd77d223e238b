//! The axes of a program along the cubics that it says, for readers. It shares nothing with the writers.

use turnpath_core::toolpath::ControlPoint;

use crate::axes::{Axes, AxisWords, NAMES};
use crate::program_format::ProgramFormat;

/// By how much a polynomial may begin with another velocity than the one before ends with, as a way in
/// its time, in 10⁻¹² mm or deg. Control points have one velocity; a larger jump is a path that they
/// cannot say.
const LARGEST_JUMP: u128 = 1000;

/// An axis from where it stands to the end of a segment, in 10⁻¹² mm or deg.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cubic {
    /// Where it ends.
    pub(crate) to: i128,
    /// The way in the time of the segment with the velocity at its beginning.
    pub(crate) begin: i128,
    /// The same with the velocity at its end.
    pub(crate) end: i128,
}

/// Where the axes are, in 10⁻¹² mm or deg.
pub(crate) struct CubicAxes {
    axes: Axes,
    steps_per_s: i64,
    position: [i128; 3],
    /// Ways in the time of the last segment at its last velocity, and its steps; `None` behind the
    /// first block, whose point waits for the velocity with which the first polynomial begins.
    last: Option<([i128; 3], i64)>,
}

impl CubicAxes {
    /// The axes at the first point.
    pub(crate) fn new(format: &ProgramFormat, position: [i128; 3]) -> Self {
        Self {
            axes: Axes::new(*format),
            steps_per_s: format.steps_per_s,
            position,
            last: None,
        }
    }

    /// The position of each axis.
    pub(crate) fn position(&self) -> [i128; 3] {
        self.position
    }

    /// Plays a segment, and appends the points that are known with it.
    ///
    /// # Errors
    /// When a velocity jumps, or has too many digits.
    pub(crate) fn play(
        &mut self,
        cubics: [Cubic; 3],
        steps: i64,
        points: &mut Vec<ControlPoint>,
    ) -> Result<(), String> {
        let begin = cubics.map(|cubic| cubic.begin);
        match self.last {
            None => points.push(self.go_to(self.position, begin, (steps, self.steps_per_s))?),
            Some(last) => refuse_jump(last, begin, steps)?,
        }
        let (target, end) = (cubics.map(|cubic| cubic.to), cubics.map(|cubic| cubic.end));
        points.push(self.go_to(target, end, (steps, self.steps_per_s))?);
        self.position = target;
        self.last = Some((end, steps));
        Ok(())
    }

    /// Whether the first point waits for the first polynomial.
    pub(crate) fn holds_point(&self) -> bool {
        self.last.is_none()
    }

    /// The point that waits for a polynomial, at the end of the path: at rest.
    pub(crate) fn finish(&mut self) -> Option<ControlPoint> {
        match self.holds_point() {
            true => self.go_to(self.position, [0; 3], (1, 1)).ok(),
            false => None,
        }
    }

    /// The point at a position with a velocity that is given as the way in `steps`.
    fn go_to(
        &mut self,
        position: [i128; 3],
        way: [i128; 3],
        (steps, steps_per_s): (i64, i64),
    ) -> Result<ControlPoint, String> {
        let mut words: AxisWords = [None; 3];
        for (k, word) in words.iter_mut().enumerate() {
            let velocity = way[k].checked_mul(i128::from(steps_per_s));
            let velocity = velocity.ok_or_else(|| too_many_digits(NAMES[k]))?;
            *word = Some((position[k], Some(rounded(velocity, steps))));
        }
        self.axes.go_to(&words, [true; 3], steps)
    }
}

/// Refuses a segment of so many steps that does not begin with the velocities with which the last one ends.
fn refuse_jump(
    (last, of_last): ([i128; 3], i64),
    begin: [i128; 3],
    steps: i64,
) -> Result<(), String> {
    for (k, name) in NAMES.into_iter().enumerate() {
        let way = last[k].checked_mul(i128::from(steps));
        let way = way.ok_or_else(|| too_many_digits(name))?;
        let expected = way / i128::from(of_last);
        let finer = LARGEST_JUMP.max(u128::from((8 * (steps / of_last)).unsigned_abs()));
        if begin[k].abs_diff(expected) > finer {
            return Err(format!(
                "the polynomial of {name} does not begin with the velocity with which the one before \
                 ends"
            ));
        }
    }
    Ok(())
}

/// A quotient, rounded.
fn rounded(value: i128, by: i64) -> i128 {
    let by = i128::from(by);
    (value + by / 2).div_euclid(by)
}

fn too_many_digits(axis: &str) -> String {
    format!("the velocity of {axis} has too many digits")
}
