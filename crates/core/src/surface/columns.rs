//! Where batches of slopes and of series are written.

use crate::Series;

/// Where [`SurfaceModel::gradient`](super::SurfaceModel::gradient) writes the height and the slopes. Each slice has one element
/// for each point.
#[derive(Debug)]
pub struct Gradients<'a> {
    /// z in mm.
    pub z: &'a mut [f64],
    /// ∂z/∂x.
    pub zx: &'a mut [f64],
    /// ∂z/∂y.
    pub zy: &'a mut [f64],
}

/// Where [`SurfaceModel::series`](super::SurfaceModel::series) writes the order-4 series of the height and of the slopes along
/// each curve.
#[derive(Debug)]
pub struct GradientSeries<'a> {
    /// z(t).
    pub z: &'a mut [Series],
    /// ∂z/∂x (t).
    pub zx: &'a mut [Series],
    /// ∂z/∂y (t).
    pub zy: &'a mut [Series],
}
