//! Compensators across the boundary.

use abi_stable::StableAbi;
use abi_stable::sabi_trait;
use abi_stable::std_types::{RBox, RSlice, RSliceMut};
use turnpath_core::interference::{Extreme, Interference};
use turnpath_core::{
    CentreSeries, Centres, Compensator, Cut, Radial, RadialRange, Rates, Result, Series, Tool,
};

use super::data::{AbiRange, AbiTool, Answer, answer, result, same_length};
use super::panic_safe_box::PanicSafeBox;
use super::surface::{self, IncomingSurface, LentSurface, OutgoingSurface};

/// Surface and tool, lent for the duration of a call.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiCut<'a> {
    surface: LentSurface<'a>,
    tool: AbiTool,
}

fn lend_cut<T>(cut: Cut<'_>, call: impl FnOnce(AbiCut<'_>) -> T) -> T {
    let surface = OutgoingSurface(cut.surface);
    call(AbiCut {
        surface: surface::lend(&surface),
        tool: cut.tool.into(),
    })
}

impl AbiCut<'_> {
    fn receive<T>(self, call: impl FnOnce(Cut<'_>) -> T) -> T {
        let (surface, tool) = (IncomingSurface(self.surface), Tool::from(self.tool));
        call(Cut {
            surface: &surface,
            tool: &tool,
        })
    }
}

/// The properties of a compensator.
#[repr(C)]
#[derive(StableAbi, Clone, Copy)]
pub struct AbiTraits {
    centre_radial: bool,
    compensates_nose: bool,
    cuts_what_fits: bool,
}

/// The value, θ and ρ of each extreme, in the order of [`Interference::extremes`].
type Extremes = [[f64; 3]; 5];

#[sabi_trait]
pub trait AbiCompensator: Send + Sync {
    fn traits(&self) -> Answer<AbiTraits>;
    fn centre(
        &self,
        cut: AbiCut<'_>,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        x: RSliceMut<'_, f64>,
        z: RSliceMut<'_, f64>,
        foot: RSliceMut<'_, f64>,
    ) -> Answer<()>;
    /// Returns false if the compensator has no exact series.
    fn series(
        &self,
        cut: AbiCut<'_>,
        theta: RSlice<'_, Series>,
        rho: RSlice<'_, Series>,
        x: RSliceMut<'_, Series>,
        z: RSliceMut<'_, Series>,
    ) -> Answer<bool>;
    /// Returns false if the compensator has no exact rates.
    fn rates(
        &self,
        cut: AbiCut<'_>,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        x_theta: RSliceMut<'_, f64>,
        x_rho: RSliceMut<'_, f64>,
        z_theta: RSliceMut<'_, f64>,
        z_x: RSliceMut<'_, f64>,
    ) -> Answer<bool>;
    #[sabi(last_prefix_field)]
    fn interference(&self, cut: AbiCut<'_>, region: AbiRange) -> Answer<Extremes>;
}

/// A compensator that belongs to its plugin.
pub type OwnedCompensator = AbiCompensator_TO<'static, RBox<()>>;

/// The author's compensator, wrapped for the boundary.
pub struct OutgoingCompensator(pub PanicSafeBox<dyn Compensator>);

impl AbiCompensator for OutgoingCompensator {
    fn traits(&self) -> Answer<AbiTraits> {
        answer(|| {
            Ok(AbiTraits {
                centre_radial: self.0.radial() == Radial::Centre,
                compensates_nose: self.0.compensates_nose(),
                cuts_what_fits: self.0.cuts_what_fits(),
            })
        })
    }

    fn centre(
        &self,
        cut: AbiCut<'_>,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        mut x: RSliceMut<'_, f64>,
        mut z: RSliceMut<'_, f64>,
        mut foot: RSliceMut<'_, f64>,
    ) -> Answer<()> {
        let out = Centres {
            x: &mut x,
            z: &mut z,
            foot: &mut foot,
        };
        answer(|| cut.receive(|cut| self.0.centre(cut, &theta, &rho, out)))
    }

    fn series(
        &self,
        cut: AbiCut<'_>,
        theta: RSlice<'_, Series>,
        rho: RSlice<'_, Series>,
        mut x: RSliceMut<'_, Series>,
        mut z: RSliceMut<'_, Series>,
    ) -> Answer<bool> {
        let out = CentreSeries {
            x: &mut x,
            z: &mut z,
        };
        answer(|| is_exact(cut.receive(|cut| self.0.exact_series(cut, &theta, &rho, out))))
    }

