//! Figures of the machined surface, weighted by area.

use rayon::prelude::*;
use turnpath_core::{Part, Result, Scalar};

use super::sections::Lines;
use super::strip::{Sample, Strip};
use crate::Subject;

/// A place of the part and the surface error there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaceOnPart {
    /// Machined − wanted along z, mm.
    pub error: f64,
    /// mm.
    pub x: f64,
    /// mm.
    pub y: f64,
}

/// The machined surface in figures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachinedFigures {
    /// Where most material stays.
    pub highest: PlaceOnPart,
    /// Where most is lacking, or the least stays.
    pub lowest: PlaceOnPart,
    /// Mean error, mm.
    pub mean: f64,
    /// Root of the mean square about zero, mm.
    pub rms: f64,
    /// Root of the mean square about the mean, mm.
    pub sq: f64,
    /// Mean amount about the mean, mm.
    pub sa: f64,
    /// Root of the mean square of the radial slope's error.
    pub rms_slope: f64,
    /// Part of the area that no nose reached.
    pub uncut: f64,
    /// Lines through the axis that were measured.
    pub lines: usize,
}

impl MachinedFigures {
    /// Peak to valley, mm.
    pub fn pv(&self) -> f64 {
        self.highest.error - self.lowest.error
    }
}

/// Integrals along one line, or several.
#[derive(Debug, Clone, Copy)]
struct Sums {
    area: f64,
    error: f64,
    square: f64,
    slope_square: f64,
    /// Error and signed place on the line of angle `0`.
    highest: (f64, f64),
    lowest: (f64, f64),
}

impl Sums {
    const NONE: Self = Self {
        area: 0.0,
        error: 0.0,
        square: 0.0,
        slope_square: 0.0,
        highest: (f64::NEG_INFINITY, 0.0),
        lowest: (f64::INFINITY, 0.0),
    };

    fn see(&mut self, sample: &Sample) {
        for k in 0..4 {
            let (weight, error, slope) = (sample.weight[k], sample.error[k], sample.slope[k]);
            self.area += weight;
            self.error += weight * error;
            self.square += weight * error * error;
            self.slope_square += weight * slope * slope;
        }
        for (s, error) in sample.extremes() {
            if error > self.highest.0 {
                self.highest = (error, s);
            }
            if error < self.lowest.0 {
                self.lowest = (error, s);
            }
        }
    }
}

impl Lines {
    /// Figures of the part, lines in parallel and put together in order; `None` where nothing of
    /// the part was cut.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn figures(&self, subject: &Subject) -> Result<Option<MachinedFigures>> {
        let lines = self.all();
        let of_line = |strip: &mut Strip, (angle, passes): &(f64, &[_])| {
            strip.take(subject, *angle, passes);
            strip.look_up(subject.surface.as_ref())?;
            let mut sums = Sums::NONE;
            strip.samples().for_each(|sample| sums.see(&sample));
            Ok(sums)
        };
        let sums: Vec<Sums> = lines
            .par_iter()
            .map_init(Strip::default, of_line)
            .collect::<Result<_>>()?;
        let total = |of: fn(&Sums) -> f64| sums.iter().map(of).sum::<f64>();
        let area = total(|line| line.area);
        if area <= 0.0 {
            return Ok(None);
        }
        let mean = total(|line| line.error) / area;
        let mean_square = total(|line| line.square) / area;
        let (highest, lowest) = extremes(&lines, &sums);
        Ok(Some(MachinedFigures {
            highest,
            lowest,
            mean,
            rms: mean_square.sqrt(),
            // Rounding may lead below zero; what is no number stays none.
            sq: (mean_square - mean * mean).clamp(0.0, f64::INFINITY).sqrt(),
            sa: self.amount_about(subject, mean)? / area,
            rms_slope: (total(|line| line.slope_square) / area).sqrt(),
            uncut: uncut(&subject.part, &sums),
            lines: lines.len(),
        }))
    }

    /// The integral of |error − mean|.
    fn amount_about(&self, subject: &Subject, mean: f64) -> Result<f64> {
        let of_line = |strip: &mut Strip, (angle, passes): (f64, &[_])| {
            strip.take(subject, angle, passes);
            strip.look_up_heights(subject.surface.as_ref())?;
            let amount = |sample: Sample| sample.amount_about(mean);
            Ok(strip.samples().map(amount).sum())
        };
        let amounts: Vec<f64> = self
            .all()
            .into_par_iter()
            .map_init(Strip::default, of_line)
            .collect::<Result<_>>()?;
        Ok(amounts.iter().sum())
    }
}

fn extremes<T>(lines: &[(f64, T)], sums: &[Sums]) -> (PlaceOnPart, PlaceOnPart) {
    let place = |angle: f64, (error, s): (f64, f64)| {
        let (sin, cos) = Scalar::sin_cos(angle);
        let (x, y) = (s * cos, s * sin);
        PlaceOnPart { error, x, y }
    };
    let mut highest = place(0.0, Sums::NONE.highest);
    let mut lowest = place(0.0, Sums::NONE.lowest);
    for ((angle, _), sums) in lines.iter().zip(sums) {
        if sums.highest.0 > highest.error {
            highest = place(*angle, sums.highest);
        }
        if sums.lowest.0 < lowest.error {
            lowest = place(*angle, sums.lowest);
        }
    }
    (highest, lowest)
}

/// Areas below this are rounding of the sums.
const ROUNDING: f64 = 1e-12;

fn uncut(part: &Part, sums: &[Sums]) -> f64 {
    let (rim, hole) = (part.aperture_radius, part.inner_radius);
    let whole = (rim * rim - hole * hole) * sums.len() as f64;
    let left = 1.0 - sums.iter().map(|line| line.area).sum::<f64>() / whole;
    if left < ROUNDING { 0.0 } else { left.min(1.0) }
}
