//! Velocity solvers: motions by polynomials on uneven nodes, and the nodes that an answer depends on.

use turnpath_core::{Dependence, Nodes, Result as Answer, Velocities, VelocitySolver};

use crate::fault::FaultKind;
use crate::trial::{Promise, Trial};

/// Nodes of a motion: an overlap of 64 on both sides of a block leaves 100.
const NODES: usize = 260;
/// The nodes of a block in the middle.
const BLOCK: std::ops::Range<usize> = 80..180;
/// Mean step between nodes, s.
const STEP: f64 = 2e-3;
/// By how much the steps vary, as a part of the mean.
const UNEVEN: f64 = 0.4;
/// How far a velocity may be off, as a part of the largest one: rounding of differences.
const ROUNDING: f64 = 1e-9;
const AXES: [char; 3] = ['C', 'X', 'Z'];

/// A motion of the axes by polynomials of time.
struct Motion {
    t: Vec<f64>,
    c: Vec<f64>,
    x: Vec<f64>,
    z: Vec<f64>,
    rates: [Vec<f64>; 3],
    z_theta: Vec<f64>,
    z_x: Vec<f64>,
}

impl Motion {
    /// Each axis moves by a polynomial of this degree, C at nearly one speed.
    fn of_degree(degree: usize) -> Self {
        let mut t = vec![0.0];
        for k in 1..NODES {
            // Steps in no order: multiples of the golden ratio, without their whole part.
            let share = (k as f64 * 0.618_033_988_749_895).fract();
            t.push(t[k - 1] + STEP * (1.0 + UNEVEN * (2.0 * share - 1.0)));
        }
        let polynomials: [[f64; 4]; 3] = [
            [0.0, 52.0, 3.0, -4.0],
            [1.0, 0.7, -0.9, 1.3],
            [0.2, -3.0, 11.0, -17.0],
        ];
        let cut = polynomials.map(|mut p| {
            p[degree + 1..].fill(0.0);
            p
        });
        let at = |p: [f64; 4]| -> Vec<f64> {
            let value = |t: &f64| ((p[3] * t + p[2]) * t + p[1]) * t + p[0];
            t.iter().map(value).collect()
        };
        let rate = |p: [f64; 4]| -> Vec<f64> {
            let value = |t: &f64| (3.0 * p[3] * t + 2.0 * p[2]) * t + p[1];
            t.iter().map(value).collect()
        };
        let rates = cut.map(rate);
        let z_x = vec![0.3; NODES];
        let z_theta = (0..NODES).map(|k| (rates[2][k] - 0.3 * rates[1][k]) / rates[0][k]);
        Self {
            c: at(cut[0]),
            x: at(cut[1]),
            z: at(cut[2]),
            z_theta: z_theta.collect(),
            z_x,
            rates,
            t,
        }
    }

    fn nodes(&self, range: std::ops::Range<usize>) -> Nodes<'_> {
        Nodes {
            t: &self.t[range.clone()],
            c: &self.c[range.clone()],
            x: &self.x[range.clone()],
            z: &self.z[range.clone()],
            c_rate: &self.rates[0][range.clone()],
            x_rate: &self.rates[1][range.clone()],
            z_theta: &self.z_theta[range.clone()],
            z_x: &self.z_x[range.clone()],
            at_start: range.start == 0,
            at_end: range.end == NODES,
        }
    }

    /// The largest rate of an axis.
    fn largest(&self, axis: usize) -> f64 {
        let rates = self.rates[axis].iter();
        rates.fold(0.0, |m: f64, rate| m.max(rate.abs()))
    }
}

/// The velocities of C, X and Z at these nodes; `state` for a solver that works in order.
fn solve(
    solver: &dyn VelocitySolver,
    nodes: Nodes<'_>,
    state: &mut Vec<f64>,
) -> Answer<[Vec<f64>; 3]> {
    let blank = vec![f64::NAN; nodes.len()];
    let mut all = [blank.clone(), blank.clone(), blank];
    let [c, x, z] = &mut all;
    let out = Velocities { c, x, z };
    match solver.dependence() {
        Dependence::Sequential => solver.solve_sequential(nodes, state, out)?,
        Dependence::Local | Dependence::Overlap(_) => solver.solve(nodes, out)?,
    }
    Ok(all)
}

