//! The PVT velocity solver: the velocities that the controller's cubics take at the nodes.

use crate::toolpath::SegmentShape;
use crate::{Dependence, Result};

/// What a solver gets of the nodes; all slices have the same length.
#[derive(Debug, Clone, Copy)]
pub struct Nodes<'a> {
    /// Time, s.
    pub t: &'a [f64],
    /// C angle, unwrapped, rad.
    pub c: &'a [f64],
    /// X of the nose centre, mm.
    pub x: &'a [f64],
    /// Z of the nose centre, mm.
    pub z: &'a [f64],
    /// The locus' own dC/dt, rad/s.
    pub c_rate: &'a [f64],
    /// The locus' own dX/dt, mm/s; at a knot of the law the mean of both sides.
    pub x_rate: &'a [f64],
    /// ∂Z/∂θ at constant X, mm/rad.
    pub z_theta: &'a [f64],
    /// ∂Z/∂X at constant θ.
    pub z_x: &'a [f64],
    /// Whether the first node is the path's first, not just the first one handed over.
    pub at_start: bool,
    /// Whether the last node is the path's last, not just the last one handed over.
    pub at_end: bool,
}

impl Nodes<'_> {
    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// The locus' own dZ/dt at node `k`, mm/s: Z_θ·vC + Z_X·vX.
    pub fn z_rate(&self, k: usize) -> f64 {
        self.z_theta[k] * self.c_rate[k] + self.z_x[k] * self.x_rate[k]
    }
}

/// Where a solver writes its velocities; as many places as nodes.
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
    /// How a block depends on its neighbours' nodes. With `Overlap(n)` the host hands over n nodes
    /// more on either side (fewer only at the path's ends) and keeps the block's own.
    fn dependence(&self) -> Dependence;

    /// What is to be played between the control points: cubics, unless it says otherwise.
    fn segments(&self) -> SegmentShape {
        SegmentShape::Cubic
    }

    /// The velocities at all nodes handed over.
    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()>;

    /// The same for a `Sequential` solver. The nodes end with the next block's first one (but for
    /// the path's last block), which the next call gets again; `state` is what the call for the
    /// block before left, empty at first.
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
