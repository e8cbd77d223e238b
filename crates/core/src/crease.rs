//! Creases: hollows of a section that are so narrow that no point of a grid shows their curvature.
//!
//! In the seam between two convex lenses the slope jumps, and every point beside the seam is smooth.
//! But between two points of a section the angle of its slope grows by the mean curvature times the
//! arc. Where this mean exceeds all curvatures that were found, there is a hollow in between, and
//! halving the stretch closes in on it.

use std::f64::consts::TAU;

use crate::extreme::Extreme;
use crate::{Cut, Gradients, RadialRange, Result, Scalar};

/// Sections around the part: as many as the grid of the pointwise extremes has.
const SECTIONS: usize = 360;
/// Stretches of a section.
pub const STRETCHES: usize = 256;
/// A mean curvature counts as a crease from this many times the largest curvature of a point on. A
/// chord is a little shorter than its arc, so that the mean over a chord may exceed it.
const SHARPER: f64 = 1.5;
/// How often a stretch with a crease is halved: to a millionth.
const HALVINGS: usize = 20;
/// Angles that are smaller than this are rounding, rad.
const LEAST_ANGLE: f64 = 1e-9;
/// A stretch whose slope grows by less than this part of what a crease needs has none. The hundredth that is
/// left covers rounding.
const ROUNDING: f64 = 0.99;

/// The sharpest crease among radial sections that is sharper than `curvature`, 1/mm, by its mean
/// curvature over a short stretch. Each section has so many stretches. A seam has one of about a
/// million stretches of the section.
pub fn sharpest(
    cut: Cut<'_>,
    (region, stretches): (RadialRange, usize),
    curvature: f64,
) -> Result<Option<Extreme>> {
    let from = SHARPER * curvature.max(0.0);
    let mut sharpest: Option<Extreme> = None;
    let mut section = Section::default();
    for number in 0..SECTIONS {
        let theta = TAU * number as f64 / SECTIONS as f64;
        section.set(theta, (0..=stretches).map(|k| at(region, k, stretches)));
        section.evaluate(cut)?;
        let may_be = |ends: &[End; 2]| may_be_sharper(ends, from);
        let measured = section.stretches().filter(may_be);
        let measured = measured.map(|ends| ends.map(|end| end.point()));
        for stretch in measured.filter(|one| is_sharper(one, from)) {
            let (value, rho) = close_in(cut, theta, stretch)?;
            if sharpest.is_none_or(|known| value > known.value) {
                sharpest = Some(Extreme { value, theta, rho });
            }
        }
    }
    Ok(sharpest)
}

/// The end number `k` of the stretches.
fn at(region: RadialRange, k: usize, stretches: usize) -> f64 {
    let part = k as f64 / stretches as f64;
    region.inner + part * (region.outer - region.inner)
}

/// Whether a stretch may be [sharper](is_sharper). The angle of a slope grows by no more than the slope, and
/// the chord is no shorter than the stretch, so that nearly no stretch needs its angles.
fn may_be_sharper([from, to]: &[End; 2], curvature: f64) -> bool {
    let growth = to.slope - from.slope;
    let least = LEAST_ANGLE.max(curvature * (to.rho - from.rho));
    growth > ROUNDING * least
}

fn is_sharper(stretch: &[Point; 2], curvature: f64) -> bool {
    stretch[1].angle - stretch[0].angle > LEAST_ANGLE && mean_curvature(stretch) > curvature
}

/// The largest mean curvature on the way to the crease in a stretch, and its radius.
fn close_in(cut: Cut<'_>, theta: f64, mut stretch: [Point; 2]) -> Result<(f64, f64)> {
    let middle = |stretch: &[Point; 2]| 0.5 * (stretch[0].rho + stretch[1].rho);
    let mut best = (mean_curvature(&stretch), middle(&stretch));
    let mut section = Section::default();
    for _ in 0..HALVINGS {
        section.set(theta, [middle(&stretch)]);
        section.evaluate(cut)?;
        let Some(between) = section.ends().next().map(|end| end.point()) else {
            break;
        };
        let halves = [[stretch[0], between], [between, stretch[1]]];
        let [left, right] = halves.map(|half| half[1].angle - half[0].angle);
        // Without a height in the middle neither is larger, and the search ends where it is.
        stretch = if left > right { halves[0] } else { halves[1] };
        let mean = mean_curvature(&stretch);
        if mean > best.0 {
            best = (mean, middle(&stretch));
        }
    }
    Ok(best)
}

/// The growth of the slope's angle over the chord.
fn mean_curvature([from, to]: &[Point; 2]) -> f64 {
    let chord = Scalar::hypot(to.rho - from.rho, to.height - from.height);
    (to.angle - from.angle) / chord
}

/// An end of a stretch.
#[derive(Debug, Clone, Copy)]
struct End {
    rho: f64,
    height: f64,
    /// The section's slope.
    slope: f64,
}

