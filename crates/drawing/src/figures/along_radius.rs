//! What runs along the radius of the part.

use turnpath_report::{Samples, TurnSketch, unit};

use crate::frame::Axis;
use crate::range::Range;

/// The room beyond the last turn.
const ROOM: f64 = 1.01;
/// A path that comes so near to the axis of the part, as a share of its radius, is drawn from there on.
const NEAR_AXIS: f64 = 0.1;

/// The mean X of each turn, mm.
pub fn radii(turns: &TurnSketch) -> Vec<f64> {
    values(&turns.radius, unit::mm::PER)
}

/// Numbers in a unit.
pub fn values(samples: &Samples, per: f64) -> Vec<f64> {
    samples.0.iter().map(|value| value * per).collect()
}

/// The axis of the radius, from the axis of the part or from its smallest turn on.
pub fn radius_axis(radii: &[f64]) -> Axis {
    let known = radii.iter().copied().filter(|radius| radius.is_finite());
    let (least, most) = known.fold((f64::MAX, f64::MIN), |(least, most), radius| {
        (least.min(radius), most.max(radius))
    });
    if most < least {
        return axis(Range::even(0.0, 1.0));
    }
    // The last turn ends a little within the rim.
    let most = ROOM * most;
    let from = if least < NEAR_AXIS * most { 0.0 } else { least };
    axis(Range::even(from, most))
}

fn axis(range: Range) -> Axis {
    Axis {
        quantity: "radius (mean X)",
        unit: "mm",
        range,
    }
}
