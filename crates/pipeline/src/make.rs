//! From nodes to control points: nodes are subdivided, put on the locus, and given velocities.

use std::f64::consts::TAU;
use std::ops::Range;

use rayon::prelude::*;
use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{CentreBuffers, Dependence, NodeList, Rates, Velocities, angles};

use crate::Result;
use crate::columns::Columns;
use crate::node_check::CLOSEST_NODES;
use crate::order::one_at_a_time;
use crate::plan::Plan;
use crate::window::{NodeBlock, NodeRow, Window};

/// How often each sampler segment of a block is halved. An empty list halves none.
pub type Depths = Vec<u8>;

/// The control points of a block, and the first one of the next block, where the last segment
/// ends.
#[derive(Default)]
pub struct BlockPoints {
    /// Which block of the path it is.
    pub index: usize,
    /// The points, the joint with the next block included.
    pub points: PathBlock,
    /// Z of each point above the locus, mm, as the sampler placed it.
    pub offsets: Vec<f64>,
    /// Which sampler segment each point's segment is a part of.
    pub owner: Vec<u32>,
    /// How many nodes the sampler placed, the path's last point included.
    pub placed: usize,
    /// Whether the path ends with the block.
    pub ends_path: bool,
}

/// Whether the velocity solver goes through the path from its beginning.
pub fn is_sequential(plan: &Plan<'_>) -> bool {
    plan.chain.velocity.strategy.dependence() == Dependence::Sequential
}

/// The state that a sequential solver starts with; nothing for others.
pub fn first_state(plan: &Plan<'_>) -> Option<Vec<f64>> {
    is_sequential(plan).then(Vec::new)
}

/// Makes the blocks of `range`, each with as many of its neighbours' nodes as the velocity solver needs: in
/// parallel, unless the solver is sequential.
pub fn make(
    plan: &Plan<'_>,
    range: Range<usize>,
    depths: &[Depths],
    solver_state: Option<&mut Vec<f64>>,
) -> Result<Vec<BlockPoints>> {
    let overlap = match plan.chain.velocity.strategy.dependence() {
        Dependence::Overlap(nodes) => nodes,
        Dependence::Local | Dependence::Sequential => 0,
    };
    let row = locate_with_neighbours(plan, range.clone(), overlap, depths)?;
    let mut blocks: Vec<BlockPoints> = match solver_state {
        Some(state) => {
            let windows = row.into_windows(plan, range.end).into_iter();
            let solved = windows.map(|window| solve(plan, window, Some(&mut *state)));
            solved.collect::<Result<_>>()?
        }
        None if overlap == 0 => {
            let windows = row.into_windows(plan, range.end).into_par_iter();
            one_at_a_time(windows.map(|window| solve(plan, window, None)))?
        }
        None => one_at_a_time(
            range
                .into_par_iter()
                .map(|index| solve(plan, row.window(plan, index, overlap), None)),
        )?,
    };
    close_joints(&mut blocks);
    Ok(blocks)
}

/// Ends every block with the first point of the next block, if that follows it on the path. The joint is then
/// measured as it is written, and not as the block's own window had it.
pub fn close_joints(blocks: &mut [BlockPoints]) {
    for i in 1..blocks.len() {
        let follows = blocks[i].index == blocks[i - 1].index + 1;
        if let Some(joint) = blocks[i].points.get(0).filter(|_| follows) {
            blocks[i - 1].points.set_last(joint);
        }
    }
}

/// Which nodes of a block are put on the locus.
#[derive(Debug, Clone, Copy)]
enum Part {
    All,
    First(usize),
    Last(usize),
}

impl Part {
    /// The part of so many nodes.
    fn of(self, count: usize) -> Range<usize> {
        match self {
            Self::All => 0..count,
            Self::First(wanted) => 0..count.min(wanted),
            Self::Last(wanted) => count.saturating_sub(wanted)..count,
        }
    }
}

