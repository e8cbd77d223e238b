//! Velocity solvers across the boundary.

use abi_stable::StableAbi;
use abi_stable::sabi_trait;
use abi_stable::std_types::{RBox, RSlice, RSliceMut, RVec};
use turnpath_core::toolpath::SegmentShape;
use turnpath_core::{Dependence, Nodes, Result, Velocities, VelocitySolver};

use super::data::{Answer, answer, result, same_length};
use super::panic_safe_box::PanicSafeBox;
use super::sampler::AbiDependence;

#[repr(C)]
#[derive(StableAbi)]
pub struct AbiNodes<'a> {
    t: RSlice<'a, f64>,
    c: RSlice<'a, f64>,
    x: RSlice<'a, f64>,
    z: RSlice<'a, f64>,
    c_rate: RSlice<'a, f64>,
    x_rate: RSlice<'a, f64>,
    z_theta: RSlice<'a, f64>,
    z_x: RSlice<'a, f64>,
    at_start: bool,
    at_end: bool,
}

impl<'a> From<Nodes<'a>> for AbiNodes<'a> {
    fn from(nodes: Nodes<'a>) -> Self {
        Self {
            t: nodes.t.into(),
            c: nodes.c.into(),
            x: nodes.x.into(),
            z: nodes.z.into(),
            c_rate: nodes.c_rate.into(),
            x_rate: nodes.x_rate.into(),
            z_theta: nodes.z_theta.into(),
            z_x: nodes.z_x.into(),
            at_start: nodes.at_start,
            at_end: nodes.at_end,
        }
    }
}

impl AbiNodes<'_> {
    fn receive(&self) -> Nodes<'_> {
        Nodes {
            t: &self.t,
            c: &self.c,
            x: &self.x,
            z: &self.z,
            c_rate: &self.c_rate,
            x_rate: &self.x_rate,
            z_theta: &self.z_theta,
            z_x: &self.z_x,
            at_start: self.at_start,
            at_end: self.at_end,
        }
    }
}

#[repr(u8)]
#[derive(StableAbi, Clone, Copy)]
pub enum AbiShape {
    Cubic,
    Linear,
}

impl From<SegmentShape> for AbiShape {
    fn from(shape: SegmentShape) -> Self {
        match shape {
            SegmentShape::Cubic => Self::Cubic,
            SegmentShape::Linear => Self::Linear,
        }
    }
}

impl From<AbiShape> for SegmentShape {
    fn from(shape: AbiShape) -> Self {
        match shape {
            AbiShape::Cubic => Self::Cubic,
            AbiShape::Linear => Self::Linear,
        }
    }
}

#[sabi_trait]
pub trait AbiVelocity: Send + Sync {
    fn dependence(&self) -> Answer<AbiDependence>;
    fn segments(&self) -> Answer<AbiShape>;
    fn gives_exact_rates(&self) -> Answer<bool>;
    fn solve(
        &self,
        nodes: AbiNodes<'_>,
        c: RSliceMut<'_, f64>,
        x: RSliceMut<'_, f64>,
        z: RSliceMut<'_, f64>,
    ) -> Answer<()>;
    #[sabi(last_prefix_field)]
    fn solve_sequential(
        &self,
        nodes: AbiNodes<'_>,
        state: &mut RVec<f64>,
        c: RSliceMut<'_, f64>,
        x: RSliceMut<'_, f64>,
        z: RSliceMut<'_, f64>,
    ) -> Answer<()>;
}

/// A velocity solver that belongs to its plugin.
pub type OwnedVelocity = AbiVelocity_TO<'static, RBox<()>>;

/// The author's solver, wrapped for the boundary.
pub struct OutgoingVelocity(pub PanicSafeBox<dyn VelocitySolver>);

impl AbiVelocity for OutgoingVelocity {
    fn dependence(&self) -> Answer<AbiDependence> {
        answer(|| Ok(self.0.dependence().into()))
    }

    fn segments(&self) -> Answer<AbiShape> {
        answer(|| Ok(self.0.segments().into()))
    }

    fn gives_exact_rates(&self) -> Answer<bool> {
        answer(|| Ok(self.0.gives_exact_rates()))
    }

    fn solve(
        &self,
        nodes: AbiNodes<'_>,
        mut c: RSliceMut<'_, f64>,
        mut x: RSliceMut<'_, f64>,
        mut z: RSliceMut<'_, f64>,
    ) -> Answer<()> {
        let out = Velocities {
            c: &mut c,
            x: &mut x,
            z: &mut z,
        };
        answer(|| self.0.solve(nodes.receive(), out))
    }

    fn solve_sequential(
        &self,
        nodes: AbiNodes<'_>,
        state: &mut RVec<f64>,
        mut c: RSliceMut<'_, f64>,
        mut x: RSliceMut<'_, f64>,
        mut z: RSliceMut<'_, f64>,
    ) -> Answer<()> {
        let out = Velocities {
            c: &mut c,
            x: &mut x,
            z: &mut z,
        };
        answer(|| {
            let mut kept = state.to_vec();
            self.0.solve_sequential(nodes.receive(), &mut kept, out)?;
            *state = kept.into();
            Ok(())
        })
    }
}

/// A plugin's solver, wrapped as a solver of the core. The wrapper reads once what the solver says
/// of itself, when it is built.
pub struct IncomingVelocity {
    solver: OwnedVelocity,
    dependence: Dependence,
    shape: SegmentShape,
    gives_exact_rates: bool,
}

impl IncomingVelocity {
    /// Reads the solver's dependence, the shape of its segments and whether its rates are exact,
    /// and wraps the solver.
    pub fn new(solver: OwnedVelocity) -> Result<Self> {
        let dependence = result(solver.dependence())?.into();
        let shape = result(solver.segments())?.into();
        let gives_exact_rates = result(solver.gives_exact_rates())?;
        Ok(Self {
            solver,
            dependence,
            shape,
            gives_exact_rates,
        })
    }
}

fn check(nodes: &Nodes<'_>, out: &Velocities<'_>) -> Result<()> {
    let rates = [
        nodes.c_rate.len(),
        nodes.x_rate.len(),
        nodes.z_theta.len(),
        nodes.z_x.len(),
    ];
    let outputs = [nodes.len(), out.c.len(), out.x.len(), out.z.len()];
    same_length(&[
        nodes.len(),
        nodes.c.len(),
        nodes.x.len(),
        nodes.z.len(),
        rates[0],
    ])?;
    same_length(&rates).and(same_length(&outputs))
}

impl VelocitySolver for IncomingVelocity {
    fn dependence(&self) -> Dependence {
        self.dependence
    }

    fn segments(&self) -> SegmentShape {
        self.shape
    }

    fn gives_exact_rates(&self) -> bool {
        self.gives_exact_rates
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        check(&nodes, &out)?;
        let Velocities { c, x, z } = out;
        result(
            self.solver
                .solve(nodes.into(), c.into(), x.into(), z.into()),
        )
    }

    fn solve_sequential(
        &self,
        nodes: Nodes<'_>,
        state: &mut Vec<f64>,
        out: Velocities<'_>,
    ) -> Result<()> {
        check(&nodes, &out)?;
        let Velocities { c, x, z } = out;
        let mut kept = RVec::from(std::mem::take(state));
        let answer =
            self.solver
                .solve_sequential(nodes.into(), &mut kept, c.into(), x.into(), z.into());
        *state = kept.into();
        result(answer)
    }
}
