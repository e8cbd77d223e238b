//! The longest step from one node to a node in a given state.

use crate::place::Place;
use crate::scale::Scale;
use crate::segment::{Node, holds};
use crate::state::State;
use crate::table::Table;

/// A search begins at this part of the last step between the same two states.
const BEGIN: f64 = 0.9;
/// The factor by which a step that does not hold is shortened, and how often at most.
const SHRINK: f64 = 0.75;
const MOST_SHRINKS: usize = 14;
/// A step that gets no further than the best so far by this part of the natural step does not count.
const GAIN: f64 = 5e-4;

/// How closely the longest step is found.
#[derive(Debug, Clone, Copy)]
pub struct Precision {
    /// The factor by which a step that holds is lengthened.
    pub growth: f64,
    /// How often the interval of the longest step is halved.
    pub halvings: usize,
}

/// The steps of one span.
pub struct Reach<'a> {
    /// The path.
    pub table: &'a Table<'a>,
    /// The natural steps.
    pub scale: &'a Scale,
    /// How closely steps are found.
    pub precision: Precision,
}

impl Reach<'_> {
    /// The node in this state at a place.
    pub fn node(&self, place: Place, state: State) -> Node {
        let allowed = self.table.limits.allowed;
        let dz_rate = match state.slope {
            0.0 => 0.0,
            slope => slope * allowed * place.c_rate / self.scale_in_radians(place.n),
        };
        Node {
            place,
            dz: state.height * allowed,
            dz_rate,
        }
    }

    /// The natural step at `n`, rad.
    pub fn scale_in_radians(&self, n: f64) -> f64 {
        std::f64::consts::TAU * self.scale.at(n)
    }

    /// Whether the step of `length` revolutions to a node in state `to` holds, and where it ends.
    fn step(&self, from: &Node, to: State, length: f64) -> Option<Place> {
        let place = self.table.place(from.place.n + length);
        holds(self.table, from, &self.node(place, to)).then_some(place)
    }

    /// The end of the longest step to a node in state `to` that is no longer than `limit`
    /// revolutions; `None` if there is none, or none that gets further than `best`. `last` is the
    /// last step between the same two states.
    pub fn longest(
        &self,
        from: &Node,
        to: State,
        (limit, last): (f64, f64),
        best: Option<f64>,
    ) -> Option<Place> {
        let first = match best {
            Some(best) => {
                let length = best + GAIN * self.scale.at(best) - from.place.n;
                let held = (length <= limit).then(|| self.step(from, to, length));
                (length, held.flatten()?)
            }
            None => self.shrink(from, to, (BEGIN * last).min(limit))?,
        };
        Some(self.grow(from, to, first, limit))
    }

    /// The first step from `length` downwards that holds.
    fn shrink(&self, from: &Node, to: State, mut length: f64) -> Option<(f64, Place)> {
        for _ in 0..=MOST_SHRINKS {
            if let Some(place) = self.step(from, to, length) {
                return Some((length, place));
            }
            length *= SHRINK;
        }
        None
    }

    /// Lengthens a step that holds until it no longer does, and halves the last interval.
    fn grow(&self, from: &Node, to: State, first: (f64, Place), limit: f64) -> Place {
        let (mut length, mut place) = first;
        while length < limit {
            let longer = (self.precision.growth * length).min(limit);
            match self.step(from, to, longer) {
                Some(end) => (length, place) = (longer, end),
                None => return self.halve(from, to, (length, place), longer),
            }
        }
        place
    }

    fn halve(&self, from: &Node, to: State, first: (f64, Place), mut beyond: f64) -> Place {
        let (mut length, mut place) = first;
        for _ in 0..self.precision.halvings {
            let middle = 0.5 * (length + beyond);
            match self.step(from, to, middle) {
                Some(end) => (length, place) = (middle, end),
                None => beyond = middle,
            }
        }
        place
    }
}
