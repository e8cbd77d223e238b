//! The law of a smooth feed: dN = dρ/F₂(ρ) integrated, as quintic pieces in N.
//!
//! A piece has ρ, ρ' = F₂ and ρ'' = F₂F₂' at both its ends, so the law is C² where pieces join.

use turnpath_plugin::prelude::*;

use crate::smooth::{MARGIN, SmoothFeed};

/// Pieces of the whole range before any is halved.
const FEWEST_PIECES: usize = 8;
/// The most times that a piece is halved. This is far below the width of a table's cell.
const MOST_HALVINGS: usize = 24;
/// Number of parts of a piece. The rate is compared with the feed between them.
const PARTS: usize = 12;
/// Nodes and weights of Gauss' rule of 10th order on (−1, 1), without the middle node.
const GAUSS: [(f64, f64); 2] = [
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];
/// Weight of the middle node.
const GAUSS_MIDDLE: f64 = 128.0 / 225.0;

/// ρ and its first two derivatives in N.
#[derive(Debug, Clone, Copy)]
struct State {
    rho: f64,
    rate: f64,
    second: f64,
}

impl State {
    fn at(feed: &SmoothFeed, rho: f64) -> Self {
        let (value, slope) = feed.at(rho);
        Self {
            rho,
            rate: value,
            second: value * slope,
        }
    }

    fn ends(self) -> [f64; 3] {
        [self.rho, self.rate, self.second]
    }

    /// The same state when the law runs backwards.
    fn reversed(self) -> Self {
        Self {
            rate: -self.rate,
            ..self
        }
    }
}

/// The part of a law between two radii.
#[derive(Debug, Clone, Copy)]
struct Interval {
    from: State,
    to: State,
    length: f64,
}

/// The pieces of the law over `range`, in the order of cutting.
///
/// # Errors
/// If no pieces can follow the feed.
pub fn pieces(
    feed: &SmoothFeed,
    range: RadialRange,
    direction: Direction,
) -> Result<Vec<FeedPiece>> {
    let RadialRange { inner, outer } = range;
    let knot = |i: usize| match i {
        FEWEST_PIECES => outer,
        _ => inner + (outer - inner) * i as f64 / FEWEST_PIECES as f64,
    };
    let mut intervals = Vec::new();
    for i in 0..FEWEST_PIECES {
        divide(feed, knot(i), knot(i + 1), MOST_HALVINGS, &mut intervals)?;
    }
    Ok(match direction {
        Direction::Outward => intervals.iter().map(Interval::piece).collect(),
        Direction::Inward => intervals
            .iter()
            .rev()
            .map(Interval::reversed_piece)
            .collect(),
    })
}

/// Halves (from, to) until each piece's rate follows the feed.
fn divide(
    feed: &SmoothFeed,
    from: f64,
    to: f64,
    halvings: usize,
    out: &mut Vec<Interval>,
) -> Result<()> {
    let interval = Interval {
        from: State::at(feed, from),
        to: State::at(feed, to),
        length: revolutions(feed, from, to),
    };
    if interval.follows(feed) {
        out.push(interval);
        return Ok(());
    }
    if halvings == 0 {
        return Err(StrategyError::failed(format!(
            "no law can follow the feed at ρ = {from} mm, where the feed is {} mm per revolution",
            interval.from.rate
        )));
    }
    let middle = 0.5 * (from + to);
    divide(feed, from, middle, halvings - 1, out)?;
    divide(feed, middle, to, halvings - 1, out)
}

/// ∫ dρ/F₂.
pub fn revolutions(feed: &SmoothFeed, from: f64, to: f64) -> f64 {
    let panels = ((to - from) / feed.scale()).ceil().max(1.0) as usize;
    let half = 0.5 * (to - from) / panels as f64;
    let turns = |rho: f64| 1.0 / feed.at(rho).0;
    let mut sum = 0.0;
    for panel in 0..panels {
        let middle = from + (2 * panel + 1) as f64 * half;
        sum += GAUSS_MIDDLE * turns(middle);
        for (node, weight) in GAUSS {
            sum += weight * (turns(middle - node * half) + turns(middle + node * half));
        }
    }
    sum * half
}

impl Interval {
    fn piece(&self) -> FeedPiece {
        FeedPiece::between(self.from.ends(), self.to.ends(), self.length)
    }

    fn reversed_piece(&self) -> FeedPiece {
        FeedPiece::between(
            self.to.reversed().ends(),
            self.from.reversed().ends(),
            self.length,
        )
    }

    /// Whether the piece's rate equals the feed, to within half the margin that the feed leaves.
    fn follows(&self, feed: &SmoothFeed) -> bool {
        let c = self.piece().coefficients;
        (1..PARTS).all(|i| {
            let n = self.length * i as f64 / PARTS as f64;
            let rho = c.iter().rev().fold(0.0, |sum, c| sum * n + c);
            let rate = (1..6).rev().fold(0.0, |sum, k| sum * n + k as f64 * c[k]);
            let expected = feed.at(rho).0;
            (rate - expected).abs() <= 0.5 * MARGIN * expected
        })
    }
}
