//! Spokes: the error that comes back at the same angles turn after turn.
//!
//! One turn cuts one ring of the part, and each ring has some error of the interpolation. Where
//! neighbouring rings have it at the same angles, it stands on the part as spokes, which scatter
//! light to where a whole pattern can be seen. Where it lies at other angles on every ring, what
//! stays of it, averaged over many rings, is next to nothing.
//!
//! So the part is divided into bands of [`BAND`] turns. In each band the error as played is averaged
//! over the turns at each of [`ANGLES`] angles. The largest harmonic of these mean turns is the
//! figure. The harmonics of a mean turn are the complex means of the harmonics of its turns, so
//! one Fourier transform for each band gives them.

use std::f64::consts::TAU;
use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlannerScalar};
use turnpath_core::Part;
use turnpath_core::toolpath::Segment;

use crate::instants::INSTANTS;
use crate::touch::Touch;

/// Angles of a mean turn: four for each period of the highest harmonic.
const ANGLES: usize = 4 * HIGHEST;
/// The lowest harmonic. Below it are tilt and astigmatism, which are no spokes.
const LOWEST: usize = 3;
/// The highest harmonic.
const HIGHEST: usize = 512;
/// Turns of a band. Fewer would not show whether a pattern that turns slowly stays.
const BAND: i64 = 64;
/// A first or last band with fewer turns than this joins its neighbour. The mean of a few turns
/// would be that of a ring.
const FEWEST_TURNS: u64 = 32;
/// C follows a straight line if it leaves it by less than this part of the segment.
const STRAIGHT: f64 = 1e-9;
/// Newton's method finds an instant to rounding in so many steps from the straight line.
const NEWTON_STEPS: usize = 5;

/// The largest spoke of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spoke {
    /// Amplitude of the harmonic of machined − wanted along z, mm: half its peak to valley.
    pub amplitude: f64,
    /// Periods on a turn.
    pub per_turn: usize,
    /// The smallest radius of a contact in its band, mm.
    pub from: f64,
    /// The largest, mm.
    pub to: f64,
}

/// The errors of a band, summed over its turns.
#[derive(Debug, Clone)]
struct Band {
    /// C over [`BAND`] turns, rounded down.
    number: i64,
    /// Sum of the errors at each angle, mm, and how many there are.
    sums: Vec<(f64, u32)>,
    from: f64,
    to: f64,
}

impl Band {
    fn new(number: i64) -> Self {
        Self {
            number,
            sums: vec![(0.0, 0); ANGLES],
            from: f64::INFINITY,
            to: 0.0,
        }
    }

    fn include(&mut self, cell: i64, error: f64, foot: f64) {
        let (sum, count) = &mut self.sums[cell.rem_euclid(ANGLES as i64) as usize];
        *sum += error;
        *count += 1;
        self.from = self.from.min(foot);
        self.to = self.to.max(foot);
    }

    fn add(&mut self, other: &Self) {
        for (own, other) in self.sums.iter_mut().zip(&other.sums) {
            *own = (own.0 + other.0, own.1 + other.1);
        }
        self.from = self.from.min(other.from);
        self.to = self.to.max(other.to);
    }

    fn is_short(&self) -> bool {
        let count: u64 = self.sums.iter().map(|(_, count)| u64::from(*count)).sum();
        count < FEWEST_TURNS * ANGLES as u64
    }

    /// The largest harmonic of the mean turn; `None` if there is an angle without errors.
    fn spoke(&self, fft: &dyn Fft<f64>) -> Option<Spoke> {
        if self.sums.iter().any(|(_, count)| *count == 0) {
            return None;
        }
        let mean = |(sum, count): &(f64, u32)| Complex::new(sum / f64::from(*count), 0.0);
        let mut harmonics: Vec<Complex<f64>> = self.sums.iter().map(mean).collect();
        fft.process(&mut harmonics);
        let harmonics = harmonics.iter().enumerate().take(HIGHEST + 1).skip(LOWEST);
        let amplitudes = harmonics.map(|(k, value)| (k, 2.0 * value.norm() / ANGLES as f64));
        let (per_turn, amplitude) = amplitudes.max_by(|one, other| one.1.total_cmp(&other.1))?;
        Some(Spoke {
            amplitude,
            per_turn,
            from: self.from,
            to: self.to,
        })
    }
}

