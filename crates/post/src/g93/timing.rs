//! The proof that LinuxCNC plays a line in its time.
//!
//! LinuxCNC turns F of `G93` into a feed rate and forgets the time (`Interp::inverse_time_rate_straight`
//! in src/emc/rs274ngc/interp_inverse.cc): the length of the line times F. The length is that of X, Y
//! and Z in mm; where none of them moves by more than 10⁻⁷, it is that of the rotary axes in deg
//! (`Interp::find_straight_length` in interp_find.cc). Up to version 2.8 the rate is at least 0.1 in a
//! minute, so a slower line takes less time than F says. Version 2.9.0 has no such bound, except that a
//! line of no length is played in no time.
//!
//! Then the motion's own rule (`getStraightVelocity` in src/emc/task/emccanon.cc) takes the rate for
//! one along X, Y and Z as soon as one of them moves by 10⁻⁸. So a line whose X or Z moves by less than
//! 10⁻⁷ and that is not quite still would be played with a rate of degrees along a length of mm. There
//! is no such line: positions are multiples of a larger step.
//!
//! Last, the planner slows a line down that would take less than 1.02 periods of the servo thread
//! (`tpRunOptimization` in src/emc/tp/tp.c, since 2.7.0).

use crate::digits::DigitSegment;
use crate::program_error::ProgramError;
use crate::program_format::{ProgramFormat, Slowest};

use super::write::inverse_minutes;

/// How far above the lowest rate a line must be, as a part of it, so that the rounding of doubles does
/// not decide.
const ROOM: f64 = 1e-9;

/// Checks that a segment takes its own time.
pub(super) fn check_time(
    format: &ProgramFormat,
    segment: &DigitSegment,
) -> Result<(), ProgramError> {
    let Some(chords) = format.chords else {
        return Ok(());
    };
    let (t, c_deg) = segment.end(format);
    if segment.steps() < chords.shortest {
        let ms = |steps: i64| 1e3 * steps as f64 / format.steps_per_s as f64;
        let (took, least) = (ms(segment.steps()), ms(chords.shortest));
        return Err(ProgramError::ShortLine {
            took,
            least,
            t,
            c_deg,
        });
    }
    let Some(slowest) = chords.slowest else {
        return Ok(());
    };
    let one = 10u64.pow(format.position_decimals) as f64;
    let way = |k: usize| segment.to.position[k] - segment.from.position[k];
    let [c, x, z] = [way(0), way(1), way(2)];
    if [c, x, z] == [0; 3] {
        // A dwell, where one is written; see `is_dwell`.
        return Ok(());
    }
    let length = |x: i64, z: i64| {
        let [x, z] = [x, z].map(|way| way as f64);
        (x * x + z * z).sqrt() / one
    };
    let feed = inverse_minutes(format, segment.steps());
    if x == 0 && z == 0 {
        let rate = length(c, 0) * feed;
        return check_rate(rate, &slowest, ("C moves", "deg"), (t, c_deg));
    }
    // `Slowest::steps` keeps X and Z from ways that are not quite none.
    let rate = length(x, z) * feed;
    check_rate(rate, &slowest, ("X and Z move", "mm"), (t, c_deg))
}

/// Whether nothing moves in a segment of a controller that would play such a line in no time.
pub(super) fn is_dwell(segment: &DigitSegment) -> bool {
    segment.from.position == segment.to.position
}

fn check_rate(
    rate: f64,
    slowest: &Slowest,
    (axes, unit): (&'static str, &'static str),
    (t, c_deg): (f64, f64),
) -> Result<(), ProgramError> {
    let lowest = slowest.rate;
    if rate >= lowest * (1.0 + ROOM) {
        return Ok(());
    }
    Err(ProgramError::Slow {
        axes,
        rate,
        lowest,
        unit,
        t,
        c_deg,
    })
}
