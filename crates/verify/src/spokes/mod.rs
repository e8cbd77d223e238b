//! Spokes: the error that comes back at the same angles turn after turn.
//!
//! One turn cuts one ring of the part, and each ring has some error of the interpolation. Where
//! neighbouring rings have it at the same angles, it stands on the part as spokes, which scatter
//! light to where a whole pattern can be seen. Where it lies at other angles on every ring, what
//! stays of it, averaged over many rings, is next to nothing.
//!
//! So the error as played is averaged at each of [`ANGLES`] angles over the turns of a window of
//! [`WINDOW`] turns. The window moves over the path by [`ADVANCE`] turns at a time, and the last one
//! ends with the path. The largest harmonic of these mean turns is the figure. The harmonics of a
//! mean turn are the complex means of the harmonics of its turns, so one Fourier transform for each
//! window gives them.
//!
//! A pattern that turns slowly does not stay at its angles: [`arms`] finds it.

mod arms;
mod cells;
mod real_transform;
mod turn;

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlannerScalar};
use turnpath_core::Part;
use turnpath_core::toolpath::Cubic;

use arms::Arms;
pub use arms::SpiralArms;
pub(crate) use cells::SegmentErrors;
use cells::{Cells, ManyCells, PER_RADIAN, TOGETHER};
use turn::{ANGLES, HIGHEST, LOWEST, Turn, WINDOW};

/// Turns from one window to the next: a pattern that stays for as many fills half of a window.
const ADVANCE: usize = 32;
/// Cells that are found one by one: for so few the instants of the segment need not be brought together.
const FEW: i64 = 8;
/// Cells of a turn.
const TURN: i64 = ANGLES as i64;

/// The largest spoke of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spoke {
    /// Amplitude of the harmonic of machined − wanted along z, mm: half its peak to valley.
    pub amplitude: f64,
    /// Periods on a turn.
    pub per_turn: usize,
    /// The smallest radius of a contact in its window, mm.
    pub from: f64,
    /// The largest, mm.
    pub to: f64,
}

/// The turns of one block of a path.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockSpokes {
    /// In order.
    turns: Vec<Turn>,
}

impl BlockSpokes {
    /// Adds the block's next segment, which plays `c` between these ends, rad. Only contacts on the part
    /// count.
    pub fn add<S: SegmentErrors>(&mut self, c: Cubic, ends: [f64; 2], found: &S, part: &Part) {
        let [from, to] = ends.map(|c| (c * PER_RADIAN).ceil());
        if !from.is_finite() || !to.is_finite() {
            return;
        }
        let (from, to) = (from as i64, to as i64);
        let cells = Cells::new(c, ends, found, part.inner_radius..=part.aperture_radius);
        match to.saturating_sub(from) <= FEW {
            true => self.add_few(&cells, from..to),
            false => self.add_many(&cells.many(), from..to),
        }
    }

    /// Adds cells one by one.
    fn add_few<S: SegmentErrors>(&mut self, cells: &Cells<'_, S>, numbers: Range<i64>) {
        for cell in numbers {
            if let Some((error, foot)) = cells.error(cell) {
                let (number, angle) = (cell.div_euclid(TURN), cell.rem_euclid(TURN));
                self.turn(number)
                    .include(angle as usize, &[error], [foot; 2]);
            }
        }
    }

    /// Adds cells that are found side by side.
    fn add_many(&mut self, cells: &ManyCells<'_>, numbers: Range<i64>) {
        let mut errors = [f64::NAN; TOGETHER];
        let mut cell = numbers.start;
        while cell < numbers.end {
            let (number, angle) = (cell.div_euclid(TURN), cell.rem_euclid(TURN));
            let left = numbers.end - cell;
            let count = left.min(TURN - angle).min(TOGETHER as i64);
            let errors = &mut errors[..count as usize];
            if let Some(feet) = cells.errors(cell, errors) {
                self.turn(number).include(angle as usize, errors, feet);
            }
            cell += count;
        }
    }

    fn turn(&mut self, number: i64) -> &mut Turn {
        let known = self.turns.iter().rposition(|turn| turn.number == number);
        let index = known.unwrap_or_else(|| {
            self.turns.push(Turn::new(number));
            self.turns.len() - 1
        });
        &mut self.turns[index]
    }
}