/// What was found on one segment.
pub(crate) struct SegmentErrors<'a> {
    /// What is played.
    pub segment: &'a Segment,
    /// C at both ends, rad, as its control points have it.
    pub ends: [f64; 2],
    /// Machined − wanted at each instant and at the end, mm.
    pub errors: [f64; INSTANTS + 1],
    /// The first touch at each instant.
    pub touches: &'a [Touch],
}

impl SegmentErrors<'_> {
    /// The place between the instants, counted in instants, where C is `c`.
    fn place(&self, c: f64) -> f64 {
        let [start, end] = self.ends;
        let mut s = (c - start) / (end - start);
        let played = &self.segment.c;
        let [_, rise, square, cube] = played.0;
        if square.abs() + cube.abs() > STRAIGHT * rise.abs() {
            for _ in 0..NEWTON_STEPS {
                s -= (played.value(s) - c) / played.slope(s);
            }
        }
        INSTANTS as f64 * s.clamp(0.0, 1.0)
    }

    /// The error at a place: the cubic through the four values around it.
    fn error_at(&self, place: f64) -> f64 {
        let first = (place as usize).saturating_sub(1).min(INSTANTS - 3);
        let [a, b, c, d] = std::array::from_fn(|k| self.errors[first + k]);
        let u = place - first as f64;
        let third = d - 3.0 * (c - b) - a;
        let bend = c - 2.0 * b + a + (u - 2.0) / 3.0 * third;
        a + u * (b - a + 0.5 * (u - 1.0) * bend)
    }
}

/// The bands of one block of a path.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockSpokes {
    /// In order.
    bands: Vec<Band>,
}

impl BlockSpokes {
    /// Adds the block's next segment. Only contacts on the part count.
    pub fn add(&mut self, found: &SegmentErrors<'_>, part: &Part) {
        let per_radian = ANGLES as f64 / TAU;
        let [from, to] = found.ends.map(|c| (c * per_radian).ceil());
        if !from.is_finite() || !to.is_finite() {
            return;
        }
        for cell in from as i64..to as i64 {
            let place = found.place(cell as f64 / per_radian);
            let nearest = (place as usize).min(INSTANTS - 1);
            let foot = found.touches[nearest].foot;
            let error = found.error_at(place);
            let counts = (part.inner_radius..=part.aperture_radius).contains(&foot);
            if counts && error.is_finite() {
                self.band_of(cell).include(cell, error, foot);
            }
        }
    }

    fn band_of(&mut self, cell: i64) -> &mut Band {
        let number = cell.div_euclid(BAND * ANGLES as i64);
        let known = self.bands.iter().rposition(|band| band.number == number);
        let index = known.unwrap_or_else(|| {
            self.bands.push(Band::new(number));
            self.bands.len() - 1
        });
        &mut self.bands[index]
    }
}

/// Finds the largest spoke of a path, block by block. It needs memory for a few bands, however long
/// the path is.
pub(crate) struct Spokes {
    fft: Arc<dyn Fft<f64>>,
    /// Bands that may still grow or join, in order.
    open: Vec<Band>,
    /// The largest spoke of all bands before.
    largest: Option<Spoke>,
}

impl Default for Spokes {
    fn default() -> Self {
        Self {
            // The scalar planner uses no vector instructions, which not every CPU has.
            fft: FftPlannerScalar::new().plan_fft_forward(ANGLES),
            open: Vec::new(),
            largest: None,
        }
    }
}

impl Spokes {
    /// Appends the path's next block.
    pub fn append(&mut self, next: &BlockSpokes) {
        for band in &next.bands {
            match self.open.last_mut() {
                Some(last) if last.number == band.number => last.add(band),
                _ => self.open.push(band.clone()),
            }
        }
        // The last band may still grow, and the one before it may get a short last band.
        while self.open.len() > 2 {
            let first = self.open.remove(0);
            if first.is_short() {
                self.open[0].add(&first);
            } else {
                self.largest = larger(self.largest, first.spoke(self.fft.as_ref()));
            }
        }
    }

