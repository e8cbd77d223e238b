//! The amplitude of each harmonic of the error around a turn.

use turnpath_report::{PathSketch, RunReport, Spokes, unit};

use crate::frame::{Axis, Frame, NUMBER, stack};
use crate::letters::{Anchor, text, width};
use crate::range::{Range, four_digits};
use crate::series::stems;
use crate::shape::{Area, Shape};

/// The room above the largest amplitude, for the line on spokes.
const ROOM: f64 = 1.15;
/// Between an amplitude and its text, mm.
const GAP: f64 = 1.2;

pub fn spectrum(report: &RunReport, sketch: &PathSketch, sheet: Area) -> Vec<Shape> {
    // The mean is no harmonic.
    let harmonics = sketch.error.harmonics.0.iter().skip(1);
    let y: Vec<f64> = harmonics
        .map(|amplitude| amplitude * unit::nm::PER)
        .collect();
    let x: Vec<f64> = (1..=y.len()).map(|periods| periods as f64).collect();
    let last = y.len() as f64;
    let most = y.iter().copied().filter(|amplitude| amplitude.is_finite());
    let across = Axis {
        quantity: "periods a turn",
        unit: "",
        // The first one stands off the frame.
        range: Range::logarithmic(0.9, last.max(2.0)),
    };
    let up = Axis {
        quantity: "amplitude",
        unit: "nm",
        range: Range::from_zero(ROOM * most.fold(0.0, f64::max)),
    };
    let (frames, mut shapes) = stack(sheet, &across, &[up]);
    for frame in &frames {
        shapes.extend(stems(frame, &x, &y));
        let spokes = report.path.spokes.as_ref();
        shapes.extend(spokes.map(|spokes| spoke_text(frame, spokes)));
    }
    shapes
}

/// The largest spoke in words, above its stem and inside of the frame.
fn spoke_text(frame: &Frame, spokes: &Spokes) -> Shape {
    let amplitude = spokes.amplitude * unit::nm::PER;
    let words = format!("{} nm, {} a turn", four_digits(amplitude), spokes.per_turn);
    let [x, y] = frame.place(spokes.per_turn as f64, amplitude);
    let half = width(&words, NUMBER) / 2.0 + GAP;
    let (left, right) = (frame.area.left + half, frame.area.right() - half);
    let x = x.max(left).min(right.max(left));
    text(&words, [x, y - GAP], Anchor::Above, NUMBER)
}
