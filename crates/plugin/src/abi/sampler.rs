//! Samplers and their plans.

use abi_stable::std_types::RVec;
use turnpath_core::{
    Dependence, NodeList, Path, Result, Revolutions, Sampler, SamplerPlan, StrategyError,
};

use super::declaration::prelude::*;
use super::loan::lists;

/// The columns of a [`NodeList`], of which there may be more one day. The host appends what the
/// other side places, and refuses a column that it does not know.
type AbiNodeList = RVec<RVec<f64>>;

lists! {
    NodeList => AbiNodeList: |_list| AbiNodeList::new(), |list, placed| {
        let mut columns = placed.into_iter().map(RVec::into_vec);
        let mut column = || columns.next().unwrap_or_default();
        let placed = NodeList::from_columns(column(), column(), column());
        if columns.any(|column| !column.is_empty()) {
            return Err(StrategyError::failed(
                "the nodes have a column that this turnpath does not know; use a newer one",
            ));
        }
        list.append(placed.ok_or_else(|| StrategyError::failed(
            "the columns of the nodes differ in length: n, dz and dz_dc",
        ))?);
    };
    AbiNodeList => NodeList: |_list| NodeList::default(),
        |list, placed| list.extend(placed.into_columns().map(RVec::from));
}

declare! {
    Sampler: Deref AsPtr, Send Sync => AbiSampler, AbiSampler_TO, IncomingSampler<'b>;
    properties { needs_exact_rates: bool = false }
    methods {
        fn plan(&self, path[&]: Path<'_>) -> Result<Box<dyn SamplerPlan>>;
    }
    owned by OwnedSampler
}

declare! {
    SamplerPlan: Deref AsPtr, Send Sync => AbiSamplerPlan, AbiSamplerPlan_TO, IncomingSamplerPlan<'b>;
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
    owned by OwnedSamplerPlan
}
