//! Parts, laws, nodes of whole paths, and their playback in time.
#![allow(dead_code, reason = "shared with other test programs")]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

#[path = "../../../../../tests/support/planned.rs"]
mod planned;

use std::f64::consts::TAU;

pub use planned::{Case, ast_5, mla_5};
use turnpath_atpg::{AtpgFeed, AtpgSampler};
use turnpath_ats::AtsFeed;
use turnpath_core::{
    CentreBuffers, CentreSeries, DEG, Locus, NodeList, NodeOffset, ParamValue, Params, Path,
    Result, Revolutions, Sampler, Series, SpiralLaw, Strategy, angle, per_radian,
};
use turnpath_minimax::MinimaxSampler;

/// Number of revolutions in the host's blocks.
pub const BLOCK: f64 = 64.0;
/// Number of instants of a segment.
const INSTANTS: usize = 64;

/// The sampler `minimax`, without wandering.
pub fn minimax(states: f64, max_step_deg: f64) -> MinimaxSampler {
    MinimaxSampler::new(&params(states, max_step_deg, false)).unwrap()
}

/// The parameters of `minimax`.
pub fn params(states: f64, max_step_deg: f64, wander: bool) -> Params {
    steps(max_step_deg, wander).with("states", states)
}

fn steps(max_step_deg: f64, wander: bool) -> Params {
    let mut params = Params::new().with("max_step", max_step_deg * DEG);
    params.set("wander", ParamValue::Flag(wander));
    params
}

/// The sampler `atpg`.
pub fn atpg(max_step_deg: f64) -> AtpgSampler {
    AtpgSampler::new(&steps(max_step_deg, false)).unwrap()
}

/// The smooth law of the feed `atpg`.
pub fn smooth_law(case: &Case) -> SpiralLaw {
    let mut params = Params::new();
    for (name, word) in [("residual", "held"), ("fit", "smooth")] {
        params.set(name, ParamValue::Text(word.to_owned()));
    }
    case.law(&AtpgFeed::new(&params).unwrap()).unwrap()
}

/// The law of the feed `ats`, which follows the angle.
pub fn ats_law(case: &Case) -> SpiralLaw {
    let mut params = Params::new();
    params.set("inward", ParamValue::Text("recursion".to_owned()));
    case.law(&AtsFeed::new(&params).unwrap()).unwrap()
}

/// The nodes of a sampler between these revolutions, block by block.
pub fn nodes_between(
    case: &Case,
    law: &SpiralLaw,
    sampler: &dyn Sampler,
    (from, to): (f64, f64),
) -> Result<Vec<NodeList>> {
    let path = Path {
        task: &case.task,
        locus: &case.locus,
        law,
        spindle: &case.spindle,
    };
    let plan = sampler.plan(&path)?;
    let mut start = from;
    let mut blocks = Vec::new();
    while start < to {
        let end = (start + BLOCK).min(to);
        let mut nodes = NodeList::default();
        plan.place(&path, Revolutions { start, end }, &mut nodes)?;
        blocks.push(nodes);
        start = end;
    }
    Ok(blocks)
}

/// The nodes of the whole path, block by block.
pub fn nodes(case: &Case, law: &SpiralLaw, sampler: &dyn Sampler) -> Vec<NodeList> {
    nodes_between(case, law, sampler, (0.0, law.end())).unwrap()
}

/// How many nodes there are.
pub fn count(blocks: &[NodeList]) -> usize {
    blocks.iter().map(NodeList::len).sum()
}

/// One axis at one node: position and velocity.
type Axis = [f64; 2];

/// A control point: time, C, X and Z.
struct Point {
    t: f64,
    axes: [Axis; 3],
}

/// The cubic of one axis at `s` in (0, 1) of a segment of `h` seconds.
fn cubic(from: Axis, to: Axis, h: f64, s: f64) -> f64 {
    let d = to[0] - from[0];
    let (a, b) = (h * from[1], h * to[1]);
    from[0] + s * (a + s * (3.0 * d - 2.0 * a - b + s * (a + b - 2.0 * d)))
}

