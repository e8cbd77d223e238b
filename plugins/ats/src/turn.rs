//! One turn of the law from the turn before, as polynomials of degree 5.
//!
//! With F(ρ, θ) the feed in the middle of a step, ℓ(N + 1) = ℓ(N) ± F(ℓ(N), 2πN). The rate and the
//! second derivative follow from those of the turn before by the chain rule. All three are exact at
//! the nodes, and the law is C² where pieces join. The distance of the nodes is halved until the
//! pieces follow the recursion between the nodes.

use turnpath_plugin::prelude::*;

use crate::jet::Jet;
use crate::residual_feed::ResidualFeed;

/// Number of pieces of a turn that is tried first: enough for usual astigmatism and coma.
const FEWEST: usize = 24;
/// Number of pieces of a turn at which the search gives up, because the feed has edges.
const MOST: usize = 24 << 8;
/// How far a piece may deviate from the recursion, as a part of the feed. A cusp then changes by 4e-5
/// of itself.
const LARGEST_DEVIATION: f64 = 1e-5;
/// Half the number of pieces makes the error 64 times larger. Half of them are tried if the error
/// is below this part of the limit.
const SLACK: f64 = 1.0 / 256.0;
/// The points at which a piece is compared with the recursion, in parts of its length. They are in
/// step with nothing.
const PROBES: [f64; 2] = [0.381_966, 0.763_932];

/// ρ, dρ/dN and d²ρ/dN².
pub type State = [f64; 3];

/// The share q of the feed in the first two turns, as polynomials of the part of each turn, lowest
/// power first: u⁴ − 0.6u⁵, then 0.4 + u − u⁴ + 0.6u⁵. From then on q is 1.
///
/// q begins at rest and ends at rest, with two continuous derivatives. Every turn adds to its rate
/// what q did on the turns before, and q'(u) + q'(1 + u) = 1. So the rate is even from the second
/// turn on where nothing follows the angle. A q over one turn alone, from rest to rest, would stop
/// X at every whole turn of the path. The first turn stays within q(1) = 0.4 feeds of its circle,
/// so at most 0.64 of a cusp stays at the edge.
const RUN_IN: [[f64; 6]; 2] = [
    [0.0, 0.0, 0.0, 0.0, 1.0, -0.6],
    [0.4, 1.0, 0.0, 0.0, -1.0, 0.6],
];

/// A turn as pieces of one length.
#[derive(Debug, Clone)]
pub struct Turn {
    /// The pieces, in order.
    pub pieces: Vec<FeedPiece>,
}

impl Turn {
    /// Value, rate and second derivative in N at a part of the turn.
    fn state(&self, part: f64) -> State {
        let count = self.pieces.len();
        let place = part * count as f64;
        let at = (place.floor() as usize).min(count.saturating_sub(1));
        let Some(piece) = self.pieces.get(at) else {
            return [f64::NAN; 3];
        };
        let n = (place - at as f64) * piece.length;
        polynomial(&piece.coefficients, n)
    }
}

/// The pieces of a law in reverse: ρ(N) = ℓ(N_end − N).
pub fn backwards(pieces: &[FeedPiece]) -> impl Iterator<Item = FeedPiece> {
    pieces.iter().rev().map(|piece| {
        let at = |n: f64| {
            let [value, rate, second] = polynomial(&piece.coefficients, n);
            [value, -rate, second]
        };
        FeedPiece::between(at(piece.length), at(0.0), piece.length)
    })
}

/// Value, rate and second derivative of a polynomial at `n`.
fn polynomial(c: &[f64; 6], n: f64) -> State {
    let value = c.iter().rev().fold(0.0, |sum, c| sum * n + c);
    let rate = (1..6).rev().fold(0.0, |sum, k| sum * n + k as f64 * c[k]);
    let second = (2..6)
        .rev()
        .fold(0.0, |sum, k| sum * n + (k * (k - 1)) as f64 * c[k]);
    [value, rate, second]
}

/// What precedes a turn.
struct Predecessor<'a> {
    /// The turn before; `None` at the start of the path.
    turn: Option<&'a Turn>,
    /// The circle at which the path begins, mm.
    circle: f64,
    /// The number of the turn, from 0 on.
    number: usize,
}

impl Predecessor<'_> {
    fn state(&self, part: f64) -> State {
        match self.turn {
            None => [self.circle, 0.0, 0.0],
            Some(turn) => turn.state(part),
        }
    }

    /// q and its derivatives.
    fn share(&self, part: f64) -> State {
        match RUN_IN.get(self.number) {
            Some(share) => polynomial(share, part),
            None => [1.0, 0.0, 0.0],
        }
    }
}

/// The orientation of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orientation {
    /// 1 outward, −1 inward.
    pub outward: f64,
    /// 1 if θ grows with N; −1 for a law that is run backwards.
    pub sense: f64,
}

/// What the turns of a law have found, for the turns that follow.
#[derive(Debug, Clone, Copy, Default)]
pub struct Findings {
    /// Number of pieces that the next turn tries first.
    count: Option<usize>,
    /// The factor of the feed of circles.
    factor: Option<f64>,
}

/// Computes turns.
pub struct Turns<'a> {
    feed: ResidualFeed<'a>,
    orientation: Orientation,
    /// Number of pieces that the next turn tries first.
    count: usize,
    theta: Vec<f64>,
    rho: Vec<f64>,
    jets: [Vec<Jet>; 2],
    values: [Vec<f64>; 2],
}

