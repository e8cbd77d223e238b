//! Places and curves of the polar plane in the surface's own x and y, in batches.

use std::ops::Range;

use turnpath_plugin::prelude::*;

/// Points that go through a surface together: their intermediate results stay in the cache.
const BATCH: usize = 256;

/// The ranges of at most [`BATCH`] points that make up `count`.
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
    pub fn place(&self, rho: f64) -> (f64, f64) {
        (rho * self.cos, rho * self.sin)
    }

    /// The straight curve (x(t), y(t)) along the ray at unit speed, through `rho` at t = 0.
    pub fn line(&self, rho: f64) -> (Series, Series) {
        let along = |unit: f64| [rho * unit, unit, 0.0, 0.0, 0.0];
        (along(self.cos), along(self.sin))
    }

    /// The part of a gradient along the ray: g_ρ.
    pub fn along(&self, zx: f64, zy: f64) -> f64 {
        zx * self.cos + zy * self.sin
    }

    /// The part of a gradient across the ray: g_θ/ρ.
    pub fn across(&self, zx: f64, zy: f64) -> f64 {
        zy * self.cos - zx * self.sin
    }
}

/// The ray's direction along a curve.
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
    pub fn place(&self, rho: Taylor<f64>) -> (Series, Series) {
        ((rho * self.cos).0, (rho * self.sin).0)
    }

    /// The part of a gradient along the ray: g_ρ(t).
    pub fn along(&self, zx: Series, zy: Series) -> Taylor<f64> {
        Taylor(zx) * self.cos + Taylor(zy) * self.sin
    }
}

/// Places or curves (x, y), and what the surface says of them.
#[derive(Debug, Default)]
pub struct Room<T> {
    x: Vec<T>,
    y: Vec<T>,
    /// Height.
    pub z: Vec<T>,
    /// ∂z/∂x.
    pub zx: Vec<T>,
    /// ∂z/∂y.
    pub zy: Vec<T>,
}

impl<T: Copy> Room<T> {
    /// Takes places or curves in place of those before.
    pub fn hold(&mut self, places: impl Iterator<Item = (T, T)>) {
        self.x.clear();
        self.y.clear();
        for (x, y) in places {
            self.x.push(x);
            self.y.push(y);
        }
    }

    fn make_room(&mut self, blank: T) {
        for places in [&mut self.z, &mut self.zx, &mut self.zy] {
            places.resize(self.x.len(), blank);
        }
    }
}

impl Room<f64> {
    /// Height and slopes at the places held.
    pub fn gradient(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        self.make_room(f64::NAN);
        let (z, zx, zy) = (&mut self.z, &mut self.zx, &mut self.zy);
        surface.gradient(&self.x, &self.y, Gradients { z, zx, zy })
    }
}

impl Room<Series> {
    /// Height and slopes along the curves held.
    pub fn series(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        self.make_room([f64::NAN; 5]);
        let (z, zx, zy) = (&mut self.z, &mut self.zx, &mut self.zy);
        surface.series(&self.x, &self.y, GradientSeries { z, zx, zy })
    }
}
