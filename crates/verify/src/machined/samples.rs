//! Pieces of the machined profile with the values at their four nodes, side by side, so that their
//! formulas fill the widest vector registers.

/// Pieces side by side.
pub(super) const WIDTH: usize = 8;
/// The inner of the four Gauss-Lobatto nodes ±1 and ±1/√5 on −1 … 1. The rule is exact to degree 5,
/// and neighbouring pieces share their ends.
pub(super) const INNER: f64 = 0.447_213_595_499_957_9;
/// Nodes of a piece.
pub(super) const NODES: usize = 4;
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
/// Partial sums of a piece's integral. Each takes every eighth step, so that no sum waits for the one
/// before.
const PARTIAL_SUMS: usize = 8;

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
    /// are too few for an absolute value, which may have a kink anywhere.
    #[inline(always)]
    pub fn amounts_about(&self, mean: f64) -> Column {
        let [a, b, c, d] = self.cubics();
        let (middle, half) = self.middles_and_halves();
        let mut sums = [[0.0; WIDTH]; PARTIAL_SUMS];
        for steps in MIDDLES.as_chunks::<PARTIAL_SUMS>().0 {
            for (sum, t) in sums.iter_mut().zip(steps) {
                for i in 0..WIDTH {
                    let error = a[i] + t * (b[i] + t * (c[i] + t * d[i]));
                    sum[i] += (error - mean).abs() * (middle[i] + t * half[i]).abs();
                }
            }
        }
        let mut amounts = [0.0; WIDTH];
        for sum in &sums {
            for (amount, part) in amounts.iter_mut().zip(sum) {
                *amount += part;
            }
        }
        let (from, to) = (&self.s[0], &self.s[NODES - 1]);
        for i in 0..WIDTH {
            amounts[i] = amounts[i] * (to[i] - from[i]) / AMOUNT_STEPS as f64;
        }
        amounts
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
}