    fn rates(
        &self,
        cut: AbiCut<'_>,
        theta: RSlice<'_, f64>,
        rho: RSlice<'_, f64>,
        mut x_theta: RSliceMut<'_, f64>,
        mut x_rho: RSliceMut<'_, f64>,
        mut z_theta: RSliceMut<'_, f64>,
        mut z_x: RSliceMut<'_, f64>,
    ) -> Answer<bool> {
        let out = Rates {
            x_theta: &mut x_theta,
            x_rho: &mut x_rho,
            z_theta: &mut z_theta,
            z_x: &mut z_x,
        };
        answer(|| is_exact(cut.receive(|cut| self.0.exact_rates(cut, &theta, &rho, out))))
    }

    fn interference(&self, cut: AbiCut<'_>, region: AbiRange) -> Answer<Extremes> {
        answer(|| {
            let interference = cut.receive(|cut| self.0.interference(cut, region.into()))?;
            let flat = |extreme: Extreme| [extreme.value, extreme.theta, extreme.rho];
            Ok(interference.extremes().map(flat))
        })
    }
}

fn is_exact(answer: Option<Result<()>>) -> Result<bool> {
    answer.map_or(Ok(false), |done| done.map(|()| true))
}

fn optional(answer: Result<bool>) -> Option<Result<()>> {
    match answer {
        Ok(true) => Some(Ok(())),
        Ok(false) => None,
        Err(error) => Some(Err(error)),
    }
}

/// A plugin's compensator, wrapped as a compensator of the core.
pub struct IncomingCompensator {
    compensator: OwnedCompensator,
    traits: AbiTraits,
}

impl IncomingCompensator {
    /// Reads the compensator's properties and wraps it.
    pub fn new(compensator: OwnedCompensator) -> Result<Self> {
        let traits = result(compensator.traits())?;
        Ok(Self {
            compensator,
            traits,
        })
    }
}

impl Compensator for IncomingCompensator {
    fn radial(&self) -> Radial {
        if self.traits.centre_radial {
            Radial::Centre
        } else {
            Radial::Contact
        }
    }

    fn compensates_nose(&self) -> bool {
        self.traits.compensates_nose
    }

    fn cuts_what_fits(&self) -> bool {
        self.traits.cuts_what_fits
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        let Centres { x, z, foot } = out;
        same_length(&[theta.len(), rho.len(), x.len(), z.len(), foot.len()])?;
        result(lend_cut(cut, |cut| {
            self.compensator.centre(
                cut,
                theta.into(),
                rho.into(),
                x.into(),
                z.into(),
                foot.into(),
            )
        }))
    }

    fn exact_series(
        &self,
        cut: Cut<'_>,
        theta: &[Series],
        rho: &[Series],
        out: CentreSeries<'_>,
    ) -> Option<Result<()>> {
        let CentreSeries { x, z } = out;
        if let Err(error) = same_length(&[theta.len(), rho.len(), x.len(), z.len()]) {
            return Some(Err(error));
        }
        optional(result(lend_cut(cut, |cut| {
            self.compensator
                .series(cut, theta.into(), rho.into(), x.into(), z.into())
        })))
    }

    fn exact_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        out: Rates<'_>,
    ) -> Option<Result<()>> {
        let Rates {
            x_theta,
            x_rho,
            z_theta,
            z_x,
        } = out;
        let outputs = [
            theta.len(),
            x_theta.len(),
            x_rho.len(),
            z_theta.len(),
            z_x.len(),
        ];
        if let Err(error) = same_length(&outputs).and(same_length(&[theta.len(), rho.len()])) {
            return Some(Err(error));
        }
        let (x_theta, x_rho) = (x_theta.into(), x_rho.into());
        let (z_theta, z_x) = (z_theta.into(), z_x.into());
        optional(result(lend_cut(cut, |cut| {
            let (theta, rho) = (theta.into(), rho.into());
            self.compensator
                .rates(cut, theta, rho, x_theta, x_rho, z_theta, z_x)
        })))
    }

    fn interference(&self, cut: Cut<'_>, region: RadialRange) -> Result<Interference> {
        let interference = result(lend_cut(cut, |cut| {
            self.compensator.interference(cut, region.into())
        }))?;
        let extreme = |[value, theta, rho]: [f64; 3]| Extreme { value, theta, rho };
        Ok(Interference::from_extremes(interference.map(extreme)))
    }
}
