//! The three-point method: velocities from each node and its two neighbours.

use turnpath_plugin::prelude::*;

/// The slope, at each node, of the parabola through the node and its neighbours: V_k = (h_k d_{k−1}
/// + h_{k−1} d_k)/(h_{k−1} + h_k) with d_k = ΔP_k/h_k.
///
/// At the path's two ends the velocities are the exact rates. The velocity is off by
/// h_{k−1}h_k/6·P‴, which makes the error of position of order 3 in the step, and no larger at the
/// ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ThreePoint;

impl Strategy for ThreePoint {
    const NAME: &'static str = "three-point";
    const SUMMARY: &'static str = "the slope of the parabola through each point and its neighbours";
    const SOURCE: &'static str = "the three-point method of the paper on triangle rotary, doi:10.1177/0954405416654192, \
        V = (h₊ d₋ + h₋ d₊)/(h₋ + h₊); exact rates at both ends; error of order 3";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl VelocitySolver for ThreePoint {
    fn dependence(&self) -> Dependence {
        Dependence::Overlap(1)
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        slopes(nodes.t, nodes.c, |k| nodes.c_rate[k], out.c);
        slopes(nodes.t, nodes.x, |k| nodes.x_rate[k], out.x);
        slopes(nodes.t, nodes.z, |k| nodes.z_rate(k), out.z);
        Ok(())
    }
}

/// The slopes of one axis. The first and the last node take the exact `rate`.
fn slopes(t: &[f64], p: &[f64], rate: impl Fn(usize) -> f64, out: &mut [f64]) {
    let inner = t.windows(3).zip(p.windows(3)).zip(out.iter_mut().skip(1));
    for ((t, p), slope) in inner {
        let (before, after) = (t[1] - t[0], t[2] - t[1]);
        let (came, goes) = ((p[1] - p[0]) / before, (p[2] - p[1]) / after);
        *slope = (after * came + before * goes) / (before + after);
    }
    let last = out.len().saturating_sub(1);
    for k in [0, last] {
        if let Some(slope) = out.get_mut(k) {
            *slope = rate(k);
        }
    }
}
