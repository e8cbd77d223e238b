//! The rate of the polynomial through five neighbouring nodes, whatever their distances.
//!
//! Lagrange's formula: p′(t_k) = Σ_j p_j · l_j′(t_k). It is exact for motions of degree 4, so that the
//! velocities have an error of order 4 in the step.
#![forbid(unsafe_code)]
use turnpath_plugin::prelude::*;

/// Nodes of the polynomial.
const STENCIL: usize = 5;
/// Nodes on either side of a node.
const SIDE: usize = STENCIL / 2;

struct FivePoints;

impl Strategy for FivePoints {
    const NAME: &'static str = "five-points";
    const SUMMARY: &'static str = "the rate of the polynomial through five neighbouring nodes";
    const SOURCE: &'static str = "Lagrange's interpolation on uneven nodes, exact for degree 4";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl VelocitySolver for FivePoints {
    /// The host passes two more nodes on either side of a block.
    fn dependence(&self) -> Dependence {
        Dependence::Overlap(SIDE)
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let most = nodes.len().min(STENCIL);
        for k in 0..nodes.len() {
            // The path's ends have neighbours on one side alone.
            let first = k.saturating_sub(SIDE).min(nodes.len() - most);
            let stencil = first..first + most;
            let weights = weights(&nodes.t[stencil.clone()], k - first);
            let rate = |p: &[f64]| -> f64 {
                // The weights add up to 0: differences from p_k keep the digits of small motions.
                let terms = weights.iter().zip(&p[stencil.clone()]);
                terms.map(|(weight, other)| weight * (other - p[k])).sum()
            };
            (out.c[k], out.x[k], out.z[k]) = (rate(nodes.c), rate(nodes.x), rate(nodes.z));
        }
        Ok(())
    }
}

/// l_j′(t_k) for every node j of a stencil.
fn weights(t: &[f64], k: usize) -> Vec<f64> {
    let others = |j: usize| (0..t.len()).filter(move |i| *i != j && *i != k);
    let weight = |j: usize| {
        let product: f64 = others(j).map(|i| (t[k] - t[i]) / (t[j] - t[i])).product();
        match j == k {
            // It belongs to p_k − p_k.
            true => 0.0,
            false => product / (t[j] - t[k]),
        }
    };
    (0..t.len()).map(weight).collect()
}

turnpath_plugin::export!(velocities: [FivePoints]);

#[cfg(test)]
mod tests {
    use turnpath_plugin_test::{Promise, Trial, check};

    #[test]
    fn conforms() {
        check!(Trial::of("five-points").promising(Promise::ExactOnCubics));
    }
}