fn failed(error: turnpath_core::StrategyError) -> FaultKind {
    FaultKind::Call {
        call: "solve",
        error,
    }
}

/// Checks a solver.
pub fn check(trial: &Trial, solver: &dyn VelocitySolver) -> Vec<FaultKind> {
    let mut faults = Vec::new();
    // A straight line at constant speed is exact for any solver.
    let mut exact_to = 1;
    if trial.promises(Promise::ExactOnCubics) || solver.gives_exact_rates() {
        exact_to = 3;
    }
    faults.extend(exactness(solver, exact_to).err());
    faults.extend(dependence(solver).err());
    faults
}

/// The highest degree of motions whose velocities are exact; 0 where straight lines are not.
pub fn exact_degree(solver: &dyn VelocitySolver) -> usize {
    (1..=3)
        .take_while(|degree| exactness(solver, *degree).is_ok())
        .last()
        .unwrap_or(0)
}

fn exactness(solver: &dyn VelocitySolver, degree: usize) -> Result<(), FaultKind> {
    let motion = Motion::of_degree(degree);
    let found = solve(solver, motion.nodes(0..NODES), &mut Vec::new()).map_err(failed)?;
    for (axis, (found, exact)) in found.iter().zip(&motion.rates).enumerate() {
        let slack = ROUNDING * motion.largest(axis);
        let is_off = |k: &usize| {
            let gap = (found[*k] - exact[*k]).abs();
            gap.is_nan() || gap > slack
        };
        if let Some(node) = (0..NODES).find(is_off) {
            return Err(FaultKind::Velocity {
                axis: AXES[axis],
                degree,
                node,
                found: found[node],
                exact: exact[node],
            });
        }
    }
    Ok(())
}

/// A block with the neighbours that the solver asks for has the velocities of the whole path.
fn dependence(solver: &dyn VelocitySolver) -> Result<(), FaultKind> {
    let motion = Motion::of_degree(3);
    let whole = solve(solver, motion.nodes(0..NODES), &mut Vec::new()).map_err(failed)?;
    let (declared, block, alone) = match solver.dependence() {
        Dependence::Local => {
            let alone = solve(solver, motion.nodes(BLOCK), &mut Vec::new());
            ("`Local`".to_owned(), BLOCK, alone.map_err(failed)?)
        }
        Dependence::Overlap(nodes) => {
            let from = BLOCK.start.saturating_sub(nodes);
            let to = BLOCK.end.saturating_add(nodes).min(NODES);
            let around = solve(solver, motion.nodes(from..to), &mut Vec::new()).map_err(failed)?;
            let own = BLOCK.start - from..BLOCK.end - from;
            let alone = around.map(|column| column[own.clone()].to_vec());
            (format!("`Overlap({nodes})`"), BLOCK, alone)
        }
        Dependence::Sequential => {
            let mut state = Vec::new();
            // The first node of the next block is the last one of this, and comes again.
            let before = motion.nodes(0..BLOCK.start + 1);
            solve(solver, before, &mut state).map_err(failed)?;
            let block = BLOCK.start..NODES;
            let alone = solve(solver, motion.nodes(block.clone()), &mut state);
            ("`Sequential`".to_owned(), block, alone.map_err(failed)?)
        }
    };
    for (axis, (whole, alone)) in whole.iter().zip(&alone).enumerate() {
        let slack = ROUNDING * motion.largest(axis);
        // Velocities that are no numbers at all show on straight lines already.
        let differs = |k: &usize| (whole[block.start + k] - alone[*k]).abs() > slack;
        if let Some(k) = (0..alone.len()).find(differs) {
            return Err(FaultKind::Dependence {
                declared,
                axis: AXES[axis],
                node: block.start + k,
                alone: alone[k],
                whole: whole[block.start + k],
            });
        }
    }
    Ok(())
}
