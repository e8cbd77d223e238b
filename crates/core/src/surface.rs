//! Surface models: the formula that an author writes, and the batches that the rest uses.

use crate::{Dual, Lanes, Result, Scalar, Series, Taylor};

/// A surface z = f(x, y), written once for every number type. Lengths in mm, z towards the tool.
///
/// The formula stands on its own beyond the aperture too: the tool runs over the rim. Where it
/// has no value it gives NaN.
pub trait Surface: Send + Sync {
    /// The height at (x, y).
    fn sag<S: Scalar>(&self, x: S, y: S) -> S;
}

/// Where [`SurfaceModel::gradient`] writes height and slopes: as many places as there are points.
#[derive(Debug)]
pub struct Gradients<'a> {
    /// z in mm.
    pub z: &'a mut [f64],
    /// ∂z/∂x.
    pub zx: &'a mut [f64],
    /// ∂z/∂y.
    pub zy: &'a mut [f64],
}

/// Where [`SurfaceModel::series`] writes: order-4 series of height and slopes along each curve.
#[derive(Debug)]
pub struct GradientSeries<'a> {
    /// z(t).
    pub z: &'a mut [Series],
    /// ∂z/∂x (t).
    pub zx: &'a mut [Series],
    /// ∂z/∂y (t).
    pub zy: &'a mut [Series],
}

/// A surface as its users hold it: object-safe, in batches. Every [`Surface`] is one.
///
/// All slices of one call have the same length. A place where the surface has no value holds NaN.
pub trait SurfaceModel: Send + Sync {
    /// z at each (x, y).
    fn sag(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()>;
    /// z and its slopes at each (x, y).
    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()>;
    /// The series of z and of its slopes along the curves (x(t), y(t)).
    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()>;
    /// The series of z alone along the curves (x(t), y(t)).
    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()>;
}
