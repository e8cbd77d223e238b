//! Pieces of the machined profile with the values at their four nodes, side by side, so that their
//! formulas fill the widest vector registers.

/// Pieces side by side.
pub(super) const WIDTH: usize = 32;
/// The inner of the four Gauss-Lobatto nodes ±1 and ±1/√5 on −1 … 1. The rule is exact to degree 5,
/// and neighbouring pieces share their ends.
pub(super) const INNER: f64 = 0.447_213_595_499_957_9;
/// Nodes of a piece.
pub(super) const NODES: usize = 4;
/// Pairs of steps of a piece in the integral of the mean amount. The two steps of a pair lie equally far from
/// the middle of the piece, one on each side. Kinks between steps cost 1e-3 of the integral.
const STEP_PAIRS: usize = 16;
/// The middles of the steps to the right, on 0 … 1.
const MIDDLES: [f64; STEP_PAIRS] = {
    let mut middles = [0.0; STEP_PAIRS];
    let mut i = 0;
    while i < STEP_PAIRS {
        middles[i] = (2 * i + 1) as f64 / (2 * STEP_PAIRS) as f64;
        i += 1;
    }
    middles
};

/// A number for each piece.
pub(super) type Column = [f64; WIDTH];

/// Numbers at the nodes of pieces.
pub(super) type NodeColumns = [Column; NODES];

/// Zeros, until the numbers at the nodes are known.
pub(super) const ZEROS: NodeColumns = [[0.0; WIDTH]; NODES];

/// Up to [`WIDTH`] pieces. Lanes beyond the last piece repeat it.
pub(super) struct Samples {
    /// Number of pieces.
    pub count: usize,
    /// Signed positions of the nodes on the line, mm.
    pub s: NodeColumns,
    /// Surface error at the nodes, mm.
    pub error: NodeColumns,
}

/// Four positions of each piece, with the errors there, among which are its largest and its smallest.
pub(super) struct Candidates {
    /// Signed positions on the line, mm.
    pub s: [Column; 4],
    /// Surface error, mm.
    pub error: [Column; 4],
}

impl Samples {
    /// Room for samples.
    #[inline(always)]
    pub fn blank() -> Self {
        Self {
            count: 0,
            s: ZEROS,
            error: ZEROS,
        }
    }

    /// The coefficients of the cubic through the errors of each piece, on −1 … 1.
    #[inline(always)]
    fn cubics(&self) -> [Column; 4] {
        let [e0, e1, e2, e3] = &self.error;
        let share = 1.0 - INNER * INNER;
        let mut cubics = [[0.0; WIDTH]; 4];
        for i in 0..WIDTH {
            let (outer, inner) = (0.5 * (e0[i] + e3[i]), 0.5 * (e1[i] + e2[i]));
            let (outer_odd, inner_odd) = (0.5 * (e3[i] - e0[i]), 0.5 * (e2[i] - e1[i]) / INNER);
            let (bend, twist) = ((outer - inner) / share, (outer_odd - inner_odd) / share);
            cubics[0][i] = outer - bend;
            cubics[1][i] = outer_odd - twist;
            cubics[2][i] = bend;
            cubics[3][i] = twist;
        }
        cubics
    }

    /// The integral of |error − mean| over the area of each piece, computed on its cubic. Four nodes
    /// are too few for an absolute value, which may have a kink anywhere. No piece lies on both sides of
    /// the axis.
    #[inline(always)]
    pub fn amounts_about(&self, mean: f64) -> Column {
        let [a, b, c, d] = self.cubics();
        // The integrals of |error − mean| and of |error − mean| times the place on −1 … 1.
        let (mut even, mut odd) = ([0.0; WIDTH], [0.0; WIDTH]);
        for t in MIDDLES {
            let square = t * t;
            for i in 0..WIDTH {
                let (of_both, apart) = (a[i] - mean + square * c[i], t * (b[i] + square * d[i]));
                let (left, right) = ((of_both - apart).abs(), (of_both + apart).abs());
                even[i] += right + left;
                odd[i] += t * (right - left);
            }
        }
        let (middle, half) = self.middles_and_halves();
        let mut amounts = [0.0; WIDTH];
        for i in 0..WIDTH {
            let by_place = (middle[i] * even[i] + half[i] * odd[i]).abs();
            amounts[i] = by_place * half[i] / STEP_PAIRS as f64;
        }
        amounts
    }

    /// A lower and an upper bound of the cubic of each piece, to rounding. They are close where the cubic is
    /// nearly a parabola around its middle, as between two cusps.
    #[inline(always)]
    pub fn bounds(&self) -> [Column; 2] {
        let [a, b, c, d] = self.cubics();
        let mut bounds = [[0.0; WIDTH]; 2];
        for i in 0..WIDTH {
            let odd = b[i].abs() + d[i].abs();
            bounds[0][i] = a[i] + c[i].min(0.0) - odd;
            bounds[1][i] = a[i] + c[i].max(0.0) + odd;
        }
        bounds
    }

