//! From nodes to control points: subdivided, placed on the locus, given velocities.

use std::f64::consts::TAU;
use std::ops::Range;

use rayon::prelude::*;
use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{CentreBuffers, Dependence, Locus, Nodes, Rates, Velocities, angle};

use crate::Result;
use crate::order::in_order;
use crate::plan::{CLOSEST_NODES, Plan};

/// How often each sampler segment of a block is halved; an empty list: not at all.
pub type Depths = Vec<u8>;

/// The control points of a block, and the next block's first one, where its last segment ends.
pub struct Made {
    /// The points, the joint with the next block included.
    pub points: PathBlock,
    /// Which sampler segment each point's segment is a part of.
    pub owner: Vec<u32>,
    /// How many nodes the sampler had placed, the path's last point included.
    pub sampled: usize,
}

/// Nodes of a block with their places on the locus.
#[derive(Default)]
struct Placed {
    owner: Vec<u32>,
    sampled: usize,
    columns: Columns,
}

/// What a velocity solver gets, a column for each quantity.
#[derive(Default)]
struct Columns {
    t: Vec<f64>,
    c: Vec<f64>,
    x: Vec<f64>,
    z: Vec<f64>,
    c_rate: Vec<f64>,
    x_rate: Vec<f64>,
    z_theta: Vec<f64>,
    z_x: Vec<f64>,
}

impl Columns {
    fn each(&self) -> [&Vec<f64>; 8] {
        let Self {
            t,
            c,
            x,
            z,
            c_rate,
            x_rate,
            z_theta,
            z_x,
        } = self;
        [t, c, x, z, c_rate, x_rate, z_theta, z_x]
    }

    fn each_mut(&mut self) -> [&mut Vec<f64>; 8] {
        let Self {
            t,
            c,
            x,
            z,
            c_rate,
            x_rate,
            z_theta,
            z_x,
        } = self;
        [t, c, x, z, c_rate, x_rate, z_theta, z_x]
    }

    fn append(&mut self, other: &Self, range: Range<usize>) {
        for (own, other) in self.each_mut().into_iter().zip(other.each()) {
            own.extend_from_slice(&other[range.clone()]);
        }
    }

    fn len(&self) -> usize {
        self.t.len()
    }
}

/// Makes the blocks of `range`, in parallel, with as many of their neighbours' nodes as the
/// velocity solver asks for.
pub fn make(
    plan: &Plan<'_>,
    range: Range<usize>,
    depths: &[Depths],
    solver_state: Option<&mut Vec<f64>>,
) -> Result<Vec<Made>> {
    let overlap = match plan.chain.velocity.strategy.dependence() {
        Dependence::Overlap(nodes) => nodes,
        Dependence::Local | Dependence::Sequential => 0,
    };
    let around = place_around(plan, range.clone(), overlap, depths)?;
    let mut made: Vec<Made> = match solver_state {
        Some(state) => range
            .map(|index| solve(plan, &around, index, overlap, Some(&mut *state)))
            .collect::<Result<_>>()?,
        None => in_order(
            range
                .into_par_iter()
                .map(|index| solve(plan, &around, index, overlap, None)),
        )?,
    };
    join(&mut made);
    Ok(made)
}

/// Ends every block with the point that the next one begins with: the joint as it is written, and
/// not as the block's own window had it, however the solver came by it.
pub fn join(made: &mut [Made]) {
    for i in 1..made.len() {
        if let Some(joint) = made[i].points.get(0) {
            made[i - 1].points.set_last(joint);
        }
    }
}

/// Blocks in a row with their nodes placed, from number `first` on.
struct Row {
    first: usize,
    blocks: Vec<Placed>,
}

impl Row {
    fn get(&self, index: usize) -> Option<&Placed> {
        self.blocks.get(index.checked_sub(self.first)?)
    }
}

/// Places the nodes of `range` and of neighbours on both sides that hold `overlap` nodes, and the
/// next block's first one besides.
fn place_around(
    plan: &Plan<'_>,
    range: Range<usize>,
    overlap: usize,
    depths: &[Depths],
) -> Result<Row> {
    let (mut first, mut last) = (range.start, range.end);
    let mut blocks = place(plan, first..last, depths)?;
    let mut before = 0;
    while first > 0 && before < overlap {
        first -= 1;
        let mut found = place(plan, first..first + 1, depths)?;
        before += found
            .iter()
            .map(|placed| placed.columns.len())
            .sum::<usize>();
        found.append(&mut blocks);
        blocks = found;
    }
    let mut after = 0;
    while last < plan.blocks() && after < overlap + 1 {
        let found = place(plan, last..last + 1, depths)?;
        after += found
            .iter()
            .map(|placed| placed.columns.len())
            .sum::<usize>();
        blocks.extend(found);
        last += 1;
    }
    Ok(Row { first, blocks })
}

