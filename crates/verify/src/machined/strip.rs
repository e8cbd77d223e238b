//! The machined profile along one line, in pieces that a cubic describes.

use turnpath_core::{Gradients, Part, Result, Scalar, SurfaceModel};

use super::envelope::{Arc, lower_arc, lower_envelope};
use super::no_height::no_height;
use super::sections::sort;
use crate::cusp::Point;
use crate::subject::Subject;

/// Longest piece, as a part of the nose radius. On steep flanks a cubic follows an arc no further.
const LONGEST: f64 = 1.0 / 32.0;
/// The inner of the four Gauss-Lobatto nodes ±1 and ±1/√5 on −1 … 1. The rule is exact to degree 5,
/// and neighbouring pieces share their ends.
const INNER: f64 = 0.447_213_595_499_957_9;
/// The weights of the four nodes.
const WEIGHTS: [f64; 4] = [1.0 / 6.0, 5.0 / 6.0, 5.0 / 6.0, 1.0 / 6.0];
/// Steps of a piece in the integral of the mean amount. Kinks between them cost 1e-3 of it.
const AMOUNT_STEPS: usize = 32;

/// All signed positions on a line.
pub(super) const EVERYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// A piece of an arc on the part.
#[derive(Debug, Clone, Copy)]
struct ArcPiece {
    centre: Point,
    /// Indices of its four nodes.
    nodes: [usize; 4],
    half: f64,
}

/// The values at the four nodes of a piece.
pub(super) struct Sample {
    /// Signed positions on the line, mm.
    pub s: [f64; 4],
    /// Surface error, mm.
    pub error: [f64; 4],
    /// Error of the radial slope; meaningless after [`Strip::look_up_heights`].
    pub slope: [f64; 4],
    /// Weights of area.
    pub weight: [f64; 4],
}

/// The machined profile along one line. Its memory is used again for the next line.
#[derive(Default)]
pub(super) struct Strip {
    passes: Vec<Point>,
    arcs: Vec<Arc>,
    pieces: Vec<ArcPiece>,
    /// Signed positions of the nodes of all pieces, mm.
    nodes: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    zx: Vec<f64>,
    zy: Vec<f64>,
    turned: (f64, f64),
    radius: f64,
}

impl Strip {
    /// Sets the line at `angle`, rad, with its passes: divides its envelope over the part into
    /// pieces.
    pub fn set_line(&mut self, subject: &Subject, angle: f64, passes: &[Point]) {
        self.set_line_within(subject, angle, passes, &[EVERYWHERE]);
    }

    /// The same where only some intervals of signed positions count, mm.
    pub fn set_line_within(
        &mut self,
        subject: &Subject,
        angle: f64,
        passes: &[Point],
        spans: &[(f64, f64)],
    ) {
        let (tool, part) = (&subject.tool, &subject.part);
        self.radius = tool.nose_radius;
        self.turned = Scalar::sin_cos(angle);
        self.passes.clear();
        self.passes.extend_from_slice(passes);
        sort(&mut self.passes);
        lower_envelope(&self.passes, self.radius, tool.reach(), &mut self.arcs);
        self.pieces.clear();
        self.nodes.clear();
        for arc in std::mem::take(&mut self.arcs) {
            for (from, to) in on_part(&arc, part, spans) {
                self.divide(arc.centre, from, to);
            }
        }
        let (sin, cos) = self.turned;
        self.x.clear();
        self.x.extend(self.nodes.iter().map(|s| s * cos));
        self.y.clear();
        self.y.extend(self.nodes.iter().map(|s| s * sin));
    }

    fn divide(&mut self, centre: Point, from: f64, to: f64) {
        let count = ((to - from) / (LONGEST * self.radius)).ceil().max(1.0);
        let half = 0.5 * (to - from) / count;
        for i in 0..count as usize {
            let begin = from + 2.0 * half * i as f64;
            let end = match i + 1 == count as usize {
                true => to,
                false => from + 2.0 * half * (i + 1) as f64,
            };
            let middle = 0.5 * (begin + end);
            let first = self.node_at(begin);
            self.nodes
                .extend([middle - INNER * half, middle + INNER * half, end]);
            self.pieces.push(ArcPiece {
                centre,
                nodes: [first, first + 1, first + 2, first + 3],
                half,
            });
        }
    }

    /// The index of the node at `s`: the last node, or a new one.
    fn node_at(&mut self, s: f64) -> usize {
        if self.nodes.last() != Some(&s) {
            self.nodes.push(s);
        }
        self.nodes.len() - 1
    }

    /// Looks up wanted heights and slopes.
    pub fn look_up(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        for column in [&mut self.z, &mut self.zx, &mut self.zy] {
            column.resize(self.x.len(), 0.0);
        }
        let out = Gradients {
            z: &mut self.z,
            zx: &mut self.zx,
            zy: &mut self.zy,
        };
        surface.gradient(&self.x, &self.y, out)?;
        self.check_heights()
    }

    /// Looks up wanted heights alone.
    pub fn look_up_heights(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        self.z.resize(self.x.len(), 0.0);
        for slopes in [&mut self.zx, &mut self.zy] {
            slopes.clear();
            slopes.resize(self.x.len(), 0.0);
        }
        surface.heights(&self.x, &self.y, &mut self.z)?;
        self.check_heights()
    }

    /// Refuses a surface that has no height at one of the nodes.
    fn check_heights(&self) -> Result<()> {
        let places = self.x.iter().zip(&self.y).zip(&self.z);
        match places.into_iter().find(|(_, z)| !z.is_finite()) {
            Some(((x, y), _)) => Err(no_height(*x, *y)),
            None => Ok(()),
        }
    }

