//! What runs along the radius of the part.

use turnpath_report::{Samples, TurnSketch, unit};

use crate::frame::Axis;
use crate::range::Range;

/// The room beyond the last turn, and beyond the first one across the axis, as a share of the larger.
const ROOM: f64 = 0.01;
/// A path that comes so near to the axis of the part, as a share of its radius, is drawn from there on.
const NEAR_AXIS: f64 = 0.1;
/// No figure of a path is as large, in any unit: what is larger would overflow while it is drawn.
const LARGEST: f64 = 1e100;

/// The mean X of each turn, mm.
pub fn radii(turns: &TurnSketch) -> Vec<f64> {
    values(&turns.radius, unit::mm::PER)
}

/// Numbers in a unit; what is too large to be drawn is no number.
pub fn values(samples: &Samples, per: f64) -> Vec<f64> {
    let in_unit = |value: &f64| match (value * per).abs() < LARGEST {
        true => value * per,
        false => f64::NAN,
    };
    samples.0.iter().map(in_unit).collect()
}

/// The axis of the radius, from the axis of the part or from its smallest turn on. X may cross the
/// axis of the part: then it begins beyond.
pub fn radius_axis(radii: &[f64]) -> Axis {
    let known = radii.iter().copied().filter(|radius| radius.is_finite());
    let (least, most) = known.fold((f64::MAX, f64::MIN), |(least, most), radius| {
        (least.min(radius), most.max(radius))
    });
    if most < least {
        return axis(Range::even(0.0, 1.0));
    }
    let room = ROOM * most.abs().max(least.abs());
    // The last turn ends a little within the rim.
    let to = if most > 0.0 { most + room } else { 0.0 };
    let from = match least {
        least if least < 0.0 => least - room,
        least if least < NEAR_AXIS * to => 0.0,
        least => least,
    };
    axis(Range::even(from, to))
}

fn axis(range: Range) -> Axis {
    Axis {
        short: "mean X",
        ..Axis::of("radius (mean X)", "mm", range)
    }
}