/// The nodes of `range`, and those of neighbours that a solver with this overlap sees: `overlap` before the
/// range, and one more than `overlap` after it, as the next block's first node is the joint. On either side
/// there is one node more, which shows that the path goes on.
fn locate_with_neighbours(
    plan: &Plan<'_>,
    range: Range<usize>,
    overlap: usize,
    depths: &[Depths],
) -> Result<NodeRow> {
    let count = |blocks: &[NodeBlock]| -> usize {
        let lengths = blocks.iter().map(|block| block.columns.len());
        lengths.sum()
    };
    let (mut first, mut last) = (range.start, range.end);
    let mut blocks = locate_blocks(plan, first..last, depths, Part::All)?;
    let mut before = 0;
    while first > 0 && before < overlap {
        first -= 1;
        let part = Part::Last(overlap + 1 - before);
        let mut more = locate_blocks(plan, first..first + 1, depths, part)?;
        before += count(&more);
        more.append(&mut blocks);
        blocks = more;
    }
    let mut after = 0;
    while last < plan.blocks() && after < overlap + 1 {
        let part = Part::First(overlap + 2 - after);
        let more = locate_blocks(plan, last..last + 1, depths, part)?;
        after += count(&more);
        blocks.extend(more);
        last += 1;
    }
    Ok(NodeRow { first, blocks })
}

/// Samples and subdivides each block, and puts a part of its nodes on the locus.
fn locate_blocks(
    plan: &Plan<'_>,
    range: Range<usize>,
    depths: &[Depths],
    part: Part,
) -> Result<Vec<NodeBlock>> {
    let placed_to = (range.end + 1).min(plan.blocks());
    let placed = (range.start..placed_to).into_par_iter();
    let raw = one_at_a_time(placed.map(|index| plan.nodes(index)))?;
    let end_of = |index: usize| {
        let next = raw
            .get(index + 1 - range.start)
            .and_then(|nodes| nodes.revolutions().first());
        next.copied().unwrap_or(plan.law.end())
    };
    one_at_a_time(range.clone().into_par_iter().map(|index| {
        let nodes = &raw[index - range.start];
        let mut block = subdivide(plan, index, nodes, end_of(index), depths);
        block.nodes.keep(part.of(block.nodes.len()));
        Ok(NodeBlock {
            columns: locate(plan, &block.nodes)?,
            owner: block.owner,
            placed: block.placed,
        })
    }))
}

/// The nodes of a block, and between them those that halve its segments.
struct Subdivision {
    nodes: NodeList,
    /// Which sampler segment each node's segment is a part of.
    owner: Vec<u32>,
    /// How many nodes the sampler placed, the path's last point included.
    placed: usize,
}

/// Halves the segments between the nodes that the sampler placed in a block, as often as `depths` says.
fn subdivide(
    plan: &Plan<'_>,
    index: usize,
    placed: &NodeList,
    end: f64,
    depths: &[Depths],
) -> Subdivision {
    let source = plan.halved_as(index);
    let depths = depths.get(source).map_or(&[][..], Vec::as_slice);
    // A block that repeats the halvings of another one may have a node more.
    let repeated = depths.last().filter(|_| source != index);
    let revolutions = placed.revolutions();
    // A sampler need not know where the path ends, nor the controller's steps of time.
    let has_no_step =
        |node: f64| plan.is_last(index) && plan.on_time(node).1 >= plan.on_time(end).1;
    let is_too_late = |node: f64| end - node < CLOSEST_NODES || has_no_step(node);
    let too_late = revolutions
        .iter()
        .rev()
        .take_while(|node| is_too_late(**node));
    let kept = &revolutions[..revolutions.len() - too_late.count()];
    let (mut nodes, mut owner) = (NodeList::default(), Vec::new());
    for (i, from) in kept.iter().enumerate() {
        let to = kept.get(i + 1).copied().unwrap_or(end);
        let depth = depths.get(i).or(repeated).copied().unwrap_or(0);
        let parts = 1u32 << depth;
        for part in 0..parts {
            let n = from + (to - from) * f64::from(part) / f64::from(parts);
            match part {
                0 if placed.has_offsets() => nodes.push_off(n, placed.offset(i)),
                _ => nodes.push(n),
            }
            owner.push(i as u32);
        }
    }
    let mut count = kept.len();
    if plan.is_last(index) {
        nodes.push(end);
        owner.push(kept.len() as u32);
        count += 1;
    }
    Subdivision {
        nodes,
        owner,
        placed: count,
    }
}

