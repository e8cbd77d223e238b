//! The longest step from one node to a node in a given state.

use crate::natural_steps::NaturalSteps;
use crate::place::Place;
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

/// Which steps between two states count, in revolutions.
#[derive(Debug, Clone, Copy)]
pub struct StepRange {
    /// The shortest.
    pub least: f64,
    /// The longest.
    pub most: f64,
    /// The last step between the same two states.
    pub last: f64,
}

/// The steps of one span.
pub struct Reach<'a> {
    /// The path.
    pub table: &'a Table<'a>,
    /// The natural steps.
    pub natural: &'a NaturalSteps,
    /// How closely steps are found.
    pub precision: Precision,
}

impl Reach<'_> {
    /// The node in this state at a place.
    pub fn node(&self, place: Place, state: State) -> Node {
        let offset = self.table.limits.allowed * self.natural.part_at(place.n);
        let dz_rate = match state.slope {
            0.0 => 0.0,
            slope => slope * offset * place.c_rate / self.natural_in_radians(place.n),
        };
        Node {
            place,
            dz: state.height * offset,
            dz_rate,
        }
    }

    /// The natural step at `n`, rad.
    fn natural_in_radians(&self, n: f64) -> f64 {
        std::f64::consts::TAU * self.natural.at(n)
    }

    /// Whether the step of `length` revolutions to a node in state `to` holds, and where it ends.
    fn step(&self, from: &Node, to: State, length: f64) -> Option<Place> {
        let place = (self.table).place_behind(from.place.n + length, from.place.next);
        holds(self.table, from, &self.node(place, to)).then_some(place)
    }

    /// The end of the longest step in `range` to a node in state `to`; `None` if there is none, or
    /// none that gets further than `best`.
    pub fn longest(
        &self,
        from: &Node,
        to: State,
        range: StepRange,
        best: Option<f64>,
    ) -> Option<Place> {
        let beyond = best.map(|best| best + GAIN * self.natural.at(best));
        let first = match beyond.map(|beyond| beyond - from.place.n) {
            Some(length) if length > range.most => return None,
            Some(length) if length >= range.least => (length, self.step(from, to, length)?),
            _ => self.first(from, to, range)?,
        };
        let place = self.grow(from, to, first, range.most);
        beyond
            .is_none_or(|beyond| place.n >= beyond)
            .then_some(place)
    }

    /// A step that holds, near the last one between the same two states.
    fn first(&self, from: &Node, to: State, range: StepRange) -> Option<(f64, Place)> {
        // Where the largest step decides, it is all that is tried.
        if range.last >= range.most
            && let Some(place) = self.step(from, to, range.most)
        {
            return Some((range.most, place));
        }
        let mut length = (BEGIN * range.last).min(range.most).max(range.least);
        for _ in 0..=MOST_SHRINKS {
            if let Some(place) = self.step(from, to, length) {
                return Some((length, place));
            }
            if length <= range.least {
                return None;
            }
            length = (SHRINK * length).max(range.least);
        }
        None
    }

    /// Lengthens a step that holds until it no longer does, and halves the last interval.
    fn grow(&self, from: &Node, to: State, first: (f64, Place), most: f64) -> Place {
        let (mut length, mut place) = first;
        while length < most {
            let longer = (self.precision.growth * length).min(most);
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
