//! The motion of X and Z against the radius, with the machine's limits.

use turnpath_core::{Axis as MachineAxis, Derivative};
use turnpath_report::{AxisSketch, PathSketch, RunReport, Samples, unit};

use super::along_radius::{radii, radius_axis, values};
use crate::frame::{Axis, stack};
use crate::range::Range;
use crate::series::{curve, limit};
use crate::shape::{Area, Shape};

/// A panel: what it shows, and the limit of it.
struct Motion {
    axis: Axis,
    values: Vec<f64>,
    limit: Option<f64>,
}

pub fn axes(report: &RunReport, sketch: &PathSketch, sheet: Area) -> Vec<Shape> {
    let turns = &sketch.turns;
    let radii = radii(turns);
    let columns = [(MachineAxis::X, &turns.x), (MachineAxis::Z, &turns.z)];
    let width = sheet.width / 2.0;
    let mut shapes = Vec::new();
    for (at, (which, sketch)) in columns.into_iter().enumerate() {
        let area = Area {
            left: sheet.left + at as f64 * width,
            width,
            ..sheet
        };
        shapes.extend(column(area, &radii, &motions(report, which, sketch)));
    }
    shapes
}

/// Velocity, acceleration and jerk of an axis above each other.
fn column(area: Area, radii: &[f64], motions: &[Motion]) -> Vec<Shape> {
    let axes: Vec<Axis> = motions.iter().map(|motion| motion.axis).collect();
    let (frames, mut shapes) = stack(area, &radius_axis(radii), &axes);
    for (frame, motion) in frames.iter().zip(motions) {
        shapes.push(curve(frame, radii, &motion.values));
        shapes.extend(motion.limit.map(|value| limit(frame, value)));
    }
    shapes
}

fn motions(report: &RunReport, axis: MachineAxis, sketch: &AxisSketch) -> [Motion; 3] {
    let words = match axis {
        MachineAxis::X => ["X velocity", "X acceleration", "X jerk"],
        _ => ["Z velocity", "Z acceleration", "Z jerk"],
    };
    let units = ["mm/s", "mm/s²", "mm/s³"];
    let all: [(Derivative, &Samples); 3] = [
        (Derivative::Velocity, &sketch.velocity),
        (Derivative::Acceleration, &sketch.acceleration),
        (Derivative::Jerk, &sketch.jerk),
    ];
    let limits = report
        .path
        .machine
        .iter()
        .flat_map(|machine| &machine.limits);
    let limits: Vec<_> = limits.map(|figure| figure.limit).collect();
    std::array::from_fn(|i| {
        let (derivative, samples) = all[i];
        let values = values(samples, unit::mm::PER);
        let known = values.iter().copied().filter(|value| value.is_finite());
        let limit = limits
            .iter()
            .find(|limit| limit.axis == axis && limit.derivative == derivative)
            .map(|limit| limit.value);
        let most = known.chain(limit).fold(0.0, f64::max);
        let axis = Axis {
            quantity: words[i],
            unit: units[i],
            range: Range::from_zero(most),
        };
        Motion {
            axis,
            values,
            limit,
        }
    })
}
