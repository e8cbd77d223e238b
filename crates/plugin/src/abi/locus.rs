//! The host's locus, lent to feed strategies, samplers and spindle strategies.

use abi_stable::sabi_types::RRef;
use turnpath_core::{CentreSeries, Centres, Locus, Radial, Rates, Result, Series, SurfaceModel};

use super::declaration::{declare, lent};
use super::loan::crossing;
use super::reply::Code;
use super::surface::IncomingSurface;

/// The caller may override the meaning of ρ, so it is an argument too. A meaning that this side
/// does not know counts as the contact's.
#[repr(transparent)]
#[derive(abi_stable::StableAbi)]
pub struct AbiRadial(u64);

crossing! {
    [] Radial => AbiRadial, |radial| AbiRadial(radial.code());
    [] AbiRadial => Radial, |radial| Radial::from_code(radial.0).unwrap_or(Radial::Contact);
}

declare! {
    Locus => AbiLocus, AbiLocus_TO, IncomingLocus<'b>;
    properties { radial: Radial }
    methods {
        fn centre(&self, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()>;
        fn series(&self, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()>;
        fn rates(&self, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()>;
        fn residual_feed(
            &self, residual: f64, radial: Radial, theta: &[f64], rho: &[f64], feed: &mut [f64],
        ) -> Result<()>;
    }
    later {}
    kept { surface: IncomingSurface<'b, RRef<'b, ()>> }
    own {
        fn surface(&self) -> &dyn SurfaceModel {
            &self.surface
        }
    }
}
lent!(Locus => AbiLocus_TO, LentLocus);
