//! What every block is made from: the chain, the task, the locus, the law, and the borders of the
//! blocks.

use std::f64::consts::TAU;

use rayon::prelude::*;
use turnpath_core::toolpath::SegmentShape;
use turnpath_core::{
    Dependence, NodeList, Overrun, Path, Revolutions, SamplerPlan, SpindleLaw, SpiralLaw,
};

use crate::held_nodes::HeldNodes;
use crate::node_check::{CLOSEST_NODES, NodeCheck, in_revolutions};
use crate::observer::{Observer, stop_if_cancelled};
use crate::order::one_at_a_time;
use crate::repeated_blocks::RepeatedBlocks;
use crate::size::check_points;
use crate::taper::{CutLaw, taper};
use crate::{Chain, Preparation, Result, beyond, seams, spindle};

/// Revolutions of a block. A sampler starts afresh at each border, which costs AST-50 a tenth of
/// a percent of points; larger blocks take more memory and leave less to do in parallel.
pub const BLOCK: f64 = 64.0;
/// Revolutions of the last block, at least. What is left of a path is a part of the block before: where a law
/// ends a rounding behind whole revolutions, no sampler has a step that short.
const SHORTEST_BLOCK: f64 = 1e-4;
/// Nodes of a block above which it takes half the revolutions, down to one, so that memory stays
/// bounded on the finest paths. The choice depends on the task alone, so the bytes do not depend on
/// the machine.
const COMFORTABLE_BLOCK: f64 = 50_000.0;
/// Nodes that a block of a sample has where they are densest, at least; it has whole revolutions. With 30 of
/// them the sizes that `check` says of the table of points err by up to 2.3 % for the recipes of the
/// documentation, and nine other lens arrays by 4.7 % in the mean square. With 8 it was 6.5 % for these.
const NODES_OF_SAMPLED_BLOCK: f64 = 30.0;
/// Most numbers for nodes that are held in memory while a path is planned, refined and written: 160
/// MB. A node on the path takes one, and a node beside it three. The sampler of a longer path is asked
/// again in every pass.
const MOST_HELD: f64 = 2e7;
/// The memory that a block takes before its nodes are held, in numbers.
const NUMBERS_OF_BLOCK: f64 = 11.0;
/// The nodes of a sequential sampler so far foretell those of the whole path, and what they foretell is divided by
/// this before it counts. A smaller number would refuse inward paths whose first revolutions have the most nodes: of
/// evenly spaced ones twice the mean. A larger number would refuse later.
const CAUTION: f64 = 4.0;
/// An overlap that is too large for a velocity solver. A spline needs 64 nodes; a solver that needs
/// thousands is sequential.
const MOST_OVERLAP: usize = 10_000;
/// Places a turn at which two laws of the spindle are compared.
const PLACES_A_TURN: f64 = 4.0;
/// Two laws differ by a factor alone if their ratio changes by no more than this part from place to place.
/// The error of a cubic then changes by about the same part, and samplers leave 2 % of the tolerance free.
/// A larger part leaves points to refinement: 2.5e-3 left 0.21 % of all on OAP-213, and this leaves 0.05 %
/// for half as many series more.
const LARGEST_CHANGE: f64 = 7.5e-4;

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
    /// t(N).
    pub spindle: SpindleLaw,
    /// The spindle law that the sampler sees: the one at which its nodes were placed.
    placed_for: SpindleLaw,
    /// Between which revolutions the law is the feed strategy's own; `None` if no part is.
    pub own: Option<[f64; 2]>,
    /// Steps of time a second on which control points must lie, if the controller has such steps.
    pub time_steps: Option<f64>,
    /// Where and when the cutting section begins.
    pub start: Start,
    /// Revolutions of a block: [`BLOCK`], or fewer where there are very many nodes.
    block: f64,
    /// Revolutions of the last block, at least.
    shortest_last: f64,
    /// Nodes of a revolution where they are densest: of a sequential sampler in the densest block, and of others
    /// at the path's start, middle and end.
    density: f64,
    /// The sampler's plan of the whole path.
    sampler: Box<dyn SamplerPlan>,
    /// The state that a sequential sampler carries into each block; empty for others.
    sampler_states: Vec<Vec<f64>>,
    /// The nodes of each block while they are held; empty while they are not.
    held: Vec<HeldNodes>,
    /// Which blocks repeat halvings of a sample; none where there is no sample, or where its sampler is
    /// sequential.
    repeated: Option<RepeatedBlocks>,
    /// Whether blocks repeat nodes too.
    repeats_nodes: bool,
}

