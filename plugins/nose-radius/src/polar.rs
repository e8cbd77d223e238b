//! Points and curves of the polar plane in the surface's own x and y, in batches.

use std::ops::Range;

use turnpath_plugin::prelude::*;
use turnpath_plugin::strip::STRIP;

/// Number of points that go through a surface together. Their intermediate results stay in the
/// cache.
const BATCH: usize = 256;

/// Splits `count` points into ranges of at most [`BATCH`] points.
pub fn batches(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count.div_ceil(BATCH)).map(move |i| i * BATCH..((i + 1) * BATCH).min(count))
}

/// The ray from the spindle axis at the angle θ.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    sin: f64,
    cos: f64,
}

impl Ray {
    /// The ray of the angle that has this sine and this cosine.
    #[inline(always)]
    pub fn from_sin_cos(sin: f64, cos: f64) -> Self {
        Self { sin, cos }
    }

    /// Sine and cosine of its angle.
    #[inline(always)]
    pub fn sin_cos(&self) -> (f64, f64) {
        (self.sin, self.cos)
    }

    /// (x, y) at the radius `rho`.
    pub fn point(&self, rho: f64) -> (f64, f64) {
        (rho * self.cos, rho * self.sin)
    }

    /// The straight curve (x(t), y(t)) along the ray at unit speed, through `rho` at t = 0.
    pub fn line(&self, rho: f64) -> (Series, Series) {
        let along = |unit: f64| [rho * unit, unit, 0.0, 0.0, 0.0];
        (along(self.cos), along(self.sin))
    }

    /// The component of a gradient along the ray: g_ρ.
    #[inline(always)]
    pub fn along(&self, zx: f64, zy: f64) -> f64 {
        zx * self.cos + zy * self.sin
    }

    /// The component of a gradient across the ray: g_θ/ρ.
    pub fn across(&self, zx: f64, zy: f64) -> f64 {
        zy * self.cos - zx * self.sin
    }
}

/// The rays of a batch of angles.
#[derive(Debug, Default)]
pub struct Rays {
    theta: Vec<f64>,
    sines: Vec<f64>,
    cosines: Vec<f64>,
}

impl Rays {
    /// The rays at these angles, one after the other.
    pub fn at(&mut self, theta: impl Iterator<Item = f64>) -> impl Iterator<Item = Ray> + Clone {
        self.theta.clear();
        self.theta.extend(theta);
        for columns in [&mut self.sines, &mut self.cosines] {
            columns.resize(self.theta.len(), f64::NAN);
        }
        sines_and_cosines(&self.theta, &mut self.sines, &mut self.cosines);
        let pairs = self.sines.iter().zip(&self.cosines);
        pairs.map(|(sin, cos)| Ray::from_sin_cos(*sin, *cos))
    }
}

/// The direction of a ray that turns along a curve.
#[derive(Debug, Clone, Copy)]
pub struct TurningRay {
    sin: Taylor<f64>,
    cos: Taylor<f64>,
}

impl TurningRay {
    /// The ray that turns to θ(t), from where it is at t = 0.
    #[inline(always)]
    pub fn from(ray: Ray, theta: Taylor<f64>) -> Self {
        let (sin, cos) = theta.sin_cos_from(ray.sin_cos());
        Self { sin, cos }
    }

    /// (x(t), y(t)) at the radius ρ(t).
    #[inline(always)]
    pub fn point(&self, rho: Taylor<f64>) -> (Taylor<f64>, Taylor<f64>) {
        (rho * self.cos, rho * self.sin)
    }

    /// The component of a gradient along the ray: the first `N` coefficients of g_ρ(t).
    #[inline(always)]
    pub fn along<const N: usize>(&self, zx: Taylor<f64, N>, zy: Taylor<f64, N>) -> Taylor<f64, N> {
        let (cos, sin) = (
            Taylor::from_series(self.cos.0),
            Taylor::from_series(self.sin.0),
        );
        zx * cos + zy * sin
    }
}

/// Points or curves (x, y), and the surface's answers for them.
#[derive(Debug, Default)]
pub struct Evaluation<T> {
    x: Vec<T>,
    y: Vec<T>,
    /// Height.
    pub z: Vec<T>,
    /// ∂z/∂x.
    pub zx: Vec<T>,
    /// ∂z/∂y.
    pub zy: Vec<T>,
}

impl<T: Copy> Evaluation<T> {
    /// Replaces the points or curves.
    pub fn set(&mut self, points: impl Iterator<Item = (T, T)>) {
        self.x.clear();
        self.y.clear();
        for (x, y) in points {
            self.x.push(x);
            self.y.push(y);
        }
    }

    fn resize(&mut self, blank: T) {
        for columns in [&mut self.z, &mut self.zx, &mut self.zy] {
            columns.resize(self.x.len(), blank);
        }
    }
}

impl Evaluation<f64> {
    /// Evaluates height and slopes at the points.
    pub fn gradient(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        self.resize(f64::NAN);
        let (z, zx, zy) = (&mut self.z, &mut self.zx, &mut self.zy);
        surface.gradient(&self.x, &self.y, Gradients { z, zx, zy })
    }
}

/// A strip of curves, and the surface's answers for them.
pub struct CurveStrip<'a> {
    /// x and y.
    pub curves: [&'a mut [Series]; 2],
    /// Height.
    pub z: &'a [Series],
    /// ∂z/∂x and ∂z/∂y.
    pub slopes: [&'a [Series]; 2],
}

impl Evaluation<Series> {
    /// The curves, [`STRIP`] at a time.
    pub fn strips(&mut self) -> impl Iterator<Item = CurveStrip<'_>> {
        let curves = self.x.chunks_mut(STRIP).zip(self.y.chunks_mut(STRIP));
        let slopes = self.zx.chunks(STRIP).zip(self.zy.chunks(STRIP));
        let answers = self.z.chunks(STRIP).zip(slopes);
        curves
            .zip(answers)
            .map(|((x, y), (z, (zx, zy)))| CurveStrip {
                curves: [x, y],
                z,
                slopes: [zx, zy],
            })
    }

    /// Evaluates height and slopes along the curves.
    pub fn series(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        self.resize([f64::NAN; 5]);
        let (z, zx, zy) = (&mut self.z, &mut self.zx, &mut self.zy);
        surface.series(&self.x, &self.y, GradientSeries { z, zx, zy })
    }

    /// Evaluates height and slopes along the curves, through these orders.
    pub fn series_to(&mut self, orders: SeriesOrders, surface: &dyn SurfaceModel) -> Result<()> {
        self.resize([f64::NAN; 5]);
        let (z, zx, zy) = (&mut self.z, &mut self.zx, &mut self.zy);
        surface.series_to(orders, &self.x, &self.y, GradientSeries { z, zx, zy })
    }
}
