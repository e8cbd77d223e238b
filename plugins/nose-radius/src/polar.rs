//! Points and curves of the polar plane in the surface's own x and y, in batches.

use std::ops::Range;

use turnpath_plugin::prelude::*;

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
    /// The ray at `theta`.
    pub fn at(theta: f64) -> Self {
        let (sin, cos) = Scalar::sin_cos(theta);
        Self { sin, cos }
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
    pub fn along(&self, zx: f64, zy: f64) -> f64 {
        zx * self.cos + zy * self.sin
    }

    /// The component of a gradient across the ray: g_θ/ρ.
    pub fn across(&self, zx: f64, zy: f64) -> f64 {
        zy * self.cos - zx * self.sin
    }
}

/// The direction of a ray that turns along a curve.
#[derive(Debug, Clone, Copy)]
pub struct TurningRay {
    sin: Taylor<f64>,
    cos: Taylor<f64>,
}

impl TurningRay {
    /// The ray at θ(t).
    pub fn at(theta: Series) -> Self {
        let (sin, cos) = Taylor(theta).sin_cos();
        Self { sin, cos }
    }

    /// (x(t), y(t)) at the radius ρ(t).
    pub fn point(&self, rho: Taylor<f64>) -> (Series, Series) {
        ((rho * self.cos).0, (rho * self.sin).0)
    }

    /// The component of a gradient along the ray: the first `N` coefficients of g_ρ(t).
    pub fn along<const N: usize>(&self, zx: Series, zy: Series) -> Taylor<f64, N> {
        let [zx, zy, cos, sin] = [zx, zy, self.cos.0, self.sin.0].map(Taylor::from_series);
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

impl Evaluation<Series> {
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
