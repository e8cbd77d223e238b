//! The shortest path over the states of the nodes of one span.

use turnpath_plugin::hermite::SHORTEST;
use turnpath_plugin::prelude::*;

use crate::grid::{LEAST_NEAR_SEAMS, too_short};
use crate::place::Place;
use crate::reach::Reach;
use crate::segment::holds;
use crate::state::{ON_LOCUS, State};

/// Inner nodes stay this part of a natural step away from the span's end. Otherwise a node could lie
/// beside the end, with absurd accelerations between the two.
const CLEAR_OF_END: f64 = 0.4;
/// A step that must be found is halved no further than this part of the shortest one.
const HALF: f64 = 0.5;

/// Where a chain of steps has got to in one state.
#[derive(Debug, Clone, Copy)]
struct Front {
    place: Place,
    /// The state of the node before.
    from: usize,
}

/// One number of nodes: how far the chains get in each state.
type Layer = Vec<Option<Front>>;

/// The search along one span.
pub struct Search<'a> {
    reach: &'a Reach<'a>,
    states: &'static [State],
    misfit: Misfit,
    layers: Vec<Layer>,
    /// The last step from each state to each other, in revolutions.
    last: Vec<f64>,
}

impl<'a> Search<'a> {
    /// A search with these states, the first of which is on the locus.
    pub fn new(reach: &'a Reach<'a>, states: &'static [State], misfit: Misfit) -> Self {
        let first = reach.table.n.first().copied().unwrap_or_default();
        Self {
            reach,
            states,
            misfit,
            layers: Vec::new(),
            last: vec![reach.scale.at(first); states.len() * states.len()],
        }
    }

    /// Appends the nodes of the span to `nodes`, its start included and its end excluded.
    ///
    /// # Errors
    /// If the path needs steps that are too short.
    pub fn run(mut self, nodes: &mut NodeList) -> Result<()> {
        let table = self.reach.table;
        let start = table.border(table.n.first().copied().unwrap_or_default())?;
        let end = table.border(table.end())?;
        let mut layer: Layer = vec![None; self.states.len()];
        layer[0] = Some(Front {
            place: start,
            from: 0,
        });
        loop {
            let ending = self.ending(&layer, end);
            let next = match ending {
                Some(_) => Layer::new(),
                None => self.next(&layer, end)?,
            };
            self.layers.push(layer);
            match ending {
                Some(state) => {
                    self.trace(state, nodes);
                    return Ok(());
                }
                None => layer = next,
            }
        }
    }

    fn node(&self, front: &Front, state: usize) -> crate::segment::Node {
        self.reach.node(front.place, self.states[state])
    }

    /// The first state from which one step ends the span.
    fn ending(&self, layer: &Layer, end: Place) -> Option<usize> {
        let last = self.reach.node(end, ON_LOCUS);
        let limits = self.reach.table.limits;
        let ends = |(state, front): (usize, &Option<Front>)| {
            let front = front.as_ref()?;
            let near = end.n - front.place.n <= limits.max_step;
            (near && holds(self.reach.table, &self.node(front, state), &last)).then_some(state)
        };
        layer.iter().enumerate().find_map(ends)
    }

    /// The fronts with one node more.
    fn next(&mut self, layer: &Layer, end: Place) -> Result<Layer> {
        let clear = end.n - CLEAR_OF_END * self.reach.scale.at(end.n);
        let mut next: Layer = vec![None; self.states.len()];
        for (to, slot) in next.iter_mut().enumerate() {
            for (from, front) in layer.iter().enumerate() {
                if let Some(front) = front
                    && let Some(place) = self.longest((from, front), to, clear, slot.as_ref())
                {
                    *slot = Some(Front { place, from });
                }
            }
        }
        let furthest = next.iter().flatten().map(|front| front.place.n);
        match furthest.reduce(f64::max) {
            Some(furthest) => {
                let least = furthest - self.reach.scale.at(furthest);
                for slot in &mut next {
                    *slot = slot.filter(|front| front.place.n >= least);
                }
            }
            None => next[0] = Some(self.forced(layer, end)?),
        }
        Ok(next)
    }

    /// The longest step between two states that gets further than the best so far.
    fn longest(
        &mut self,
        (from, front): (usize, &Front),
        to: usize,
        clear: f64,
        best: Option<&Front>,
    ) -> Option<Place> {
        let limit = self.reach.table.limits.max_step.min(clear - front.place.n);
        if limit <= 0.0 {
            return None;
        }
        let pair = from * self.states.len() + to;
        let best = best.map(|best| best.place.n);
        let node = self.node(front, from);
        let range = (limit, self.last[pair]);
        let place = self.reach.longest(&node, self.states[to], range, best)?;
        self.last[pair] = place.n - front.place.n;
        Some(place)
    }

    /// A step to the locus from the furthest front, as short as it takes. Only where the path has a
    /// kink no other step is left.
    fn forced(&self, layer: &Layer, end: Place) -> Result<Front> {
        let fronts = layer.iter().enumerate();
        let fronts = fronts.filter_map(|(from, front)| front.map(|front| (from, front)));
        let furthest = fronts.max_by(|a, b| a.1.place.n.total_cmp(&b.1.place.n));
        let Some((from, front)) = furthest else {
            return Err(StrategyError::failed("no step can be found"));
        };
        let node = self.node(&front, from);
        let shortest = match self.misfit {
            Misfit::Refuse => SHORTEST,
            Misfit::CutWhatFits => LEAST_NEAR_SEAMS,
        } / TAU;
        let mut length = (HALF * (end.n - front.place.n)).min(self.reach.scale.at(front.place.n));
        loop {
            let place = self.reach.table.place(front.place.n + length);
            if holds(self.reach.table, &node, &self.reach.node(place, ON_LOCUS)) {
                return Ok(Front { place, from });
            }
            if length <= shortest {
                return match self.misfit {
                    Misfit::CutWhatFits => Ok(Front { place, from }),
                    Misfit::Refuse => Err(too_short(front.place.n, TAU * length)),
                };
            }
            length = (HALF * length).max(shortest);
        }
    }

    /// Appends the chain that ends in `state` of the last layer.
    fn trace(&self, mut state: usize, nodes: &mut NodeList) {
        let mut chain = Vec::with_capacity(self.layers.len());
        for layer in self.layers.iter().rev() {
            let Some(front) = &layer[state] else { break };
            let node = self.node(front, state);
            let offset = NodeOffset {
                dz: node.dz,
                dz_dc: node.dz_rate / front.place.c_rate,
            };
            chain.push((front.place.n, offset));
            state = front.from;
        }
        for (n, offset) in chain.into_iter().rev() {
            match offset == NodeOffset::default() {
                true => nodes.push(n),
                false => nodes.push_off(n, offset),
            }
        }
    }
}
