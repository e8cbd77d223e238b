//! The machined profile along one line, in pieces that a cubic describes.

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::{Gradients, Part, Result, Scalar, SurfaceModel};

use super::envelope::{Arc, lower_envelope};
use super::no_height::no_height;
use super::samples::{INNER, NODES, NodeColumns, Samples, WIDTH, ZEROS};
use super::sections::sort;
use crate::cusp::Point;
use crate::subject::Subject;

/// Longest piece, as a part of the nose radius. On steep flanks a cubic follows an arc no further.
const LONGEST: f64 = 1.0 / 32.0;
/// The weights of the four nodes.
const WEIGHTS: [f64; NODES] = [1.0 / 6.0, 5.0 / 6.0, 5.0 / 6.0, 1.0 / 6.0];

/// All signed positions on a line.
pub(super) const EVERYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// A piece of an arc on the part.
#[derive(Debug, Clone, Copy)]
struct ArcPiece {
    centre: Point,
    /// Index of its first node. The others follow.
    first: usize,
    half: f64,
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
        let (rim, hole) = (part.aperture_radius, part.inner_radius);
        let counts_everywhere = *spans == [EVERYWHERE];
        for arc in &arcs {
            let on_right = hole <= arc.from && arc.to <= rim;
            let on_left = -rim <= arc.from && arc.to <= -hole;
            // Nearly all arcs lie on one side of the part. An arc of the envelope is never empty.
            if counts_everywhere && (on_left || on_right) {
                self.divide(arc.centre, arc.from, arc.to);
                continue;
            }
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
        let longest = LONGEST * self.radius;
        // Nearly all arcs are one piece, and rounding up takes a call on some CPUs.
        if to - from <= longest {
            self.add_piece(centre, from, to, 0.5 * (to - from));
            return;
        }
        let count = ((to - from) / longest).ceil();
        let half = 0.5 * (to - from) / count;
        for i in 0..count as usize {
            let begin = from + 2.0 * half * i as f64;
            let end = match i + 1 == count as usize {
                true => to,
                false => from + 2.0 * half * (i + 1) as f64,
            };
            self.add_piece(centre, begin, end, half);
        }
    }

    /// Adds a piece with its nodes. It begins with the last node so far, or with a new one.
    fn add_piece(&mut self, centre: Point, begin: f64, end: f64, half: f64) {
        let middle = 0.5 * (begin + end);
        let nodes = [begin, middle - INNER * half, middle + INNER * half, end];
        let own = match self.nodes.last() == Some(&begin) {
            true => &nodes[1..],
            false => &nodes[..],
        };
        self.nodes.extend_from_slice(own);
        self.pieces.push(ArcPiece {
            centre,
            first: self.nodes.len() - NODES,
            half,
        });
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

    /// All pieces in groups, from left to right.
    pub fn groups(&self) -> impl Iterator<Item = Group<'_>> {
        let groups = self.pieces.chunks(WIDTH);
        groups.map(|pieces| Group {
            strip: self,
            pieces,
        })
    }

    /// The integral of |error − mean| along the line, weighted by area.
    pub fn amount_about(&self, mean: f64) -> f64 {
        in_widest(Amounts(self, mean))
    }
}

/// Up to [`WIDTH`] pieces of a strip, and at least one. Its methods are for loops that go through
/// [`in_widest`].
pub(super) struct Group<'a> {
    strip: &'a Strip,
    pieces: &'a [ArcPiece],
}

/// Samples with what their sums over the part need.
pub(super) struct WeightedSamples {
    pub samples: Samples,
    /// Error of the radial slope.
    pub slope: NodeColumns,
    /// Weights of area.
    pub weight: NodeColumns,
}

/// The nose's edge at the nodes of pieces.
struct NoseEdge {
    /// How far each node lies to the right of the nose's centre, mm.
    off: NodeColumns,
    /// How far the centre lies above the edge there, mm.
    lift: NodeColumns,
}

