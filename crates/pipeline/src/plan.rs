//! What every block is made from: the chain, the task, the locus, the law, and the borders of the
//! blocks.

use std::f64::consts::TAU;

use turnpath_core::{Dependence, Overrun, Path, Revolutions, SpiralLaw};

use crate::observer::{Observer, stop_if_cancelled};
use crate::taper::{CutLaw, taper};
use crate::{Chain, Preparation, Result, beyond, seams};

/// Revolutions of a block. A sampler starts afresh at each border, which costs AST-50 a tenth of
/// a percent of points; larger blocks take more memory and leave less to do in parallel.
pub const BLOCK: f64 = 64.0;
/// Nodes of a block above which it takes half the revolutions, down to one, so that memory stays
/// bounded on the finest paths. The choice depends on the task alone, so the bytes do not depend on
/// the machine.
const COMFORTABLE_BLOCK: f64 = 50_000.0;
/// Most nodes that a sampler may place in a block. More are taken for a mistake.
const MOST_NODES: usize = 4_000_000;
/// An overlap that is too large for a velocity solver. A spline needs 64 nodes; a solver that needs
/// thousands is sequential.
const MOST_OVERLAP: usize = 10_000;
/// Smallest distance between nodes, in revolutions. Closer nodes are a sampler's mistake: the
/// velocity between them would be rounding.
pub const CLOSEST_NODES: f64 = 1e-9;

/// Where and when the cutting section begins: after the lead-in, if there is one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Start {
    /// Whole revolutions of C before it, so that C stays θ.
    pub turns: f64,
    /// Time before it: in steps of the controller's time where it has such steps, else in s.
    pub time: f64,
}

/// A task with its law and its blocks.
pub struct Plan<'a> {
    /// The strategies.
    pub chain: &'a Chain,
    /// The task, the locus, the first touch.
    pub preparation: &'a Preparation,
    /// ρ = ℓ(N).
    pub law: SpiralLaw,
    /// Between which revolutions the law is the feed strategy's own; `None` if no part is.
    pub own: Option<[f64; 2]>,
    /// Steps of time a second on which control points must lie, if the controller has such steps.
    pub time_steps: Option<f64>,
    /// Where and when the cutting section begins.
    pub start: Start,
    /// Revolutions of a block: [`BLOCK`], or fewer where there are very many nodes.
    block: f64,
    /// What the sampler prepared from the whole path.
    sampler_data: Vec<f64>,
    /// The state that a sequential sampler carries into each block; empty for others.
    sampler_states: Vec<Vec<f64>>,
}

impl<'a> Plan<'a> {
    /// Plans the law. Runs a sequential sampler once over the path to learn its states.
    pub fn new(
        chain: &'a Chain,
        preparation: &'a Preparation,
        observer: &dyn Observer,
    ) -> Result<Self> {
        if let Dependence::Overlap(nodes @ MOST_OVERLAP..) = chain.velocity.strategy.dependence() {
            let what = format!("an overlap of {nodes} nodes; it must be below {MOST_OVERLAP}");
            return Err(chain.velocity.bad_answer(what));
        }
        let law = seams::plan(chain, preparation, observer)?;
        let CutLaw { law, own } = match preparation.overrun {
            Overrun::Contact => taper(&law, &preparation.task),
            Overrun::None | Overrun::Length(_) => CutLaw::without_taper(law),
        };
        beyond::check(chain, preparation, &law)?;
        let mut plan = Self {
            chain,
            preparation,
            law,
            own,
            time_steps: None,
            start: Start::default(),
            block: BLOCK,
            sampler_data: Vec::new(),
            sampler_states: Vec::new(),
        };
        plan.sampler_data = plan.prepare_sampler()?;
        plan.block = plan.comfortable_block()?;
        if chain.sampler.strategy.dependence() == Dependence::Sequential {
            let mut state = Vec::new();
            for index in 0..plan.blocks() {
                stop_if_cancelled(observer)?;
                plan.sampler_states.push(state.clone());
                plan.sample_from(index, &mut state)?;
            }
        }
        Ok(plan)
    }

    fn prepare_sampler(&self) -> Result<Vec<f64>> {
        let sampler = &self.chain.sampler;
        let answer = sampler.strategy.prepare(&self.path(&self.law));
        answer.map_err(|error| sampler.failed("while it looked at the whole path", error))
    }

    /// Revolutions of a block, from the nodes of one revolution each at the path's start, middle
    /// and end. A sequential sampler can begin at the start only.
    fn comfortable_block(&self) -> Result<f64> {
        let last = (self.law.end() - 1.0).max(0.0).floor();
        let sequential = self.chain.sampler.strategy.dependence() == Dependence::Sequential;
        let count = if sequential { 1 } else { 3 };
        let mut densest = 0;
        for start in [0.0, (0.5 * last).floor(), last].into_iter().take(count) {
            let end = (start + 1.0).min(self.law.end());
            let nodes = self.ask_sampler(Revolutions { start, end }, &mut Vec::new())?;
            densest = densest.max(nodes.len());
        }
        let mut block = BLOCK;
        while block > 1.0 && block * densest as f64 > COMFORTABLE_BLOCK {
            block *= 0.5;
        }
        Ok(block)
    }

