//! The machined profile along one line, in pieces that a cubic describes.

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::{Gradients, Part, Result, Scalar, SurfaceModel};

use super::envelope::{Arc, lower_envelope};
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
/// The middles of these steps on −1 … 1.
const MIDDLES: [f64; AMOUNT_STEPS] = {
    let mut middles = [0.0; AMOUNT_STEPS];
    let mut i = 0;
    while i < AMOUNT_STEPS {
        middles[i] = (2 * i + 1) as f64 / AMOUNT_STEPS as f64 - 1.0;
        i += 1;
    }
    middles
};
/// Sums of the integral that grow side by side.
const LANES: usize = 8;

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
        let arcs = std::mem::take(&mut self.arcs);
        for arc in &arcs {
            for (from, to) in on_part(arc, part, spans) {
                self.divide(arc.centre, from, to);
            }
        }
        self.arcs = arcs;
        let (sin, cos) = self.turned;
        self.x.clear();
        self.x.extend(self.nodes.iter().map(|s| s * cos));
        self.y.clear();
        self.y.extend(self.nodes.iter().map(|s| s * sin));
    }

    /// The whole envelope of the line, from left to right.
    pub fn arcs(&self) -> &[Arc] {
        &self.arcs
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

    /// The integral of |error − mean| along the line, weighted by area.
    pub fn amount_about(&self, mean: f64) -> f64 {
        in_widest(Amounts(self, mean))
    }

    #[inline(always)]
    fn sample(&self, piece: &ArcPiece) -> Sample {
        let (sin, cos) = self.turned;
        let square = self.radius * self.radius;
        let s = piece.nodes.map(|node| self.nodes[node]);
        let [z, zx, zy] = [&self.z, &self.zx, &self.zy].map(|c| piece.nodes.map(|node| c[node]));
        let (mut error, mut slope, mut weight) = ([0.0; 4], [0.0; 4], WEIGHTS);
        for k in 0..4 {
            let off = s[k] - piece.centre.x;
            let lift = (square - off * off).max(0.0).sqrt();
            error[k] = piece.centre.y - lift - z[k];
            slope[k] = off / lift - zx[k] * cos - zy[k] * sin;
            weight[k] = weight[k] * piece.half * s[k].abs();
        }
        Sample {
            s,
            error,
            slope,
            weight,
        }
    }
}

/// The loop that sums up the amounts of a line's pieces.
struct Amounts<'a>(&'a Strip, f64);

impl Loop for Amounts<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self(strip, mean) = self;
        let mut sum = 0.0;
        for piece in &strip.pieces {
            sum += strip.sample(piece).amount_about(mean);
        }
        sum
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
    #[inline(always)]
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
    #[inline(always)]
    fn amount_about(&self, mean: f64) -> f64 {
        let [a, b, c, d] = self.cubic();
        let half = 0.5 * (self.s[3] - self.s[0]);
        let middle = 0.5 * (self.s[3] + self.s[0]);
        let mut sums = [0.0; LANES];
        for steps in MIDDLES.as_chunks::<LANES>().0 {
            for (sum, t) in sums.iter_mut().zip(steps) {
                let error = a + t * (b + t * (c + t * d));
                *sum += (error - mean).abs() * (middle + t * half).abs();
            }
        }
        sums.iter().sum::<f64>() * (self.s[3] - self.s[0]) / AMOUNT_STEPS as f64
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
