//! How far from X the nose can touch at all, by how steep the surface is.
//!
//! A contact at an offset d stands higher than the place below the nose by at least what the nose
//! rises there, R − sqrt(R² − d²) = d tan(φ/2) with d = R sin φ. On a surface that rises by no more
//! than a slope m from place to place, φ is at most 2 atan m.

use std::f64::consts::FRAC_PI_2;

use rayon::prelude::*;
use turnpath_core::{Gradients, Result, Scalar};

use crate::Subject;

/// Places a nose radius at which slopes are looked at: as fine as the scan of the edge.
const PLACES_A_RADIUS: f64 = 128.0;
/// Most places: where that takes more, nothing is said, and every search looks along the whole edge.
const MOST_PLACES: f64 = 4e6;
/// How much steeper the surface may be between them.
const MARGIN: f64 = 1.1;

/// The largest |s − X|, mm, of a contact s with the whole edge within `length` of the axis.
///
/// # Errors
/// Where the surface fails.
pub(crate) fn farthest_contact(subject: &Subject, length: f64) -> Result<f64> {
    let (radius, reach) = (subject.tool.nose_radius, subject.tool.reach());
    let count = (2.0 * length / radius * PLACES_A_RADIUS).ceil() + 1.0;
    if count * count > MOST_PLACES {
        return Ok(reach);
    }
    let angle = match steepest(subject, length, count as usize)? {
        Some(slope) => 2.0 * Scalar::atan(MARGIN * slope),
        None => FRAC_PI_2,
    };
    Ok(reach.min(radius * Scalar::sin(angle.min(FRAC_PI_2))))
}

/// The steepest slope on a grid of `count` by `count` places; `None` where one has no number.
fn steepest(subject: &Subject, length: f64, count: usize) -> Result<Option<f64>> {
    let step = 2.0 * length / (count - 1) as f64;
    let places: Vec<f64> = (0..count).map(|i| i as f64 * step - length).collect();
    let row = |y: &f64| -> Result<f64> {
        let [mut z, mut zx, mut zy] = [(); 3].map(|()| vec![0.0; count]);
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        subject.surface.gradient(&places, &vec![*y; count], out)?;
        let square = zx.iter().zip(&zy).map(|(zx, zy)| zx * zx + zy * zy);
        Ok(square.fold(0.0, largest))
    };
    let rows: Vec<f64> = places.par_iter().map(row).collect::<Result<_>>()?;
    let square = rows.into_iter().fold(0.0, largest);
    Ok(square.is_finite().then(|| square.sqrt()))
}

/// The larger of two; no number where either is none.
fn largest(one: f64, other: f64) -> f64 {
    if one >= other { one } else { other + 0.0 * one }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use turnpath_core::{Misfit, Part, Surface, Tool};

    use super::*;

    struct Cone(f64);

    impl Surface for Cone {
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
    fn on_a_gentle_cone_contacts_are_near_and_on_a_steep_one_anywhere() {
        let (slope, radius) = (0.05, 2.0);
        let known = radius * 2.0 * slope;
        let found = farthest(slope, radius, 1.0);
        assert!(found > known && found < 1.2 * known, "{found}, {known}");
        assert_eq!(farthest(1.0, radius, 1.0), radius);
    }

    #[test]
    fn on_a_part_too_large_to_be_looked_at_they_are_anywhere() {
        assert_eq!(farthest(0.05, 0.1, 50.0), 0.1);
    }

    #[test]
    fn what_is_no_number_stays_none() {
        assert!(largest(f64::NAN, 1.0).is_nan() && largest(1.0, f64::NAN).is_nan());
        assert_eq!((largest(1.0, 2.0), largest(2.0, 1.0)), (2.0, 2.0));
    }
}
