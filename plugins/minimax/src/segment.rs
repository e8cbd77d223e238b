//! The error of one segment as the controller plays it: a cubic in time for each axis.

use std::ops::Range;

use crate::place::Place;
use crate::table::Table;

/// Places that are compared at once. Compilers make vector instructions of this.
const LANES: usize = 8;
/// With fewer places than this inside, a segment is compared at [`BETWEEN`] instead.
const FEWEST: usize = 6;
/// Instants of a segment that is shorter than the table is fine.
const BETWEEN: [f64; 7] = [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875];
/// By this part an error may exceed the limit: rounding, where a node lies on the limit.
const ROUNDING: f64 = 1e-6;

/// A place with a node's offsets.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    /// The place on the locus.
    pub place: Place,
    /// Z above the locus, mm.
    pub dz: f64,
    /// dZ/dt beyond that of the locus.
    pub dz_rate: f64,
}

/// A cubic in the time since its start.
#[derive(Debug, Clone, Copy)]
struct Cubic([f64; 4]);

impl Cubic {
    /// The cubic from (value, rate) to (value, rate) within `length`.
    fn between(from: [f64; 2], to: [f64; 2], length: f64) -> Self {
        let mean = (to[0] - from[0]) / length;
        let second = (3.0 * mean - 2.0 * from[1] - to[1]) / length;
        let third = (from[1] + to[1] - 2.0 * mean) / (length * length);
        Self([from[0], from[1], second, third])
    }

    fn at(&self, t: f64) -> f64 {
        let [value, rate, second, third] = self.0;
        value + t * (rate + t * (second + t * third))
    }
}

/// The cubics of one segment.
struct Played {
    start: f64,
    length: f64,
    x: Cubic,
    z: Cubic,
    c: Cubic,
    /// The largest error of Z, mm.
    limit: f64,
    /// Whether X's own error is held. It is not beside a kink of the law, where the rate of X
    /// belongs to neither side.
    holds_x: bool,
}

impl Played {
    fn new(table: &Table<'_>, from: &Node, to: &Node) -> Self {
        let (a, b) = (&from.place, &to.place);
        let length = b.t - a.t;
        Self {
            start: a.t,
            x: Cubic::between([a.x, a.x_rate], [b.x, b.x_rate], length),
            z: Cubic::between(
                [a.z + from.dz, a.z_rate + from.dz_rate],
                [b.z + to.dz, b.z_rate + to.dz_rate],
                length,
            ),
            c: Cubic::between([a.c, a.c_rate], [b.c, b.c_rate], length),
            limit: table.limits.allowed * (1.0 + ROUNDING),
            holds_x: !(a.is_kink || b.is_kink),
            length,
        }
    }

    /// Whether Z accelerates by no more than `most`. It accelerates most at an end. Beside a kink of
    /// the law the rate of Z belongs to neither side, and no step is calm.
    fn is_calm(&self, most: f64) -> bool {
        let [_, _, second, third] = self.z.0;
        let [start, end] = [0.0, self.length].map(|t| 2.0 * second + 6.0 * third * t);
        !self.holds_x || start.abs().max(end.abs()) <= most
    }
}

/// Whether a segment keeps to all limits at every place of the table within it.
pub fn holds(table: &Table<'_>, from: &Node, to: &Node) -> bool {
    let played = Played::new(table, from, to);
    played.is_calm(table.most_acceleration) && holds_errors(table, &played, from, to)
}

/// Whether a segment keeps to the limits of errors, however much Z accelerates.
pub fn holds_tolerance(table: &Table<'_>, from: &Node, to: &Node) -> bool {
    holds_errors(table, &Played::new(table, from, to), from, to)
}

fn holds_errors(table: &Table<'_>, played: &Played, from: &Node, to: &Node) -> bool {
    let places = from.place.next..to.place.next;
    if places.len() < FEWEST {
        return holds_between(table, played, from, to);
    }
    match (table.x_matters, table.speed_varies) {
        (false, false) => holds_alone(played, &table.t[places.clone()], &table.z[places]),
        (false, true) => Coupled::<false, true>::at(table, played, places).holds(),
        (true, false) => Coupled::<true, false>::at(table, played, places).holds(),
        (true, true) => Coupled::<true, true>::at(table, played, places).holds(),
    }
}

