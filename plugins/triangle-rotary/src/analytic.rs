//! The exact rates of the tool locus as velocities.

use turnpath_plugin::prelude::*;

/// vC and vX come from the laws, and vZ = Z_θ·vC + Z_X·vX with that same vX.
///
/// The cubics then have the value and the slope of the true path at every node. The error of
/// position is of order 4 in the step, and no node depends on another. At a knot of the feed vX is
/// the mean of both sides, and vZ follows from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Analytic;

impl Strategy for Analytic {
    const NAME: &'static str = "analytic";
    const SUMMARY: &'static str = "the exact rates of the tool locus";
    const SOURCE: &'static str = "cubic Hermite interpolation with exact slopes, error h⁴/384·|φ⁗|";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl VelocitySolver for Analytic {
    fn dependence(&self) -> Dependence {
        Dependence::Local
    }

    fn gives_exact_rates(&self) -> bool {
        true
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        out.c.copy_from_slice(nodes.c_rate);
        out.x.copy_from_slice(nodes.x_rate);
        for (k, z) in out.z.iter_mut().enumerate() {
            *z = nodes.z_rate(k);
        }
        Ok(())
    }
}
