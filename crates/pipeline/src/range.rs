//! The range of ρ: how far the path runs beyond the part.
//!
//! With `overrun = "contact"` the range ends where the contact reaches the rim at every angle. Where
//! ρ is the contact's radius, that is the rim itself. Where ρ is the centre's X, it is the largest
//! of a − R g_ρ/w over the angles, with the rim's radius a; at a hole it is the smallest.

use std::f64::consts::TAU;

use turnpath_core::locus::{Profile, profile_at};
use turnpath_core::{
    Compensator, Overrun, Part, Radial, RadialRange, Result, StrategyError, SurfaceModel, Tool,
};

/// Angles of the first search on a rim: a wave with 72 periods on a revolution gets 10 a period.
const ANGLES: usize = 720;
/// How many of the angles with the largest overrun are refined.
const CANDIDATES: usize = 8;
/// Rounds of the refinement, each to a quarter of the interval: from half a degree to 1e-12 rad.
/// There ρ no longer changes, since it is flat at its extreme.
const ROUNDS: usize = 16;

/// The range of ρ over which the path runs.
///
/// # Errors
/// Where the surface has no slope at the rim or at the hole.
pub fn range(
    overrun: Overrun,
    part: &Part,
    tool: &Tool,
    surface: &dyn SurfaceModel,
    compensator: &dyn Compensator,
) -> Result<RadialRange> {
    let part_only = RadialRange {
        inner: part.inner_radius,
        outer: part.aperture_radius,
    };
    let by_centre = compensator.radial() == Radial::Centre && compensator.compensates_nose();
    match overrun {
        Overrun::None => Ok(part_only),
        Overrun::Length(length) => Ok(RadialRange {
            inner: beyond_hole(part, length),
            outer: part.aperture_radius + length,
        }),
        Overrun::Contact if by_centre => {
            let at_rim = Rim {
                surface,
                tool,
                radius: part.aperture_radius,
                outward: 1.0,
            };
            let at_hole = Rim {
                radius: part.inner_radius,
                outward: -1.0,
                ..at_rim
            };
            let outer = at_rim.furthest()?;
            let inner = match part.inner_radius > 0.0 {
                true => at_hole.furthest()?,
                false => 0.0,
            };
            Ok(RadialRange { inner, outer })
        }
        Overrun::Contact => Ok(part_only),
    }
}

/// The inner end of an overrun of this length. In a hole it ends at the axis; without a hole it goes
/// beyond the axis.
fn beyond_hole(part: &Part, length: f64) -> f64 {
    match part.inner_radius > 0.0 {
        true => (part.inner_radius - length).max(0.0),
        false => -length,
    }
}

/// A circle of the part that the contact must reach at every angle.
#[derive(Clone, Copy)]
struct Rim<'a> {
    surface: &'a dyn SurfaceModel,
    tool: &'a Tool,
    radius: f64,
    /// 1 at the rim of the part, −1 at a hole.
    outward: f64,
}