/// Finds the largest spoke of a path, block by block. It needs memory for one window, however long
/// the path is.
pub(crate) struct Spokes {
    fft: Arc<dyn Fft<f64>>,
    /// The last turns, [`WINDOW`] at the most, in order. The last of them may still grow.
    window: VecDeque<Turn>,
    /// Turns that end before the next window does.
    until_next: usize,
    /// The largest spoke of all windows before.
    largest: Option<Spoke>,
    /// The largest amplitude of each harmonic over all windows before, mm; empty before the first.
    harmonics: Vec<f64>,
    /// What comes back at other angles.
    arms: Arms,
}

impl Default for Spokes {
    fn default() -> Self {
        Self {
            // The scalar planner uses no vector instructions, which not every CPU has.
            fft: FftPlannerScalar::new().plan_fft_forward(ANGLES),
            window: VecDeque::with_capacity(WINDOW),
            until_next: WINDOW,
            largest: None,
            harmonics: Vec::new(),
            arms: Arms::default(),
        }
    }
}

impl Spokes {
    /// Appends the path's next block.
    pub fn append(&mut self, next: BlockSpokes) {
        let mut turns = next.turns;
        let last = self.window.back_mut();
        if let (Some(last), Some(first)) = (last, turns.first())
            && last.number == first.number
        {
            last.join(&turns.remove(0));
        }
        // The first turn of a path ends no other one.
        if self.window.is_empty() && !turns.is_empty() {
            self.push(turns.remove(0));
        }
        // Each turn that begins ends the one before.
        let before: Vec<&Turn> = self.window.back().into_iter().chain(&turns).collect();
        let ended = before.get(..turns.len()).unwrap_or_default();
        let harmonics = self.arms.harmonics(ended);
        for (turn, harmonics) in turns.into_iter().zip(harmonics) {
            self.arms.include(harmonics);
            self.push(turn);
        }
    }

    /// Begins the path's next turn: the one before is whole, and the arms have it.
    fn push(&mut self, turn: Turn) {
        if self.until_next == 0 {
            self.arms.look(self.radii());
            let amplitudes = self.amplitudes();
            self.largest = larger(self.largest, self.spoke(&amplitudes));
            self.harmonics = largest_of_each(&self.harmonics, &amplitudes);
            self.until_next = ADVANCE;
        }
        if self.window.len() == WINDOW {
            self.window.pop_front();
        }
        self.window.push_back(turn);
        self.until_next -= 1;
    }

    /// The largest spoke so far; `None` if no window has errors at all angles.
    pub fn largest(&self) -> Option<Spoke> {
        larger(self.largest, self.spoke(&self.amplitudes()))
    }

    /// The largest spiral arms so far; `None` on a path of a few turns.
    pub fn largest_arms(&self) -> Option<SpiralArms> {
        let mut arms = self.arms.clone();
        for last in arms.harmonics(&[self.window.back()?]) {
            arms.include(last);
        }
        arms.look(self.radii());
        arms.largest()
    }

    /// The smallest and the largest radius of a contact in the window, mm.
    fn radii(&self) -> [f64; 2] {
        let from = self.window.iter().map(|turn| turn.from);
        let to = self.window.iter().map(|turn| turn.to);
        [from.fold(f64::INFINITY, f64::min), to.fold(0.0, f64::max)]
    }

    /// The largest amplitude of each harmonic over all windows so far, mm: entry k has k periods a
    /// turn. Empty if no window has errors at all angles.
    pub fn harmonics(&self) -> Vec<f64> {
        largest_of_each(&self.harmonics, &self.amplitudes())
    }

    /// The amplitude of each harmonic of the window's mean turn, mm; empty if there is an angle
    /// without errors.
    fn amplitudes(&self) -> Vec<f64> {
        let Some(mut harmonics) = self.mean_turn() else {
            return Vec::new();
        };
        self.fft.process(&mut harmonics);
        let harmonics = harmonics.iter().take(HIGHEST + 1);
        let amplitudes = harmonics.map(|value| 2.0 * value.norm() / ANGLES as f64);
        amplitudes.collect()
    }

    /// The largest spoke of a window with these amplitudes; `None` if there are none.
    fn spoke(&self, amplitudes: &[f64]) -> Option<Spoke> {
        let spokes = amplitudes.iter().copied().enumerate().skip(LOWEST);
        let (per_turn, amplitude) = spokes.max_by(|one, other| one.1.total_cmp(&other.1))?;
        let [from, to] = self.radii();
        Some(Spoke {
            amplitude,
            per_turn,
            from,
            to,
        })
    }

