//! Samplers and their plans.

use abi_stable::StableAbi;
use abi_stable::std_types::RVec;
use turnpath_core::{
    Dependence, NodeList, Path, Result, Revolutions, Sampler, SamplerPlan, StrategyError,
};

use super::declaration::{declare, owned};
use super::loan::{Crossing, crossing};
use super::reply::Code;

/// 0 is local, 1 is sequential, and 2 + n is an overlap of n nodes.
impl Code for Dependence {
    fn code(self) -> u64 {
        match self {
            Self::Local => 0,
            Self::Sequential => 1,
            Self::Overlap(nodes) => (nodes as u64).saturating_add(2),
        }
    }

    fn from_code(code: u64) -> Option<Self> {
        Some(match code {
            0 => Self::Local,
            1 => Self::Sequential,
            more => Self::Overlap(usize::try_from(more - 2).unwrap_or(usize::MAX)),
        })
    }
}

/// Start and end of a block, in revolutions.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiBlock(f64, f64);

crossing! {
    [] Revolutions => AbiBlock, |block| AbiBlock(block.start, block.end);
    [] AbiBlock => Revolutions, |block| Revolutions { start: block.0, end: block.1 };
}

/// The columns of a [`NodeList`], of which there may be more one day. They are empty at first; the
/// host appends what the other side placed.
type AbiNodeList = RVec<RVec<f64>>;

pub struct NodeListLender<'a> {
    home: &'a mut NodeList,
    placed: AbiNodeList,
}

impl<'a> Crossing for &'a mut NodeList {
    type Wire<'w> = &'w mut AbiNodeList;
    type Lender = NodeListLender<'a>;

    fn lender(self) -> Result<NodeListLender<'a>> {
        let placed = RVec::new();
        Ok(NodeListLender { home: self, placed })
    }

    fn lend<'l>(lender: &'l mut NodeListLender<'a>) -> &'l mut AbiNodeList {
        &mut lender.placed
    }

    fn settle(lender: NodeListLender<'a>) -> Result<()> {
        let mut columns = lender.placed.into_iter().map(RVec::into_vec);
        let mut column = || columns.next().unwrap_or_default();
        let placed = NodeList::from_columns(column(), column(), column());
        let placed = placed.ok_or_else(|| {
            StrategyError::failed("the columns of the nodes differ in length: n, dz and dz_dc")
        })?;
        lender.home.append(placed);
        Ok(())
    }
}

pub struct NodeListReader<'a> {
    home: &'a mut AbiNodeList,
    placed: NodeList,
}

impl<'a> Crossing for &'a mut AbiNodeList {
    type Wire<'w> = &'w mut NodeList;
    type Lender = NodeListReader<'a>;

    fn lender(self) -> Result<NodeListReader<'a>> {
        let placed = NodeList::default();
        Ok(NodeListReader { home: self, placed })
    }

    fn lend<'l>(lender: &'l mut NodeListReader<'a>) -> &'l mut NodeList {
        &mut lender.placed
    }

    fn settle(lender: NodeListReader<'a>) -> Result<()> {
        let columns = lender.placed.into_columns();
        lender.home.extend(columns.map(RVec::from));
        Ok(())
    }
}

declare! {
    Sampler => AbiSampler, AbiSampler_TO, IncomingSampler<'b>;
    properties { needs_exact_rates: bool = false }
    methods {
        fn plan(&self, path[&]: Path<'_>) -> Result<Box<dyn SamplerPlan>>;
    }
    later {}
}
owned!(Sampler => AbiSampler_TO, IncomingSampler, OwnedSampler);

declare! {
    SamplerPlan => AbiSamplerPlan, AbiSamplerPlan_TO, IncomingSamplerPlan<'b>;
    properties { dependence: Dependence = Dependence::Local }
    methods {
        fn place(&self, path[&]: Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()>;
        fn place_sequential(
            &self,
            path[&]: Path<'_>,
            block: Revolutions,
            state: &mut Vec<f64>,
            nodes: &mut NodeList,
        ) -> Result<()>;
    }
    later {}
}
owned!(SamplerPlan => AbiSamplerPlan_TO, IncomingSamplerPlan, OwnedSamplerPlan);