    /// The sample of each piece, from left to right.
    pub fn samples(&self) -> impl Iterator<Item = Sample> + '_ {
        self.pieces.iter().map(|piece| self.sample(piece))
    }

    fn sample(&self, piece: &ArcPiece) -> Sample {
        let s = piece.nodes.map(|node| self.nodes[node]);
        let (sin, cos) = self.turned;
        let of = |k: usize, f: &dyn Fn(usize, f64) -> f64| f(piece.nodes[k], s[k]);
        let error = |node: usize, s: f64| lower_arc(piece.centre, self.radius, s) - self.z[node];
        let slope = |node: usize, s: f64| {
            let off = s - piece.centre.x;
            let lift = (self.radius * self.radius - off * off).max(0.0).sqrt();
            off / lift - self.zx[node] * cos - self.zy[node] * sin
        };
        Sample {
            s,
            error: std::array::from_fn(|k| of(k, &error)),
            slope: std::array::from_fn(|k| of(k, &slope)),
            weight: std::array::from_fn(|k| WEIGHTS[k] * piece.half * s[k].abs()),
        }
    }
}

/// The intervals of an arc that lie on the part, on either side of the hole or of the axis, and
/// within `spans`.
pub(super) fn on_part<'a>(
    arc: &Arc,
    part: &Part,
    spans: &'a [(f64, f64)],
) -> impl Iterator<Item = (f64, f64)> + use<'a> {
    let (rim, hole) = (part.aperture_radius, part.inner_radius);
    let (from, to) = (arc.from, arc.to);
    let sides = [(-rim, -hole), (hole, rim)].into_iter();
    let within = move |(left, right): (f64, f64)| {
        let spans = spans.iter();
        spans.map(move |span| (left.max(span.0), right.min(span.1)))
    };
    sides
        .flat_map(within)
        .map(move |(left, right)| (from.max(left), to.min(right)))
        .filter(|(from, to)| from < to)
}

impl Sample {
    /// The coefficients of the cubic through the errors, on −1 … 1.
    fn cubic(&self) -> [f64; 4] {
        let [e0, e1, e2, e3] = self.error;
        let (outer, inner) = (0.5 * (e0 + e3), 0.5 * (e1 + e2));
        let (outer_odd, inner_odd) = (0.5 * (e3 - e0), 0.5 * (e2 - e1) / INNER);
        let share = 1.0 - INNER * INNER;
        let (bend, twist) = ((outer - inner) / share, (outer_odd - inner_odd) / share);
        [outer - bend, outer_odd - twist, bend, twist]
    }

    /// The integral of |error − mean| over the area, computed on the cubic. Four nodes are too few
    /// for an absolute value, which may have a kink anywhere.
    pub fn amount_about(&self, mean: f64) -> f64 {
        let [a, b, c, d] = self.cubic();
        let half = 0.5 * (self.s[3] - self.s[0]);
        let middle = 0.5 * (self.s[3] + self.s[0]);
        let of_step = |i: usize| {
            let t = (2 * i + 1) as f64 / AMOUNT_STEPS as f64 - 1.0;
            let error = a + t * (b + t * (c + t * d));
            (error - mean).abs() * (middle + t * half).abs()
        };
        let sum: f64 = (0..AMOUNT_STEPS).map(of_step).sum();
        sum * (self.s[3] - self.s[0]) / AMOUNT_STEPS as f64
    }

    /// Positions and errors that can be the largest or smallest of the piece: those at its ends,
    /// and those where the slope of the cubic through the errors is zero.
    pub fn extremes(&self) -> [(f64, f64); 4] {
        let [a, b, c, d] = self.cubic();
        let at = |t: f64| {
            let middle = 0.5 * (self.s[0] + self.s[3]);
            let half = 0.5 * (self.s[3] - self.s[0]);
            (middle + t * half, a + t * (b + t * (c + t * d)))
        };
        let root = (c * c - 3.0 * b * d).sqrt();
        // Both roots in the form that loses no digits.
        let q = -(c + root.copysign(c));
        let level = |t: f64| match t.abs() < 1.0 {
            true => at(t),
            false => (self.s[3], self.error[3]),
        };
        let ends = [(self.s[0], self.error[0]), (self.s[3], self.error[3])];
        [ends[0], ends[1], level(b / q), level(q / (3.0 * d))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(f: impl Fn(f64) -> f64) -> Sample {
        let s = [-1.0, -INNER, INNER, 1.0].map(|t| 5.0 + 2.0 * t);
        Sample {
            s,
            error: s.map(f),
            slope: [0.0; 4],
            weight: [0.0; 4],
        }
    }

    fn range(sample: &Sample) -> (f64, f64) {
        let errors = sample.extremes().map(|(_, error)| error);
        let low = errors.into_iter().fold(f64::INFINITY, f64::min);
        (low, errors.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }

    #[test]
    fn extremes_of_a_parabola_a_cubic_and_a_line_are_exact() {
        let (low, high) = range(&of(|s| (s - 4.5) * (s - 4.5) - 1.0));
        assert!((low + 1.0).abs() < 1e-14 && (high - 5.25).abs() < 1e-14);
        let (low, high) = range(&of(|s| (s - 5.0) * ((s - 5.0) * (s - 5.0) - 3.0)));
        assert!((low + 2.0).abs() < 1e-13 && (high - 2.0).abs() < 1e-13);
        assert_eq!(range(&of(|s| s)), (3.0, 7.0));
        assert_eq!(range(&of(|_| 2.0)), (2.0, 2.0));
    }
}
