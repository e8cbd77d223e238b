//! Surface models: from a plugin to the host, and lent by the host to other strategies.

use abi_stable::StableAbi;
use abi_stable::sabi_trait::TD_Opaque;
use abi_stable::sabi_types::RRef;
use turnpath_core::{
    GradientSeries, Gradients, Result, Series, SeriesOrders, SurfaceData, SurfaceGap, SurfaceModel,
};

use super::declaration::prelude::*;
use super::loan::{composite, crossing};

composite! {
    Gradients => AbiGradients { z: &'a mut [f64], zx: &'a mut [f64], zy: &'a mut [f64] }
    GradientSeries => AbiGradientSeries {
        z: &'a mut [Series], zx: &'a mut [Series], zy: &'a mut [Series],
    }
}

declare! {
    SurfaceModel: Deref AsPtr, Send Sync => AbiSurface, AbiSurface_TO, IncomingSurface<'b>;
    methods {
        fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()>;
        fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()>;
        fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()>;
        fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()>;
    }
    later {
        fn beyond_data(&self, x: &[f64], y: &[f64], distance: &mut [f64]) -> Result<()>
            = { distance.into_mut_slice().fill(0.0); Ok(()) };
        fn data(&self) -> Result<Option<SurfaceData>> = Ok(None);
        fn gap(&self, x: f64, y: f64) -> Result<Option<SurfaceGap>> = Ok(None);
        fn series_to(
            &self,
            orders: SeriesOrders,
            x: &[Series],
            y: &[Series],
            out: GradientSeries<'_>
        ) -> Result<()> = result(self.series(x, y, out));
        fn height_series_to(&self, order: usize, x: &[Series], y: &[Series], z: &mut [Series])
            -> Result<()> = result(self.height_series(x, y, z));
    }
    owned by OwnedSurface
}

/// The orders of heights and of slopes.
#[repr(C)]
#[derive(Clone, Copy, StableAbi)]
pub struct AbiSeriesOrders {
    heights: usize,
    slopes: usize,
}

crossing! {
    [] SeriesOrders => AbiSeriesOrders, AbiSeriesOrders:
        |orders| AbiSeriesOrders { heights: orders.heights, slopes: orders.slopes },
        |orders| *orders;
    [] AbiSeriesOrders => SeriesOrders, SeriesOrders:
        |orders| SeriesOrders { heights: orders.heights, slopes: orders.slopes },
        |orders| *orders;
}

/// The data of a surface cross as text; a formula has none.
impl Returned for Option<SurfaceData> {
    type Wire = RString;

    fn send(self) -> RString {
        text::write(&self)
    }

    fn receive(text: RString) -> Result<Self> {
        text::read(&text, "data of a surface")
    }
}

/// Why a surface has no height crosses as text.
impl Returned for Option<SurfaceGap> {
    type Wire = RString;

    fn send(self) -> RString {
        text::write(&self)
    }

    fn receive(text: RString) -> Result<Self> {
        text::read(&text, "gap of a surface")
    }
}

/// A surface, lent for the duration of a call.
pub type LentSurface<'a> = AbiSurface_TO<'a, RRef<'a, ()>>;

crossing! {
    ['a] &'a dyn SurfaceModel => LentSurface<'w>, AuthorObject<&'a dyn SurfaceModel>:
        |surface| AuthorObject(surface), |surface| AbiSurface_TO::from_ptr(RRef::new(surface), TD_Opaque);
    ['a] LentSurface<'a> => &'w dyn SurfaceModel, IncomingSurface<'a, RRef<'a, ()>>:
        |surface| IncomingSurface::new(surface)?, |surface| surface;
}
