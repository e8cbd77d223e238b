//! Surface models across the boundary, in both directions: from a plugin to the host, and from the
//! host to a compensator or a feed strategy.

use std::ops::Deref;

use abi_stable::sabi_trait;
use abi_stable::sabi_types::RRef;
use abi_stable::std_types::{RBox, RSlice, RSliceMut};
use turnpath_core::{GradientSeries, Gradients, Result, Series, SurfaceModel};

use super::data::{Answer, answer, result, same_length};

#[sabi_trait]
pub trait AbiSurface: Send + Sync {
    fn heights(&self, x: RSlice<'_, f64>, y: RSlice<'_, f64>, z: RSliceMut<'_, f64>) -> Answer<()>;
    fn gradient(
        &self,
        x: RSlice<'_, f64>,
        y: RSlice<'_, f64>,
        z: RSliceMut<'_, f64>,
        zx: RSliceMut<'_, f64>,
        zy: RSliceMut<'_, f64>,
    ) -> Answer<()>;
    fn series(
        &self,
        x: RSlice<'_, Series>,
        y: RSlice<'_, Series>,
        z: RSliceMut<'_, Series>,
        zx: RSliceMut<'_, Series>,
        zy: RSliceMut<'_, Series>,
    ) -> Answer<()>;
    #[sabi(last_prefix_field)]
    fn height_series(
        &self,
        x: RSlice<'_, Series>,
        y: RSlice<'_, Series>,
        z: RSliceMut<'_, Series>,
    ) -> Answer<()>;
}

/// A surface that belongs to its plugin.
pub type OwnedSurface = AbiSurface_TO<'static, RBox<()>>;
/// A surface, lent for the duration of a call.
pub type LentSurface<'a> = AbiSurface_TO<'a, RRef<'a, ()>>;

/// A surface of the core, wrapped for the boundary.
pub struct OutgoingSurface<P>(pub P);

impl<'a, P: Deref<Target = dyn SurfaceModel + 'a> + Send + Sync> AbiSurface for OutgoingSurface<P> {
    fn heights(
        &self,
        x: RSlice<'_, f64>,
        y: RSlice<'_, f64>,
        mut z: RSliceMut<'_, f64>,
    ) -> Answer<()> {
        answer(|| self.0.heights(&x, &y, &mut z))
    }

    fn gradient(
        &self,
        x: RSlice<'_, f64>,
        y: RSlice<'_, f64>,
        mut z: RSliceMut<'_, f64>,
        mut zx: RSliceMut<'_, f64>,
        mut zy: RSliceMut<'_, f64>,
    ) -> Answer<()> {
        answer(|| {
            self.0.gradient(
                &x,
                &y,
                Gradients {
                    z: &mut z,
                    zx: &mut zx,
                    zy: &mut zy,
                },
            )
        })
    }

    fn series(
        &self,
        x: RSlice<'_, Series>,
        y: RSlice<'_, Series>,
        mut z: RSliceMut<'_, Series>,
        mut zx: RSliceMut<'_, Series>,
        mut zy: RSliceMut<'_, Series>,
    ) -> Answer<()> {
        answer(|| {
            self.0.series(
                &x,
                &y,
                GradientSeries {
                    z: &mut z,
                    zx: &mut zx,
                    zy: &mut zy,
                },
            )
        })
    }

    fn height_series(
        &self,
        x: RSlice<'_, Series>,
        y: RSlice<'_, Series>,
        mut z: RSliceMut<'_, Series>,
    ) -> Answer<()> {
        answer(|| self.0.height_series(&x, &y, &mut z))
    }
}

/// Lends a surface to the other side.
pub fn lend<'a>(outgoing: &'a OutgoingSurface<&'a dyn SurfaceModel>) -> LentSurface<'a> {
    AbiSurface_TO::from_ptr(RRef::new(outgoing), sabi_trait::TD_Opaque)
}

/// A surface from the other side, wrapped as a surface of the core.
pub struct IncomingSurface<T>(pub T);

macro_rules! incoming {
    ($object:ty, [$($lifetime:lifetime)?]) => {
        impl$(<$lifetime>)? SurfaceModel for IncomingSurface<$object> {
            fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
                same_length(&[x.len(), y.len(), z.len()])?;
                result(self.0.heights(x.into(), y.into(), z.into()))
            }

            fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
                let Gradients { z, zx, zy } = out;
                same_length(&[x.len(), y.len(), z.len(), zx.len(), zy.len()])?;
                result(self.0.gradient(x.into(), y.into(), z.into(), zx.into(), zy.into()))
            }

            fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
                let GradientSeries { z, zx, zy } = out;
                same_length(&[x.len(), y.len(), z.len(), zx.len(), zy.len()])?;
                result(self.0.series(x.into(), y.into(), z.into(), zx.into(), zy.into()))
            }

            fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
                same_length(&[x.len(), y.len(), z.len()])?;
                result(self.0.height_series(x.into(), y.into(), z.into()))
            }
        }
    };
}

incoming!(OwnedSurface, []);
incoming!(LentSurface<'a>, ['a]);
