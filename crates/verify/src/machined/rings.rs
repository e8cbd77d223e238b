//! The mean error of the machined surface on rings: a picture of it without its cusps.
//!
//! A cusp is far narrower than a cell of any picture. Samples of single points would show which part
//! of a cusp each cell happens to meet. So a cell here has the mean along the radius over its width,
//! at its angle.

use std::f64::consts::TAU;

use rayon::prelude::*;
use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::{Result, Scalar};

use super::grid::Grid;
use super::lines::{Line, Lines};
use super::pieces::Pieces;
use super::samples::{NODES, Samples};
use super::strip::Strip;
use crate::order::in_order;
use crate::subject::Subject;
use crate::touch::FirstTouch;

/// Rings between the hole, or the axis, and the rim.
const RINGS: usize = 192;
/// The weights of the nodes of a piece, without their radii.
const WEIGHTS: [f64; NODES] = [1.0 / 12.0, 5.0 / 12.0, 5.0 / 12.0, 1.0 / 12.0];

/// Mean errors on rings, mm: machined − wanted along z.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorRings {
    /// Radius of the hole, mm.
    inner: f64,
    /// Radius of the rim, mm.
    outer: f64,
    /// The angle of the first column, rad; the others follow at equal distances.
    first: f64,
    /// Angles of each ring.
    angles: usize,
    /// Ring after ring from the inside out; not a number where no pass has cut.
    errors: Vec<f64>,
}

/// The sums along one side of a line, ring by ring.
#[derive(Clone)]
struct RadialSums {
    width: f64,
    inner: f64,
    /// (∫ error, length) of each ring.
    sums: Vec<(f64, f64)>,
}

impl Lines {
    /// The mean errors on rings; `None` if nothing of the part was cut.
    ///
    /// # Errors
    /// When the surface fails or has no height at a place that was cut.
    pub fn rings(&self, touch: &FirstTouch) -> Result<Option<ErrorRings>> {
        let (subject, lines) = (touch.subject(), self.all());
        let Some(first) = lines.first() else {
            return Ok(None);
        };
        let of_line = |strip: &mut Strip, line: &Line<'_>| {
            strip.set_line(subject, line);
            strip.look_up_heights(subject.surface.as_ref())?;
            let empty = RadialSums::new(subject);
            Ok(in_widest(Sides(strip.pieces(), [empty.clone(), empty])))
        };
        let sides = in_order(lines.par_iter().map_init(Strip::default, of_line))?;
        let columns = |side: usize| sides.iter().map(move |sides| &sides[side]);
        let columns: Vec<&RadialSums> = columns(0).chain(columns(1)).collect();
        let ring = |ring: usize| columns.iter().map(move |column| column.mean(ring));
        let errors: Vec<f64> = (0..RINGS).flat_map(ring).collect();
        if errors.iter().all(|error| error.is_nan()) {
            return Ok(None);
        }
        Ok(Some(ErrorRings {
            inner: subject.part.inner_radius,
            outer: subject.part.aperture_radius,
            first: first.angle,
            angles: columns.len(),
            errors,
        }))
    }
}

/// The loop that adds up the two sides of a line.
struct Sides<'a>(&'a Pieces, [RadialSums; 2]);

impl Loop for Sides<'_> {
    type Output = [RadialSums; 2];

    #[inline(always)]
    fn call(self) -> [RadialSums; 2] {
        let Self(pieces, mut sides) = self;
        let mut samples = Samples::blank();
        for group in pieces.groups() {
            group.sample(&mut samples);
            for piece in 0..samples.count {
                let twice_middle = samples.s[0][piece] + samples.s[NODES - 1][piece];
                sides[usize::from(twice_middle < 0.0)].include(&samples, piece);
            }
        }
        sides
    }
}

impl RadialSums {
    fn new(subject: &Subject) -> Self {
        let (inner, outer) = (subject.part.inner_radius, subject.part.aperture_radius);
        Self {
            width: (outer - inner) / RINGS as f64,
            inner,
            sums: vec![(0.0, 0.0); RINGS],
        }
    }