    fn path<'b>(&'b self, law: &'b SpiralLaw) -> Path<'b> {
        let Preparation { task, locus, .. } = self.preparation;
        Path {
            task,
            locus,
            law,
            prepared: &self.sampler_data,
        }
    }

    /// How many blocks there are.
    pub fn blocks(&self) -> usize {
        (self.law.end() / self.block).ceil() as usize
    }

    /// The revolutions of a block.
    pub fn revolutions(&self, index: usize) -> Revolutions {
        let start = index as f64 * self.block;
        Revolutions {
            start,
            end: (start + self.block).min(self.law.end()),
        }
    }

    /// A node and its time in the path. Where the controller has steps of time, the node is moved
    /// to the nearest step. The path's end is moved to the step before it, so that the path does
    /// not run beyond its end.
    pub fn on_time(&self, n: f64) -> (f64, f64) {
        let spindle = &self.preparation.task.spindle;
        let t = spindle.time_at(n);
        let Some(steps) = self.time_steps else {
            return (n, self.start.time + t);
        };
        let whole = if n < self.law.end() {
            (t * steps).round()
        } else {
            (t * steps).floor()
        };
        let moved = (whole / steps - t) * spindle.speed_at(n) / TAU;
        (n + moved, (self.start.time + whole) / steps)
    }

    /// Between which angles of C, rad, the law is the feed strategy's own.
    pub fn own_angles(&self) -> Option<[f64; 2]> {
        self.own
            .map(|own| own.map(|n| TAU * (n + self.start.turns)))
    }

    /// Revolutions of every block but the last.
    pub fn block(&self) -> f64 {
        self.block
    }

    /// Whether it is the path's last block.
    pub fn is_last(&self, index: usize) -> bool {
        index + 1 == self.blocks()
    }

    /// The sampler's nodes of a block, checked. The first block includes the path's first point.
    pub fn sample(&self, index: usize) -> Result<Vec<f64>> {
        let mut state = self.sampler_states.get(index).cloned().unwrap_or_default();
        self.sample_from(index, &mut state)
    }

    fn sample_from(&self, index: usize, state: &mut Vec<f64>) -> Result<Vec<f64>> {
        let mut nodes = self.ask_sampler(self.revolutions(index), state)?;
        self.check(index, &nodes)
            .map_err(|what| self.chain.sampler.bad_answer(what))?;
        if index == 0 {
            let too_early = nodes.iter().take_while(|node| **node < CLOSEST_NODES);
            nodes.splice(..too_early.count(), [0.0]);
        }
        Ok(nodes)
    }

    /// The sampler's nodes as it gives them.
    fn ask_sampler(&self, block: Revolutions, state: &mut Vec<f64>) -> Result<Vec<f64>> {
        let sampler = &self.chain.sampler;
        let window = self.law.window(block.start - 1.0, block.end + 1.0);
        let path = self.path(&window);
        let mut nodes = Vec::new();
        let answer = match sampler.strategy.dependence() {
            Dependence::Sequential => sampler
                .strategy
                .place_sequential(&path, block, state, &mut nodes),
            _ => sampler.strategy.place(&path, block, &mut nodes),
        };
        answer.map_err(|error| sampler.failed(in_revolutions(block), error))?;
        Ok(nodes)
    }

    fn check(&self, index: usize, nodes: &[f64]) -> std::result::Result<(), String> {
        let block = self.revolutions(index);
        let context = in_revolutions(block);
        if nodes.is_empty() && !self.is_last(index) {
            return Err(format!("no node {context}"));
        }
        if nodes.len() > MOST_NODES {
            return Err(format!(
                "{} nodes {context}; at most {MOST_NODES} are allowed",
                nodes.len()
            ));
        }
        let mut last: Option<f64> = None;
        for (i, node) in nodes.iter().enumerate() {
            if !node.is_finite() {
                return Err(format!("node {i} is {node}, {context}"));
            }
            if !(block.start..block.end).contains(node) {
                return Err(format!(
                    "node {i} at {node} lies outside the block, {context}"
                ));
            }
            if let Some(last) = last.filter(|last| node - last < CLOSEST_NODES) {
                return Err(format!(
                    "node {i} at {node} does not lie beyond {last}, {context}"
                ));
            }
            last = Some(*node);
        }
        Ok(())
    }
}

fn in_revolutions(block: Revolutions) -> String {
    format!("in revolutions {:.0} to {:.3}", block.start, block.end)
}
