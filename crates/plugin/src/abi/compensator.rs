//! Compensators.

use abi_stable::StableAbi;
use abi_stable::std_types::RSlice;
use turnpath_core::interference::{Extreme, Interference};
use turnpath_core::{
    CentreSeries, Centres, Compensator, Cut, Radial, RadialRange, Rates, Result, Series,
    SurfaceModel, Tool,
};

use super::declaration::{Outgoing, declare, owned};
use super::loan::{Crossing, columns, crossing};
use super::numbers::{TOOL, read_tool, tool_numbers};
use super::reply::{Value, codes};
use super::surface::{IncomingSurface, LentSurface};

codes! {
    Radial { 0 => Radial::Contact, 1 => Radial::Centre }
}

columns! {
    Centres => AbiCentres { x, z, foot } of f64;
    CentreSeries => AbiCentreSeries { x, z } of Series;
    Rates => AbiRates { x_theta, x_rho, z_theta, z_x } of f64;
}

/// Surface and tool, lent for the duration of a call.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiCut<'a> {
    surface: LentSurface<'a>,
    tool: RSlice<'a, f64>,
}

pub struct CutLender<'a> {
    surface: Outgoing<&'a dyn SurfaceModel>,
    tool: [f64; TOOL],
}

impl<'a> Crossing for Cut<'a> {
    type Wire<'w> = AbiCut<'w>;
    type Lender = CutLender<'a>;

    fn lender(self) -> Result<CutLender<'a>> {
        Ok(CutLender {
            surface: Outgoing(self.surface),
            tool: tool_numbers(self.tool),
        })
    }

    fn lend<'l>(lender: &'l mut CutLender<'a>) -> AbiCut<'l> {
        AbiCut {
            surface: lender.surface.lend(),
            tool: lender.tool.as_slice().into(),
        }
    }
}

pub struct CutReader<'a> {
    surface: IncomingSurface<'a, abi_stable::sabi_types::RRef<'a, ()>>,
    tool: Tool,
}

impl<'a> Crossing for AbiCut<'a> {
    type Wire<'w> = Cut<'w>;
    type Lender = CutReader<'a>;

    fn lender(self) -> Result<CutReader<'a>> {
        Ok(CutReader {
            surface: IncomingSurface::new(self.surface)?,
            tool: read_tool(&self.tool),
        })
    }

    fn lend<'l>(lender: &'l mut CutReader<'a>) -> Cut<'l> {
        Cut {
            surface: &lender.surface,
            tool: &lender.tool,
        }
    }
}

/// The inner and the outer end of a range of ρ, mm.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiRange(f64, f64);

crossing! {
    [] RadialRange => AbiRange, |range| AbiRange(range.inner, range.outer);
    [] AbiRange => RadialRange, |range| RadialRange { inner: range.0, outer: range.1 };
}

/// The value, θ and ρ of each extreme, in the order of [`Interference::extremes`].
impl Value for Interference {
    type Wire = [[f64; 3]; 5];

    fn send(self) -> Self::Wire {
        self.extremes()
            .map(|extreme| [extreme.value, extreme.theta, extreme.rho])
    }

    fn receive(extremes: Self::Wire) -> Result<Self> {
        let extreme = |[value, theta, rho]: [f64; 3]| Extreme { value, theta, rho };
        Ok(Self::from_extremes(extremes.map(extreme)))
    }
}

declare! {
    Compensator => AbiCompensator, AbiCompensator_TO, IncomingCompensator<'b>;
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
    later {}
}
owned!(Compensator => AbiCompensator_TO, IncomingCompensator, OwnedCompensator);
