//! The host's locus, lent to feed strategies and samplers.

use abi_stable::sabi_trait;
use abi_stable::sabi_types::RRef;
use abi_stable::std_types::{RSlice, RSliceMut};
use turnpath_core::{CentreSeries, Centres, Locus, Radial, Rates, Result, Series, SurfaceModel};

use super::data::{Answer, answer, result, same_length};
use super::surface::{IncomingSurface, LentSurface};

#[sabi_trait]
pub trait AbiLocus: Send + Sync {
    fn centre_radial(&self) -> bool;
    fn centre(
        &self,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        x: RSliceMut<'_, f64>,
        z: RSliceMut<'_, f64>,
        foot: RSliceMut<'_, f64>,
    ) -> Answer<()>;
    fn series(
        &self,
        theta: RSlice<'_, Series>,
        rho: RSlice<'_, Series>,
        x: RSliceMut<'_, Series>,
        z: RSliceMut<'_, Series>,
    ) -> Answer<()>;
    fn rates(
        &self,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        x_theta: RSliceMut<'_, f64>,
        x_rho: RSliceMut<'_, f64>,
        z_theta: RSliceMut<'_, f64>,
        z_x: RSliceMut<'_, f64>,
    ) -> Answer<()>;
    #[sabi(last_prefix_field)]
    fn residual_feed(
        &self,
        residual: f64,
        centre_radial: bool,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        feed: RSliceMut<'_, f64>,
    ) -> Answer<()>;
}

/// A locus, lent for the duration of a call.
pub type LentLocus<'a> = AbiLocus_TO<'a, RRef<'a, ()>>;

/// The host's locus, wrapped for the boundary.
pub struct OutgoingLocus<'a>(pub &'a dyn Locus);

impl AbiLocus for OutgoingLocus<'_> {
    fn centre_radial(&self) -> bool {
        self.0.radial() == Radial::Centre
    }

    fn centre(
        &self,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        mut x: RSliceMut<'_, f64>,
        mut z: RSliceMut<'_, f64>,
        mut foot: RSliceMut<'_, f64>,
    ) -> Answer<()> {
        answer(|| {
            self.0.centre(
                &theta,
                &rho,
                Centres {
                    x: &mut x,
                    z: &mut z,
                    foot: &mut foot,
                },
            )
        })
    }

    fn series(
        &self,
        theta: RSlice<'_, Series>,
        rho: RSlice<'_, Series>,
        mut x: RSliceMut<'_, Series>,
        mut z: RSliceMut<'_, Series>,
    ) -> Answer<()> {
        answer(|| {
            self.0.series(
                &theta,
                &rho,
                CentreSeries {
                    x: &mut x,
                    z: &mut z,
                },
            )
        })
    }

    fn rates(
        &self,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        mut x_theta: RSliceMut<'_, f64>,
        mut x_rho: RSliceMut<'_, f64>,
        mut z_theta: RSliceMut<'_, f64>,
        mut z_x: RSliceMut<'_, f64>,
    ) -> Answer<()> {
        let (x_theta, x_rho) = (&mut *x_theta, &mut *x_rho);
        let (z_theta, z_x) = (&mut *z_theta, &mut *z_x);
        answer(|| {
            self.0.rates(
                &theta,
                &rho,
                Rates {
                    x_theta,
                    x_rho,
                    z_theta,
                    z_x,
                },
            )
        })
    }

    fn residual_feed(
        &self,
        residual: f64,
        centre_radial: bool,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        mut feed: RSliceMut<'_, f64>,
    ) -> Answer<()> {
        answer(|| {
            self.0
                .residual_feed(residual, radial(centre_radial), &theta, &rho, &mut feed)
        })
    }
}

fn radial(centre: bool) -> Radial {
    if centre {
        Radial::Centre
    } else {
        Radial::Contact
    }
}

/// Lends a locus to the other side.
pub fn lend<'a>(outgoing: &'a OutgoingLocus<'a>) -> LentLocus<'a> {
    AbiLocus_TO::from_ptr(RRef::new(outgoing), sabi_trait::TD_Opaque)
}

/// The host's locus, wrapped as a locus of the core on the plugin's side.
pub struct IncomingLocus<'a> {
    locus: LentLocus<'a>,
    surface: IncomingSurface<LentSurface<'a>>,
}

impl<'a> IncomingLocus<'a> {
    /// Wraps the two objects that the host lends.
    pub fn new(locus: LentLocus<'a>, surface: LentSurface<'a>) -> Self {
        Self {
            locus,
            surface: IncomingSurface(surface),
        }
    }
}

impl Locus for IncomingLocus<'_> {
    fn surface(&self) -> &dyn SurfaceModel {
        &self.surface
    }

    fn radial(&self) -> Radial {
        radial(self.locus.centre_radial())
    }

    fn centre(&self, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        let Centres { x, z, foot } = out;
        same_length(&[theta.len(), rho.len(), x.len(), z.len(), foot.len()])?;
        result(
            self.locus
                .centre(theta.into(), rho.into(), x.into(), z.into(), foot.into()),
        )
    }

    fn series(&self, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()> {
        let CentreSeries { x, z } = out;
        same_length(&[theta.len(), rho.len(), x.len(), z.len()])?;
        result(
            self.locus
                .series(theta.into(), rho.into(), x.into(), z.into()),
        )
    }

    fn rates(&self, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()> {
        let Rates {
            x_theta,
            x_rho,
            z_theta,
            z_x,
        } = out;
        let outputs = [x_theta.len(), x_rho.len(), z_theta.len(), z_x.len()];
        same_length(&[theta.len(), rho.len()])?;
        same_length(&outputs)?;
        same_length(&[theta.len(), outputs[0]])?;
        let (x_theta, x_rho) = (x_theta.into(), x_rho.into());
        let (z_theta, z_x) = (z_theta.into(), z_x.into());
        result(
            self.locus
                .rates(theta.into(), rho.into(), x_theta, x_rho, z_theta, z_x),
        )
    }

    fn residual_feed(
        &self,
        residual: f64,
        radial: Radial,
        theta: &[f64],
        rho: &[f64],
        feed: &mut [f64],
    ) -> Result<()> {
        same_length(&[theta.len(), rho.len(), feed.len()])?;
        let centre = radial == Radial::Centre;
        result(
            self.locus
                .residual_feed(residual, centre, theta.into(), rho.into(), feed.into()),
        )
    }
}