/// Samples, subdivides and places the nodes of each block.
fn place(plan: &Plan<'_>, range: Range<usize>, depths: &[Depths]) -> Result<Vec<Placed>> {
    let sampled_to = (range.end + 1).min(plan.blocks());
    let sampled = (range.start..sampled_to).into_par_iter();
    let raw = in_order(sampled.map(|index| plan.sample(index)))?;
    let end_of = |index: usize| {
        let next = raw
            .get(index + 1 - range.start)
            .and_then(|nodes| nodes.first());
        next.copied().unwrap_or(plan.law.end())
    };
    in_order(range.clone().into_par_iter().map(|index| {
        let nodes = &raw[index - range.start];
        let halved = depths.get(index).map_or(&[][..], Vec::as_slice);
        place_block(plan, index, nodes, end_of(index), halved)
    }))
}

fn place_block(
    plan: &Plan<'_>,
    index: usize,
    sampled: &[f64],
    end: f64,
    depths: &[u8],
) -> Result<Placed> {
    let too_late = sampled
        .iter()
        .rev()
        .take_while(|node| end - **node < CLOSEST_NODES)
        .count();
    let sampled = &sampled[..sampled.len() - too_late.min(sampled.len())];
    let (mut n, mut owner) = (Vec::new(), Vec::new());
    for (i, from) in sampled.iter().enumerate() {
        let to = sampled.get(i + 1).copied().unwrap_or(end);
        let parts = 1u32 << depths.get(i).copied().unwrap_or(0);
        for part in 0..parts {
            n.push(from + (to - from) * f64::from(part) / f64::from(parts));
            owner.push(i as u32);
        }
    }
    let mut count = sampled.len();
    if plan.is_last(index) {
        n.push(end);
        owner.push(sampled.len() as u32);
        count += 1;
    }
    Ok(Placed {
        columns: locate(plan, &n)?,
        owner,
        sampled: count,
    })
}

/// Nodes and their times; on the steps of the controller's time, if it has such.
fn on_time(plan: &Plan<'_>, nodes: &[f64]) -> Result<(Vec<f64>, Vec<f64>)> {
    let (n, t): (Vec<f64>, Vec<f64>) = nodes.iter().map(|n| plan.on_time(*n)).unzip();
    match t.windows(2).position(|pair| pair[1] <= pair[0]) {
        None => Ok((n, t)),
        Some(i) => Err(plan.chain.sampler.bad_answer(format!(
            "the nodes at {} and {} revolutions are closer in time than the controller's step",
            nodes[i],
            nodes[i + 1]
        ))),
    }
}

/// Puts nodes on the locus.
fn locate(plan: &Plan<'_>, nodes: &[f64]) -> Result<Columns> {
    let (task, compensator) = (&plan.prepared.task, &plan.chain.compensator);
    let (n, t) = on_time(plan, nodes)?;
    let place = || match (n.first(), n.last()) {
        (Some(first), Some(last)) => format!("in revolutions {first:.3} to {last:.3}"),
        _ => String::new(),
    };
    let theta: Vec<f64> = n.iter().map(|n| angle(*n)).collect();
    let rho: Vec<f64> = n.iter().map(|n| plan.law.value(*n)).collect();
    let mut centres = CentreBuffers::default();
    centres.resize(n.len());
    let locus = &plan.prepared.locus;
    locus
        .centre(&theta, &rho, centres.as_centres())
        .map_err(|error| compensator.failed(place(), error))?;
    let blank = vec![f64::NAN; n.len()];
    let (mut x_theta, mut x_rho) = (blank.clone(), blank.clone());
    let (mut z_theta, mut z_x) = (blank.clone(), blank);
    let rates = Rates {
        x_theta: &mut x_theta,
        x_rho: &mut x_rho,
        z_theta: &mut z_theta,
        z_x: &mut z_x,
    };
    locus
        .rates(&theta, &rho, rates)
        .map_err(|error| compensator.failed(place(), error))?;
    let c_rate: Vec<f64> = n.iter().map(|n| task.spindle.speed_at(*n)).collect();
    let x_rate = (0..n.len())
        .map(|i| c_rate[i] * (x_theta[i] + x_rho[i] * plan.law.rate(n[i]) / TAU))
        .collect();
    let columns = Columns {
        t,
        c: n.iter().map(|n| TAU * (n + plan.start.turns)).collect(),
        x: centres.x,
        z: centres.z,
        c_rate,
        x_rate,
        z_theta,
        z_x,
    };
    for (i, n) in n.iter().enumerate() {
        if columns.each().iter().any(|column| !column[i].is_finite()) {
            let what = format!(
                "no number for the tool centre at C = {:.3} deg, ρ = {} mm",
                360.0 * n,
                rho[i]
            );
            return Err(compensator.bad_answer(what));
        }
    }
    Ok(columns)
}

