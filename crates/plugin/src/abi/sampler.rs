//! Samplers across the boundary.

use abi_stable::StableAbi;
use abi_stable::sabi_trait;
use abi_stable::std_types::{RBox, RVec};
use turnpath_core::{
    Dependence, NodeList, Path, Result, Revolutions, Sampler, SamplerPlan, StrategyError,
};

use super::data::{Answer, answer, result};
use super::panic_safe_box::PanicSafeBox;
use super::path::{AbiPath, lend_path};

/// How a strategy depends on its neighbours. `overlap` has a meaning for `kind` 1 alone.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiDependence {
    kind: u8,
    overlap: u64,
}

impl From<Dependence> for AbiDependence {
    fn from(dependence: Dependence) -> Self {
        match dependence {
            Dependence::Local => Self {
                kind: 0,
                overlap: 0,
            },
            Dependence::Overlap(nodes) => Self {
                kind: 1,
                overlap: nodes as u64,
            },
            Dependence::Sequential => Self {
                kind: 2,
                overlap: 0,
            },
        }
    }
}

impl From<AbiDependence> for Dependence {
    fn from(dependence: AbiDependence) -> Self {
        match dependence.kind {
            0 => Self::Local,
            1 => Self::Overlap(usize::try_from(dependence.overlap).unwrap_or(usize::MAX)),
            _ => Self::Sequential,
        }
    }
}

/// Start and end of a block, in revolutions.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiBlock {
    start: f64,
    end: f64,
}

impl From<Revolutions> for AbiBlock {
    fn from(Revolutions { start, end }: Revolutions) -> Self {
        Self { start, end }
    }
}

impl From<AbiBlock> for Revolutions {
    fn from(AbiBlock { start, end }: AbiBlock) -> Self {
        Self { start, end }
    }
}

/// The columns of a [`NodeList`].
#[repr(C)]
#[derive(StableAbi, Default)]
pub struct AbiNodeList {
    n: RVec<f64>,
    dz: RVec<f64>,
    dz_dc: RVec<f64>,
}

impl From<NodeList> for AbiNodeList {
    fn from(nodes: NodeList) -> Self {
        let [n, dz, dz_dc] = nodes.into_columns().map(RVec::from);
        Self { n, dz, dz_dc }
    }
}

/// Appends what a plugin placed.
fn append(nodes: &mut NodeList, placed: AbiNodeList) -> Result<()> {
    let AbiNodeList { n, dz, dz_dc } = placed;
    let placed = NodeList::from_columns(n.into(), dz.into(), dz_dc.into());
    let placed = placed.ok_or_else(|| {
        StrategyError::failed("the columns of the nodes differ in length: n, dz and dz_dc")
    })?;
    nodes.append(placed);
    Ok(())
}

#[sabi_trait]
pub trait AbiSampler: Send + Sync {
    fn needs_exact_rates(&self) -> Answer<bool>;
    #[sabi(last_prefix_field)]
    fn plan(&self, path: AbiPath<'_>) -> Answer<OwnedSamplerPlan>;
}

#[sabi_trait]
pub trait AbiSamplerPlan: Send + Sync {
    fn dependence(&self) -> Answer<AbiDependence>;
    fn place(&self, path: AbiPath<'_>, block: AbiBlock) -> Answer<AbiNodeList>;
    #[sabi(last_prefix_field)]
    fn place_sequential(
        &self,
        path: AbiPath<'_>,
        block: AbiBlock,
        state: &mut RVec<f64>,
    ) -> Answer<AbiNodeList>;
}

/// A sampler that belongs to its plugin.
pub type OwnedSampler = AbiSampler_TO<'static, RBox<()>>;
/// A plan of a sampler that belongs to its plugin.
pub type OwnedSamplerPlan = AbiSamplerPlan_TO<'static, RBox<()>>;

/// The author's sampler, wrapped for the boundary.
pub struct OutgoingSampler(pub PanicSafeBox<dyn Sampler>);

impl AbiSampler for OutgoingSampler {
    fn needs_exact_rates(&self) -> Answer<bool> {
        answer(|| Ok(self.0.needs_exact_rates()))
    }

    fn plan(&self, path: AbiPath<'_>) -> Answer<OwnedSamplerPlan> {
        answer(|| {
            let plan = path.receive(|path| self.0.plan(path))?;
            Ok(AbiSamplerPlan_TO::from_value(
                OutgoingSamplerPlan(PanicSafeBox::new(plan)),
                sabi_trait::TD_Opaque,
            ))
        })
    }
}

struct OutgoingSamplerPlan(PanicSafeBox<dyn SamplerPlan>);

impl AbiSamplerPlan for OutgoingSamplerPlan {
    fn dependence(&self) -> Answer<AbiDependence> {
        answer(|| Ok(self.0.dependence().into()))
    }

    fn place(&self, path: AbiPath<'_>, block: AbiBlock) -> Answer<AbiNodeList> {
        answer(|| {
            let mut placed = NodeList::default();
            path.receive(|path| self.0.place(path, block.into(), &mut placed))?;
            Ok(placed.into())
        })
    }

    fn place_sequential(
        &self,
        path: AbiPath<'_>,
        block: AbiBlock,
        state: &mut RVec<f64>,
    ) -> Answer<AbiNodeList> {
        answer(|| {
            let (mut kept, mut placed) = (state.to_vec(), NodeList::default());
            path.receive(|path| {
                (self.0).place_sequential(path, block.into(), &mut kept, &mut placed)
            })?;
            *state = kept.into();
            Ok(placed.into())
        })
    }
}

/// A plugin's sampler, wrapped as a sampler of the core. The wrapper reads once whether the sampler
/// needs exact rates, when it is built.
pub struct IncomingSampler {
    sampler: OwnedSampler,
    needs_exact_rates: bool,
}

impl IncomingSampler {
    /// Asks the sampler whether it needs exact rates, and wraps it.
    pub fn new(sampler: OwnedSampler) -> Result<Self> {
        let needs_exact_rates = result(sampler.needs_exact_rates())?;
        Ok(Self {
            sampler,
            needs_exact_rates,
        })
    }
}

impl Sampler for IncomingSampler {
    fn plan(&self, path: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        let plan = result(lend_path(path, |path| self.sampler.plan(path)))?;
        Ok(Box::new(IncomingSamplerPlan::new(plan)?))
    }

    fn needs_exact_rates(&self) -> bool {
        self.needs_exact_rates
    }
}

/// A plugin's plan, wrapped as a plan of the core. The wrapper reads the dependence once, when it
/// is built.
struct IncomingSamplerPlan {
    plan: OwnedSamplerPlan,
    dependence: Dependence,
}

impl IncomingSamplerPlan {
    fn new(plan: OwnedSamplerPlan) -> Result<Self> {
        let dependence = result(plan.dependence())?.into();
        Ok(Self { plan, dependence })
    }
}

impl SamplerPlan for IncomingSamplerPlan {
    fn dependence(&self) -> Dependence {
        self.dependence
    }

    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        let placed = lend_path(path, |path| self.plan.place(path, block.into()));
        append(nodes, result(placed)?)
    }

    fn place_sequential(
        &self,
        path: &Path<'_>,
        block: Revolutions,
        state: &mut Vec<f64>,
        nodes: &mut NodeList,
    ) -> Result<()> {
        let mut kept = RVec::from(std::mem::take(state));
        let placed = lend_path(path, |path| {
            (self.plan).place_sequential(path, block.into(), &mut kept)
        });
        *state = kept.into();
        append(nodes, result(placed)?)
    }
}
