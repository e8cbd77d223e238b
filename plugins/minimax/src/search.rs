//! The shortest path over the states of the nodes of one span.

use turnpath_plugin::hermite::SHORTEST;
use turnpath_plugin::prelude::*;

use crate::grid::{LEAST_NEAR_SEAMS, too_short};
use crate::place::Place;
use crate::reach::{Reach, StepRange};
use crate::segment::{Node, holds, holds_tolerance};
use crate::state::{ON_LOCUS, State};

/// A step to or from a node beside the locus is no shorter than this part of a natural step, and
/// inner nodes stay so far away from the span's end. Otherwise nodes could lie beside each other with
/// absurd accelerations between them.
const LEAST: f64 = 0.4;
/// A step from the locus to the locus is looked for down to this part of a natural step. Where the
/// path has a kink, a step may be shorter.
const LEAST_ON_LOCUS: f64 = 0.02;
/// Nodes beside the locus are tried where a natural step takes more than this part of the tolerance
/// on both sides. Elsewhere a step between two nodes on the locus takes a fifth of it at the most, and
/// the largest step or X decides.
const WORTH: f64 = 0.5;
/// A step that must be found is halved no further than this part of the shortest one.
const HALF: f64 = 0.5;
/// By this part a step may exceed the largest one at the end of a span: rounding.
const ROUNDING: f64 = 1e-9;

/// Where a chain of steps has got to in one state.
#[derive(Debug, Clone, Copy)]
struct Front {
    place: Place,
    /// The state of the node before.
    from: usize,
}

/// What all steps from one front have in common.
struct Start {
    node: Node,
    /// The shorter of the natural steps at both ends of a natural step, in revolutions.
    natural: f64,
    /// How long a step may be, in revolutions.
    room: f64,
    /// Whether nodes beside the locus are tried.
    is_worth: bool,
}

/// One number of nodes: how far the chains get in each state.
type Layer = Vec<Option<Front>>;

/// A node of a chain: where it is, and the state of the node before.
type Past = Option<(f64, u8)>;

/// The search along one span.
pub struct Search<'a> {
    reach: &'a Reach<'a>,
    states: &'static [State],
    /// The shortest step, in revolutions.
    shortest: f64,
    misfit: Misfit,
    layers: Vec<Box<[Past]>>,
    /// The last step from each state to each other, in revolutions.
    last: Vec<f64>,
}

