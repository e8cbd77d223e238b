//! One turn of the law from the one before, as polynomials of degree 5.
//!
//! With F(ρ, θ) the feed in the middle of a step, ℓ(N + 1) = ℓ(N) ± F(ℓ(N), 2πN), and so do rate and
//! second derivative follow from those a turn before, by the chain rule: all three are exact at
//! the nodes, and the law is C² wherever pieces join. Nodes are halved apart until the pieces
//! follow the recursion between them.

use turnpath_plugin::prelude::*;

use crate::held::ResidualFeed;
use crate::jet::Jet;

/// Pieces of a turn at first: enough for astigmatism and coma as they come.
const FEWEST: usize = 24;
/// Pieces of a turn at which it is given up: the feed has edges.
const MOST: usize = 24 << 8;
/// How far a piece may stray from the recursion, as a part of the feed: a cusp then changes by
/// 4e-5 of itself.
const STRAY: f64 = 1e-5;
/// Halving the count of pieces makes the error 64 times larger; below this part of what is allowed
/// it is tried.
const SLACK: f64 = 1.0 / 256.0;
/// Where in a piece it is held against the recursion, in parts of its length: in step with
/// nothing.
const PROBES: [f64; 2] = [0.381_966, 0.763_932];

/// ρ, dρ/dN and d²ρ/dN².
pub type State = [f64; 3];

/// How much q of the feed is taken in the first two turns, against the part of each, lowest power
/// first: u⁴ − 0.6u⁵, then 0.4 + u − u⁴ + 0.6u⁵, and all of it from then on.
///
/// q comes from rest and ends at rest, with two continuous derivatives. Since every turn adds what q
/// does on it to the rate of those before, and q'(u) + q'(1 + u) = 1, the rate is even from the second
/// turn on where nothing follows the angle: one turn alone, from rest to rest, would stop X at every
/// whole turn of the path. The first turn keeps within q(1) = 0.4 feeds of its circle, so no more
/// than 0.64 of a cusp stays at the edge.
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
    /// Value, rate and second derivative at a part of the turn, in N.
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

/// The pieces of a law the other way round: ρ(N) = ℓ(N_end − N).
pub fn backwards(pieces: &[FeedPiece]) -> impl Iterator<Item = FeedPiece> {
    pieces.iter().rev().map(|piece| {
        let at = |n: f64| {
            let [value, rate, second] = polynomial(&piece.coefficients, n);
            [value, -rate, second]
        };
        FeedPiece::between(at(piece.length), at(0.0), piece.length)
    })
}

/// Value, rate and second derivative.
fn polynomial(c: &[f64; 6], n: f64) -> State {
    let value = c.iter().rev().fold(0.0, |sum, c| sum * n + c);
    let rate = (1..6).rev().fold(0.0, |sum, k| sum * n + k as f64 * c[k]);
    let second = (2..6)
        .rev()
        .fold(0.0, |sum, k| sum * n + (k * (k - 1)) as f64 * c[k]);
    [value, rate, second]
}

/// What a turn is made from.
struct Before<'a> {
    /// The turn before; none where the path begins.
    turn: Option<&'a Turn>,
    /// The circle that the path begins at, mm.
    circle: f64,
    /// The turn's number, from 0 on.
    number: usize,
}

impl Before<'_> {
    fn state(&self, part: f64) -> State {
        match self.turn {
            None => [self.circle, 0.0, 0.0],
            Some(turn) => turn.state(part),
        }
    }

    /// q with its derivatives.
    fn share(&self, part: f64) -> State {
        match RUN_IN.get(self.number) {
            Some(share) => polynomial(share, part),
            None => [1.0, 0.0, 0.0],
        }
    }
}

/// Which way a law is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way {
    /// 1 outward, −1 inward.
    pub outward: f64,
    /// 1 where θ grows with N; −1 for a law that is run backwards.
    pub sense: f64,
}

/// Makes turns.
pub struct Turns<'a> {
    feed: ResidualFeed<'a>,
    way: Way,
    /// Pieces of the next turn, to begin with.
    count: usize,
    theta: Vec<f64>,
    rho: Vec<f64>,
    jets: [Vec<Jet>; 2],
    values: [Vec<f64>; 2],
}

