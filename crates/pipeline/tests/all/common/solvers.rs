//! Velocity solvers of each dependence.

use turnpath_core::{Dependence, Nodes, Result, Velocities, VelocitySolver};

/// The exact rates.
pub struct Exact;

impl VelocitySolver for Exact {
    fn dependence(&self) -> Dependence {
        Dependence::Local
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

/// A solver that says that it depends on more than it does.
pub struct Saying<S>(pub S, pub Dependence);

impl<S: VelocitySolver> VelocitySolver for Saying<S> {
    fn dependence(&self) -> Dependence {
        self.1
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        self.0.solve(nodes, out)
    }

    fn solve_sequential(
        &self,
        nodes: Nodes<'_>,
        _: &mut Vec<f64>,
        out: Velocities<'_>,
    ) -> Result<()> {
        self.0.solve(nodes, out)
    }
}

/// The exact rates of C and X, and no velocity of Z: the error falls only with the step.
pub struct Resting;

impl VelocitySolver for Resting {
    fn dependence(&self) -> Dependence {
        Dependence::Local
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        out.c.copy_from_slice(nodes.c_rate);
        out.x.copy_from_slice(nodes.x_rate);
        out.z.fill(0.0);
        Ok(())
    }
}

/// The exact rates, but X halts at every node.
pub struct Halting;

impl VelocitySolver for Halting {
    fn dependence(&self) -> Dependence {
        Dependence::Local
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let Velocities { c, x, z } = out;
        let all = Velocities { c, x: &mut *x, z };
        Exact.solve(nodes, all)?;
        x.fill(0.0);
        Ok(())
    }
}

/// The exact rates, but no number for Z beyond C = 1000 rad.
pub struct Broken;

impl VelocitySolver for Broken {
    fn dependence(&self) -> Dependence {
        Dependence::Local
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let Velocities { c, x, z } = out;
        let all = Velocities { c, x, z: &mut *z };
        Exact.solve(nodes, all)?;
        for (c, z) in nodes.c.iter().zip(z) {
            if *c > 1000.0 {
                *z = f64::NAN;
            }
        }
        Ok(())
    }
}

/// The cubic spline with no acceleration at the path's two ends, clamped at those of a window.
pub struct Spline {
    pub overlap: usize,
}

impl VelocitySolver for Spline {
    fn dependence(&self) -> Dependence {
        Dependence::Overlap(self.overlap)
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let z_rate: Vec<f64> = (0..nodes.len()).map(|k| nodes.z_rate(k)).collect();
        spline(&nodes, nodes.c, nodes.c_rate, out.c);
        spline(&nodes, nodes.x, nodes.x_rate, out.x);
        spline(&nodes, nodes.z, &z_rate, out.z);
        Ok(())
    }
}

/// Gaussian elimination of the slopes' tridiagonal equations.
fn spline(nodes: &Nodes<'_>, p: &[f64], rate: &[f64], slopes: &mut [f64]) {
    let last = p.len() - 1;
    if last == 0 {
        slopes.copy_from_slice(rate);
        return;
    }
    let h = |k: usize| nodes.t[k + 1] - nodes.t[k];
    let d = |k: usize| (p[k + 1] - p[k]) / h(k);
    let mut upper = vec![0.0; p.len()];
    for k in 0..=last {
        let (low, mid, up, right) = if k == 0 && nodes.at_start {
            (0.0, 2.0, 1.0, 3.0 * d(0))
        } else if k == last && nodes.at_end {
            (1.0, 2.0, 0.0, 3.0 * d(last - 1))
        } else if k == 0 || k == last {
            (0.0, 1.0, 0.0, rate[k])
        } else {
            let (a, b) = (h(k - 1), h(k));
            let (low, up) = (b / (a + b), a / (a + b));
            (low, 2.0, up, 3.0 * (low * d(k - 1) + up * d(k)))
        };
        let (before, above) = match k {
            0 => (0.0, 0.0),
            _ => (slopes[k - 1], upper[k - 1]),
        };
        let pivot = mid - low * above;
        (upper[k], slopes[k]) = (up / pivot, (right - low * before) / pivot);
    }
    for k in (0..last).rev() {
        slopes[k] -= upper[k] * slopes[k + 1];
    }
}

/// V₊ = V + (d − V)/c with c = 2/3, which begins with the exact rates. It is sequential: its state
/// is the three velocities at the next block's first node.
pub struct Area;

impl VelocitySolver for Area {
    fn dependence(&self) -> Dependence {
        Dependence::Sequential
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        self.solve_sequential(nodes, &mut Vec::new(), out)
    }

    fn solve_sequential(
        &self,
        nodes: Nodes<'_>,
        state: &mut Vec<f64>,
        out: Velocities<'_>,
    ) -> Result<()> {
        assert_eq!(state.is_empty(), nodes.at_start);
        let exact = [nodes.c_rate[0], nodes.x_rate[0], nodes.z_rate(0)];
        let columns = [(nodes.c, out.c), (nodes.x, out.x), (nodes.z, out.z)];
        let mut left = Vec::new();
        for (axis, (p, v)) in columns.into_iter().enumerate() {
            v[0] = state.get(axis).copied().unwrap_or(exact[axis]);
            for k in 0..p.len() - 1 {
                let mean = (p[k + 1] - p[k]) / (nodes.t[k + 1] - nodes.t[k]);
                v[k + 1] = v[k] + 1.5 * (mean - v[k]);
            }
            left.push(v[p.len() - 1]);
        }
        *state = left;
        Ok(())
    }
}

/// The exact rates, but a zero rate of Z at the first node of every call: the windows of two
/// neighbouring blocks then disagree about their joint.
pub struct Disjoint;

impl VelocitySolver for Disjoint {
    fn dependence(&self) -> Dependence {
        Dependence::Local
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let Velocities { c, x, z } = out;
        Exact.solve(nodes, Velocities { c, x, z: &mut *z })?;
        z[0] = 0.0;
        Ok(())
    }
}

/// Requires an overlap of all nodes.
pub struct Greedy;

impl VelocitySolver for Greedy {
    fn dependence(&self) -> Dependence {
        Dependence::Overlap(usize::MAX)
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        Exact.solve(nodes, out)
    }
}