impl Group<'_> {
    /// The errors at the nodes, once heights are looked up.
    #[inline(always)]
    pub fn samples(&self) -> Samples {
        self.samples_and_edge().0
    }

    /// The errors at the nodes, those of slopes, and weights, once heights and slopes are looked up.
    #[inline(always)]
    pub fn weighted_samples(&self) -> WeightedSamples {
        let (sin, cos) = self.strip.turned;
        let (samples, edge) = self.samples_and_edge();
        let [zx, zy] = [&self.strip.zx, &self.strip.zy].map(|of_nodes| self.at_nodes(of_nodes));
        let mut half = [0.0; WIDTH];
        for (half, piece) in half.iter_mut().zip(self.lanes()) {
            *half = piece.half;
        }
        let (mut slope, mut weight) = (ZEROS, ZEROS);
        for (k, of_node) in WEIGHTS.into_iter().enumerate() {
            let (s, off, lift) = (&samples.s[k], &edge.off[k], &edge.lift[k]);
            for i in 0..WIDTH {
                slope[k][i] = off[i] / lift[i] - zx[k][i] * cos - zy[k][i] * sin;
                weight[k][i] = of_node * half[i] * s[i].abs();
            }
        }
        WeightedSamples {
            samples,
            slope,
            weight,
        }
    }

    /// The errors at the nodes, with the nose's edge that they come from.
    #[inline(always)]
    fn samples_and_edge(&self) -> (Samples, NoseEdge) {
        let square = self.strip.radius * self.strip.radius;
        let [s, z] = [&self.strip.nodes, &self.strip.z].map(|of_nodes| self.at_nodes(of_nodes));
        let (mut x, mut y) = ([0.0; WIDTH], [0.0; WIDTH]);
        for ((x, y), piece) in x.iter_mut().zip(&mut y).zip(self.lanes()) {
            (*x, *y) = (piece.centre.x, piece.centre.y);
        }
        let (mut error, mut off, mut lift) = (ZEROS, ZEROS, ZEROS);
        for k in 0..NODES {
            for i in 0..WIDTH {
                off[k][i] = s[k][i] - x[i];
                lift[k][i] = (square - off[k][i] * off[k][i]).max(0.0).sqrt();
                error[k][i] = y[i] - lift[k][i] - z[k][i];
            }
        }
        let samples = Samples {
            count: self.pieces.len(),
            s,
            error,
        };
        (samples, NoseEdge { off, lift })
    }

    /// What these numbers are at the nodes of the pieces.
    #[inline(always)]
    fn at_nodes(&self, of_nodes: &[f64]) -> NodeColumns {
        let mut columns = ZEROS;
        for (i, piece) in self.lanes().enumerate() {
            let nodes = &of_nodes[piece.first..piece.first + NODES];
            for (column, number) in columns.iter_mut().zip(nodes) {
                column[i] = *number;
            }
        }
        columns
    }

    /// The piece in each lane.
    #[inline(always)]
    fn lanes(&self) -> impl Iterator<Item = &ArcPiece> {
        let last = self.pieces.len() - 1;
        (0..WIDTH).map(move |i| &self.pieces[i.min(last)])
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
        for group in strip.groups() {
            let samples = group.samples();
            let amounts = samples.amounts_about(mean);
            for amount in amounts.iter().take(samples.count) {
                sum += amount;
            }
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use turnpath_core::{Misfit, Surface, Tool};

    use super::{ArcPiece, EVERYWHERE, NODES, Part, Point, Scalar, Strip, Subject, WEIGHTS};

    struct Flat;

    impl Surface for Flat {
        fn sag<S: Scalar>(&self, x: S, _: S) -> S {
            x * 0.0
        }
    }

    /// A strip of so many pieces of a flat part's profile, in threes with gaps between them.
    fn strip(pieces: usize) -> Strip {
        let mut strip = Strip {
            radius: 2.0,
            turned: (0.6, 0.8),
            ..Strip::default()
        };
        for i in 0..pieces {
            let from = 0.05 * i as f64 + if i % 3 == 0 { 0.01 } else { 0.0 };
            let centre = Point::new(from + 0.02, 2.0 + 1e-4 * (i % 5) as f64);
            strip.divide(centre, from, 0.05 * (i + 1) as f64);
        }
        let wave = |k: usize| (0..strip.nodes.len()).map(move |i| 1e-4 * ((i * i + k) % 17) as f64);
        (strip.z, strip.zx, strip.zy) = (wave(0).collect(), wave(5).collect(), wave(9).collect());
        strip
    }

    /// The error, the error of the slope and the weight at a node of a piece.
    fn at_node(strip: &Strip, piece: usize, k: usize) -> [f64; 3] {
        let (sin, cos) = strip.turned;
        let piece = strip.pieces[piece];
        let node = piece.first + k;
        let off = strip.nodes[node] - piece.centre.x;
        let lift = (strip.radius * strip.radius - off * off).sqrt();
        let error = piece.centre.y - lift - strip.z[node];
        let slope = off / lift - strip.zx[node] * cos - strip.zy[node] * sin;
        [
            error,
            slope,
            WEIGHTS[k] * piece.half * strip.nodes[node].abs(),
        ]
    }

    /// An arc on one side of the part goes a shorter way, if all of the line counts.
    #[test]
    fn a_line_has_the_same_pieces_whether_or_not_its_arcs_are_cut_at_borders() {
        let tool = Tool {
            nose_radius: 2.0,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        };
        // Passes on both sides, from beyond the rim to the axis, some of them without a neighbour.
        let passes = |step: f64| -> Vec<Point> {
            let places = (-80..=80).filter(|k| k % 13 != 0);
            let pass = |k: i32| Point::new(step * f64::from(k), 2.0 + 1e-4 * f64::from(k % 5));
            places.map(pass).collect()
        };
        for (inner_radius, step) in [(0.0, 0.1), (0.0, 0.0625), (1.5, 0.1), (0.31, 0.07)] {
            let subject = Subject {
                surface: Arc::new(Flat),
                part: Part {
                    aperture_radius: 5.0,
                    inner_radius,
                },
                tool,
                compensates_nose: true,
            };
            let of_line = |span: (f64, f64)| {
                let mut strip = Strip::default();
                strip.set_line_within(&subject, 0.7, &passes(step), &[span]);
                let piece = |piece: &ArcPiece| {
                    let ArcPiece { centre, half, .. } = piece;
                    ([centre.x, centre.y, *half].map(f64::to_bits), piece.first)
                };
                let nodes: Vec<u64> = strip.nodes.iter().map(|node| node.to_bits()).collect();
                let pieces: Vec<_> = strip.pieces.iter().map(piece).collect();
                (pieces, nodes)
            };
            let whole = of_line(EVERYWHERE);
            assert!(whole.0.len() > 100);
            assert_eq!(whole, of_line((-1e300, 1e300)), "{inner_radius} {step}");
        }
    }

    #[test]
    fn each_piece_has_the_samples_that_it_has_alone() {
        for count in [0, 1, 7, 8, 9, 17] {
            let strip = strip(count);
            assert_eq!(strip.pieces.len(), count);
            let mut seen = 0;
            for group in strip.groups() {
                let found = group.weighted_samples();
                for i in 0..found.samples.count {
                    for k in 0..NODES {
                        let found = [
                            found.samples.error[k][i],
                            found.slope[k][i],
                            found.weight[k][i],
                        ];
                        let expected = at_node(&strip, seen, k);
                        assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
                    }
                    seen += 1;
                }
            }
            assert_eq!(seen, count);
        }
    }

    #[test]
    fn an_amount_is_the_sum_of_those_of_all_pieces() {
        for count in [0, 1, 7, 8, 9, 17] {
            let whole = strip(count);
            let mut sum = 0.0;
            for piece in &whole.pieces {
                let alone = Strip {
                    pieces: vec![*piece],
                    ..strip(count)
                };
                sum += alone.amount_about(2e-4);
            }
            assert_eq!(whole.amount_about(2e-4).to_bits(), f64::to_bits(sum));
        }
    }
}
