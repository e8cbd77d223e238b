//! The host's locus, lent to feed strategies, samplers and spindle strategies.

use abi_stable::StableAbi;
use abi_stable::sabi_trait::TD_Opaque;
use abi_stable::sabi_types::RRef;
use turnpath_core::{CentreSeries, Centres, Locus, Radial, Rates, Result, Series, SurfaceModel};

use super::declaration::prelude::*;
use super::loan::{Crossing, crossing};
use super::surface::LentSurface;

declare! {
    Locus: Deref AsPtr, Send Sync => AbiLocus, AbiLocus_TO, IncomingLocus<'b>;
    properties { radial: Radial }
    methods {
        fn centre(&self, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()>;
        fn series(&self, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()>;
        fn rates(&self, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()>;
        fn residual_feed(
            &self, residual: f64, radial: Radial, theta: &[f64], rho: &[f64], feed: &mut [f64],
        ) -> Result<()>;
    }
    later {
        fn least_residual_feeds(&self, residual: f64, rho: &[f64], least: &mut [f64])
            -> Option<Result<()>> = None;
    }
    kept { surface: <LentSurface<'b> as Crossing>::Lender } own {
        fn surface(&self) -> &dyn SurfaceModel {
            &self.surface
        }
    }
}

/// A locus with its surface, lent for the duration of a call.
#[repr(C)]
#[derive(StableAbi)]
pub struct LentLocus<'a> {
    locus: AbiLocus_TO<'a, RRef<'a, ()>>,
    surface: LentSurface<'a>,
}

crossing! {
    ['a] &'a dyn Locus => LentLocus<'w>,
    (AuthorObject<&'a dyn Locus>, AuthorObject<&'a dyn SurfaceModel>):
        |locus, lengths| (AuthorObject(locus), locus.surface().lender(lengths)?),
        |lender| LentLocus {
            locus: AbiLocus_TO::from_ptr(RRef::new(&lender.0), TD_Opaque),
            surface: <&dyn SurfaceModel>::lend(&mut lender.1),
        };
    ['a] LentLocus<'a> => &'w dyn Locus, IncomingLocus<'a, RRef<'a, ()>>:
        |lent, lengths| IncomingLocus::new(lent.locus, lent.surface.lender(lengths)?)?,
        |locus| locus;
}
