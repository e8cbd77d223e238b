//! What is drawn inside of a frame.

use crate::colours::{BLUE, LIMIT};
use crate::frame::Frame;
use crate::shape::{Colour, Ink, Place, Shape, Step};

/// Width of a curve, mm.
const CURVE: f64 = 0.25;
/// Width of a stem, mm.
const STEM: f64 = 0.12;
/// Diameter of the head of a stem, mm.
const HEAD: f64 = 0.55;
/// Dashes of a limit and their gaps, mm.
const DASH: f64 = 1.2;

/// A curve; values that are no numbers interrupt it.
pub fn curve(frame: &Frame, x: &[f64], y: &[f64]) -> Shape {
    let mut steps = Vec::new();
    let mut continues = false;
    for (x, y) in x.iter().zip(y) {
        let known = x.is_finite() && y.is_finite();
        if known {
            let place = frame.place(*x, *y);
            steps.push(match continues {
                true => Step::Line(place),
                false => Step::Move(place),
            });
        }
        continues = known;
    }
    Shape::Outline {
        steps,
        ink: Ink::Line {
            width: CURVE,
            dash: None,
        },
        colour: BLUE,
        label: None,
    }
}

/// A limit: a dashed line across the frame.
pub fn limit(frame: &Frame, value: f64) -> Shape {
    let ends = [frame.x.from, frame.x.to].map(|x| frame.place(x, value));
    let line = Shape::line(&ends, CURVE, LIMIT);
    match line {
        Shape::Outline { steps, colour, .. } => Shape::Outline {
            steps,
            colour,
            ink: Ink::Line {
                width: CURVE,
                dash: Some(DASH),
            },
            label: Some("limit".to_owned()),
        },
        other => other,
    }
}

/// A stem with a head for each value.
pub fn stems(frame: &Frame, x: &[f64], y: &[f64]) -> Vec<Shape> {
    let known = x.iter().zip(y).filter(|(_, y)| y.is_finite());
    let heads: Vec<Place> = known.map(|(x, y)| frame.place(*x, *y)).collect();
    let foot = frame.area.bottom();
    let lines = heads
        .iter()
        .flat_map(|[x, y]| [Step::Move([*x, foot]), Step::Line([*x, *y])]);
    let lines = Shape::Outline {
        steps: lines.collect(),
        ink: Ink::Line {
            width: STEM,
            dash: None,
        },
        colour: BLUE,
        label: None,
    };
    vec![lines, dots(&heads, HEAD, BLUE)]
}

/// A dot at each place.
pub fn dots(places: &[Place], diameter: f64, colour: Colour) -> Shape {
    /// The corner of an octagon of the width 1, beside the middle of its side.
    const CORNER: f64 = 0.207_107;
    let dot = |[x, y]: &Place| {
        let (side, corner) = (0.5 * diameter, CORNER * diameter);
        let corners = [
            [side, corner],
            [corner, side],
            [-corner, side],
            [-side, corner],
            [-side, -corner],
            [-corner, -side],
            [corner, -side],
            [side, -corner],
        ];
        let (x, y) = (*x, *y);
        let steps = corners.into_iter().enumerate().map(move |(at, corner)| {
            let place = [x + corner[0], y + corner[1]];
            match at {
                0 => Step::Move(place),
                _ => Step::Line(place),
            }
        });
        steps.chain([Step::Close])
    };
    Shape::Outline {
        steps: places.iter().flat_map(dot).collect(),
        ink: Ink::Fill,
        colour,
        label: None,
    }
}
