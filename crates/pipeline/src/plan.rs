//! What every block is made from: chain, job, locus, law, and the blocks' borders.

use turnpath_core::{Dependence, Path, Revolutions, SpiralLaw};

use crate::{Chain, Prepared, Result};

/// Revolutions of a block. A sampler starts afresh at each border, which costs AST-50 a tenth of
/// a percent of points; larger blocks take more memory and leave less to do in parallel.
pub const BLOCK: f64 = 64.0;
/// Nodes closer together than this part of a revolution are a sampler's mistake: the velocity
/// between them would be rounding.
pub const CLOSEST_NODES: f64 = 1e-9;

/// A job with its law.
pub struct Plan<'a> {
    /// The strategies.
    pub chain: &'a Chain,
    /// Job, locus, first touch.
    pub prepared: &'a Prepared,
    /// ρ = ℓ(N).
    pub law: SpiralLaw,
    /// What the sampler found on the whole path.
    pub prepared_sampler: Vec<f64>,
    /// What a sequential sampler carries into each block; empty for others.
    pub sampler_states: Vec<Vec<f64>>,
}

impl<'a> Plan<'a> {
    /// Plans the law; runs a sequential sampler once through to learn its states.
    pub fn new(chain: &'a Chain, prepared: &'a Prepared) -> Result<Self> {
        let law = crate::law::plan(chain, &prepared.job, &prepared.locus)?;
        let mut plan = Self {
            chain,
            prepared,
            law,
            prepared_sampler: Vec::new(),
            sampler_states: Vec::new(),
        };
        plan.prepared_sampler = plan.prepare_sampler()?;
        if chain.sampler.strategy.dependence() == Dependence::Sequential {
            let mut state = Vec::new();
            for index in 0..plan.blocks() {
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

    fn path<'b>(&'b self, law: &'b SpiralLaw) -> Path<'b> {
        let Prepared { job, locus, .. } = self.prepared;
        let prepared = &self.prepared_sampler;
        Path {
            job,
            locus,
            law,
            prepared,
        }
    }

    /// How many blocks there are.
    pub fn blocks(&self) -> usize {
        (self.law.end() / BLOCK).ceil() as usize
    }

    /// The revolutions of a block.
    pub fn revolutions(&self, index: usize) -> Revolutions {
        let start = index as f64 * BLOCK;
        Revolutions {
            start,
            end: (start + BLOCK).min(self.law.end()),
        }
    }

    /// Whether it is the path's last block.
    pub fn is_last(&self, index: usize) -> bool {
        index + 1 == self.blocks()
    }

    /// The sampler's nodes of a block, checked; the path's first point is among them.
    pub fn sample(&self, index: usize) -> Result<Vec<f64>> {
        let mut state = self.sampler_states.get(index).cloned().unwrap_or_default();
        self.sample_from(index, &mut state)
    }

    fn sample_from(&self, index: usize, state: &mut Vec<f64>) -> Result<Vec<f64>> {
        let (sampler, block) = (&self.chain.sampler, self.revolutions(index));
        let window = self.law.window(block.start - 1.0, block.end + 1.0);
        let path = self.path(&window);
        let mut nodes = Vec::new();
        let answer = match sampler.strategy.dependence() {
            Dependence::Sequential => sampler
                .strategy
                .place_onward(&path, block, state, &mut nodes),
            _ => sampler.strategy.place(&path, block, &mut nodes),
        };
        answer.map_err(|error| sampler.failed(place_of(block), error))?;
        self.check(index, &nodes)
            .map_err(|what| sampler.bad_answer(what))?;
        if index == 0 {
            let too_early = nodes.iter().take_while(|node| **node < CLOSEST_NODES);
            nodes.splice(..too_early.count(), [0.0]);
        }
        Ok(nodes)
    }

    fn check(&self, index: usize, nodes: &[f64]) -> std::result::Result<(), String> {
        let block = self.revolutions(index);
        let place = place_of(block);
        if nodes.is_empty() && !self.is_last(index) {
            return Err(format!("no node {place}"));
        }
        let mut last: Option<f64> = None;
        for (i, node) in nodes.iter().enumerate() {
            if !node.is_finite() {
                return Err(format!("node {i} is {node}, {place}"));
            }
            if !(block.start..block.end).contains(node) {
                return Err(format!(
                    "node {i} at {node} lies outside the block, {place}"
                ));
            }
            if let Some(last) = last.filter(|last| node - last < CLOSEST_NODES) {
                return Err(format!(
                    "node {i} at {node} does not lie beyond {last}, {place}"
                ));
            }
            last = Some(*node);
        }
        Ok(())
    }
}

fn place_of(block: Revolutions) -> String {
    format!("in revolutions {:.0} to {:.3}", block.start, block.end)
}
