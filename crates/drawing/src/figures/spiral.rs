//! Places of the tool, coloured by the error of the path there.

use turnpath_report::{PathSketch, unit};

use super::along_radius::values;
use super::square_part::axes;
use crate::colours::ColourScale;
use crate::frame::{Axis, Frame};
use crate::range::Range;
use crate::series::dots;
use crate::shape::{Area, Place, Shape};
use crate::square::square;

/// Diameter of a place, mm.
const DOT: f64 = 0.35;
/// Colours that are told apart.
const LEVELS: usize = 64;
/// Below it there is rounding alone, nm.
const LEAST: f64 = 1e-6;
/// The room around the spiral, as a share of its radius.
const ROOM: f64 = 1.03;

pub fn spiral(sketch: &PathSketch, sheet: Area) -> Vec<Shape> {
    let spiral = &sketch.spiral;
    let errors = values(&spiral.errors, unit::nm::PER);
    let known = errors.iter().copied().filter(|error| error.is_finite());
    let most = known.fold(0.0, f64::max);
    let bar = Axis {
        short: "interpolation",
        ..Axis::of("|played − true|", "nm", Range::even(0.0, most.max(LEAST)))
    };
    let scale = ColourScale {
        from: bar.range.from,
        to: bar.range.to,
    };
    let sides = [&spiral.x, &spiral.y].map(|side| values(side, unit::mm::PER));
    let known = sides.iter().flatten().filter(|side| side.is_finite());
    let half = known.fold(0.0, |half: f64, side| half.max(side.abs()));
    let (x, y) = axes(ROOM * half);
    let (frame, axes) = square(sheet, (&x, &y), (&bar, scale));
    let [x, y] = &sides;
    let places = x.iter().zip(y).zip(&errors);
    let places = places.map(|((x, y), error)| ([*x, *y], *error));
    let shapes = levels(&frame, places, scale);
    let spiral = Shape::Group {
        name: "spiral".to_owned(),
        shapes,
    };
    [vec![spiral], axes].concat()
}

/// The places of each level, the largest errors last, so that none lies below another.
fn levels(
    frame: &Frame,
    places: impl Iterator<Item = (Place, f64)>,
    scale: ColourScale,
) -> Vec<Shape> {
    let mut levels: Vec<Vec<Place>> = vec![Vec::new(); LEVELS];
    let known =
        |([x, y], error): &(Place, f64)| [x, y, error].into_iter().all(|value| value.is_finite());
    for ([x, y], error) in places.filter(known) {
        let share = (error - scale.from) / (scale.to - scale.from);
        let level = ((share * LEVELS as f64) as usize).min(LEVELS - 1);
        if let Some(level) = levels.get_mut(level) {
            level.push(frame.place(x, y));
        }
    }
    let level = |(level, places): (usize, &Vec<Place>)| {
        let middle = (level as f64 + 0.5) / LEVELS as f64;
        let colour = scale.colour(scale.from + middle * (scale.to - scale.from));
        (!places.is_empty()).then(|| dots(places, DOT, colour))
    };
    levels.iter().enumerate().filter_map(level).collect()
}