impl<'a> Turns<'a> {
    /// For one task, with `count` pieces to begin with; `None` for a law that begins.
    pub fn new(setup: Setup<'a>, way: Way, count: Option<usize>) -> Self {
        Self {
            feed: ResidualFeed::new(setup),
            way,
            count: count.unwrap_or(FEWEST),
            theta: Vec::new(),
            rho: Vec::new(),
            jets: Default::default(),
            values: Default::default(),
        }
    }

    /// How many pieces the next turn should try.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Turn `number` of a law that begins at the radius `circle`, after the turn before it.
    pub fn turn(&mut self, number: usize, circle: f64, before: Option<&Turn>) -> Result<Turn> {
        self.next(&Before {
            turn: before,
            circle,
            number,
        })
    }

    fn next(&mut self, before: &Before<'_>) -> Result<Turn> {
        loop {
            let turn = self.fit(before)?;
            let stray = self.stray(before, &turn)?;
            if stray <= STRAY {
                if stray <= SLACK * STRAY && self.count > FEWEST {
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

    /// Pieces with the recursion's states at their ends.
    fn fit(&mut self, before: &Before<'_>) -> Result<Turn> {
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

    /// The states a turn on from those at the given parts of the turn before.
    fn states(&mut self, before: &Before<'_>, parts: &[f64]) -> Result<Vec<State>> {
        self.hold(before, parts);
        let Way { outward, sense } = self.way;
        let feeds = self.feeds()?;
        Ok(feeds
            .iter()
            .zip(parts)
            .map(|(feed, part)| {
                let state = before.state(*part);
                onward(
                    state,
                    before.share(*part),
                    along(feed, state, sense),
                    outward,
                )
            })
            .collect())
    }

    /// F at the places held: the feed at ρ ± ½f(ρ), as a function of (θ, ρ). The places move there.
    fn feeds(&mut self) -> Result<&[Jet]> {
        let half = 0.5 * self.way.outward;
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
    fn stray(&mut self, before: &Before<'_>, turn: &Turn) -> Result<f64> {
        let count = turn.pieces.len() as f64;
        let parts: Vec<f64> = (0..turn.pieces.len())
            .flat_map(|i| PROBES.map(|probe| (i as f64 + probe) / count))
            .collect();
        self.hold(before, &parts);
        let half = 0.5 * self.way.outward;
        let [inner, outer] = &mut self.values;
        self.feed.values(&self.theta, &self.rho, inner)?;
        for (rho, feed) in self.rho.iter_mut().zip(inner.iter()) {
            *rho += half * feed;
        }
        self.feed.values(&self.theta, &self.rho, outer)?;
        let mut stray: f64 = 0.0;
        for (part, feed) in parts.iter().zip(outer.iter()) {
            let taken = self.way.outward * before.share(*part)[0] * feed;
            let exact = before.state(*part)[0] + taken;
            stray = stray.max((turn.state(*part)[0] - exact).abs() / feed);
        }
        Ok(stray)
    }

    fn hold(&mut self, before: &Before<'_>, parts: &[f64]) {
        self.theta.clear();
        let turn = self.way.sense * TAU;
        self.theta.extend(parts.iter().map(|part| turn * part));
        self.rho.clear();
        self.rho
            .extend(parts.iter().map(|part| before.state(*part)[0]));
    }
}

/// A function of (θ, ρ) along the law, as one of N with its first two derivatives.
fn along(feed: &Jet, [_, rate, second]: State, sense: f64) -> State {
    let turn = sense * TAU;
    [
        feed.value,
        turn * feed.t + feed.r * rate,
        turn * (turn * feed.tt + 2.0 * feed.tr * rate) + feed.rr * rate * rate + feed.r * second,
    ]
}

/// ℓ ± q·F.
fn onward(state: State, share: State, feed: State, outward: f64) -> State {
    let taken = [
        share[0] * feed[0],
        share[1] * feed[0] + share[0] * feed[1],
        share[2] * feed[0] + 2.0 * share[1] * feed[1] + share[0] * feed[2],
    ];
    std::array::from_fn(|k| state[k] + outward * taken[k])
}

fn no_edges(rho: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the feed that holds the residual is not smooth around ρ = {rho:.3} mm, so no law can \
         follow it at every angle; choose feed `atpg`"
    ))
}
