//! Straight segments.

use turnpath_plugin::prelude::*;

/// Straight lines between the control points, with each axis at constant speed. The controller
/// plays no velocities. The velocity of a node is the rate of the segment after it; at the path's
/// last node it is the rate of the segment before.
///
/// The error of position is of order 2 in the step, h²/8·P″. A bound for cubics does not hold here,
/// so refinement has more to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Linear;

impl Strategy for Linear {
    const NAME: &'static str = "linear";
    const SUMMARY: &'static str = "straight lines between the points, no velocities";
    const SOURCE: &'static str = "linear interpolation, error h²/8·|φ″|";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl VelocitySolver for Linear {
    fn dependence(&self) -> Dependence {
        Dependence::Overlap(1)
    }

    fn segments(&self) -> SegmentShape {
        SegmentShape::Linear
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        rates(nodes.t, nodes.c, out.c);
        rates(nodes.t, nodes.x, out.x);
        rates(nodes.t, nodes.z, out.z);
        Ok(())
    }
}

/// The rates of one axis. A single node is at rest.
fn rates(t: &[f64], p: &[f64], out: &mut [f64]) {
    let mut rate = 0.0;
    for (k, out) in out.iter_mut().enumerate() {
        if let (Some(t), Some(p)) = (t.get(k..k + 2), p.get(k..k + 2)) {
            rate = (p[1] - p[0]) / (t[1] - t[0]);
        }
        *out = rate;
    }
}
