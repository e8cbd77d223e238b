//! Groups of pieces of the machined profile, side by side.

use super::pieces::{PieceRun, Pieces};
use super::samples::{Column, NODES, NodeColumns, Samples, WIDTH, ZEROS};

/// The weights of the four nodes.
const WEIGHTS: [f64; NODES] = [1.0 / 6.0, 5.0 / 6.0, 5.0 / 6.0, 1.0 / 6.0];

/// Up to [`WIDTH`] pieces of a run, and at least one. Its methods are for loops that go through
/// [`in_widest`](turnpath_core::registers::in_widest).
pub(super) struct Group<'a> {
    all: &'a Pieces,
    /// Index of its first piece.
    first: usize,
    /// Index of the left end of that piece.
    first_end: usize,
    count: usize,
}

/// Samples with what their sums over the part need.
pub(super) struct WeightedSamples {
    pub samples: Samples,
    /// Error of the radial slope. It is 0 in lanes beyond the last piece.
    pub slope: NodeColumns,
    /// Weights of area. They are 0 in lanes beyond the last piece.
    pub weight: NodeColumns,
}

impl WeightedSamples {
    /// Room for samples.
    #[inline(always)]
    pub fn blank() -> Self {
        Self {
            samples: Samples::blank(),
            slope: ZEROS,
            weight: ZEROS,
        }
    }
}

/// A point of the nose's edge.
struct NoseEdge {
    /// How far it lies to the right of the nose's centre, mm.
    off: f64,
    /// How far the centre lies above it, mm.
    lift: f64,
}

impl NoseEdge {
    /// The point so far to the right of the centre of a nose, whose radius has this square.
    #[inline(always)]
    fn at(off: f64, square: f64) -> Self {
        let lift = (square - off * off).max(0.0).sqrt();
        Self { off, lift }
    }
}

impl Pieces {
    /// All pieces in groups, from left to right.
    #[inline(always)]
    pub fn groups(&self) -> impl Iterator<Item = Group<'_>> {
        let runs = self.runs.iter();
        runs.flat_map(|run| Group::all_of(self, run))
    }
}

