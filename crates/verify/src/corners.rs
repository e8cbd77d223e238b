//! Corners of the true path. At a corner the contact jumps over a seam, and the error has a sharp
//! peak that lies between two instants of the playback.

use turnpath_core::Result;
use turnpath_core::toolpath::Segment;

use crate::between_instants::play;
use crate::instants::INSTANTS;
use crate::touch::{FirstTouch, Touch, TouchBuffers};
use crate::worst::Worst;

/// A contact that moves further than this part of the nose radius from one instant to the next may
/// have jumped. If a smooth motion is taken for a jump, only time is lost.
const JUMP: f64 = 2e-3;
/// Halvings of the time between two instants.
const HALVINGS: usize = 14;

/// An interval of time in which the contact may jump: two times within a segment, 0 to 1, and the
/// contacts at both.
struct JumpInterval {
    segment: usize,
    time: [f64; 2],
    foot: [f64; 2],
}

/// The largest error at the corners of each segment; `None` for a segment without corners.
/// `touches` are the first touches at the instants of all segments, one segment after the other.
pub(crate) fn at_corners(
    touch: &FirstTouch,
    segments: &[Segment],
    touches: &[Touch],
) -> Result<Vec<Option<Worst>>> {
    let mut found = vec![None; segments.len()];
    let ends: Vec<(usize, f64)> = (0..segments.len()).map(|segment| (segment, 1.0)).collect();
    let mut buffers = TouchBuffers::default();
    play(touch, segments, &ends, &mut buffers)?;
    let ends: Vec<Touch> = buffers.touches.iter().collect();
    let mut intervals = jump_intervals(touch, touches, &ends);
    for _ in 0..HALVINGS {
        let middle = |interval: &JumpInterval| {
            let [begin, end] = interval.time;
            (interval.segment, 0.5 * (begin + end))
        };
        let middles: Vec<(usize, f64)> = intervals.iter().map(middle).collect();
        let errors = play(touch, segments, &middles, &mut buffers)?;
        let results = middles.iter().zip(buffers.touches.iter().zip(errors));
        for (interval, ((segment, at), (touch, error))) in intervals.iter_mut().zip(results) {
            interval.keep_jump(*at, touch.foot);
            let here = Worst { error, at: *at };
            let worst: &mut Option<Worst> = &mut found[*segment];
            if worst.is_none_or(|worst| here.amount() > worst.amount()) {
                *worst = Some(here);
            }
        }
    }
    Ok(found)
}

/// The intervals between instants in which the contact may jump. `ends` are the first touches at
/// the ends of the segments.
fn jump_intervals(touch: &FirstTouch, touches: &[Touch], ends: &[Touch]) -> Vec<JumpInterval> {
    let jump = JUMP * touch.subject().tool.nose_radius;
    let mut intervals = Vec::new();
    for (segment, (touches, end)) in touches.chunks(INSTANTS).zip(ends).enumerate() {
        let after = touches.iter().skip(1).chain([end]);
        for (k, (first, second)) in touches.iter().zip(after).enumerate() {
            if (second.foot - first.foot).abs() > jump {
                let time = [k, k + 1].map(|k| k as f64 / INSTANTS as f64);
                intervals.push(JumpInterval {
                    segment,
                    time,
                    foot: [first.foot, second.foot],
                });
            }
        }
    }
    intervals
}

impl JumpInterval {
    /// Keeps the half in which the contact moves further. `foot` is the contact at the middle.
    fn keep_jump(&mut self, at: f64, foot: f64) {
        let half = usize::from((foot - self.foot[0]).abs() >= (self.foot[1] - foot).abs());
        (self.time[half], self.foot[half]) = (at, foot);
    }
}
