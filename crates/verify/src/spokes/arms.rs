//! Spiral arms: the error that comes back a little further on, turn after turn.
//!
//! A pattern has k periods on a turn, and lies a little further round on each next turn. On the part it
//! stands as k spiral arms. Its harmonic F_k then turns evenly in the complex plane from turn to turn. So
//! a Fourier transform of F_k over the turns of a window finds it. A pattern that lies at the same angles
//! on all turns is spokes.

use std::collections::VecDeque;
use std::sync::Arc;

use rayon::prelude::*;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlannerScalar};

use super::real_transform::RealTransform;
use super::turn::{HIGHEST, LOWEST, Turn, WINDOW};

/// Rates that are tried, all around: four for each one that fits into a window, so that at most a
/// fortieth of an amplitude is lost between two of them.
const RATES: usize = 4 * WINDOW;
/// The fewest turns after which arms come back to an angle. Finer ones are as fine as the marks of the
/// tool.
const FEWEST_TURNS: usize = 4;
/// Turns whose harmonics a thread finds at least: with fewer, threads that have other work are asked too
/// often.
const FEWEST_A_THREAD: usize = 8;

/// The largest spiral arms of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpiralArms {
    /// Amplitude of the pattern of machined − wanted along z, mm: half its peak to valley.
    pub amplitude: f64,
    /// Arms: periods on a turn.
    pub per_turn: usize,
    /// From arm to arm along a radius, mm.
    pub pitch: f64,
    /// The smallest radius of a contact in their window, mm.
    pub from: f64,
    /// The largest, mm.
    pub to: f64,
}

/// The harmonics of the last turns of a path, and the largest arms on it so far.
#[derive(Clone)]
pub(super) struct Arms {
    of_turn: RealTransform,
    over_turns: Arc<dyn Fft<f64>>,
    /// Those of each turn of the window.
    turns: VecDeque<TurnHarmonics>,
    largest: Option<SpiralArms>,
}

/// The harmonics of one turn from the lowest on; empty for a turn that lies in part beside the part.
#[derive(Clone, Default)]
pub(super) struct TurnHarmonics {
    /// F_k, mm.
    values: Vec<Complex<f64>>,
    /// |F_k|², mm².
    squares: Vec<f64>,
}

impl TurnHarmonics {
    fn of(transform: &mut RealTransform, turn: &&Turn) -> Self {
        if turn.errors.iter().any(|error| error.is_nan()) {
            return Self::default();
        }
        let mut values = Vec::with_capacity(HIGHEST + 1 - LOWEST);
        transform.harmonics(&turn.errors, &mut values);
        let squares = values.iter().map(|value| value.norm_sqr()).collect();
        Self { values, squares }
    }
}

impl Default for Arms {
    fn default() -> Self {
        // The scalar planner uses no vector instructions, which not every CPU has.
        let mut planner = FftPlannerScalar::new();
        Self {
            of_turn: RealTransform::default(),
            over_turns: planner.plan_fft_forward(RATES),
            turns: VecDeque::with_capacity(WINDOW),
            largest: None,
        }
    }
}

impl Arms {
    /// Adds the path's next turn, which is whole, by its harmonics.
    pub(super) fn include(&mut self, harmonics: TurnHarmonics) {
        if self.turns.len() == WINDOW {
            self.turns.pop_front();
        }
        self.turns.push_back(harmonics);
    }

    /// The harmonics of whole turns. Threads that have nothing else to do take a part of them.
    pub(super) fn harmonics(&self, turns: &[&Turn]) -> Vec<TurnHarmonics> {
        let each = turns.par_iter().with_min_len(FEWEST_A_THREAD);
        let each = each.map_init(|| self.of_turn.clone(), TurnHarmonics::of);
        each.collect()
    }

    /// Looks for larger arms on the turns of the window, whose contacts lie between two radii.
    pub(super) fn look(&mut self, [from, to]: [f64; 2]) {
        let whole = self.turns.iter().filter(|turn| !turn.values.is_empty());
        let mut squares = vec![0.0; HIGHEST + 1 - LOWEST];
        let mut count = 0;
        for turn in whole {
            let each = squares.iter_mut().zip(&turn.squares);
            each.for_each(|(sum, square)| *sum += square);
            count += 1;
        }
        // Where many turns lie in part beside the part, nothing is known of the others.
        if 2 * count < self.turns.len() {
            return;
        }
        let mut largest = self.largest.map_or(0.0, |arms| arms.amplitude);
        let mut over_turns = vec![Complex::default(); RATES];
        let mut scratch = vec![Complex::default(); self.over_turns.get_inplace_scratch_len()];
        for (number, square) in squares.iter().enumerate() {
            // No pattern is larger than the root of the mean square of its harmonic on the turns, with or
            // without what stays.
            if 2.0 * (square / count as f64).sqrt() <= largest {
                continue;
            }
            over_turns.fill(Complex::default());
            for (slot, turn) in over_turns.iter_mut().zip(&self.turns) {
                *slot = turn.values.get(number).copied().unwrap_or_default();
            }
            let still = over_turns.iter().sum::<Complex<f64>>() / count as f64;
            // What stays is spokes, and would stand at all rates by the edges of the window.
            for (slot, turn) in over_turns.iter_mut().zip(&self.turns) {
                if !turn.values.is_empty() {
                    *slot -= still;
                }
            }
            self.over_turns
                .process_with_scratch(&mut over_turns, &mut scratch);
            let found = largest_rate(&over_turns, self.turns.len());
            let Some((rate, size)) = found else { continue };
            let amplitude = 2.0 * size / count as f64;
            if amplitude > largest {
                let turns_round = RATES as f64 / rate as f64;
                largest = amplitude;
                self.largest = Some(SpiralArms {
                    amplitude,
                    per_turn: LOWEST + number,
                    pitch: turns_round * (to - from) / self.turns.len() as f64,
                    from,
                    to,
                });
            }
        }
    }

    /// The largest arms so far.
    pub(super) fn largest(&self) -> Option<SpiralArms> {
        self.largest
    }
}

/// The rate, in either sense, with the largest size. Slower ones than one period in so many turns are
/// spokes, as far as the window can tell.
fn largest_rate(over_turns: &[Complex<f64>], turns: usize) -> Option<(usize, f64)> {
    let slowest = RATES.div_ceil(turns.max(1));
    let rates = slowest..=RATES / FEWEST_TURNS;
    let sizes = rates.filter_map(|rate| {
        let forwards = over_turns.get(rate)?.norm();
        let backwards = over_turns.get(RATES - rate)?.norm();
        Some((rate, forwards.max(backwards)))
    });
    sizes.max_by(|one, other| one.1.total_cmp(&other.1))
}