/// Gives the points of a block their velocities.
fn solve(
    plan: &Plan<'_>,
    row: &Row,
    index: usize,
    overlap: usize,
    state: Option<&mut Vec<f64>>,
) -> Result<Made> {
    let Window {
        columns,
        own,
        at_start,
        at_end,
    } = row.window(plan, index, overlap);
    let (mut c, mut x, mut z) = (columns.unset(), columns.unset(), columns.unset());
    let nodes = columns.nodes(at_start, at_end);
    let out = Velocities {
        c: &mut c,
        x: &mut x,
        z: &mut z,
    };
    let link = &plan.chain.velocity;
    let answer = match state {
        Some(state) => link.strategy.solve_sequential(nodes, state, out),
        None => link.strategy.solve(nodes, out),
    };
    let start = columns.t.get(own.start).copied().unwrap_or_default();
    answer.map_err(|error| link.failed(format!("from {start:.6} s on"), error))?;
    let mut points = PathBlock {
        shape: link.strategy.segments(),
        ..PathBlock::default()
    };
    // One more than its own: the joint with the next block.
    for k in own.start..(own.end + 1).min(columns.len()) {
        let point = columns.point(k, c[k], x[k], z[k]);
        if !point.is_finite() {
            let what = format!(
                "vC = {}, vX = {}, vZ = {} at {:.6} s are no velocities",
                point.vc, point.vx, point.vz, point.t
            );
            return Err(link.bad_answer(what));
        }
        points.push(point);
    }
    let (owner, sampled) = row.get(index).map_or((Vec::new(), 0), |block| {
        (block.owner.clone(), block.sampled)
    });
    Ok(Made {
        points,
        owner,
        sampled,
    })
}

/// What a velocity solver gets for one block.
struct Window {
    columns: Columns,
    /// Where the block's own nodes are.
    own: Range<usize>,
    /// Whether the first node is the path's first, and the last one its last.
    at_start: bool,
    at_end: bool,
}

impl Row {
    /// The nodes of a block between `overlap` ones of its neighbours, the joint with the next
    /// block besides.
    fn window(&self, plan: &Plan<'_>, index: usize, overlap: usize) -> Window {
        let length = |block: &Placed| block.columns.len();
        let (before, rest) = self.blocks.split_at(index - self.first);
        let behind: usize = before.iter().map(length).sum();
        let all: usize = behind + rest.iter().map(length).sum::<usize>();
        let own = behind..behind + rest.first().map_or(0, length);
        let wanted = own.start.saturating_sub(overlap)..(own.end + overlap + 1).min(all);
        let mut columns = Columns::default();
        let mut start = 0;
        for block in &self.blocks {
            let end = start + length(block);
            let (from, to) = (wanted.start.max(start), wanted.end.min(end));
            if from < to {
                columns.append(&block.columns, from - start..to - start);
            }
            start = end;
        }
        Window {
            columns,
            own: own.start - wanted.start..own.end - wanted.start,
            at_start: self.first == 0 && wanted.start == 0,
            at_end: self.first + self.blocks.len() == plan.blocks() && wanted.end == all,
        }
    }
}

impl Columns {
    fn unset(&self) -> Vec<f64> {
        vec![f64::NAN; self.len()]
    }

    fn nodes(&self, at_start: bool, at_end: bool) -> Nodes<'_> {
        Nodes {
            t: &self.t,
            c: &self.c,
            x: &self.x,
            z: &self.z,
            c_rate: &self.c_rate,
            x_rate: &self.x_rate,
            z_theta: &self.z_theta,
            z_x: &self.z_x,
            at_start,
            at_end,
        }
    }

    fn point(&self, k: usize, vc: f64, vx: f64, vz: f64) -> ControlPoint {
        ControlPoint {
            t: self.t[k],
            c: self.c[k],
            x: self.x[k],
            z: self.z[k],
            vc,
            vx,
            vz,
        }
    }
}
