//! The axes as a controller moves them along a program, for its reader.

use turnpath_core::DEG;
use turnpath_core::toolpath::ControlPoint;

use crate::fixed_point::{ONE, SHORT_ONE, to_f64};
use crate::program_format::{ProgramFormat, TURN_DEG};

/// A revolution in 10⁻¹² deg.
const TURN: i128 = TURN_DEG as i128 * ONE;
/// The names of the path's axes, by their index.
pub(crate) const NAMES: [&str; 3] = ["C", "X", "Z"];

/// Position and velocity of each axis that one line moves, in 10⁻¹² of the program's units.
pub(crate) type AxisWords = [Option<(i128, Option<i128>)>; 3];

/// The state of the axes. Times are counted as the controller counts them, and positions are summed
/// exactly. So a program with distances gives the same points as one with positions.
pub(crate) struct Axes {
    format: ProgramFormat,
    /// The program's positions, C unwrapped; `None` before the first point.
    position: Option<[i128; 3]>,
    velocity: [i128; 3],
    elapsed: i64,
}

impl Axes {
    pub(crate) fn new(format: ProgramFormat) -> Self {
        Self {
            format,
            position: None,
            velocity: [0; 3],
            elapsed: 0,
        }
    }

    /// Moves to the end of a segment that takes `steps`, and gives its point. The move to the first
    /// point takes no time of the path. Nothing changes where it is refused.
    pub(crate) fn go_to(
        &mut self,
        words: &AxisWords,
        absolute: [bool; 3],
        steps: i64,
    ) -> Result<ControlPoint, String> {
        let Some(last) = self.position else {
            self.position = Some(first_position(words, absolute)?);
            self.velocity = velocities(words);
            return Ok(self.point());
        };
        let mut target = last;
        for (k, word) in words.iter().enumerate() {
            let Some((position, _)) = word else { continue };
            target[k] = match absolute[k] {
                false => last[k] + position,
                true if k == 0 && self.format.c_wrapped => last[k] + nearest(position - last[k]),
                true => *position,
            };
        }
        let elapsed = self.elapsed.checked_add(steps);
        self.elapsed = elapsed.ok_or("the program takes longer than any path")?;
        self.position = Some(target);
        self.velocity = velocities(words);
        Ok(self.point())
    }

    /// The state of the axes as a control point.
    fn point(&self) -> ControlPoint {
        let format = &self.format;
        let (sign, per) = (format.c_sign(), format.velocity_time());
        let ([c, x, z], [vc, vx, vz]) = (self.position.unwrap_or_default(), self.velocity);
        // Divisions of one loop go side by side.
        let mut values = [c, x, z, vc, vx, vz].map(to_f64);
        values.iter_mut().for_each(|value| *value /= ONE as f64);
        let [c, x, z, mut vc, mut vx, mut vz] = values;
        if per != 1.0 {
            [vc, vx, vz] = [vc / per, vx / per, vz / per];
        }
        ControlPoint {
            t: self.elapsed as f64 / format.steps_per_s as f64,
            c: sign * c * DEG,
            x,
            z: z + format.z_above,
            vc: sign * vc * DEG,
            vx,
            vz,
        }
    }
}

/// A time in steps, from 10⁻¹² of a unit that has `steps_per_unit` of them; `None` where no segment
/// takes that long.
pub(crate) fn steps_of(time: i128, steps_per_unit: i64, longest: i64) -> Option<i64> {
    let steps = match short_steps(time, steps_per_unit) {
        Some(steps) => steps,
        None => {
            let steps = time.checked_mul(i128::from(steps_per_unit))? + ONE / 2;
            i64::try_from(steps.div_euclid(ONE)).ok()?
        }
    };
    (1..=longest).contains(&steps).then_some(steps)
}

/// The steps of a time that 64 bits suffice for, which most times are; a division of 128 bits takes longer than all
/// else of a line's time.
#[inline(always)]
fn short_steps(time: i128, steps_per_unit: i64) -> Option<i64> {
    let parts = u64::try_from(time)
        .ok()?
        .checked_mul(u64::try_from(steps_per_unit).ok()?)?;
    let steps = parts.checked_add(SHORT_ONE / 2)? / SHORT_ONE;
    i64::try_from(steps).ok()
}

/// The times that a segment may take, for messages: from a step to the longest, in a unit that has
/// `steps_per_unit` steps.
pub(crate) fn times(steps_per_unit: i64, longest: i64, unit: &str) -> String {
    let in_units = |steps: i64| steps as f64 / steps_per_unit as f64;
    let (shortest, longest) = (in_units(1), in_units(longest));
    format!("{shortest} {unit} to {longest} {unit}")
}

/// The position of the first point, which must give all axes.
fn first_position(words: &AxisWords, absolute: [bool; 3]) -> Result<[i128; 3], String> {
    let mut first = [0; 3];
    for (k, word) in words.iter().enumerate() {
        let Some((position, _)) = word else {
            return Err(format!("the first point does not give {}", NAMES[k]));
        };
        if !absolute[k] {
            return Err("the first point must be a position, not a distance".to_owned());
        }
        first[k] = *position;
    }
    Ok(first)
}

/// The velocities of a line. An axis without a velocity ends at rest.
fn velocities(words: &AxisWords) -> [i128; 3] {
    words.map(|word| word.and_then(|(_, velocity)| velocity).unwrap_or(0))
}

/// An angle, wrapped to less than half a revolution.
fn nearest(angle: i128) -> i128 {
    (angle + TURN / 2).rem_euclid(TURN) - TURN / 2
}
