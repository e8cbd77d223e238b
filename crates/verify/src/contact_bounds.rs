//! Contact bounds: how far from X the nose can touch the part, from the largest slope of the
//! surface.
//!
//! A contact at an offset d stands higher than the surface straight below the nose by at least the
//! rise of the nose there, R − sqrt(R² − d²) = d tan(φ/2) with d = R sin φ. On a surface whose
//! slope is nowhere larger than m, φ is at most 2 atan m.

use std::f64::consts::FRAC_PI_2;

use rayon::prelude::*;
use turnpath_core::{Gradients, Result, Scalar};

use crate::order::in_order;
use crate::subject::Subject;

/// Points per nose radius at which slopes are computed: as fine as the scan of the edge.
const POINTS_PER_RADIUS: f64 = 128.0;
/// Largest number of points. On a part that needs more, slopes are not computed, and every search
/// covers the whole edge.
const MOST_POINTS: f64 = 4e6;
/// How many times steeper the surface may be between the points.
const MARGIN: f64 = 1.1;

/// An upper bound of |s − X|, mm, for a contact s, with the whole edge within `length` of the axis,
/// mm.
///
/// # Errors
/// Where the surface fails.
pub(crate) fn farthest_contact(subject: &Subject, length: f64) -> Result<f64> {
    let (radius, reach) = (subject.tool.nose_radius, subject.tool.reach());
    let count = (2.0 * length / radius * POINTS_PER_RADIUS).ceil() + 1.0;
    if count * count > MOST_POINTS {
        return Ok(reach);
    }
    let angle = match largest_slope(subject, length, count as usize)? {
        Some(slope) => 2.0 * Scalar::atan(MARGIN * slope),
        None => FRAC_PI_2,
    };
    Ok(reach.min(radius * Scalar::sin(angle.min(FRAC_PI_2))))
}

/// The largest slope on a grid of `count` by `count` points; `None` if a slope is not finite.
fn largest_slope(subject: &Subject, length: f64, count: usize) -> Result<Option<f64>> {
    let step = 2.0 * length / (count - 1) as f64;
    let points: Vec<f64> = (0..count).map(|i| i as f64 * step - length).collect();
    let row = |y: &f64| -> Result<f64> {
        let [mut z, mut zx, mut zy] = [(); 3].map(|()| vec![0.0; count]);
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        subject.surface.gradient(&points, &vec![*y; count], out)?;
        let square = zx.iter().zip(&zy).map(|(zx, zy)| zx * zx + zy * zy);
        Ok(square.fold(0.0, larger))
    };
    let rows = in_order(points.par_iter().map(row))?;
    let square = rows.into_iter().fold(0.0, larger);
    Ok(square.is_finite().then(|| square.sqrt()))
}

/// The larger of two numbers; NaN if either is NaN.
fn larger(one: f64, other: f64) -> f64 {
    if one >= other { one } else { other + 0.0 * one }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use turnpath_core::{Misfit, Part, Surface, Tool};

    use super::*;

    struct Cone(f64);

    impl Surface for Cone {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            (x.squared() + y.squared() + 1e-12).sqrt() * self.0
        }
    }

    fn farthest(slope: f64, nose_radius: f64, aperture_radius: f64) -> f64 {
        let part = Part {
            aperture_radius,
            inner_radius: 0.0,
        };
        let tool = Tool {
            nose_radius,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::CutWhatFits,
        };
        let subject = Subject {
            surface: Arc::new(Cone(slope)),
            part,
            tool,
            compensates_nose: true,
        };
        farthest_contact(&subject, aperture_radius + 2.0 * nose_radius).unwrap_or(f64::NAN)
    }

    #[test]
    fn contacts_are_near_on_a_gentle_cone_and_anywhere_on_a_steep_one() {
        let (slope, radius) = (0.05, 2.0);
        let known = radius * 2.0 * slope;
        let found = farthest(slope, radius, 1.0);
        assert!(found > known && found < 1.2 * known, "{found}, {known}");
        assert_eq!(farthest(1.0, radius, 1.0), radius);
    }

    #[test]
    fn contacts_are_anywhere_on_a_part_too_large_for_the_grid() {
        assert_eq!(farthest(0.05, 0.1, 50.0), 0.1);
    }

    #[test]
    fn nan_stays_nan() {
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
        assert_eq!((larger(1.0, 2.0), larger(2.0, 1.0)), (2.0, 2.0));
    }
}
