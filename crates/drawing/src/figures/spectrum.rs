//! The amplitude of each harmonic of the error around a turn.

use turnpath_report::{PathSketch, RunReport, Spokes, unit};

use super::along_radius::values;
use crate::frame::{Axis, Frame, NUMBER};
use crate::letters::{Anchor, text, width};
use crate::range::{Range, four_digits};
use crate::series::stems;
use crate::shape::{Area, Shape};
use crate::stack::{Titles, stack};

/// The room above the largest amplitude, for the line on spokes.
const ROOM: f64 = 1.15;
/// Between an amplitude and its text, and between the text and the frame, mm.
const GAP: f64 = 1.2;

pub fn spectrum(report: &RunReport, sketch: &PathSketch, sheet: Area) -> Vec<Shape> {
    let harmonics = values(&sketch.error.harmonics, unit::nm::PER);
    // The mean is no harmonic.
    let y: Vec<f64> = harmonics.into_iter().skip(1).collect();
    let x: Vec<f64> = (1..=y.len()).map(|periods| periods as f64).collect();
    // The first one stands off the frame.
    let across = Range::logarithmic(0.9, (y.len() as f64).max(2.0));
    let across = Axis::of("periods a turn", "", across);
    let range = Range::with_zero(y.iter().map(|amplitude| ROOM * amplitude));
    let up = [Axis::of("amplitude", "nm", range)];
    let titles = Titles::of_stacks(sheet.height, [up.to_vec()]);
    let (frames, mut shapes) = stack(sheet, &across, &up, titles);
    for frame in &frames {
        shapes.extend(stems(frame, &x, &y));
        let spokes = report.path.spokes.as_ref();
        shapes.extend(spokes.and_then(|spokes| spoke_text(frame, spokes)));
    }
    shapes
}

/// The largest spoke in words, above its stem and inside of the frame. Where the frame is narrow it is
/// the amplitude alone, or nothing.
fn spoke_text(frame: &Frame, spokes: &Spokes) -> Option<Shape> {
    let amplitude = spokes.amplitude * unit::nm::PER;
    let size = format!("{} nm", four_digits(amplitude));
    let words = format!("{size}, {} a turn", spokes.per_turn);
    let room = frame.area.width - 2.0 * GAP;
    let fits = |words: &String| amplitude.is_finite() && width(words, NUMBER) <= room;
    let words = [words, size].into_iter().find(fits)?;
    let [x, y] = frame.place(spokes.per_turn as f64, amplitude);
    let half = width(&words, NUMBER) / 2.0 + GAP;
    let x = x.max(frame.area.left + half).min(frame.area.right() - half);
    let y = (y - GAP).max(frame.area.top + GAP + NUMBER);
    Some(text(&words, [x, y], Anchor::Above, NUMBER))
}