    fn mean_turn(&self) -> Option<Vec<Complex<f64>>> {
        let (mut sums, mut counts) = (vec![0.0; ANGLES], vec![0.0; ANGLES]);
        for turn in &self.window {
            let totals = sums.iter_mut().zip(&mut counts);
            for ((sum, count), error) in totals.zip(&turn.errors) {
                let is_known = !error.is_nan();
                *sum += if is_known { *error } else { 0.0 };
                *count += if is_known { 1.0 } else { 0.0 };
            }
        }
        let means = sums.iter().zip(&counts).map(|(sum, count)| match *count {
            0.0 => None,
            count => Some(Complex::new(sum / count, 0.0)),
        });
        means.collect()
    }
}

fn largest_of_each(some: &[f64], others: &[f64]) -> Vec<f64> {
    match (some, others) {
        ([], all) | (all, []) => all.to_vec(),
        _ => some
            .iter()
            .zip(others)
            .map(|(one, other)| one.max(*other))
            .collect(),
    }
}

fn larger(one: Option<Spoke>, other: Option<Spoke>) -> Option<Spoke> {
    match (one, other) {
        (Some(one), Some(other)) if other.amplitude > one.amplitude => Some(other),
        (one, other) => one.or(other),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use turnpath_core::Scalar;
    use turnpath_core::toolpath::{ControlPoint, Segment};

    use super::*;
    use crate::instants::INSTANTS;

    const PART: Part = Part {
        aperture_radius: 1000.0,
        inner_radius: 0.0,
    };
    /// Steps on a turn.
    const STEPS: usize = 20;

    /// The errors at the instants of a segment, and the radius of all its contacts.
    struct Found {
        errors: [f64; INSTANTS + 1],
        foot: f64,
    }

    impl SegmentErrors for Found {
        fn error(&self, instant: usize) -> f64 {
            self.errors[instant]
        }

        fn foot(&self, _: usize) -> f64 {
            self.foot
        }
    }

    /// The block of turns whose error is `error(turn, θ)`, at the radius of the turn's number. The
    /// speed swings within a step by `swing`.
    fn block(turns: Range<usize>, swing: f64, error: impl Fn(usize, f64) -> f64) -> BlockSpokes {
        let mut spokes = BlockSpokes::default();
        let speed = TAU / STEPS as f64;
        let point = |i: usize| ControlPoint {
            t: i as f64,
            c: speed * i as f64,
            vc: speed * (1.0 + if i.is_multiple_of(2) { swing } else { -swing }),
            ..ControlPoint::default()
        };
        for i in turns.start * STEPS..turns.end * STEPS {
            let segment = Segment::between(&point(i), &point(i + 1));
            let turn = i / STEPS;
            let foot = turn as f64;
            let found = Found {
                errors: std::array::from_fn(|k| {
                    error(turn, segment.c.value(k as f64 / INSTANTS as f64))
                }),
                foot,
            };
            spokes.add(segment.c, [point(i).c, point(i + 1).c], &found, &PART);
        }
        spokes
    }

    fn largest(blocks: &[BlockSpokes]) -> Option<Spoke> {
        let mut spokes = Spokes::default();
        blocks
            .iter()
            .cloned()
            .for_each(|block| spokes.append(block));
        spokes.largest()
    }

    fn is_near(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < 2e-3
    }

    #[test]
    fn a_wave_at_the_same_angles_has_its_amplitude_whatever_the_speed() {
        for swing in [0.0, 0.3] {
            let wave = |_: usize, c: f64| 3.0 + Scalar::cos(c) + 2e-3 * Scalar::sin(17.0 * c);
            let found = largest(&[block(0..64, swing, wave)]).unwrap();
            assert_eq!(found.per_turn, 17);
            assert!(is_near(found.amplitude, 2e-3), "{found:?}");
            assert_eq!((found.from, found.to), (0.0, 63.0));
        }
    }

    #[test]
    fn a_wave_that_comes_round_evenly_leaves_nothing() {
        let wave = |turn: usize, c: f64| Scalar::sin(17.0 * c + TAU * turn as f64 / 16.0);
        let found = largest(&[block(0..64, 0.0, wave)]).unwrap();
        assert!(found.amplitude < 1e-2, "{found:?}");
    }

    #[test]
    fn the_largest_window_counts_with_its_radii_however_the_path_is_cut() {
        let wave = |turn: usize, c: f64| match turn {
            96..160 => 4.0 * Scalar::cos(5.0 * c),
            _ => Scalar::cos(9.0 * c),
        };
        let found = largest(&[block(0..100, 0.0, wave), block(100..200, 0.0, wave)]).unwrap();
        assert_eq!((found.per_turn, found.from, found.to), (5, 96.0, 159.0));
        assert!(is_near(found.amplitude, 4.0), "{found:?}");
        let whole = largest(&[block(0..200, 0.0, wave)]).unwrap();
        assert!(is_near(found.amplitude, whole.amplitude));
        assert_eq!(found.per_turn, whole.per_turn);
    }

    #[test]
    fn the_last_window_ends_with_the_path() {
        let wave = |turn: usize, c: f64| match turn {
            64..74 => Scalar::cos(9.0 * c),
            _ => 0.0,
        };
        let found = largest(&[block(0..74, 0.0, wave)]).unwrap();
        assert!(is_near(found.amplitude, 10.0 / 64.0), "{found:?}");
        assert_eq!((found.from, found.to), (10.0, 73.0));
    }

    #[test]
    fn a_path_of_few_turns_is_one_window() {
        let wave = |turn: usize, c: f64| turn as f64 * Scalar::cos(9.0 * c);
        let found = largest(&[block(0..3, 0.0, wave)]).unwrap();
        assert!(is_near(found.amplitude, 1.0), "{found:?}");
    }

    fn largest_arms(blocks: &[BlockSpokes]) -> Option<SpiralArms> {
        let mut spokes = Spokes::default();
        blocks
            .iter()
            .cloned()
            .for_each(|block| spokes.append(block));
        spokes.largest_arms()
    }

    /// The turn of number k has the radius k, so a pitch of p mm is one of p turns.
    #[test]
    fn a_wave_that_turns_evenly_stands_as_arms_with_their_pitch() {
        for (turns_round, sense) in [(62.0, 1.0), (16.0, -1.0), (5.0, 1.0)] {
            let wave = |turn: usize, c: f64| {
                2e-3 * Scalar::sin(7.0 * c + sense * TAU * turn as f64 / turns_round)
            };
            let found = largest_arms(&[block(0..30, 0.0, wave), block(30..96, 0.0, wave)]).unwrap();
            assert_eq!(found.per_turn, 7);
            // Between two rates a fortieth is lost.
            assert!((found.amplitude / 2e-3 - 0.99).abs() < 0.015, "{found:?}");
            assert!((found.pitch / turns_round - 1.0).abs() < 0.12, "{found:?}");
        }
    }

    #[test]
    fn a_wave_that_stays_or_turns_as_fast_as_the_feed_is_no_arms() {
        // On 64 turns a peak has sides of 1/(64 sin(π Δ)) at rates that are Δ periods a turn slower.
        let side = |turns_round: f64| {
            let slower = 1.0 / turns_round - 0.25;
            1.0 / (64.0 * Scalar::sin(PI * slower))
        };
        for (turns_round, most) in [(f64::INFINITY, 1e-9), (2.0, side(2.0)), (3.0, side(3.0))] {
            let wave = |turn: usize, c: f64| Scalar::sin(7.0 * c + TAU * turn as f64 / turns_round);
            let found = largest_arms(&[block(0..64, 0.0, wave)]);
            assert!(found.is_none_or(|arms| arms.amplitude < most), "{found:?}");
        }
        assert_eq!(
            largest_arms(&[block(0..3, 0.0, |_, c| Scalar::sin(7.0 * c))]),
            None
        );
        assert_eq!(largest_arms(&[]), None);
    }

    #[test]
    fn turns_beside_the_part_do_not_count_for_arms() {
        let wave = |turn: usize, c: f64| Scalar::sin(7.0 * c + TAU * turn as f64 / 16.0);
        let mut found = block(0..64, 0.0, wave);
        found.turns[0].errors[5] = f64::NAN;
        let arms = largest_arms(std::slice::from_ref(&found)).unwrap();
        assert!((arms.amplitude - 1.0).abs() < 0.03, "{arms:?}");
        for turn in &mut found.turns[..40] {
            turn.errors[5] = f64::NAN;
        }
        assert_eq!(largest_arms(&[found]), None);
    }

    #[test]
    fn a_path_of_less_than_a_turn_has_no_spokes() {
        assert_eq!(largest(&[]), None);
        let mut half = block(0..1, 0.0, |_, c| c);
        half.turns[0].errors[5] = f64::NAN;
        assert_eq!(largest(&[half]), None);
    }
}