impl Rim<'_> {
    /// X of the nose centre from which the contact reaches the circle at every angle: the value of
    /// a − R g_ρ/w that lies furthest outward (inward at a hole). Where the normal misses the edge,
    /// the end of the edge touches.
    fn furthest(&self) -> Result<f64> {
        let step = TAU / ANGLES as f64;
        let all: Vec<f64> = (0..ANGLES).map(|i| i as f64 * step).collect();
        let mut candidates = self.beyond(&all)?;
        candidates.sort_by(|a, b| b.1.total_cmp(&a.1));
        candidates.truncate(CANDIDATES);
        let mut scale = step;
        for _ in 0..ROUNDS {
            let around: Vec<f64> = candidates
                .iter()
                .flat_map(|(theta, _)| {
                    [-0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75].map(|k| theta + k * scale)
                })
                .collect();
            let around = self.beyond(&around)?;
            for (best, around) in candidates.iter_mut().zip(around.chunks(7)) {
                for point in around {
                    if point.1 > best.1 {
                        *best = *point;
                    }
                }
            }
            scale *= 0.25;
        }
        let most = candidates
            .iter()
            .map(|point| point.1)
            .fold(f64::NEG_INFINITY, f64::max);
        Ok(self.radius + self.outward * most)
    }

    /// Each angle, and how far the nose centre stands beyond the circle when it touches there.
    fn beyond(&self, theta: &[f64]) -> Result<Vec<(f64, f64)>> {
        let rho = vec![self.radius; theta.len()];
        let mut profiles = vec![Profile::default(); theta.len()];
        profile_at(self.surface, theta, &rho, &mut profiles)?;
        let reach = self.tool.reach();
        let offset = |profile: &Profile| {
            let normal = self.tool.nose_radius * profile.slope / profile.slant();
            -self.outward * normal.clamp(-reach, reach)
        };
        let points: Vec<(f64, f64)> = theta
            .iter()
            .copied()
            .zip(profiles.iter().map(offset))
            .collect();
        match points.iter().find(|point| point.1.is_nan()) {
            None => Ok(points),
            Some((theta, _)) => Err(self.no_slope(*theta)),
        }
    }

    fn no_slope(&self, theta: f64) -> StrategyError {
        let (radius, at) = (self.radius, theta / turnpath_core::DEG);
        StrategyError::failed(format!(
            "the surface has no slope at radius {radius:.4} mm, C = {at:.1} deg, so the overrun \
             cannot be found; choose a smaller aperture, or overrun = \"none\""
        ))
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::{Centres, Cut, Misfit, Scalar, Surface};

    use super::*;

    /// z = 0.16 x y, so that g_ρ = 0.16 ρ sin 2θ.
    struct Saddle;

    impl Surface for Saddle {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            x * y * 0.16
        }
    }

    struct Fixed(Radial);

    impl Compensator for Fixed {
        fn radial(&self) -> Radial {
            self.0
        }

        fn centre(&self, _: Cut<'_>, _: &[f64], _: &[f64], _: Centres<'_>) -> Result<()> {
            Ok(())
        }
    }

    const DISC: Part = Part {
        aperture_radius: 2.5,
        inner_radius: 0.0,
    };
    const RING: Part = Part {
        inner_radius: 1.0,
        ..DISC
    };

    fn range_of(
        overrun: Overrun,
        part: Part,
        radial: Radial,
        included_angle: Option<f64>,
    ) -> [f64; 2] {
        let tool = Tool {
            nose_radius: 1.0,
            included_angle,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        };
        let range = range(overrun, &part, &tool, &Saddle, &Fixed(radial)).unwrap();
        [range.inner, range.outer]
    }

    #[track_caller]
    fn near(range: [f64; 2], expected: [f64; 2]) {
        let far = range
            .iter()
            .zip(expected)
            .any(|(f, e)| (f - e).abs() > 1e-14);
        assert!(!far, "{range:?} for {expected:?}");
    }

    #[test]
    fn the_centre_goes_as_far_as_the_normal_at_the_rim_leads() {
        let lever = |slope: f64| slope / (1.0 + slope * slope).sqrt();
        let contact = Overrun::Contact;
        near(
            range_of(contact, DISC, Radial::Centre, None),
            [0.0, 2.5 + lever(0.4)],
        );
        let ring = range_of(contact, RING, Radial::Centre, None);
        near(ring, [1.0 - lever(0.16), 2.5 + lever(0.4)]);
        near(range_of(contact, RING, Radial::Contact, None), [1.0, 2.5]);
    }

    #[test]
    fn the_end_of_the_edge_touches_where_the_normal_misses_it() {
        let narrow = range_of(
            Overrun::Contact,
            DISC,
            Radial::Centre,
            Some(20f64.to_radians()),
        );
        near(narrow, [0.0, 2.5 + Scalar::sin(10f64.to_radians())]);
    }

    #[test]
    fn a_length_counts_from_the_aperture_and_from_hole_or_axis() {
        let by = |length, part| range_of(Overrun::Length(length), part, Radial::Centre, None);
        near(by(0.5, DISC), [-0.5, 3.0]);
        near(by(0.5, RING), [0.5, 3.0]);
        near(by(1.5, RING), [0.0, 4.0]);
        near(
            range_of(Overrun::None, RING, Radial::Centre, None),
            [1.0, 2.5],
        );
    }
}