/// The check of Z alone: neither X nor C errs.
fn holds_alone(played: &Played, t: &[f64], z: &[f64]) -> bool {
    let Played {
        start,
        z: cubic,
        limit,
        ..
    } = *played;
    let is_beyond = |t: f64, z: f64| (cubic.at(t - start) - z).abs() > limit;
    // A step that is too long errs most in its middle.
    let middle = t.len() / 2;
    if is_beyond(t[middle], z[middle]) {
        return false;
    }
    let (t_lanes, t_rest) = t.as_chunks::<LANES>();
    let (z_lanes, z_rest) = z.as_chunks::<LANES>();
    for (t, z) in t_lanes.iter().zip(z_lanes) {
        let mut beyond = false;
        for lane in 0..LANES {
            beyond |= is_beyond(t[lane], z[lane]);
        }
        if beyond {
            return false;
        }
    }
    !t_rest.iter().zip(z_rest).any(|(t, z)| is_beyond(*t, *z))
}

/// What is compared at some places: with what X errs if `X`, with what C errs if `C`.
struct Coupled<'a, const X: bool, const C: bool> {
    played: &'a Played,
    t: &'a [f64],
    z: &'a [f64],
    x: &'a [f64],
    c: &'a [f64],
    slope: &'a [f64],
    along: &'a [f64],
    x_weight: &'a [f64],
}

impl<'a, const X: bool, const C: bool> Coupled<'a, X, C> {
    fn at(table: &'a Table<'_>, played: &'a Played, places: Range<usize>) -> Self {
        let coupling = &table.coupling;
        let of = |column: &'a [f64], counts: bool| match counts {
            true => &column[places.clone()],
            false => &[],
        };
        Self {
            played,
            t: of(&table.t, true),
            z: of(&table.z, true),
            x: of(&table.x, X),
            c: of(&table.c, C),
            slope: of(&coupling.slope, X),
            along: of(&coupling.along, C),
            x_weight: of(&coupling.x_weight, X),
        }
    }

    /// Whether the segment keeps to the limits at all places.
    fn holds(&self) -> bool {
        // A step that is too long errs most in its middle.
        if !self.holds_at(self.t.len() / 2) {
            return false;
        }
        let lanes = self.t.len() / LANES * LANES;
        for first in (0..lanes).step_by(LANES) {
            let mut within = true;
            for k in first..first + LANES {
                within &= self.holds_at(k);
            }
            if !within {
                return false;
            }
        }
        (lanes..self.t.len()).all(|k| self.holds_at(k))
    }

    /// The check at one place with what X and C err: e_Z − Z_X·e_X − Z_θ·e_C.
    #[inline(always)]
    fn holds_at(&self, k: usize) -> bool {
        let Self { played, .. } = self;
        let t = self.t[k] - played.start;
        let mut error = played.z.at(t) - self.z[k];
        if C {
            error -= self.along[k] * (played.c.at(t) - self.c[k]);
        }
        let mut x_within = true;
        if X {
            let off_x = played.x.at(t) - self.x[k];
            error -= self.slope[k] * off_x;
            x_within = !played.holds_x | (off_x.abs() * self.x_weight[k] <= 1.0);
        }
        (error.abs() <= played.limit) & x_within
    }
}

/// The check of a segment that is shorter than the table is fine.
fn holds_between(table: &Table<'_>, played: &Played, from: &Node, to: &Node) -> bool {
    let length = to.place.n - from.place.n;
    BETWEEN.iter().all(|part| {
        let truth = table.place(from.place.n + part * length);
        let t = truth.t - played.start;
        let [slope, along, weight] = table.coupling_near(truth.next);
        let mut error = played.z.at(t) - truth.z;
        if table.speed_varies {
            error -= along * (played.c.at(t) - truth.c);
        }
        let mut off_x = 0.0;
        if table.x_matters {
            off_x = played.x.at(t) - truth.x;
            error -= slope * off_x;
        }
        let x_within = !played.holds_x || off_x.abs() * weight <= 1.0;
        error.abs() <= played.limit && x_within
    })
}