    /// Adds a piece to the rings that it lies on, to each by its length there.
    fn include(&mut self, samples: &Samples, piece: usize) {
        let ends = [0, NODES - 1].map(|k| samples.s[k][piece].abs());
        let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let errors = samples.error.iter().zip(WEIGHTS);
        let mean: f64 = errors.map(|(error, weight)| error[piece] * weight).sum();
        let ring = |radius: f64| ((radius - self.inner) / self.width).max(0.0) as usize;
        for index in ring(from)..=ring(to).min(RINGS - 1) {
            let begin = self.inner + index as f64 * self.width;
            let length = to.min(begin + self.width) - from.max(begin);
            if let Some((sum, whole)) = self.sums.get_mut(index).filter(|_| length > 0.0) {
                *sum += mean * length;
                *whole += length;
            }
        }
    }

    /// The mean of a ring, mm; not a number where nothing was cut.
    fn mean(&self, ring: usize) -> f64 {
        let (sum, length) = self.sums[ring];
        sum / length
    }
}

impl ErrorRings {
    /// The radius of the rim, mm.
    pub fn outer(&self) -> f64 {
        self.outer
    }

    /// The radius of the middle of each ring, mm.
    pub fn radii(&self) -> Vec<f64> {
        let middle = |ring: usize| self.inner + (ring as f64 + 0.5) * self.width();
        (0..RINGS).map(middle).collect()
    }

    fn width(&self) -> f64 {
        (self.outer - self.inner) / RINGS as f64
    }

    fn ring(&self, ring: usize) -> &[f64] {
        &self.errors[ring * self.angles..(ring + 1) * self.angles]
    }

    /// The mean error of each ring, mm.
    pub fn radial_mean(&self) -> Vec<f64> {
        (0..RINGS).map(|ring| mean(self.ring(ring))).collect()
    }

    /// The errors along the line through the axis nearest to `angle`, rad: its own angle, rad, and
    /// places (s, error) in mm, where s is the signed radius.
    pub fn profile(&self, angle: f64) -> (f64, Vec<(f64, f64)>) {
        let step = TAU / self.angles as f64;
        let half = self.angles / 2;
        let column = ((angle - self.first) / step).round() as i64;
        let column = column.rem_euclid(self.angles as i64) as usize;
        let opposite = (column + half) % self.angles;
        let radii = self.radii();
        let side = |sign: f64, column: usize| {
            let rings = radii.iter().enumerate();
            rings.map(move |(ring, radius)| (sign * radius, self.ring(ring)[column]))
        };
        let mut places: Vec<(f64, f64)> = side(-1.0, opposite).collect();
        places.reverse();
        places.extend(side(1.0, column));
        (self.first + column as f64 * step, places)
    }

    /// The error at the cells of a Cartesian grid over the part, mm, row after row: between the two
    /// nearest rings and angles. Not a number off the part.
    pub fn map(&self, count: usize) -> Vec<f64> {
        let grid = Grid::Cartesian {
            count,
            half: self.outer,
        };
        let cells = (0..count).flat_map(|row| (0..count).map(move |column| (row, column)));
        cells
            .map(|(row, column)| self.at(grid.point(row, column)))
            .collect()
    }

    fn at(&self, (x, y): (f64, f64)) -> f64 {
        let radius = (x * x + y * y).sqrt();
        if radius < self.inner || radius > self.outer {
            return f64::NAN;
        }
        let turn = (Scalar::atan2(y, x) - self.first) / TAU;
        let column = turn.rem_euclid(1.0) * self.angles as f64;
        let ring = (radius - self.inner) / self.width() - 0.5;
        let below = ring.clamp(0.0, (RINGS - 1) as f64) as usize;
        let above = (below + 1).min(RINGS - 1);
        let between = |ring: usize| self.between_angles(self.ring(ring), column);
        let share = (ring - below as f64).clamp(0.0, 1.0);
        interpolated(between(below), between(above), share)
    }

    /// The error of a ring at a place between its angles, counted in them.
    fn between_angles(&self, errors: &[f64], column: f64) -> f64 {
        let before = (column as usize).min(self.angles - 1);
        let after = (before + 1) % self.angles;
        interpolated(errors[before], errors[after], column - before as f64)
    }
}

/// The value between two; the known one where the other is not a number.
fn interpolated(one: f64, other: f64, share: f64) -> f64 {
    match (one.is_nan(), other.is_nan()) {
        (false, false) => one + share * (other - one),
        (true, false) => other,
        _ => one,
    }
}

/// The mean of those that are numbers; not a number where none is.
fn mean(values: &[f64]) -> f64 {
    let known = values.iter().filter(|value| !value.is_nan());
    known.clone().sum::<f64>() / known.count() as f64
}