impl<'a> Group<'a> {
    /// The pieces of a run in groups, from left to right.
    #[inline(always)]
    fn all_of(all: &'a Pieces, run: &PieceRun) -> impl Iterator<Item = Self> + use<'a> {
        let PieceRun {
            first,
            pieces,
            first_end,
        } = *run;
        (0..pieces).step_by(WIDTH).map(move |before| Self {
            all,
            first: first + before,
            first_end: first_end + before,
            count: WIDTH.min(pieces - before),
        })
    }

    /// Finds the errors at the nodes, once heights are looked up.
    #[inline(always)]
    pub fn sample(&self, samples: &mut Samples) {
        let square = self.all.radius * self.all.radius;
        let (x, y) = self.centres();
        let z = self.at_nodes(&self.all.z);
        samples.count = self.count;
        samples.s = self.at_nodes(&self.all.s);
        for ((s, z), error) in samples.s.iter().zip(&z).zip(&mut samples.error) {
            for i in 0..WIDTH {
                let edge = NoseEdge::at(s[i] - x[i], square);
                error[i] = y[i] - edge.lift - z[i];
            }
        }
    }

    /// Finds the errors at the nodes, those of slopes, and weights, once heights and slopes are looked up.
    #[inline(always)]
    pub fn sample_with_weights(&self, found: &mut WeightedSamples) {
        let square = self.all.radius * self.all.radius;
        let (sin, cos) = self.all.turned;
        let (x, y) = self.centres();
        let z = self.at_nodes(&self.all.z);
        let (zx, zy) = (self.at_nodes(&self.all.zx), self.at_nodes(&self.all.zy));
        let s = self.at_nodes(&self.all.s);
        let mut half = [0.0; WIDTH];
        for i in 0..WIDTH {
            let of_piece = 0.5 * (s[NODES - 1][i] - s[0][i]);
            half[i] = if i < self.count { of_piece } else { 0.0 };
        }
        let WeightedSamples {
            samples,
            slope,
            weight,
        } = found;
        for (k, of_node) in WEIGHTS.into_iter().enumerate() {
            let (error, slope, weight) = (&mut samples.error[k], &mut slope[k], &mut weight[k]);
            for i in 0..WIDTH {
                let edge = NoseEdge::at(s[k][i] - x[i], square);
                error[i] = y[i] - edge.lift - z[k][i];
                let of_piece = edge.off / edge.lift - zx[k][i] * cos - zy[k][i] * sin;
                slope[i] = if i < self.count { of_piece } else { 0.0 };
                weight[i] = of_node * half[i] * s[k][i].abs();
            }
        }
        samples.count = self.count;
        samples.s = s;
    }

    /// The centres of the nose, (x, y).
    #[inline(always)]
    fn centres(&self) -> (Column, Column) {
        let Pieces {
            centre_x, centre_y, ..
        } = self.all;
        (
            self.column(centre_x, self.first),
            self.column(centre_y, self.first),
        )
    }

    /// What these numbers are at the nodes of the pieces.
    #[inline(always)]
    fn at_nodes(&self, of_nodes: &[f64]) -> NodeColumns {
        let [ends, left, right] = self.all.by_place(of_nodes);
        [
            self.column(ends, self.first_end),
            self.column(left, self.first),
            self.column(right, self.first),
            self.column(ends, self.first_end + 1),
        ]
    }

    /// The numbers of the group, of which this is the first. Lanes beyond the last piece repeat it.
    #[inline(always)]
    fn column(&self, numbers: &[f64], first: usize) -> Column {
        let numbers = &numbers[first..first + self.count];
        let mut column = [numbers[self.count - 1]; WIDTH];
        match numbers.first_chunk() {
            Some(whole) => column = *whole,
            None => column[..self.count].copy_from_slice(numbers),
        }
        column
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cusp::Point;
    use crate::machined::samples::INNER;

    /// So many pieces of a flat part's profile, in elevens with gaps between them.
    fn pieces(count: usize) -> Pieces {
        let mut pieces = Pieces {
            radius: 2.0,
            turned: (0.6, 0.8),
            ..Pieces::default()
        };
        for i in 0..count {
            let from = 0.05 * i as f64 + if i % 11 == 0 { 0.01 } else { 0.0 };
            let centre = Point::new(from + 0.02, 2.0 + 1e-4 * (i % 5) as f64);
            pieces.divide(centre, from, 0.05 * (i + 1) as f64);
        }
        pieces.place_nodes();
        let wave = |k: usize| (0..pieces.s.len()).map(move |i| 1e-4 * ((i * i + k) % 17) as f64);
        (pieces.z, pieces.zx, pieces.zy) =
            (wave(0).collect(), wave(5).collect(), wave(9).collect());
        pieces
    }

    /// The indices of the nodes of a piece.
    fn nodes(pieces: &Pieces, piece: usize) -> [usize; NODES] {
        let count = pieces.centre_x.len();
        let (end, ends) = (pieces.left_end(piece), pieces.s.len() - 2 * count);
        [end, ends + piece, ends + count + piece, end + 1]
    }

    /// The error, the error of the slope and the weight at a node of a piece.
    fn at_node(pieces: &Pieces, piece: usize, k: usize) -> [f64; 3] {
        let (sin, cos) = pieces.turned;
        let nodes = nodes(pieces, piece);
        let half = 0.5 * (pieces.s[nodes[3]] - pieces.s[nodes[0]]);
        let (node, weight) = (nodes[k], [1.0, 5.0, 5.0, 1.0][k] / 6.0);
        let off = pieces.s[node] - pieces.centre_x[piece];
        let lift = (pieces.radius * pieces.radius - off * off).sqrt();
        let error = pieces.centre_y[piece] - lift - pieces.z[node];
        let slope = off / lift - pieces.zx[node] * cos - pieces.zy[node] * sin;
        [error, slope, weight * half * pieces.s[node].abs()]
    }

    /// The nodes lie where Gauss and Lobatto have them, and neighbours share their ends.
    #[test]
    fn a_piece_begins_where_the_one_before_it_ends_or_after_a_gap() {
        let pieces = pieces(17);
        assert_eq!(pieces.runs.len(), 2);
        for piece in 0..17 {
            let s = nodes(&pieces, piece).map(|node| pieces.s[node]);
            let from = 0.05 * piece as f64 + if piece % 11 == 0 { 0.01 } else { 0.0 };
            let (to, half) = (0.05 * (piece + 1) as f64, 0.5 * (s[3] - s[0]));
            assert_eq!((s[0], s[3]), (from, to));
            let inner = [s[1], s[2]].map(|s| (s - 0.5 * (from + to)) / half);
            assert!((inner[0] + INNER).abs() < 1e-12 && (inner[1] - INNER).abs() < 1e-12);
        }
    }

    #[test]
    fn each_piece_has_the_samples_that_it_has_alone() {
        for count in [0, 1, 7, 8, 9, 17, 50] {
            let pieces = pieces(count);
            assert_eq!(pieces.centre_x.len(), count);
            let mut seen = 0;
            for group in pieces.groups() {
                let mut found = WeightedSamples::blank();
                group.sample_with_weights(&mut found);
                for k in 0..NODES {
                    for i in 0..found.samples.count {
                        let found = [
                            found.samples.error[k][i],
                            found.slope[k][i],
                            found.weight[k][i],
                        ];
                        let expected = at_node(&pieces, seen + i, k);
                        assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
                    }
                    assert!(
                        found.weight[k][found.samples.count..]
                            .iter()
                            .all(|w| *w == 0.0)
                    );
                }
                seen += found.samples.count;
            }
            assert_eq!(seen, count);
        }
    }

    /// There the edge is vertical, and no lane without a piece may turn an infinite slope into no number.
    #[test]
    fn a_run_that_ends_with_the_nose_has_an_infinite_slope_there() {
        let mut pieces = Pieces {
            radius: 2.0,
            turned: (0.0, 1.0),
            ..Pieces::default()
        };
        pieces.divide(Point::new(3.0, 2.0), 4.95, 5.0);
        pieces.place_nodes();
        let zeros = || vec![0.0; pieces.s.len()];
        (pieces.z, pieces.zx, pieces.zy) = (zeros(), zeros(), zeros());
        let mut found = WeightedSamples::blank();
        for group in pieces.groups() {
            group.sample_with_weights(&mut found);
        }
        let count = found.samples.count;
        assert_eq!(found.slope[3][count - 1], f64::INFINITY);
        for k in 0..NODES {
            assert!(found.slope[k][count..].iter().all(|slope| *slope == 0.0));
        }
    }

    fn amount(pieces: &Pieces) -> f64 {
        let (mut samples, mut sum) = (Samples::blank(), 0.0);
        for group in pieces.groups() {
            group.sample(&mut samples);
            let amounts = samples.amounts_about(2e-4);
            for amount in amounts.iter().take(samples.count) {
                sum += amount;
            }
        }
        sum
    }

    #[test]
    fn an_amount_is_the_sum_of_those_of_all_pieces() {
        for count in [0, 1, 7, 8, 9, 17, 50] {
            let whole = pieces(count);
            let mut sum = 0.0;
            for piece in 0..count {
                let nodes = nodes(&whole, piece);
                let mut alone = Pieces {
                    radius: whole.radius,
                    turned: whole.turned,
                    ..Pieces::default()
                };
                let centre = Point::new(whole.centre_x[piece], whole.centre_y[piece]);
                alone.divide(centre, whole.s[nodes[0]], whole.s[nodes[3]]);
                alone.place_nodes();
                // Both ends come before the inner nodes.
                alone.z = [0, 3, 1, 2].map(|k| whole.z[nodes[k]]).to_vec();
                sum += amount(&alone);
            }
            assert_eq!(amount(&whole).to_bits(), f64::to_bits(sum));
        }
    }
}
