//! The sampler: it decides where the control points lie along the spiral.

use serde::{Deserialize, Serialize};

use crate::{NodeList, Path, Result, Revolutions};

/// How a strategy's answer for one block depends on the rest of the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Dependence {
    /// The answer depends on the block alone.
    Local,
    /// The answer also depends on this many nodes before and after the block. The velocities of a node depend on so
    /// many nodes on either side of it, and on no others of its block. So refinement does not play a segment again
    /// if both of its ends lie farther from every new node.
    Overlap(usize),
    /// The answer depends on everything before the block. The host processes the blocks in order
    /// and passes a small state from one to the next.
    Sequential,
}

/// Places the control points along the spiral.
///
/// A sampler that needs nothing of the whole path implements [`SamplerPlan`] and `Clone`. It is
/// then a sampler whose plan is a copy of itself.
pub trait Sampler: Send + Sync {
    /// Looks at the whole path once, before any block. The plan that comes back places the nodes
    /// of each block.
    fn plan(&self, path: &Path<'_>) -> Result<Box<dyn SamplerPlan>>;

    /// Whether the nodes hold the tolerance only with the exact rates of the path, because they use
    /// the error of a cubic on both sides or lie off the locus. The host then refuses a velocity
    /// solver that does not give exact rates
    /// ([`VelocitySolver::gives_exact_rates`](crate::VelocitySolver::gives_exact_rates)). The
    /// default is false.
    fn needs_exact_rates(&self) -> bool {
        false
    }
}

impl<T: SamplerPlan + Clone + 'static> Sampler for T {
    fn plan(&self, _: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        Ok(Box::new(self.clone()))
    }
}

/// The nodes of one path, block by block.
pub trait SamplerPlan: Send + Sync {
    /// Appends the nodes of `block`, in increasing order, from block.start (included) to block.end
    /// (excluded). The host adds the first and the last point of the path. In `path`, the laws may
    /// be only their parts around the block. A plan must not wait for other work of the host's threads:
    /// such work may itself wait for this block.
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()>;

    /// How a block depends on the others. The default is `Local`.
    fn dependence(&self) -> Dependence {
        Dependence::Local
    }

    /// Does the same as [`place`](SamplerPlan::place) for a `Sequential` plan. `state` is what the
    /// call for the block before left; it is empty at first.
    fn place_sequential(
        &self,
        path: &Path<'_>,
        block: Revolutions,
        state: &mut Vec<f64>,
        nodes: &mut NodeList,
    ) -> Result<()> {
        let _ = state;
        self.place(path, block, nodes)
    }
}