/// The control points that the host makes of these nodes with exact rates.
fn points(case: &Case, law: &SpiralLaw, nodes: &[(f64, NodeOffset)]) -> Vec<Point> {
    let n: Vec<f64> = nodes.iter().map(|node| node.0).collect();
    let theta: Vec<Series> = n.iter().map(|n| [angle(*n), 1.0, 0.0, 0.0, 0.0]).collect();
    let rho = |n: &f64| {
        let mut series = law.series(*n);
        series[1] = law.rate(*n);
        per_radian(series)
    };
    let rho: Vec<Series> = n.iter().map(rho).collect();
    let (mut x, mut z) = (vec![[0.0; 5]; n.len()], vec![[0.0; 5]; n.len()]);
    let out = CentreSeries {
        x: &mut x,
        z: &mut z,
    };
    case.locus.series(&theta, &rho, out).unwrap();
    let point = |(i, (n, offset)): (usize, &(f64, NodeOffset))| {
        let speed = case.spindle.speed_at(*n);
        Point {
            t: case.spindle.time_at(*n),
            axes: [
                [TAU * n, speed],
                [x[i][0], x[i][1] * speed],
                [z[i][0] + offset.dz, (z[i][1] + offset.dz_dc) * speed],
            ],
        }
    };
    nodes.iter().enumerate().map(point).collect()
}

/// All nodes with their offsets, and the path's end.
fn with_offsets(blocks: &[NodeList], end: f64) -> Vec<(f64, NodeOffset)> {
    let every = blocks.iter().flat_map(|nodes| {
        let n = nodes.revolutions().iter().copied().enumerate();
        n.map(|(i, n)| (n, nodes.offset(i)))
    });
    let mut every: Vec<(f64, NodeOffset)> = every.collect();
    every.push((end, NodeOffset::default()));
    every
}

/// The largest acceleration and jerk of Z as played, mm/s² and mm/s³.
pub fn motion_of_z(case: &Case, law: &SpiralLaw, blocks: &[NodeList]) -> [f64; 2] {
    let points = points(case, law, &with_offsets(blocks, law.end()));
    let mut largest = [0.0_f64; 2];
    for pair in points.windows(2) {
        let h = pair[1].t - pair[0].t;
        let [[from, rate], [to, end_rate]] = [pair[0].axes[2], pair[1].axes[2]];
        let mean = (to - from) / h;
        let jerk = 6.0 * (rate + end_rate - 2.0 * mean) / (h * h);
        let start = (6.0 * mean - 4.0 * rate - 2.0 * end_rate) / h;
        let end = start + jerk * h;
        largest[0] = largest[0].max(start.abs()).max(end.abs());
        largest[1] = largest[1].max(jerk.abs());
    }
    largest
}

/// The largest |played − true| along z of a path that ends at `end`, mm. The truth comes from
/// `truth`, whose ρ is the nose centre's X.
pub fn largest_error(
    (played, truth): (&Case, &Case),
    law: &SpiralLaw,
    blocks: &[NodeList],
    end: f64,
) -> f64 {
    let points = points(played, law, &with_offsets(blocks, end));
    let (mut theta, mut x, mut z) = (Vec::new(), Vec::new(), Vec::new());
    for pair in points.windows(2) {
        let h = pair[1].t - pair[0].t;
        for i in 0..INSTANTS {
            let s = i as f64 / INSTANTS as f64;
            let [c, at_x, at_z] = [0, 1, 2].map(|a| cubic(pair[0].axes[a], pair[1].axes[a], h, s));
            theta.push(angle(c / TAU));
            x.push(at_x);
            z.push(at_z);
        }
    }
    let mut room = CentreBuffers::default();
    room.resize(theta.len());
    truth.locus.centre(&theta, &x, room.as_centres()).unwrap();
    let errors = z.iter().zip(&room.z).map(|(z, truth)| (z - truth).abs());
    errors.fold(0.0, f64::max)
}
