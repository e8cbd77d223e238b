//! Compensators.

use abi_stable::std_types::ROption;
use turnpath_core::interference::{Extreme, Interference};
use turnpath_core::{
    CentreSeries, Centres, Compensator, Cut, Radial, RadialRange, Rates, Result, Series,
    SurfaceModel, Tool,
};

use super::declaration::prelude::*;
use super::loan::composite;
use super::reply::Returned;

composite! {
    Centres => AbiCentres { x: &'a mut [f64], z: &'a mut [f64], foot: &'a mut [f64] }
    CentreSeries => AbiCentreSeries { x: &'a mut [Series], z: &'a mut [Series] }
    Rates => AbiRates {
        x_theta: &'a mut [f64], x_rho: &'a mut [f64], z_theta: &'a mut [f64], z_x: &'a mut [f64],
    }
    Cut => AbiCut { surface: &'a dyn SurfaceModel, tool: &'a Tool }
}

/// The value, θ and ρ of each extreme, in the order of [`Interference::extremes`].
impl Returned for Interference {
    type Wire = [[f64; 3]; 5];

    fn send(self) -> Self::Wire {
        let numbers = |one: Extreme| [one.value, one.theta, one.rho];
        self.extremes().map(numbers)
    }

    fn receive(extremes: Self::Wire) -> Result<Self> {
        let extreme = |[value, theta, rho]: [f64; 3]| Extreme { value, theta, rho };
        Ok(Self::from_extremes(extremes.map(extreme)))
    }
}

/// An extreme that may be missing crosses as at most one.
impl Returned for Option<Extreme> {
    type Wire = ROption<[f64; 3]>;

    fn send(self) -> Self::Wire {
        self.map(|one| [one.value, one.theta, one.rho]).into()
    }

    fn receive(extreme: Self::Wire) -> Result<Self> {
        let one = extreme.into_option();
        Ok(one.map(|[value, theta, rho]| Extreme { value, theta, rho }))
    }
}

declare! {
    Compensator: Deref AsPtr, Send Sync => AbiCompensator, AbiCompensator_TO, IncomingCompensator<'b>;
    properties {
        radial: Radial,
        compensates_nose: bool = true,
        cuts_what_fits: bool = false,
    }
    methods {
        fn centre(
            &self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>,
        ) -> Result<()>;
        fn exact_series(
            &self, cut: Cut<'_>, theta: &[Series], rho: &[Series], out: CentreSeries<'_>,
        ) -> Option<Result<()>>;
        fn exact_rates(
            &self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Rates<'_>,
        ) -> Option<Result<()>>;
        fn interference(&self, cut: Cut<'_>, region: RadialRange) -> Result<Interference>;
    }
    later {
        fn centre_and_rates(
            &self, cut: Cut<'_>, theta: &[f64], rho: &[f64], centres: Centres<'_>, rates: Rates<'_>
        ) -> Option<Result<()>> = None;
        fn curvature_outside(&self, cut: Cut<'_>, part: RadialRange, region: RadialRange)
            -> Result<Option<Extreme>> = Ok(None);
    }
    owned by OwnedCompensator
}