impl<'a> Search<'a> {
    /// A search with these states, the first of which is on the locus.
    pub fn new(reach: &'a Reach<'a>, states: &'static [State], misfit: Misfit) -> Self {
        let first = reach.table.n.first().copied().unwrap_or_default();
        let shortest = match misfit {
            Misfit::Refuse => SHORTEST,
            Misfit::CutWhatFits => SHORTEST.min(LEAST_NEAR_SEAMS),
        };
        Self {
            reach,
            states,
            shortest: shortest / TAU,
            misfit,
            layers: Vec::new(),
            last: vec![reach.natural.at(first); states.len() * states.len()],
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
        // Every step is longer than half of the shortest one, so no chain has more nodes.
        let most = ((end.n - start.n) / (HALF * self.shortest)).ceil() as usize + 1;
        let mut layer: Layer = vec![None; self.states.len()];
        layer[0] = Some(Front {
            place: start,
            from: 0,
        });
        while self.layers.len() <= most {
            let ending = self.ending(&layer, end);
            let next = match ending {
                Some(_) => Layer::new(),
                None => self.next(&layer, end)?,
            };
            self.layers.push(past(&layer));
            match ending {
                Some(state) => {
                    self.trace(state, nodes);
                    return Ok(());
                }
                None => layer = next,
            }
        }
        Err(too_short(end.n, TAU * self.shortest))
    }

    fn node(&self, front: &Front, state: usize) -> Node {
        self.reach.node(front.place, self.states[state])
    }

    /// The first state from which one step ends the span.
    fn ending(&self, layer: &Layer, end: Place) -> Option<usize> {
        let last = self.reach.node(end, ON_LOCUS);
        let most = self.reach.table.limits.max_step * (1.0 + ROUNDING);
        // Only steps that had to be found lie so close to the end.
        let least = LEAST * self.reach.natural.at(end.n);
        let ends = |(state, front): (usize, &Option<Front>)| {
            let front = front.as_ref()?;
            let length = end.n - front.place.n;
            if length > most.max(least) {
                return None;
            }
            let node = self.node(front, state);
            let held = match length < least {
                true => holds_tolerance(self.reach.table, &node, &last),
                false => length <= most && holds(self.reach.table, &node, &last),
            };
            held.then_some(state)
        };
        layer.iter().enumerate().find_map(ends)
    }

    /// The fronts with one node more.
    fn next(&mut self, layer: &Layer, end: Place) -> Result<Layer> {
        let clear = end.n - LEAST * self.reach.natural.at(end.n);
        let mut next: Layer = vec![None; self.states.len()];
        let start =
            |(from, front): (usize, &Option<Front>)| self.start(from, front.as_ref()?, clear);
        let starts: Vec<Option<Start>> = layer.iter().enumerate().map(start).collect();
        for (to, slot) in next.iter_mut().enumerate() {
            for (from, start) in starts.iter().enumerate() {
                if let Some(start) = start
                    && let Some(place) = self.longest((from, start), to, slot.as_ref())
                {
                    *slot = Some(Front { place, from });
                }
            }
        }
        let furthest = next.iter().flatten().map(|front| front.place.n);
        match furthest.reduce(f64::max) {
            Some(furthest) => {
                let least = furthest - self.reach.natural.at(furthest);
                // The front on the locus stays: from there a step of any length may go on.
                for slot in &mut next[1..] {
                    *slot = slot.filter(|front| front.place.n >= least);
                }
            }
            None => next[0] = Some(self.forced(layer, end)?),
        }
        Ok(next)
    }

    /// The start of steps up to `clear`, or `None` if none of them is long enough.
    fn start(&self, from: usize, front: &Front, clear: f64) -> Option<Start> {
        let steps = self.reach.natural;
        let step = steps.at(front.place.n);
        let ahead = front.place.n + step;
        let natural = step.min(steps.at(ahead));
        let room = clear - front.place.n;
        (room >= LEAST * natural).then(|| Start {
            node: self.node(front, from),
            natural,
            room,
            is_worth: steps.part_at(ahead) >= WORTH,
        })
    }

    /// The longest step between two states that gets further than the best so far.
    fn longest(
        &mut self,
        (from, start): (usize, &Start),
        to: usize,
        best: Option<&Front>,
    ) -> Option<Place> {
        if to != 0 && !start.is_worth {
            return None;
        }
        let pair = from * self.states.len() + to;
        let range = StepRange {
            least: match (from, to) {
                (0, 0) => (LEAST_ON_LOCUS * start.natural).max(self.shortest),
                _ => LEAST * start.natural,
            },
            most: self.reach.table.limits.max_step.min(start.room),
            last: self.last[pair],
        };
        if range.most < range.least {
            return None;
        }
        let best = best.map(|best| best.place.n);
        let node = &start.node;
        let place = self.reach.longest(node, self.states[to], range, best)?;
        self.last[pair] = place.n - node.place.n;
        Some(place)
    }

    /// A step to the locus, as short as it takes. Only where the path has a kink no other step is
    /// left. It begins on the locus if a front lies there: beside it a short step shakes Z.
    fn forced(&self, layer: &Layer, end: Place) -> Result<Front> {
        let fronts = layer.iter().enumerate();
        let fronts = fronts.filter_map(|(from, front)| front.map(|front| (from, front)));
        let furthest = fronts.max_by(|a, b| a.1.place.n.total_cmp(&b.1.place.n));
        let on_locus = layer[0].map(|front| (0, front));
        let Some((from, front)) = on_locus.or(furthest) else {
            return Err(StrategyError::failed("no step can be found"));
        };
        let node = self.node(&front, from);
        let shortest = match self.misfit {
            Misfit::Refuse => SHORTEST,
            Misfit::CutWhatFits => LEAST_NEAR_SEAMS,
        } / TAU;
        let room = HALF * (end.n - front.place.n);
        let mut length = room.min(self.reach.natural.at(front.place.n));
        loop {
            let place = self.reach.table.place(front.place.n + length);
            if holds_tolerance(self.reach.table, &node, &self.reach.node(place, ON_LOCUS)) {
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
            let Some(Some((n, from))) = layer.get(state) else {
                break;
            };
            chain.push((*n, self.offset(*n, state)));
            state = usize::from(*from);
        }
        for (n, offset) in chain.into_iter().rev() {
            match offset == NodeOffset::default() {
                true => nodes.push(n),
                false => nodes.push_off(n, offset),
            }
        }
    }

    fn offset(&self, n: f64, state: usize) -> NodeOffset {
        if state == 0 {
            return NodeOffset::default();
        }
        let place = self.reach.table.place(n);
        let node = self.reach.node(place, self.states[state]);
        NodeOffset {
            dz: node.dz,
            dz_dc: node.dz_rate / place.c_rate,
        }
    }
}

/// What of a layer the way back needs.
fn past(layer: &Layer) -> Box<[Past]> {
    let last = layer.iter().rposition(Option::is_some).unwrap_or_default();
    let past = |front: &Option<Front>| front.map(|front| (front.place.n, front.from as u8));
    layer.iter().take(last + 1).map(past).collect()
}
