//! The descent of the nose along a curve: how foot and height move, order by order.

use turnpath_plugin::prelude::*;
use turnpath_plugin::registers::Loop;
use turnpath_plugin::strip::{Column, Group, STRIP, Strip, blank, gather, scatter};

use crate::polar::{Ray, TurningRay};
use crate::touch::{Touch, rise};

/// The least −F_d·R that the motion of the foot uses. It is 1/cos³φ − Rκ. It is above zero at a
/// highest point, except where the section osculates the nose: there the foot moves without bound.
const LEAST_STEEPNESS: f64 = 1e-6;

/// The descent of the nose along one curve. ρ_t(t) = ρ(t) + d(t) is the foot.
///
/// With h(t, d) = g(θ(t), ρ(t) + d) + sqrt(R² − d²) and F = ∂h/∂d, the foot has F = 0. A foot d₀ +
/// at that is right to order 1 leaves F = F₂t² + …, and Z = max h then still lacks −F₂²/(2F_d)·t⁴ +
/// O(t⁵). So three series of the surface give Z exactly through order 4.
struct Descent {
    radius: f64,
    /// The ray at t = 0.
    ray: Ray,
    turning: TurningRay,
    rho: Taylor<f64>,
    offset: Taylor<f64>,
    /// F_d at t = 0, negative; −∞ if the end of the edge touches, whose offset does not move.
    steepness: f64,
}

impl Descent {
    /// The foot's curve, to the order that is known so far.
    #[inline(always)]
    fn curve(&self) -> (Taylor<f64>, Taylor<f64>) {
        self.turning.point(self.rho + self.offset)
    }

    /// F_d = g_ρρ − R²/(R² − d²)^{3/2}, from the gradient's change along the section.
    #[inline(always)]
    fn steepness(&self, zx_rho: f64, zy_rho: f64) -> f64 {
        let radius = self.radius;
        let rise = rise(radius, self.offset.0[0]);
        let second = self.ray.along(zx_rho, zy_rho);
        let steepness = second - radius * radius / (rise * rise * rise);
        steepness.min(-LEAST_STEEPNESS / radius)
    }

    /// F(t) = g_ρ − d/sqrt(R² − d²) at the foot, in its first `N` coefficients.
    #[inline(always)]
    fn tilt<const N: usize>(&self, zx: Taylor<f64, N>, zy: Taylor<f64, N>) -> Taylor<f64, N> {
        let offset = Taylor::from_series(self.offset.0);
        self.turning.along(zx, zy) - offset / rise(self.radius, offset)
    }

    /// The speed of the foot: with it, F₁ = 0.
    #[inline(always)]
    fn speed(&self, zx: Taylor<f64, 2>, zy: Taylor<f64, 2>) -> f64 {
        -self.tilt(zx, zy).0[1] / self.steepness
    }

    /// The height at the foot, and what Z still lacks in the fourth order.
    #[inline(always)]
    fn height(&self, z: Taylor<f64>, zx: Taylor<f64, 3>, zy: Taylor<f64, 3>) -> Taylor<f64> {
        let rest = self.tilt(zx, zy).0[2];
        let mut height = z + rise(self.radius, self.offset);
        height.0[4] -= 0.5 * rest * rest / self.steepness;
        height
    }
}

/// The descents along the curves of a strip.
#[derive(Debug)]
pub struct Descents {
    count: usize,
    radius: f64,
    sin: Column,
    cos: Column,
    theta: Strip<{ ORDER + 1 }>,
    rho: Strip<{ ORDER + 1 }>,
    /// d₀.
    offset: Column,
    /// d₁, which is 0 until it is known.
    speed: Column,
    steepness: Column,
    at_edge_end: [bool; STRIP],
}

impl Descents {
    /// Room for a strip.
    pub fn none() -> Self {
        Self {
            count: 0,
            radius: f64::NAN,
            sin: [0.0; STRIP],
            cos: [0.0; STRIP],
            theta: blank(),
            rho: blank(),
            offset: [0.0; STRIP],
            speed: [0.0; STRIP],
            steepness: [0.0; STRIP],
            at_edge_end: [false; STRIP],
        }
    }

