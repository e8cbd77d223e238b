//! The error map, as the page of a result has it.

use turnpath_report::{ErrorMap, PathSketch, Samples, unit};

use super::along_radius::values;
use super::square_part::axes;
use crate::colours::ColourScale;
use crate::frame::Axis;
use crate::range::Range;
use crate::shape::{Area, Shape};
use crate::square::square;

/// The part of the radius whose cells set the scale: at its rim a path may leave material of
/// another scale.
const INNER: f64 = 0.95;
/// The share of the highest and of the lowest cells that the scale leaves out.
const BEYOND: f64 = 0.002;

pub fn map(sketch: &PathSketch, sheet: Area) -> Vec<Shape> {
    let nothing = ErrorMap {
        cells: 0,
        half: 1.0,
        errors: Samples::default(),
    };
    let map = sketch.error.map.as_ref().unwrap_or(&nothing);
    let errors = values(&map.errors, unit::nm::PER);
    let range = range_of(&errors, map.cells);
    let scale = ColourScale {
        from: range.from,
        to: range.to,
    };
    let bar = Axis::of("error", "nm", range);
    let (x, y) = axes(map.half * unit::mm::PER);
    let (frame, axes) = square(sheet, (&x, &y), (&bar, scale));
    let picture = (!errors.is_empty()).then(|| Shape::Picture {
        pixels: scale.pixels(&errors, map.cells),
        area: frame.area,
    });
    let picture = Shape::Group {
        name: "map".to_owned(),
        shapes: picture.into_iter().collect(),
    };
    [vec![picture], axes].concat()
}

/// From the lowest cell of the inner part to its highest, but for some.
fn range_of(errors: &[f64], cells: usize) -> Range {
    let middle = |index: usize| (2 * index + 1) as f64 / cells as f64 - 1.0;
    let inner = |(index, error): (usize, &f64)| {
        let (x, y) = (middle(index % cells), middle(index / cells));
        let counts = !error.is_nan() && x * x + y * y < INNER * INNER;
        counts.then_some(*error)
    };
    let mut values: Vec<f64> = errors.iter().enumerate().filter_map(inner).collect();
    values.sort_unstable_by(f64::total_cmp);
    let off = (BEYOND * values.len().saturating_sub(1) as f64) as usize;
    let at = |index: usize| values.get(index).copied().unwrap_or(f64::NAN);
    Range::even(at(off), at(values.len().saturating_sub(1 + off)))
}