/// Nodes and their times. Where the controller has steps of time, the nodes are moved onto them.
fn on_time(plan: &Plan<'_>, nodes: &[f64]) -> Result<(Vec<f64>, Vec<f64>)> {
    let mut t = column(nodes.iter().map(|_| f64::NAN));
    plan.spindle.times_at(nodes, &mut t);
    let mut n = nodes.to_vec();
    for (n, t) in n.iter_mut().zip(&mut t) {
        (*n, *t) = plan.moved_on_time(*n, *t);
    }
    match t.windows(2).position(|pair| pair[1] <= pair[0]) {
        None => Ok((n, t)),
        Some(i) => Err(plan.chain.sampler.bad_answer(format!(
            "the nodes at {} and {} revolutions are closer in time than the controller's step",
            nodes[i],
            nodes[i + 1]
        ))),
    }
}

/// A quantity of a block's nodes, with room for that of the joint with the next block.
fn column(values: impl ExactSizeIterator<Item = f64>) -> Vec<f64> {
    let mut column = Vec::with_capacity(values.len() + 1);
    column.extend(values);
    column
}

/// Puts nodes on the locus, or as far off it as the sampler placed them.
fn locate(plan: &Plan<'_>, nodes: &NodeList) -> Result<Columns> {
    let compensator = &plan.chain.compensator;
    let (n, t) = on_time(plan, nodes.revolutions())?;
    let context = || match (n.first(), n.last()) {
        (Some(first), Some(last)) => format!("in revolutions {first:.3} to {last:.3}"),
        _ => String::new(),
    };
    let unset = || column((0..n.len()).map(|_| f64::NAN));
    let (mut theta, mut rho) = (vec![f64::NAN; n.len()], vec![f64::NAN; n.len()]);
    angles(&n, &mut theta);
    plan.law.values(&n, &mut rho);
    let mut centres = CentreBuffers {
        x: unset(),
        z: unset(),
        foot: unset(),
    };
    let (mut x_theta, mut x_rho) = (unset(), unset());
    let (mut z_theta, mut z_x) = (unset(), unset());
    let rates = Rates {
        x_theta: &mut x_theta,
        x_rho: &mut x_rho,
        z_theta: &mut z_theta,
        z_x: &mut z_x,
    };
    let locus = &plan.preparation.locus;
    locus
        .centre_and_rates(&theta, &rho, centres.as_centres(), rates)
        .map_err(|error| compensator.failed(context(), error))?;
    let (mut c_rate, mut law_rate) = (unset(), unset());
    plan.spindle.speeds_at(&n, &mut c_rate);
    plan.law.rates(&n, &mut law_rate);
    let x_rate =
        column((0..n.len()).map(|i| c_rate[i] * (x_theta[i] + x_rho[i] * law_rate[i] / TAU)));
    let mut columns = Columns {
        dz: column(n.iter().map(|_| 0.0)),
        t,
        c: column(n.iter().map(|n| TAU * (n + plan.start.turns))),
        x: centres.x,
        z: centres.z,
        c_rate,
        x_rate,
        z_theta,
        z_x,
    };
    columns.shift(nodes);
    match columns.first_unknown() {
        None => Ok(columns),
        Some(i) => Err(compensator.bad_answer(format!(
            "no number for the tool centre at C = {:.3} deg, ρ = {} mm",
            360.0 * n[i],
            rho[i]
        ))),
    }
}

/// Gives the points of a block their velocities.
fn solve(plan: &Plan<'_>, window: Window, state: Option<&mut Vec<f64>>) -> Result<BlockPoints> {
    let Window {
        index,
        owner,
        placed,
        columns,
        own,
        at_start,
        at_end,
    } = window;
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
    // One more than its own: the joint with the next block.
    let with_joint = own.start..(own.end + 1).min(columns.len());
    let part = |column: Vec<f64>| match with_joint == (0..column.len()) {
        true => column,
        false => column[with_joint.clone()].to_vec(),
    };
    let points = PathBlock {
        t: part(columns.t),
        c: part(columns.c),
        x: part(columns.x),
        z: part(columns.z),
        vc: part(c),
        vx: part(x),
        vz: part(z),
        shape: link.strategy.segments(),
    };
    let wrong = |point: ControlPoint| {
        let place = || (!point.is_finite()).then(|| "a position is not finite".to_owned());
        let what = point.wild_velocity().or_else(place)?;
        Some(format!("at {:.6} s {what}", point.t))
    };
    if let Some(what) = points.points().find_map(wrong) {
        return Err(link.bad_answer(what));
    }
    Ok(BlockPoints {
        index,
        points,
        offsets: part(columns.dz),
        owner,
        placed,
        ends_path: plan.is_last(index),
    })
}
