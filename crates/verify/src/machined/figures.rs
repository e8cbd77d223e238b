//! Figures of the machined surface, weighted by area.

use rayon::prelude::*;
use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::{Part, Result};

use super::cusps::{HighestCusp, Tips};
use super::extremes::{LineExtremes, PartPoint, SurfaceExtremes};
use super::groups::WeightedSamples;
use super::lines::{Line, Lines};
use super::pieces::Pieces;
use super::samples::{NODES, WIDTH};
use super::strip::Strip;
use crate::order::in_order;
use crate::subject::Subject;
use crate::touch::FirstTouch;

/// The figures of the machined surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachinedFigures {
    /// The point with the largest error, where most material is left.
    pub highest: PartPoint,
    /// The point with the smallest error, where most material is missing or least is left.
    pub lowest: PartPoint,
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
    /// Part of the area that no pass reached.
    pub uncut: f64,
    /// Number of lines through the axis that were measured.
    pub lines: usize,
    /// The highest cusp as played; `None` where no two passes meet on the part.
    pub cusp: Option<HighestCusp>,
    /// What the real nose leaves where the path takes its radius as 0; `None` elsewhere.
    pub real_nose: Option<SurfaceExtremes>,
}

impl MachinedFigures {
    /// Peak to valley, mm.
    pub fn pv(&self) -> f64 {
        self.highest.error - self.lowest.error
    }
}

/// Integrals along one line.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    area: f64,
    error: f64,
    square: f64,
    slope_square: f64,
    extremes: LineExtremes,
}

impl Sums {
    /// The integrals along the line of a strip, once heights and slopes are looked up.
    fn of(strip: &Strip) -> Self {
        in_widest(LineSums(strip.pieces()))
    }
}

/// The loop that sums up the pieces of a line: each lane for itself, and then all lanes.
struct LineSums<'a>(&'a Pieces);

impl Loop for LineSums<'_> {
    type Output = Sums;

    #[inline(always)]
    fn call(self) -> Sums {
        let Self(of_line) = self;
        let mut extremes = LineExtremes::default();
        let [mut area, mut error, mut square, mut slope_square] = [[0.0; WIDTH]; 4];
        let mut pieces = WeightedSamples::blank();
        for group in of_line.groups() {
            group.sample_with_weights(&mut pieces);
            for k in 0..NODES {
                let (weights, errors) = (&pieces.weight[k], &pieces.samples.error[k]);
                let slopes = &pieces.slope[k];
                for i in 0..WIDTH {
                    area[i] += weights[i];
                    error[i] += weights[i] * errors[i];
                    square[i] += weights[i] * errors[i] * errors[i];
                    slope_square[i] += weights[i] * slopes[i] * slopes[i];
                }
            }
            extremes.include_samples(&pieces.samples);
        }
        Sums {
            area: area.iter().sum(),
            error: error.iter().sum(),
            square: square.iter().sum(),
            slope_square: slope_square.iter().sum(),
            extremes,
        }
    }
}

impl Lines {
    /// The figures of the part; `None` if nothing of the part was cut. Lines are measured in
    /// parallel and combined in order. `counts_centre` says whether cusps between the passes of the
    /// two sides of the axis count.
    ///
    /// # Errors
    /// When the surface fails or has no height at a place that was cut.
    pub fn figures(
        &self,
        touch: &FirstTouch,
        counts_centre: bool,
    ) -> Result<Option<MachinedFigures>> {
        let subject = touch.subject();
        let lines = self.all();
        let tips = Tips {
            touch,
            counts_centre,
        };
        let (sums, cusps) = sums_and_cusps(&tips, &lines)?;
        let total = |of: fn(&Sums) -> f64| sums.iter().map(of).sum::<f64>();
        let area = total(|line| line.area);
        if area <= 0.0 {
            return Ok(None);
        }
        let Some(SurfaceExtremes { highest, lowest }) = extremes(&lines, &sums) else {
            return Ok(None);
        };
        let mean = total(|line| line.error) / area;
        let mean_square = total(|line| line.square) / area;
        Ok(Some(MachinedFigures {
            highest,
            lowest,
            mean,
            rms: mean_square.sqrt(),
            // Rounding may make it negative. NaN stays NaN.
            sq: (mean_square - mean * mean).clamp(0.0, f64::INFINITY).sqrt(),
            sa: self.amount_about(subject, mean)? / area,
            rms_slope: (total(|line| line.slope_square) / area).sqrt(),
            uncut: uncut(&subject.part, &sums),
            lines: lines.len(),
            cusp: HighestCusp::of(cusps),
            real_nose: None,
        }))
    }

    /// The extremes over the part; `None` if nothing of the part was cut.
    ///
    /// # Errors
    /// When the surface fails or has no height at a place that was cut.
    pub fn extremes(&self, subject: &Subject) -> Result<Option<SurfaceExtremes>> {
        let lines = self.all();
        let sums = sums(subject, &lines)?;
        Ok(extremes(&lines, &sums))
    }

    /// The integral of |error − mean|.
    fn amount_about(&self, subject: &Subject, mean: f64) -> Result<f64> {
        let of_line = |strip: &mut Strip, line: Line<'_>| {
            strip.set_line(subject, &line);
            strip.look_up_heights(subject.surface.as_ref())?;
            Ok(strip.amount_about(mean))
        };
        let lines = self.all().into_par_iter();
        let amounts = in_order(lines.map_init(Strip::default, of_line))?;
        Ok(amounts.iter().sum())
    }
}

/// The integrals along each line.
fn sums(subject: &Subject, lines: &[Line<'_>]) -> Result<Vec<Sums>> {
    let of_line = |strip: &mut Strip, line: &Line<'_>| {
        strip.set_line(subject, line);
        strip.look_up(subject.surface.as_ref())?;
        Ok(Sums::of(strip))
    };
    in_order(lines.par_iter().map_init(Strip::default, of_line))
}

/// The integrals along each line, and its highest cusp.
fn sums_and_cusps(
    tips: &Tips<'_>,
    lines: &[Line<'_>],
) -> Result<(Vec<Sums>, Vec<Option<HighestCusp>>)> {
    let subject = tips.touch.subject();
    let of_line = |strip: &mut Strip, (number, line): (usize, &Line<'_>)| {
        strip.set_line(subject, line);
        strip.look_up(subject.surface.as_ref())?;
        Ok((
            Sums::of(strip),
            tips.highest(number, line.angle, strip.pieces())?,
        ))
    };
    let numbered = lines.par_iter().enumerate();
    let each = in_order(numbered.map_init(Strip::default, of_line))?;
    Ok(each.into_iter().unzip())
}

/// The highest and the lowest point over all lines.
fn extremes(lines: &[Line<'_>], sums: &[Sums]) -> Option<SurfaceExtremes> {
    let each = lines.iter().zip(sums);
    SurfaceExtremes::over(each.map(|(line, sums)| (line.angle, &sums.extremes)))
}

/// An uncut part of the area below this comes from rounding of the sums.
const ROUNDING: f64 = 1e-12;

/// The part of the area that no pass reached.
fn uncut(part: &Part, sums: &[Sums]) -> f64 {
    let (rim, hole) = (part.aperture_radius, part.inner_radius);
    let whole = (rim * rim - hole * hole) * sums.len() as f64;
    let left = 1.0 - sums.iter().map(|line| line.area).sum::<f64>() / whole;
    if left < ROUNDING { 0.0 } else { left.min(1.0) }
}
