//! Surface models: from a plugin to the host, and lent by the host to other strategies.

use turnpath_core::{GradientSeries, Gradients, Result, Series, SurfaceModel};

use super::declaration::{declare, lent, owned};
use super::loan::columns;

columns! {
    Gradients => AbiGradients { z, zx, zy } of f64;
    GradientSeries => AbiGradientSeries { z, zx, zy } of Series;
}

declare! {
    SurfaceModel => AbiSurface, AbiSurface_TO, IncomingSurface<'b>;
    properties {}
    methods {
        fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()>;
        fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()>;
        fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()>;
        fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()>;
    }
    later {}
}
owned!(SurfaceModel => AbiSurface_TO, IncomingSurface, OwnedSurface);
lent!(SurfaceModel => AbiSurface_TO, LentSurface);