impl<'a> Plan<'a> {
    /// Plans the laws and the nodes. The spindle strategy gets no factors yet. A sequential sampler
    /// runs over the path, so that its states are known.
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
        let spindle = spindle::plan(chain, preparation, &law, &[])?;
        let sampler = plan_nodes(chain, preparation, &law, &spindle)?;
        let mut plan = Self {
            chain,
            preparation,
            law,
            placed_for: spindle.clone(),
            spindle,
            own,
            time_steps: None,
            start: Start::default(),
            block: BLOCK,
            shortest_last: SHORTEST_BLOCK,
            density: 0.0,
            sampler,
            sampler_states: Vec::new(),
            held: Vec::new(),
            repeated: None,
            repeats_nodes: false,
        };
        plan.divide(observer)?;
        Ok(plan)
    }

    /// Takes another spindle law. The nodes stay where they are: with other nodes the played axes
    /// would have other peaks.
    pub fn take_spindle(&mut self, spindle: SpindleLaw) {
        self.spindle = spindle;
    }

    /// Lets the sampler place its nodes again, for the present spindle law. They are held if those
    /// before were. Held nodes stay in a block in which the law changes by a factor alone: a factor does
    /// not change how Z and X belong to C.
    pub fn place_again(&mut self, observer: &dyn Observer) -> Result<()> {
        let Self {
            chain,
            preparation,
            block,
            ..
        } = *self;
        let before = std::mem::replace(&mut self.placed_for, self.spindle.clone());
        self.sampler = plan_nodes(chain, preparation, &self.law, &self.placed_for)?;
        let held = std::mem::take(&mut self.held);
        self.divide(observer)?;
        if held.is_empty() {
            return Ok(());
        }
        self.hold_nodes();
        if self.block != block || self.sampler.dependence() != Dependence::Local {
            return Ok(());
        }
        for (index, nodes) in held.into_iter().enumerate() {
            let stays = changes_by_a_factor(&before, &self.placed_for, self.revolutions(index));
            if let (true, Some(held)) = (stays, self.held.get_mut(index)) {
                *held = nodes;
            }
        }
        Ok(())
    }

    /// Holds the nodes of each block as the sampler places them, so that it is not asked again. A
    /// path whose nodes take more than [`MOST_HELD`] numbers holds none.
    pub fn hold_nodes(&mut self) {
        let numbers = match self.chain.sampler.strategy.needs_exact_rates() {
            true => 3.0,
            false => 1.0,
        };
        if !self.holds_nodes() && numbers * self.density * self.law.end() <= MOST_HELD {
            self.held = (0..self.blocks()).map(|_| HeldNodes::default()).collect();
        }
    }

    /// Divides the path into small blocks, of which a sample is taken. Those of a sequential sampler
    /// stay, as it has run over them already, and so do blocks whose nodes are held.
    pub fn divide_for_sample(&mut self) {
        if self.keeps_its_blocks() {
            return;
        }
        while self.block > 1.0 && 0.5 * self.block * self.density >= NODES_OF_SAMPLED_BLOCK {
            self.block *= 0.5;
            // In the path the rest of such a block is the end of a long one.
            self.shortest_last = 0.5 * self.block;
        }
    }

    /// Holds the nodes of a sample. The blocks that are not of it get the halvings of
    /// [repeated blocks](RepeatedBlocks). They get their nodes too, whole revolutions on, if each repeated block
    /// begins with a node at its start. Otherwise the sampler does not begin afresh at each block, and places
    /// all nodes itself.
    pub fn repeat(&mut self, blocks: RepeatedBlocks) -> Result<()> {
        if self.keeps_its_blocks() {
            return Ok(());
        }
        if self.blocks() as f64 * NUMBERS_OF_BLOCK <= MOST_HELD {
            self.held = (0..self.blocks()).map(|_| HeldNodes::default()).collect();
        }
        let begins_afresh = |index: usize| {
            let nodes = self.own_nodes(index)?;
            let first = nodes.revolutions().first();
            let start = self.revolutions(index).start;
            Ok(first.is_some_and(|first| first - start < CLOSEST_NODES))
        };
        let repeated = blocks.repeated().par_iter();
        let begin_afresh: Vec<bool> = one_at_a_time(repeated.map(|index| begins_afresh(*index)))?;
        self.repeats_nodes = begin_afresh.into_iter().all(|is| is);
        self.repeated = Some(blocks);
        Ok(())
    }

    /// Whether the blocks stay as they are: the sampler has run over them, or their nodes are held.
    fn keeps_its_blocks(&self) -> bool {
        self.sampler.dependence() == Dependence::Sequential || self.holds_nodes()
    }

    /// Divides the path into blocks, and learns the states of a sequential sampler.
    fn divide(&mut self, observer: &dyn Observer) -> Result<()> {
        (self.block, self.shortest_last) = (BLOCK, SHORTEST_BLOCK);
        self.look_at_density()?;
        self.shorten_blocks();
        self.sampler_states = Vec::new();
        (self.repeated, self.repeats_nodes) = (None, false);
        match self.sampler.dependence() {
            Dependence::Sequential => self.learn_states(observer),
            _ => Ok(()),
        }
    }

    /// Learns the states of a sequential sampler. Its first revolution may have far fewer nodes than others, so blocks
    /// may turn out to be too long.
    fn learn_states(&mut self, observer: &dyn Observer) -> Result<()> {
        loop {
            self.run_over_nodes(observer)?;
            if !self.shorten_blocks() {
                return Ok(());
            }
        }
    }

    /// Runs a sequential sampler over the path: its states at all blocks, and where its nodes are densest.
    fn run_over_nodes(&mut self, observer: &dyn Observer) -> Result<()> {
        let (mut state, mut states) = (Vec::new(), Vec::new());
        let mut nodes = 0;
        for index in 0..self.blocks() {
            stop_if_cancelled(observer)?;
            states.push(state.clone());
            let Revolutions { start, end } = self.revolutions(index);
            let own = self.place_from(index, &mut state)?.len();
            // The last block may be a small part of a revolution.
            self.density = self.density.max(own as f64 / (end - start).max(1.0));
            nodes += own;
            let foretold = (nodes as f64 / end) / CAUTION;
            let revolutions = self.law.end();
            let placed = nodes as f64 / revolutions;
            check_points(self.distance(), revolutions, placed.max(foretold))?;
        }
        self.sampler_states = states;
        Ok(())
    }

    /// Halves the revolutions of a block until few nodes lie on them where they are densest. Says whether it did.
    fn shorten_blocks(&mut self) -> bool {
        let before = self.block;
        while self.block > 1.0 && self.block * self.density > COMFORTABLE_BLOCK {
            self.block *= 0.5;
        }
        self.block < before
    }

    /// How far the path feeds on the part, mm.
    fn distance(&self) -> f64 {
        let range = self.preparation.task.range;
        range.outer - range.inner
    }

    /// Counts the nodes of one revolution each at the path's start, middle and end. A sequential sampler can
    /// begin at the start only.
    fn look_at_density(&mut self) -> Result<()> {
        let last = (self.law.end() - 1.0).max(0.0).floor();
        let sequential = self.sampler.dependence() == Dependence::Sequential;
        let count = if sequential { 1 } else { 3 };
        let starts = [0.0, (0.5 * last).floor(), last]
            .into_par_iter()
            .take(count);
        let nodes = one_at_a_time(starts.map(|start| {
            let end = (start + 1.0).min(self.law.end());
            let nodes = self.ask_sampler(Revolutions { start, end }, &mut Vec::new())?;
            Ok(nodes.len())
        }))?;
        let [sparsest, densest] = [nodes.iter().min(), nodes.iter().max()]
            .map(|nodes| nodes.map_or(0.0, |nodes| *nodes as f64));
        self.density = densest;
        match sequential {
            true => Ok(()),
            false => check_points(self.distance(), self.law.end(), sparsest),
        }
    }

    /// What the controller plays between control points.
    pub fn segment_shape(&self) -> SegmentShape {
        self.chain.velocity.strategy.segments()
    }

    /// How many blocks there are.
    pub fn blocks(&self) -> usize {
        let blocks = (self.law.end() / self.block).ceil() as usize;
        let of_last = self.law.end() - blocks.saturating_sub(1) as f64 * self.block;
        match of_last < self.shortest_last {
            true => blocks.saturating_sub(1).max(1),
            false => blocks,
        }
    }

    /// The revolutions of a block.
    pub fn revolutions(&self, index: usize) -> Revolutions {
        let start = index as f64 * self.block;
        Revolutions {
            start,
            end: match self.is_last(index) {
                true => self.law.end(),
                false => start + self.block,
            },
        }
    }

    /// A node and its time in the path. Where the controller has steps of time, the node is moved
    /// to the nearest step. The path's end is moved to the step before it, so that the path does
    /// not run beyond its end.
    pub fn on_time(&self, n: f64) -> (f64, f64) {
        self.moved_on_time(n, self.spindle.time_at(n))
    }

    /// What [`on_time`](Self::on_time) gives for a node `n` whose time since the cut's start is `t`, s.
    pub fn moved_on_time(&self, n: f64, t: f64) -> (f64, f64) {
        let Some(steps) = self.time_steps else {
            return (n, self.start.time + t);
        };
        let whole = if n < self.law.end() {
            (t * steps).round()
        } else {
            (t * steps).floor()
        };
        let moved = self.spindle.revolutions_at(whole / steps, n);
        (moved, (self.start.time + whole) / steps)
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

    /// Whether nodes are held.
    pub fn holds_nodes(&self) -> bool {
        !self.held.is_empty()
    }

    /// Places the nodes of a block that will be wanted, where nodes are held and no thread has begun to.
    pub fn place_ahead(&self, index: usize) {
        if let Some(held) = self.held.get(index) {
            held.place_ahead(|| self.place(index));
        }
    }

    /// The sampler's nodes of a block, checked. The first block includes the path's first point.
    pub fn nodes(&self, index: usize) -> Result<NodeList> {
        let repeated = self.repeated.as_ref().filter(|_| self.repeats_nodes);
        let source = repeated.map_or(index, |blocks| blocks.source(index));
        if source == index {
            return self.own_nodes(index);
        }
        let turns = self.revolutions(index).start - self.revolutions(source).start;
        Ok(self.own_nodes(source)?.turned_on(turns))
    }

    /// Whether a sample repeats nodes. Its sampler begins afresh at each block.
    pub fn repeats_nodes(&self) -> bool {
        self.repeats_nodes
    }

    /// The block whose segments are halved as often as those of a block: itself, unless a sample repeats
    /// halvings.
    pub fn halved_as(&self, index: usize) -> usize {
        let repeated = self.repeated.as_ref();
        repeated.map_or(index, |blocks| blocks.halved_as(index))
    }

    fn own_nodes(&self, index: usize) -> Result<NodeList> {
        match self.held.get(index) {
            Some(held) => held.get_or_place(|| self.place(index)),
            None => self.place(index),
        }
    }

    fn place(&self, index: usize) -> Result<NodeList> {
        let mut state = self.sampler_states.get(index).cloned().unwrap_or_default();
        self.place_from(index, &mut state)
    }

    fn place_from(&self, index: usize, state: &mut Vec<f64>) -> Result<NodeList> {
        let mut nodes = self.ask_sampler(self.revolutions(index), state)?;
        let check = NodeCheck {
            block: self.revolutions(index),
            is_last: self.is_last(index),
            tolerance: self.preparation.task.tolerance.interpolation,
            allows_offsets: self.chain.sampler.strategy.needs_exact_rates(),
        };
        check
            .check(&nodes)
            .map_err(|what| self.chain.sampler.bad_answer(what))?;
        if index == 0 {
            let on_start = |node: &&f64| **node < CLOSEST_NODES;
            let too_early = nodes.revolutions().iter().take_while(on_start).count();
            nodes.replace_first(too_early, 0.0);
        }
        Ok(nodes)
    }

    /// The sampler's nodes as it gives them.
    fn ask_sampler(&self, block: Revolutions, state: &mut Vec<f64>) -> Result<NodeList> {
        let Preparation { task, locus, .. } = self.preparation;
        let (from, to) = (block.start - 1.0, block.end + 1.0);
        let path = Path {
            task,
            locus,
            law: &self.law.window(from, to),
            spindle: &self.placed_for.window(from, to),
        };
        let mut nodes = NodeList::default();
        let answer = match self.sampler.dependence() {
            Dependence::Sequential => {
                (self.sampler).place_sequential(&path, block, state, &mut nodes)
            }
            _ => self.sampler.place(&path, block, &mut nodes),
        };
        let failed = |error| self.chain.sampler.failed(in_revolutions(block), error);
        answer.map_err(failed)?;
        Ok(nodes)
    }
}

/// Whether the speed of one law is a multiple of that of another all over a block.
fn changes_by_a_factor(one: &SpindleLaw, other: &SpindleLaw, block: Revolutions) -> bool {
    let places = ((block.end - block.start) * PLACES_A_TURN).ceil();
    let at = |place: u32| (block.start + f64::from(place) / PLACES_A_TURN).min(block.end);
    let factor = |n: f64| other.speed_at(n) / one.speed_at(n);
    (0..places as u32).all(|place| {
        let [from, to] = [at(place), at(place + 1)].map(factor);
        (to / from - 1.0).abs() <= LARGEST_CHANGE
    })
}

/// Lets the sampler look at the whole path.
fn plan_nodes(
    chain: &Chain,
    preparation: &Preparation,
    law: &SpiralLaw,
    spindle: &SpindleLaw,
) -> Result<Box<dyn SamplerPlan>> {
    let Preparation { task, locus, .. } = preparation;
    let path = Path {
        task,
        locus,
        law,
        spindle,
    };
    let plan = chain.sampler.strategy.plan(&path);
    let context = "while it looked at the whole path";
    plan.map_err(|error| chain.sampler.failed(context, error))
}
