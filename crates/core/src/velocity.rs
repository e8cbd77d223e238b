//! The PVT velocity solver: it chooses the velocities at the nodes for the controller's cubics.

use crate::toolpath::SegmentShape;
use crate::{Dependence, Result};

/// The nodes as a solver gets them. All slices have the same length.
#[derive(Debug, Clone, Copy)]
pub struct Nodes<'a> {
    /// Time, s.
    pub t: &'a [f64],
    /// C angle, unwrapped, rad.
    pub c: &'a [f64],
    /// X of the nose centre, mm.
    pub x: &'a [f64],
    /// Z of the nose centre, mm, with the sampler's offset.
    pub z: &'a [f64],
    /// dC/dt of the locus itself, rad/s.
    pub c_rate: &'a [f64],
    /// dX/dt of the locus itself, mm/s. At a knot of the law it is the mean of both sides.
    pub x_rate: &'a [f64],
    /// ∂Z/∂θ at constant X, mm/rad, with what the sampler's offset adds to it.
    pub z_theta: &'a [f64],
    /// ∂Z/∂X at constant θ.
    pub z_x: &'a [f64],
    /// Whether the first node is the first of the path, not only of this call.
    pub at_start: bool,
    /// Whether the last node is the last of the path, not only of this call.
    pub at_end: bool,
}

impl Nodes<'_> {
    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// dZ/dt of the path itself at node `k`, mm/s: Z_θ·vC + Z_X·vX.
    pub fn z_rate(&self, k: usize) -> f64 {
        self.z_theta[k] * self.c_rate[k] + self.z_x[k] * self.x_rate[k]
    }
}

/// Where a solver writes the velocities. Each slice has one element for each node.
#[derive(Debug)]
pub struct Velocities<'a> {
    /// vC, rad/s.
    pub c: &'a mut [f64],
    /// vX, mm/s.
    pub x: &'a mut [f64],
    /// vZ, mm/s.
    pub z: &'a mut [f64],
}

/// Chooses the velocities at the nodes.
pub trait VelocitySolver: Send + Sync {
    /// How a block depends on its neighbours' nodes. With `Overlap(n)` the host passes n more nodes
    /// on either side (fewer only at the path's ends) and keeps the velocities of the block's own
    /// nodes.
    fn dependence(&self) -> Dependence;

    /// What the controller must play between the control points. The default is cubics.
    fn segments(&self) -> SegmentShape {
        SegmentShape::Cubic
    }

    /// Whether the velocities are those of the path itself: vC and vX of the locus, and vZ as
    /// [`Nodes::z_rate`] gives it. Some samplers need this. The default is false.
    fn gives_exact_rates(&self) -> bool {
        false
    }

    /// Computes the velocities at all nodes of the call.
    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()>;

    /// Does the same as [`solve`](VelocitySolver::solve) for a `Sequential` solver. Except in the
    /// path's last block, the nodes end with the first node of the next block, and the next call
    /// gets this node again. `state` is what the call for the block before left; it is empty at
    /// first.
    fn solve_sequential(
        &self,
        nodes: Nodes<'_>,
        state: &mut Vec<f64>,
        out: Velocities<'_>,
    ) -> Result<()> {
        let _ = state;
        self.solve(nodes, out)
    }
}
