//! The path that samplers and spindle strategies look at.

use crate::locus::Locus;
use crate::{Result, Series, SpindleLaw, SpiralLaw, Task, angle, per_radian};

/// The path to sample: task, locus, spiral law and spindle law.
///
/// While the host asks for one block, `law` and `spindle` may be only the parts around the block.
#[derive(Clone, Copy)]
pub struct Path<'a> {
    /// Part, tool, tolerance, range of ρ, direction, largest spindle speed.
    pub task: &'a Task,
    /// The locus of the nose centre.
    pub locus: &'a dyn Locus,
    /// The spiral law ρ = ℓ(N).
    pub law: &'a SpiralLaw,
    /// The spindle law t(N).
    pub spindle: &'a SpindleLaw,
}

impl Path<'_> {
    /// ρ after `n` revolutions, mm.
    pub fn radius_at(&self, n: f64) -> f64 {
        self.law.value(n)
    }

    /// The order-4 series in θ of the nose centre's (X, Z) along the true spiral at each of `n`
    /// revolutions. At a knot of the law the series are those of the piece that begins there.
    pub fn series_at(&self, n: &[f64], x: &mut [Series], z: &mut [Series]) -> Result<()> {
        let theta: Vec<Series> = n.iter().map(|n| [angle(*n), 1.0, 0.0, 0.0, 0.0]).collect();
        let rho: Vec<Series> = n.iter().map(|n| per_radian(self.law.series(*n))).collect();
        self.locus
            .series(&theta, &rho, crate::CentreSeries { x, z })
    }
}