    /// Begins the descents of a nose of this radius (mm) along the curves (θ, ρ) where these touches
    /// are. There are [`STRIP`] of them at the most.
    pub fn begin(&mut self, radius: f64, theta: &[Series], rho: &[Series], touches: &[Touch]) {
        (self.count, self.radius) = (touches.len().min(STRIP), radius);
        gather(theta, &mut self.theta);
        gather(rho, &mut self.rho);
        for (i, touch) in touches.iter().enumerate().take(STRIP) {
            (self.sin[i], self.cos[i]) = touch.ray.sin_cos();
            self.offset[i] = touch.offset;
            self.at_edge_end[i] = touch.at_edge_end;
        }
        self.speed.fill(0.0);
        self.steepness.fill(f64::NEG_INFINITY);
    }

    /// Descent `i`.
    #[inline(always)]
    fn at(&self, i: usize) -> Descent {
        let ray = Ray::from_sin_cos(self.sin[i], self.cos[i]);
        let mut offset = Taylor::constant(self.offset[i]);
        offset.0[1] = self.speed[i];
        Descent {
            radius: self.radius,
            ray,
            turning: TurningRay::from(ray, f64::take(&self.theta, i)),
            rho: f64::take(&self.rho, i),
            offset,
            steepness: self.steepness[i],
        }
    }
}

/// The loop that learns the steepness of each descent from the slopes' series along its section, and
/// gives the curve of a foot that does not move.
pub struct StillFeet<'a> {
    /// The descents.
    pub descents: &'a mut Descents,
    /// ∂z/∂x and ∂z/∂y along the sections, through order 1.
    pub slopes: [&'a [Series]; 2],
    /// The curves (x, y).
    pub curves: [&'a mut [Series]; 2],
}

impl Loop for StillFeet<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let descents = self.descents;
        let [zx, zy] = self.slopes.map(gathered::<2>);
        let (mut steepness, mut x, mut y) = ([0.0; STRIP], blank(), blank());
        for i in 0..descents.count.min(STRIP) {
            let descent = descents.at(i);
            steepness[i] = descent.steepness(zx[1][i], zy[1][i]);
            let along = descent.curve();
            f64::put(i, along.0, &mut x);
            f64::put(i, along.1, &mut y);
        }
        for (i, steepness) in steepness.into_iter().enumerate() {
            if !descents.at_edge_end[i] {
                descents.steepness[i] = steepness;
            }
        }
        let [curves_x, curves_y] = self.curves;
        scatter(&x, curves_x);
        scatter(&y, curves_y);
    }
}

/// The loop that learns the speed of each foot from the slopes' series along its curve, and gives the
/// curve of a foot that moves at this speed.
pub struct MovingFeet<'a> {
    /// The descents.
    pub descents: &'a mut Descents,
    /// ∂z/∂x and ∂z/∂y along the curves of feet that do not move, through order 1.
    pub slopes: [&'a [Series]; 2],
    /// The curves (x, y).
    pub curves: [&'a mut [Series]; 2],
}

impl Loop for MovingFeet<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let descents = self.descents;
        let [zx, zy] = self.slopes.map(gathered::<2>);
        let (mut speed, mut x, mut y) = ([0.0; STRIP], blank(), blank());
        for (i, speed) in speed.iter_mut().enumerate().take(descents.count) {
            let mut descent = descents.at(i);
            *speed = descent.speed(f64::take(&zx, i), f64::take(&zy, i));
            descent.offset.0[1] = *speed;
            let along = descent.curve();
            f64::put(i, along.0, &mut x);
            f64::put(i, along.1, &mut y);
        }
        descents.speed = speed;
        let [curves_x, curves_y] = self.curves;
        scatter(&x, curves_x);
        scatter(&y, curves_y);
    }
}

/// The loop that gives the series of heights from those of the surface along the curves of feet that
/// move.
pub struct Heights<'a> {
    /// The descents.
    pub descents: &'a Descents,
    /// z along the curves.
    pub z: &'a [Series],
    /// ∂z/∂x and ∂z/∂y along the curves, through order 2.
    pub slopes: [&'a [Series]; 2],
    /// Z.
    pub out: &'a mut [Series],
}

impl Loop for Heights<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let z = gathered::<{ ORDER + 1 }>(self.z);
        let [zx, zy] = self.slopes.map(gathered::<3>);
        let mut heights = blank::<{ ORDER + 1 }>();
        for i in 0..self.descents.count.min(STRIP) {
            let descent = self.descents.at(i);
            let height = descent.height(f64::take(&z, i), f64::take(&zx, i), f64::take(&zy, i));
            f64::put(i, height, &mut heights);
        }
        scatter(&heights, self.out);
    }
}

#[inline(always)]
fn gathered<const N: usize>(curves: &[Series]) -> Strip<N> {
    let mut strip = blank();
    gather(curves, &mut strip);
    strip
}