    /// What can be the largest or smallest of each piece: the errors at its ends, and those where the
    /// slope of the cubic through the errors is zero.
    #[inline(always)]
    pub fn candidates(&self) -> Candidates {
        let (first, last) = (&self.s[0], &self.s[NODES - 1]);
        let (first_error, last_error) = (&self.error[0], &self.error[NODES - 1]);
        let [a, b, c, d] = self.cubics();
        let (middle, half) = self.middles_and_halves();
        let mut candidates = Candidates {
            s: [*first, *last, *last, *last],
            error: [*first_error, *last_error, *last_error, *last_error],
        };
        for i in 0..WIDTH {
            let root = (c[i] * c[i] - 3.0 * b[i] * d[i]).sqrt();
            // Both roots in the form that loses no digits.
            let q = -(c[i] + root.copysign(c[i]));
            for (k, t) in [(2, b[i] / q), (3, q / (3.0 * d[i]))] {
                let error = a[i] + t * (b[i] + t * (c[i] + t * d[i]));
                let within = t.abs() < 1.0;
                candidates.s[k][i] = if within {
                    middle[i] + t * half[i]
                } else {
                    last[i]
                };
                candidates.error[k][i] = if within { error } else { last_error[i] };
            }
        }
        candidates
    }

    /// The middle of each piece, and half its length, mm.
    #[inline(always)]
    fn middles_and_halves(&self) -> (Column, Column) {
        let (from, to) = (&self.s[0], &self.s[NODES - 1]);
        let (mut middle, mut half) = ([0.0; WIDTH], [0.0; WIDTH]);
        for i in 0..WIDTH {
            middle[i] = 0.5 * (to[i] + from[i]);
            half[i] = 0.5 * (to[i] - from[i]);
        }
        (middle, half)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pieces from 3 to 7, and each by a tenth further to the right, with the same errors.
    fn of(f: impl Fn(f64) -> f64) -> Samples {
        let mut samples = Samples {
            count: WIDTH,
            s: ZEROS,
            error: ZEROS,
        };
        for (k, t) in [-1.0, -INNER, INNER, 1.0].into_iter().enumerate() {
            for i in 0..WIDTH {
                samples.s[k][i] = 5.0 + 2.0 * t + 0.1 * i as f64;
                samples.error[k][i] = f(5.0 + 2.0 * t);
            }
        }
        samples
    }

    /// The smallest and the largest error, which all pieces have in common.
    fn range(samples: &Samples) -> (f64, f64) {
        let errors = samples.candidates().error;
        let of_piece = |i: usize| {
            let errors = errors.iter().map(|column| column[i]);
            let low = errors.clone().fold(f64::INFINITY, f64::min);
            (low, errors.fold(f64::NEG_INFINITY, f64::max))
        };
        let first = of_piece(0);
        assert!((1..WIDTH).all(|i| of_piece(i) == first));
        first
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

    #[test]
    fn candidates_lie_where_the_cubic_is_level() {
        let candidates = of(|s| (s - 5.0) * ((s - 5.0) * (s - 5.0) - 3.0)).candidates();
        for i in 0..WIDTH {
            let shift = 0.1 * i as f64;
            let mut level = [candidates.s[2][i] - shift, candidates.s[3][i] - shift];
            level.sort_by(f64::total_cmp);
            assert!((level[0] - 4.0).abs() < 1e-13 && (level[1] - 6.0).abs() < 1e-13);
            assert_eq!(
                (candidates.s[0][i], candidates.s[1][i]),
                (3.0 + shift, 7.0 + shift)
            );
        }
    }

    /// ∫ |s − 5| s ds from 3 to 7, and from 3.1 to 7.1 with errors a tenth further on.
    #[test]
    fn amounts_are_integrals_over_the_area() {
        let amounts = of(|s| s).amounts_about(5.0);
        for (i, amount) in amounts.into_iter().enumerate() {
            let expected = 4.0 * (5.0 + 0.1 * i as f64);
            assert!((amount / expected - 1.0).abs() < 1e-12, "{amount}");
        }
    }

    /// The weight of a place is its distance from the axis, on either side of it.
    #[test]
    fn amounts_on_the_left_are_those_of_the_mirrored_pieces() {
        let right = of(|s| (s - 4.0) * (s - 6.5));
        let (mut left, last) = (of(|s| (s - 4.0) * (s - 6.5)), NODES - 1);
        for k in 0..NODES {
            left.s[k] = right.s[last - k].map(|s| -s);
            left.error[k] = right.error[last - k];
        }
        let both = right
            .amounts_about(0.3)
            .into_iter()
            .zip(left.amounts_about(0.3));
        for (right, left) in both {
            assert!(
                (left / right - 1.0).abs() < 1e-14 && right > 1.0,
                "{left} {right}"
            );
        }
    }

    #[test]
    fn bounds_hold_all_of_a_cubic_and_are_close_to_a_parabola() {
        for [a, b, c, d] in [
            [0.3, 0.0, 1.0, 0.0],
            [0.3, 0.0, -2.0, 0.0],
            [-1.0, 0.2, 0.7, -0.1],
            [0.0, 1.0, 0.0, -1.3],
            [5.0, -3.0, -1.0, 2.0],
        ] {
            let cubic = |t: f64| a + t * (b + t * (c + t * d));
            let [low, high] = of(|s| cubic(0.5 * (s - 5.0))).bounds();
            let places = (0..=1000).map(|k| cubic(f64::from(k) / 500.0 - 1.0));
            let range = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), error| {
                (low.min(error), high.max(error))
            });
            let wide = b.abs() + d.abs();
            assert!(low[3] <= range.0 + 1e-14 && high[3] >= range.1 - 1e-14);
            assert!(low[3] >= range.0 - 2.0 * wide - 1e-14);
            assert!(high[3] <= range.1 + 2.0 * wide + 1e-14);
        }
    }
}