impl<'a> Turns<'a> {
    /// The turns of one task, with what the turns before have found.
    pub fn new(setup: Setup<'a>, orientation: Orientation, found: Findings) -> Self {
        let range = setup.task.range;
        let start = match orientation.outward > 0.0 {
            true => range.inner,
            false => range.outer,
        };
        Self {
            feed: ResidualFeed::new(setup, start, found.factor),
            orientation,
            count: found.count.unwrap_or(FEWEST),
            theta: Vec::new(),
            rho: Vec::new(),
            jets: Default::default(),
            values: Default::default(),
        }
    }

    /// What the turns have found.
    pub fn findings(&self) -> Findings {
        Findings {
            count: Some(self.count),
            factor: self.feed.factor(),
        }
    }

    /// Turn number `number` of a law that begins at the radius `circle`, after the turn before it.
    pub fn turn(&mut self, number: usize, circle: f64, before: Option<&Turn>) -> Result<Turn> {
        self.next(&Predecessor {
            turn: before,
            circle,
            number,
        })
    }

    fn next(&mut self, before: &Predecessor<'_>) -> Result<Turn> {
        loop {
            let turn = self.fit(before)?;
            let deviation = self.deviation(before, &turn)?;
            if deviation <= LARGEST_DEVIATION {
                if deviation <= SLACK * LARGEST_DEVIATION && self.count > FEWEST {
                    self.count /= 2;
                }
                return Ok(turn);
            }
            if self.count >= MOST {
                return Err(no_edges(before.state(0.0)[0]));
            }
            self.count *= 2;
        }
    }

    /// Pieces with the states of the recursion at their ends.
    fn fit(&mut self, before: &Predecessor<'_>) -> Result<Turn> {
        let count = self.count;
        let parts: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
        let states = self.states(before, &parts)?;
        let length = 1.0 / count as f64;
        let pieces = states.windows(2);
        Ok(Turn {
            pieces: pieces
                .map(|ends| FeedPiece::between(ends[0], ends[1], length))
                .collect(),
        })
    }

    /// The states one turn later than those at the given parts of the turn before.
    fn states(&mut self, before: &Predecessor<'_>, parts: &[f64]) -> Result<Vec<State>> {
        self.load(before, parts);
        let Orientation { outward, sense } = self.orientation;
        let feeds = self.feeds()?;
        Ok(feeds
            .iter()
            .zip(parts)
            .map(|(feed, part)| {
                let state = before.state(*part);
                advance(
                    state,
                    before.share(*part),
                    along(feed, state, sense),
                    outward,
                )
            })
            .collect())
    }

    /// F at the points in the buffers: the feed at ρ ± ½f(ρ), as a function of (θ, ρ). The points
    /// move there.
    fn feeds(&mut self) -> Result<&[Jet]> {
        let half = 0.5 * self.orientation.outward;
        let [inner, outer] = &mut self.jets;
        self.feed.jets(&self.theta, &self.rho, inner)?;
        for (jet, rho) in inner.iter_mut().zip(&mut self.rho) {
            *jet = Jet::radius(*rho).plus(half, jet);
            *rho = jet.value;
        }
        self.feed.jets(&self.theta, &self.rho, outer)?;
        for (outer, middle) in outer.iter_mut().zip(inner.iter()) {
            *outer = outer.through(middle);
        }
        Ok(outer)
    }

    /// The largest distance of a turn from the recursion, in parts of the feed.
    fn deviation(&mut self, before: &Predecessor<'_>, turn: &Turn) -> Result<f64> {
        let count = turn.pieces.len() as f64;
        let parts: Vec<f64> = (0..turn.pieces.len())
            .flat_map(|i| PROBES.map(|probe| (i as f64 + probe) / count))
            .collect();
        self.load(before, &parts);
        let half = 0.5 * self.orientation.outward;
        let [inner, outer] = &mut self.values;
        self.feed.values(&self.theta, &self.rho, inner)?;
        for (rho, feed) in self.rho.iter_mut().zip(inner.iter()) {
            *rho += half * feed;
        }
        self.feed.values(&self.theta, &self.rho, outer)?;
        let mut deviation: f64 = 0.0;
        for (part, feed) in parts.iter().zip(outer.iter()) {
            let step = self.orientation.outward * before.share(*part)[0] * feed;
            let exact = before.state(*part)[0] + step;
            deviation = deviation.max((turn.state(*part)[0] - exact).abs() / feed);
        }
        Ok(deviation)
    }

    fn load(&mut self, before: &Predecessor<'_>, parts: &[f64]) {
        self.theta.clear();
        let turn = self.orientation.sense * TAU;
        self.theta.extend(parts.iter().map(|part| turn * part));
        self.rho.clear();
        self.rho
            .extend(parts.iter().map(|part| before.state(*part)[0]));
    }
}

/// Turns a function of (θ, ρ) into a function of N along the law, with its first two derivatives.
fn along(feed: &Jet, [_, rate, second]: State, sense: f64) -> State {
    let turn = sense * TAU;
    [
        feed.value,
        turn * feed.t + feed.r * rate,
        turn * (turn * feed.tt + 2.0 * feed.tr * rate) + feed.rr * rate * rate + feed.r * second,
    ]
}

/// ℓ ± q·F.
fn advance(state: State, share: State, feed: State, outward: f64) -> State {
    let step = [
        share[0] * feed[0],
        share[1] * feed[0] + share[0] * feed[1],
        share[2] * feed[0] + 2.0 * share[1] * feed[1] + share[0] * feed[2],
    ];
    std::array::from_fn(|k| state[k] + outward * step[k])
}

fn no_edges(rho: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the feed that holds the residual is not smooth around ρ = {rho:.3} mm, so no law can \
         follow it at every angle; choose feed `atpg`"
    ))
}