impl End {
    fn point(&self) -> Point {
        Point {
            rho: self.rho,
            height: self.height,
            angle: Scalar::atan(self.slope),
        }
    }
}

/// A point of a section.
#[derive(Debug, Clone, Copy)]
struct Point {
    rho: f64,
    height: f64,
    /// The angle of the section's slope.
    angle: f64,
}

/// Points of one radial section. NaN where the surface has no height.
#[derive(Default)]
struct Section {
    sin_cos: (f64, f64),
    rho: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    zx: Vec<f64>,
    zy: Vec<f64>,
}

impl Section {
    fn set(&mut self, theta: f64, rho: impl IntoIterator<Item = f64>) {
        let (sin, cos) = Scalar::sin_cos(theta);
        self.sin_cos = (sin, cos);
        self.rho.clear();
        self.rho.extend(rho);
        for (all, turned) in [(&mut self.x, cos), (&mut self.y, sin)] {
            all.clear();
            all.extend(self.rho.iter().map(|rho| rho * turned));
        }
        for all in [&mut self.z, &mut self.zx, &mut self.zy] {
            all.clear();
            all.resize(self.rho.len(), 0.0);
        }
    }

    fn evaluate(&mut self, cut: Cut<'_>) -> Result<()> {
        let out = Gradients {
            z: &mut self.z,
            zx: &mut self.zx,
            zy: &mut self.zy,
        };
        cut.surface.gradient(&self.x, &self.y, out)
    }

    fn ends(&self) -> impl Iterator<Item = End> {
        let (sin, cos) = self.sin_cos;
        let slopes = self.zx.iter().zip(&self.zy);
        let places = self.rho.iter().zip(&self.z).zip(slopes);
        places.map(move |((rho, height), (zx, zy))| End {
            rho: *rho,
            height: *height,
            slope: zx * cos + zy * sin,
        })
    }

    fn stretches(&self) -> impl Iterator<Item = [End; 2]> {
        self.ends()
            .zip(self.ends().skip(1))
            .map(|(from, to)| [from, to])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Misfit, Surface, Tool};

    /// Walls of slope 0.1 that meet in a valley at x = 0.7, or in a ridge if the slope is negative,
    /// with a floor of `radius`.
    struct Valley {
        slope: f64,
        radius: f64,
    }

    impl Surface for Valley {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, _: S) -> S {
            let off = x - 0.7;
            (off.squared() + self.radius * self.radius).sqrt() * self.slope
        }
    }

    fn sharpest_of(slope: f64, radius: f64) -> Option<Extreme> {
        let tool = Tool {
            nose_radius: 1.0,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        };
        let surface = Valley { slope, radius };
        let cut = Cut {
            surface: &surface,
            tool: &tool,
        };
        let region = RadialRange {
            inner: 0.0,
            outer: 2.0,
        };
        sharpest(cut, (region, STRETCHES), 0.0).unwrap()
    }

    #[test]
    fn a_valley_without_a_floor_is_sharper_than_any_nose() {
        let found = sharpest_of(0.1, 1e-12).unwrap();
        assert!(found.value > 1e6, "{found:?}");
        assert!((found.rho * Scalar::cos(found.theta) - 0.7).abs() < 1e-6);
    }

    /// The hyperbola has the curvature slope/radius at its vertex.
    #[test]
    fn the_floor_of_a_narrow_valley_has_nearly_its_own_curvature() {
        let found = sharpest_of(0.1, 1e-4).unwrap();
        let own = 0.1 / 1e-4;
        assert!(
            found.value > 0.9 * own && found.value < 1.001 * own,
            "{found:?}"
        );
    }

    /// On flat and on steep walls, for curvatures around the stretch's own.
    #[test]
    fn a_stretch_that_is_left_out_is_not_sharper() {
        let (mut left_out, mut sharper) = (0, 0);
        for slope in [-30.0, -1.0, -0.01, 0.0, 0.3, 4.0, 100.0] {
            for growth in [0.0, 1e-10, 1.1e-9, 1e-4, 0.02, 0.5, 3.0] {
                let end = |rho: f64, height: f64, slope: f64| End { rho, height, slope };
                let rise = 0.01 * (slope + 0.5 * growth);
                let ends = [end(0.5, 0.0, slope), end(0.51, rise, slope + growth)];
                let stretch = ends.map(|end| end.point());
                let own = mean_curvature(&stretch);
                for curvature in [0.0, 0.98 * own, 1.02 * own, 50.0] {
                    let is_sharper = is_sharper(&stretch, curvature);
                    let may_be = may_be_sharper(&ends, curvature);
                    assert!(may_be || !is_sharper, "{slope} {growth} {curvature}");
                    sharper += usize::from(is_sharper);
                    left_out += usize::from(!may_be && growth > 1e-9);
                }
            }
        }
        assert!(left_out > 20 && sharper > 50, "{left_out} {sharper}");
    }

    #[test]
    fn a_ridge_is_no_hollow() {
        assert_eq!(sharpest_of(-0.1, 1e-12), None);
    }
}
