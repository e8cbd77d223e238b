//! Feed, control points and speed of the spindle against the radius.

use turnpath_report::{PathSketch, Samples, unit};

use super::along_radius::{radii, radius_axis, values};
use crate::frame::Axis;
use crate::range::Range;
use crate::series::curve;
use crate::shape::{Area, Shape};
use crate::stack::{Titles, stack};

pub fn feed(sketch: &PathSketch, sheet: Area) -> Vec<Shape> {
    let turns = &sketch.turns;
    let axis = |quantity, unit, samples: &Samples, per| {
        let values = values(samples, per);
        let range = Range::with_zero(values.iter().copied());
        (Axis::of(quantity, unit, range), values)
    };
    let panels = [
        axis("feed", "µm/rev", &turns.feed, unit::um::PER),
        axis("points a turn", "", &turns.points_per_turn, unit::one::PER),
        axis("spindle", "rpm", &turns.spindle, unit::rpm::PER),
    ];
    let radii = radii(turns);
    let axes: Vec<Axis> = panels.iter().map(|(axis, _)| *axis).collect();
    let titles = Titles::of_stacks(sheet.height, [axes.clone()]);
    let (frames, mut shapes) = stack(sheet, &radius_axis(&radii), &axes, titles);
    let curves = frames.iter().zip(&panels);
    shapes.extend(curves.map(|(frame, (_, values))| curve(frame, &radii, values)));
    shapes
}
