//! The error of one segment as the controller plays it: a cubic in time for each axis.

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
    let mut places = from.place.next..to.place.next;
    if places.len() < FEWEST {
        return holds_between(table, played, from, to);
    }
    match (table.x_matters, table.speed_varies) {
        (false, false) => holds_alone(played, &table.t[places.clone()], &table.z[places]),
        _ => {
            let middle = places.start + places.len() / 2;
            coupled(table, played, middle) && places.all(|k| coupled(table, played, k))
        }
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

/// The check at one place with what X and C err: e_Z − Z_X·e_X − Z_θ·e_C.
fn coupled(table: &Table<'_>, played: &Played, k: usize) -> bool {
    let t = table.t[k] - played.start;
    let mut error = played.z.at(t) - table.z[k];
    if table.speed_varies {
        error -= table.coupling.along[k] * (played.c.at(t) - table.c[k]);
    }
    let mut x_within = true;
    if table.x_matters {
        let off_x = played.x.at(t) - table.x[k];
        error -= table.coupling.slope[k] * off_x;
        x_within = !played.holds_x || off_x.abs() * table.coupling.x_weight[k] <= 1.0;
    }
    error.abs() <= played.limit && x_within
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
