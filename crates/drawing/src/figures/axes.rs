//! The motion of X and Z against the radius, with the machine's limits.

use turnpath_core::{Axis as MachineAxis, Derivative};
use turnpath_report::{AxisSketch, PathSketch, RunReport, Samples, unit};

use super::along_radius::{radii, radius_axis, values};
use crate::frame::Axis;
use crate::range::Range;
use crate::series::{curve, limit};
use crate::shape::{Area, Shape};
use crate::stack::{Titles, stack};

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
    let columns = columns.map(|(which, sketch)| motions(report, which, sketch));
    let titles = Titles::of_stacks(sheet.height, columns.iter().map(|motions| axes_of(motions)));
    let mut shapes = Vec::new();
    for (at, motions) in columns.iter().enumerate() {
        let area = Area {
            left: sheet.left + at as f64 * width,
            width,
            ..sheet
        };
        shapes.extend(column(area, &radii, motions, titles));
    }
    shapes
}

fn axes_of(motions: &[Motion]) -> Vec<Axis> {
    motions.iter().map(|motion| motion.axis).collect()
}

/// Velocity, acceleration and jerk of an axis above each other.
fn column(area: Area, radii: &[f64], motions: &[Motion], titles: Titles) -> Vec<Shape> {
    let (frames, mut shapes) = stack(area, &radius_axis(radii), &axes_of(motions), titles);
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
    let short_words = match axis {
        MachineAxis::X => ["X velocity", "X accel.", "X jerk"],
        _ => ["Z velocity", "Z accel.", "Z jerk"],
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
        let limit = limits
            .iter()
            .find(|limit| limit.axis == axis && limit.derivative == derivative)
            .map(|limit| limit.value);
        let range = Range::with_zero(values.iter().copied().chain(limit));
        let axis = Axis {
            short: short_words[i],
            ..Axis::of(words[i], units[i], range)
        };
        Motion {
            axis,
            values,
            limit,
        }
    })
}
