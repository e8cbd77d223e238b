//! Formulas whose height jumps where an angle ends: θ goes from −π to π, and no tool follows a wall.

use turnpath_plugin::prelude::Scalar;

use crate::complaint::{Complaint, Mistake};
use crate::graph::{Graph, Node};
use crate::lexer::{Kind, tokens};
use crate::names::{Function, PairFunction, Variable};
use crate::tape::Tape;

/// Radii that are tried in each decade, from the smallest part to the largest one.
const PER_DECADE: i32 = 10;
/// The decades of the radii, mm.
const DECADES: std::ops::RangeInclusive<i32> = -3..=2;
/// A difference below this share of the heights on the ring is rounding.
const ROUNDING: f64 = 1e-9;
/// Heights below this are none, mm.
const NO_HEIGHT: f64 = 1e-15;

/// The words whose value may jump.
const WORDS: [&str; 3] = ["theta", "atan2", "atan"];

/// A direction from the axis, on both sides of it: the sign of a zero is the side.
struct Ray {
    angle: &'static str,
    sides: [[f64; 2]; 2],
}

const RAYS: [Ray; 4] = [
    Ray {
        angle: "180 deg",
        sides: [[-1.0, 0.0], [-1.0, -0.0]],
    },
    Ray {
        angle: "-90 deg",
        sides: [[0.0, -1.0], [-0.0, -1.0]],
    },
    Ray {
        angle: "90 deg",
        sides: [[0.0, 1.0], [-0.0, 1.0]],
    },
    Ray {
        angle: "0 deg",
        sides: [[1.0, 0.0], [1.0, -0.0]],
    },
];

/// A jump of the height.
pub struct Jump {
    jump: f64,
    angle: &'static str,
}

/// The first jump that is found at the ends of an angle.
pub fn jump(graph: &Graph, tape: &Tape) -> Option<Jump> {
    let has_angle = graph.nodes().iter().any(|node| {
        matches!(
            node,
            Node::Variable(Variable::Theta)
                | Node::Two(PairFunction::Atan2, ..)
                | Node::One(Function::Atan, _)
        )
    });
    if !has_angle {
        return None;
    }
    RAYS.iter().find_map(|ray| {
        radii().find_map(|radius| {
            let height = |[x, y]: [f64; 2]| tape.at(radius * x, radius * y);
            let [one, other] = ray.sides.map(height);
            let jump = (one - other).abs();
            // Nothing is known where one side has no height.
            let is_jump = jump.is_finite() && jump > ROUNDING * size(tape, radius);
            is_jump.then_some(Jump {
                jump,
                angle: ray.angle,
            })
        })
    })
}

fn radii() -> impl Iterator<Item = f64> {
    DECADES.flat_map(|decade| {
        (0..PER_DECADE).map(move |part| {
            let exponent = f64::from(decade) + f64::from(part) / f64::from(PER_DECADE);
            Scalar::exp(exponent * std::f64::consts::LN_10)
        })
    })
}

/// The largest height on a ring, mm.
fn size(tape: &Tape, radius: f64) -> f64 {
    let heights = (0..16).map(|k| {
        let (sin, cos) = Scalar::sin_cos(f64::from(k) + 0.5);
        tape.at(radius * cos, radius * sin)
    });
    heights
        .map(f64::abs)
        .filter(|z| z.is_finite())
        .fold(NO_HEIGHT, f64::max)
}

impl Jump {
    /// What happens, without a place in a text.
    pub fn sentence(&self) -> String {
        format!("the height jumps by {:.3e} mm at {}", self.jump, self.angle)
    }

    /// The complaint at the first angle of the text.
    pub fn complaint(self, text: &str) -> Complaint {
        let tokens = tokens(text).unwrap_or_default();
        let is_angle = |kind: &Kind, word: &str| *kind == Kind::Name && WORDS.contains(&word);
        let angle = tokens.into_iter().find(|token| {
            let word = text.get(token.place.clone()).unwrap_or_default();
            is_angle(&token.kind, word)
        });
        let place = angle.map_or(0..text.len(), |token| token.place);
        let Self { jump, angle } = self;
        Mistake::Jump { jump, angle }.at(place)
    }
}
