//! Control points: how far they lie from where the sampler placed them.
//!
//! Whatever is played between control points, the points themselves lie on the locus, or off it by
//! the sampler's offset: to rounding in a table, to half a digit in a program. A point that someone
//! moved by hand shows here long before it shows in the interpolation error.

use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Result, within_turns};

use crate::touch::FirstTouch;

/// The error of the control points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointFigures {
    /// The error with the largest amount, signed: Z of the point − its offset − first touch, mm. NaN
    /// where the surface has no height.
    pub extreme: f64,
    /// C of that point, unwrapped, rad.
    pub at_c: f64,
    /// X of that point, mm.
    pub at_x: f64,
    /// The largest amount by which a point was placed off the locus, mm; `None` if that is not known.
    pub offset: Option<f64>,
}

impl PointFigures {
    /// Largest amount, mm; infinite if an error is NaN.
    pub fn max(&self) -> f64 {
        match self.extreme.is_nan() {
            true => f64::INFINITY,
            false => self.extreme.abs(),
        }
    }

    /// The figures of a block, from the distances of its points from the first touch. `offsets`
    /// has how far each point was placed off the locus; it may be empty.
    pub(crate) fn of(points: &PathBlock, distances: &[f64], offsets: &[f64]) -> Self {
        let mut figures = Self::default();
        for (i, distance) in distances.iter().enumerate() {
            let offset = offsets.get(i).copied();
            figures.include(&Self {
                extreme: distance - offset.unwrap_or(0.0),
                at_c: points.c[i],
                at_x: points.x[i],
                offset: offset.map(f64::abs),
            });
        }
        figures
    }

    /// Keeps the larger error and the larger offset of the two.
    pub(crate) fn include(&mut self, other: &Self) {
        let worse = other.extreme.is_nan() || other.extreme.abs() > self.extreme.abs();
        let offset = match (self.offset, other.offset) {
            (Some(own), Some(other)) => Some(own.max(other)),
            (own, other) => own.or(other),
        };
        if !self.extreme.is_nan() && worse {
            *self = *other;
        }
        self.offset = offset;
    }
}

/// Z − first touch at the control points of a block that has no segments, mm; empty for others.
pub(crate) fn errors_without_segments(touch: &FirstTouch, points: &PathBlock) -> Result<Vec<f64>> {
    if points.len() != 1 {
        return Ok(Vec::new());
    }
    let mut theta = points.c.clone();
    within_turns(&mut theta);
    let mut touches = Vec::new();
    touch.find(&theta, &points.x, &mut touches)?;
    let pairs = points.z.iter().zip(&touches);
    Ok(pairs.map(|(z, touch)| z - touch.z).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_amount_counts_and_nan_outweighs_all() {
        let mut points = PathBlock::default();
        for c in 0..4 {
            points.push(turnpath_core::toolpath::ControlPoint {
                c: f64::from(c),
                ..Default::default()
            });
        }
        let figures = PointFigures::of(&points, &[1e-6, -3e-6, 2e-6, 0.0], &[]);
        assert_eq!((figures.extreme, figures.at_c), (-3e-6, 1.0));
        let broken = PointFigures::of(&points, &[1e-6, -3e-6, f64::NAN, 1.0], &[]);
        assert_eq!((broken.max(), broken.at_c), (f64::INFINITY, 2.0));
        let mut both = broken;
        both.include(&figures);
        assert_eq!(both.max(), f64::INFINITY);
    }

    #[test]
    fn an_offset_is_no_error() {
        let mut points = PathBlock::default();
        for c in 0..3 {
            points.push(turnpath_core::toolpath::ControlPoint {
                c: f64::from(c),
                ..Default::default()
            });
        }
        let figures = PointFigures::of(&points, &[4e-6, -8e-6, 1e-6], &[4e-6, -8e-6, 0.0]);
        assert_eq!((figures.extreme, figures.at_c), (1e-6, 2.0));
        assert_eq!(figures.offset, Some(8e-6));
    }
}