    /// The largest spoke so far; `None` if no band has errors at all angles.
    pub fn largest(&self) -> Option<Spoke> {
        let mut open = self.open.clone();
        if let [first, last] = open.as_mut_slice()
            && (first.is_short() || last.is_short())
        {
            first.add(last);
            open.truncate(1);
        }
        let spokes = open.iter().map(|band| band.spoke(self.fft.as_ref()));
        spokes.fold(self.largest, larger)
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
    use std::ops::Range;

    use turnpath_core::Scalar;
    use turnpath_core::toolpath::ControlPoint;

    use super::*;

    const PART: Part = Part {
        aperture_radius: 1000.0,
        inner_radius: 0.0,
    };
    /// Steps on a turn.
    const STEPS: usize = 20;

    /// The block of turns whose error is `error(turn, θ)`, at the radius of the turn's number. The
    /// speed swings within a step by `swing`.
    fn block(turns: Range<usize>, swing: f64, error: impl Fn(usize, f64) -> f64) -> BlockSpokes {
        let mut spokes = BlockSpokes::default();
        let speed = TAU / STEPS as f64;
        let point = |i: usize| ControlPoint {
            t: i as f64,
            c: speed * i as f64,
            vc: speed * (1.0 + if i % 2 == 0 { swing } else { -swing }),
            ..ControlPoint::default()
        };
        for i in turns.start * STEPS..turns.end * STEPS {
            let segment = Segment::between(&point(i), &point(i + 1));
            let turn = i / STEPS;
            let foot = turn as f64;
            let touches = [Touch {
                foot,
                ..Touch::default()
            }; INSTANTS];
            spokes.add(
                &SegmentErrors {
                    segment: &segment,
                    ends: [point(i).c, point(i + 1).c],
                    errors: std::array::from_fn(|k| {
                        error(turn, segment.c.value(k as f64 / INSTANTS as f64))
                    }),
                    touches: &touches,
                },
                &PART,
            );
        }
        spokes
    }

    fn largest(blocks: &[BlockSpokes]) -> Option<Spoke> {
        let mut spokes = Spokes::default();
        blocks.iter().for_each(|block| spokes.append(block));
        spokes.largest()
    }

    fn is_near(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < 2e-3
    }

    #[test]
    fn a_wave_at_the_same_angles_has_its_amplitude_whatever_the_speed() {
        for swing in [0.0, 0.3] {
            let wave = |_: usize, c: f64| 3.0 + Scalar::cos(c) + 2e-3 * Scalar::sin(17.0 * c);
            let found = largest(&[block(0..70, swing, wave)]).unwrap();
            assert_eq!(found.per_turn, 17);
            assert!(is_near(found.amplitude, 2e-3), "{found:?}");
            assert_eq!((found.from, found.to), (0.0, 69.0));
        }
    }

    #[test]
    fn a_wave_that_comes_round_evenly_leaves_nothing() {
        let wave = |turn: usize, c: f64| Scalar::sin(17.0 * c + TAU * turn as f64 / 16.0);
        let found = largest(&[block(0..64, 0.0, wave)]).unwrap();
        assert!(found.amplitude < 1e-2, "{found:?}");
    }

    #[test]
    fn the_largest_band_counts_with_its_radii() {
        let wave = |turn: usize, c: f64| match turn {
            64..128 => 4.0 * Scalar::cos(5.0 * c),
            _ => Scalar::cos(9.0 * c),
        };
        let found = largest(&[block(0..100, 0.0, wave), block(100..200, 0.0, wave)]).unwrap();
        assert_eq!((found.per_turn, found.from, found.to), (5, 64.0, 127.0));
        assert!(is_near(found.amplitude, 4.0), "{found:?}");
        let whole = largest(&[block(0..200, 0.0, wave)]).unwrap();
        assert!(is_near(found.amplitude, whole.amplitude));
        assert_eq!(found.per_turn, whole.per_turn);
    }

    #[test]
    fn a_short_band_at_either_end_joins_its_neighbour() {
        let wave = |turn: usize, c: f64| match turn {
            54..64 | 128..138 => Scalar::cos(9.0 * c),
            _ => 0.0,
        };
        let found = largest(&[block(54..138, 0.0, wave)]).unwrap();
        assert!(is_near(found.amplitude, 20.0 / 84.0), "{found:?}");
        assert_eq!((found.from, found.to), (54.0, 137.0));
    }

    #[test]
    fn a_path_of_less_than_a_turn_has_no_spokes() {
        assert_eq!(largest(&[]), None);
        let mut half = block(0..1, 0.0, |_, c| c);
        half.bands[0].sums[5] = (0.0, 0);
        assert_eq!(largest(&[half]), None);
    }
}
