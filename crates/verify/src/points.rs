//! Control points: how far they lie from the true locus, apart from what is played between them.
//!
//! A strategy may play what it likes between control points, but puts the points themselves on the
//! locus: to rounding in a table, to half a digit in a program. A point that was moved by hand
//! shows here long before it shows in the interpolation error.

use std::f64::consts::TAU;

use turnpath_core::Result;
use turnpath_core::toolpath::PathBlock;

use crate::touch::FirstTouch;

/// The error of the control points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointFigures {
    /// Signed error of largest amount, Z of the point − first touch, mm; no number where the
    /// surface has no height.
    pub extreme: f64,
    /// C where it is, unwrapped, rad.
    pub at_c: f64,
    /// X where it is, mm.
    pub at_x: f64,
}

impl PointFigures {
    /// Largest amount, mm; infinite where there was no number.
    pub fn max(&self) -> f64 {
        match self.extreme.is_nan() {
            true => f64::INFINITY,
            false => self.extreme.abs(),
        }
    }

    /// Of a stretch with the errors of its points.
    pub(crate) fn of(points: &PathBlock, errors: &[f64]) -> Self {
        let mut figures = Self::default();
        for (i, error) in errors.iter().enumerate() {
            figures.see(&Self {
                extreme: *error,
                at_c: points.c[i],
                at_x: points.x[i],
            });
        }
        figures
    }

    /// Takes what is larger.
    pub(crate) fn see(&mut self, other: &Self) {
        let worse = other.extreme.is_nan() || other.extreme.abs() > self.extreme.abs();
        if !self.extreme.is_nan() && worse {
            *self = *other;
        }
    }
}

/// Z − first touch at each control point, mm.
pub(crate) fn point_errors(touch: &FirstTouch, points: &PathBlock) -> Result<Vec<f64>> {
    let theta: Vec<f64> = points.c.iter().map(|c| c.rem_euclid(TAU)).collect();
    let mut touches = Vec::new();
    touch.find(&theta, &points.x, &mut touches)?;
    let pairs = points.z.iter().zip(&touches);
    Ok(pairs.map(|(z, touch)| z - touch.z).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_amount_counts_and_no_number_most_of_all() {
        let mut points = PathBlock::default();
        for c in 0..4 {
            points.push(turnpath_core::toolpath::ControlPoint {
                c: f64::from(c),
                ..Default::default()
            });
        }
        let figures = PointFigures::of(&points, &[1e-6, -3e-6, 2e-6, 0.0]);
        assert_eq!((figures.extreme, figures.at_c), (-3e-6, 1.0));
        let broken = PointFigures::of(&points, &[1e-6, -3e-6, f64::NAN, 1.0]);
        assert_eq!((broken.max(), broken.at_c), (f64::INFINITY, 2.0));
        let mut both = broken;
        both.see(&figures);
        assert_eq!(both.max(), f64::INFINITY);
    }
}
