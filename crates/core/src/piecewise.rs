//! Piecewise polynomials of degree 5 against the number of revolutions, and their knots.

use crate::Series;
use crate::registers::{Loop, in_widest};

/// One polynomial Σ c_i (n − start)^i, from `start` to the start of the next piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Start of the piece, in revolutions.
    pub start: f64,
    /// Coefficients against n − start, lowest first.
    pub coefficients: [f64; 6],
}

impl Piece {
    /// The coefficients of the same polynomial against n − `at`, lowest first.
    pub fn shifted(&self, at: f64) -> [f64; 6] {
        let s = at - self.start;
        let mut shifted = self.coefficients;
        for low in 0..5 {
            for i in (low..5).rev() {
                shifted[i] += s * shifted[i + 1];
            }
        }
        shifted
    }

    /// The slope at `n`: what [`Self::shifted`] gives for it, without the coefficients above.
    pub fn rate(&self, n: f64) -> f64 {
        let s = n - self.start;
        if let Some([_, rate]) = self.line().filter(|_| s.is_finite()) {
            return rate;
        }
        let mut shifted = self.coefficients;
        for low in 0..2 {
            for i in (low..5).rev() {
                shifted[i] += s * shifted[i + 1];
            }
        }
        shifted[1]
    }

    /// The value and the rate of a line; `None` if the piece is none. Only a line whose rate is not zero has the bits
    /// of the whole polynomial, and only at finite places: a sum with a rate of zero could change its sign, and
    /// infinity times zero is no number.
    fn line(&self) -> Option<[f64; 2]> {
        let [value, rate, others @ ..] = self.coefficients;
        (rate != 0.0 && others == [0.0; 4]).then_some([value, rate])
    }

    /// The value and the derivatives up to the 4th at `n`, each divided by its factorial.
    fn series(&self, n: f64) -> Series {
        let [value, rate, second, third, fourth, _] = self.shifted(n);
        [value, rate, second, third, fourth]
    }

    /// The value at `n`.
    pub fn value(&self, n: f64) -> f64 {
        let s = n - self.start;
        if let Some([value, rate]) = self.line().filter(|_| s.is_finite()) {
            return s * rate + value;
        }
        self.coefficients
            .iter()
            .rev()
            .fold(0.0, |sum, c| sum * s + c)
    }
}

/// A piece whose rate is the same all over, and not zero. It has the bits of the whole polynomial at finite
/// places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LinearPiece {
    start: f64,
    value: f64,
    rate: f64,
}

impl LinearPiece {
    fn of(piece: &Piece) -> Option<Self> {
        let [value, rate] = piece.line()?;
        Some(Self {
            start: piece.start,
            value,
            rate,
        })
    }

    /// The value at a place `n`; NaN where that is not finite.
    #[inline(always)]
    pub fn value(&self, n: f64) -> f64 {
        let s = n - self.start;
        if s.is_finite() {
            s * self.rate + self.value
        } else {
            f64::NAN
        }
    }

    /// The rate.
    pub fn rate(&self) -> f64 {
        self.rate
    }
}

/// The loop that finds the values of a line.
struct LineValues<'a> {
    line: LinearPiece,
    n: &'a [f64],
    values: &'a mut [f64],
}

impl Loop for LineValues<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (value, n) in self.values.iter_mut().zip(self.n) {
            *value = self.line.value(*n);
        }
    }
}

/// The coefficients, lowest first, of the polynomial of degree 5 that goes within `length` from one
/// value with its first and second derivative to another value with its own.
pub fn quintic(from: [f64; 3], to: [f64; 3], length: f64) -> [f64; 6] {
    let t = length;
    let d = to[0] - from[0] - t * (from[1] + 0.5 * t * from[2]);
    let v = t * (to[1] - from[1] - t * from[2]);
    let a = 0.5 * t * t * (to[2] - from[2]);
    let cube = t * t * t;
    [
        from[0],
        from[1],
        0.5 * from[2],
        (10.0 * d - 4.0 * v + a) / cube,
        (-15.0 * d + 7.0 * v - 2.0 * a) / (cube * t),
        (6.0 * d - 3.0 * v + a) / (cube * t * t),
    ]
}

/// A function of N in pieces, defined from 0 to [`PiecewisePolynomial::end`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PiecewisePolynomial {
    pieces: Vec<Piece>,
    end: f64,
}

impl PiecewisePolynomial {
    /// A function without pieces. It begins and ends at 0.
    pub fn new() -> Self {
        Self::default()
    }

    /// A function from pieces in order and the end of the last piece.
    pub fn from_pieces(pieces: Vec<Piece>, end: f64) -> Self {
        Self { pieces, end }
    }

    /// Appends a piece of the given length. The coefficients are against the revolutions since its
    /// start, lowest first.
    pub fn push(&mut self, length: f64, coefficients: [f64; 6]) {
        self.pieces.push(Piece {
            start: self.end,
            coefficients,
        });
        self.end += length;
    }

    /// The pieces that touch [from, to], with the end of the whole function: what one block needs.
    pub fn window(&self, from: f64, to: f64) -> Self {
        let first = self
            .pieces
            .partition_point(|piece| piece.start < from)
            .saturating_sub(1);
        let last = self.pieces.partition_point(|piece| piece.start <= to);
        let pieces = self.pieces.get(first..last).unwrap_or_default().to_vec();
        Self {
            pieces,
            end: self.end,
        }
    }

    /// End of the last piece, in revolutions.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The pieces in order.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The inner knots within (from, to). A knot is where two pieces join.
    pub fn knots(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
        let first = self
            .pieces
            .partition_point(|piece| piece.start <= from)
            .max(1);
        let rest = self.pieces.get(first..).unwrap_or_default();
        rest.iter()
            .map(|piece| piece.start)
            .take_while(move |start| *start < to)
    }

    /// The value at `n`. The first and the last piece continue beyond the ends. NaN if there are no
    /// pieces.
    pub fn value(&self, n: f64) -> f64 {
        self.piece_after(n).map_or(f64::NAN, |piece| piece.value(n))
    }

    /// The series in N at `n`. At a knot it is the series of the piece that begins there.
    pub fn series(&self, n: f64) -> Series {
        self.piece_after(n)
            .map_or([f64::NAN; 5], |piece| piece.series(n))
    }

    /// The series in N at `n`. At a knot it is the series of the piece that ends there.
    pub fn series_before(&self, n: f64) -> Series {
        let next = self.pieces.partition_point(|piece| piece.start < n);
        let piece = self.pieces.get(next.saturating_sub(1));
        piece.map_or([f64::NAN; 5], |piece| piece.series(n))
    }

    /// The rate at `n`. At a knot it is the mean of both sides.
    pub fn rate(&self, n: f64) -> f64 {
        let Some(piece) = self.piece_after(n) else {
            return f64::NAN;
        };
        let after = piece.rate(n);
        let before = match piece.start == n {
            true => self.series_before(n)[1],
            false => after,
        };
        if after == before {
            after
        } else {
            0.5 * (after + before)
        }
    }

    /// The values at all these places: those that [`value`](Self::value) gives one by one. `values` has the
    /// length of `n`.
    pub fn values(&self, n: &[f64], values: &mut [f64]) {
        match self.line_around(n) {
            Some(line) => in_widest(LineValues { line, n, values }),
            None => self.values_along(n, values),
        }
    }

    /// The values at places most of which lie in the piece of the one before.
    fn values_along(&self, n: &[f64], values: &mut [f64]) {
        let mut known: Option<(&Piece, f64)> = None;
        for (value, n) in values.iter_mut().zip(n) {
            let here = known.filter(|(piece, end)| piece.start <= *n && n < end);
            known = here.or_else(|| self.piece_and_end(*n));
            *value = known.map_or(f64::NAN, |(piece, _)| piece.value(*n));
        }
    }

    /// The piece at `n`, and where the next one begins.
    fn piece_and_end(&self, n: f64) -> Option<(&Piece, f64)> {
        let index = self.index_after(n);
        let next = self.pieces.get(index + 1);
        let end = next.map_or(f64::INFINITY, |next| next.start);
        Some((self.pieces.get(index)?, end))
    }

    /// The rates at all these places: those that [`rate`](Self::rate) gives one by one. `rates` has the
    /// length of `n`.
    pub fn rates(&self, n: &[f64], rates: &mut [f64]) {
        match self.line_around(n) {
            Some(line) => rates.fill(line.rate),
            None => {
                let each = rates.iter_mut().zip(n);
                each.for_each(|(rate, n)| *rate = self.rate(*n));
            }
        }
    }

    /// The line that the function is all over, if it has a single piece with a rate other than zero.
    pub(crate) fn only_line(&self) -> Option<LinearPiece> {
        match self.pieces.as_slice() {
            [piece] => LinearPiece::of(piece),
            _ => None,
        }
    }

    /// The line that the function is at all these places, if they lie within one piece and on none of its
    /// ends.
    fn line_around(&self, n: &[f64]) -> Option<LinearPiece> {
        let after = self
            .pieces
            .partition_point(|piece| piece.start <= *n.first().unwrap_or(&0.0));
        let index = after.saturating_sub(1);
        // The first and the last piece go on without an end.
        let from = match index {
            0 => f64::NEG_INFINITY,
            _ => self.pieces.get(index)?.start,
        };
        let to = self
            .pieces
            .get(index + 1)
            .map_or(f64::INFINITY, |next| next.start);
        // Without a way out of the loop it goes through vector registers.
        let is_one = n.iter().fold(true, |all, n| all & (from < *n) & (*n < to));
        self.pieces
            .get(index)
            .filter(|_| is_one)
            .and_then(LinearPiece::of)
    }

    /// The value at N = 0 and the rate, where the function is a line with a rate other than zero from `from`
    /// to `to`. The first and the last piece continue beyond the ends.
    pub fn line_over(&self, from: f64, to: f64) -> Option<[f64; 2]> {
        let piece = self.piece_after(from)?;
        let is_one = self.piece_after(to).is_some_and(|last| last == piece);
        let [value, rate] = piece.line().filter(|_| is_one)?;
        Some([value - rate * piece.start, rate])
    }

    fn piece_after(&self, n: f64) -> Option<&Piece> {
        self.pieces.get(self.index_after(n))
    }

    /// The number of the piece at `n`. The first one begins before all places.
    fn index_after(&self, n: f64) -> usize {
        let next = self.pieces.partition_point(|piece| piece.start <= n);
        next.saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_pieces() -> PiecewisePolynomial {
        let mut law = PiecewisePolynomial::new();
        law.push(2.0, [1.0, 0.5, 0.0, 0.0, 0.0, 1.0]);
        law.push(1.0, [34.0, -1.0, 0.25, 0.0, 0.0, 0.0]);
        law
    }

    #[test]
    fn the_rate_is_that_of_the_series_to_the_last_bit() {
        let law = two_pieces();
        for n in [-0.3, 0.0, 0.123_456, 1.999, 2.0, 2.7, 3.0, 4.1] {
            let [after, before] = [law.series(n)[1], law.series_before(n)[1]];
            let mean = if after == before {
                after
            } else {
                0.5 * (after + before)
            };
            assert_eq!(law.rate(n).to_bits(), mean.to_bits(), "{n}");
        }
        assert!(PiecewisePolynomial::new().rate(1.0).is_nan());
    }

    #[test]
    fn series_is_that_of_the_expanded_polynomial() {
        let s = two_pieces().series(1.0);
        assert_eq!(s, [2.5, 5.5, 10.0, 10.0, 5.0]);
    }

    /// Constant feeds and speeds are lines. The zeros behind change no bit, whatever their signs.
    #[test]
    fn a_line_has_the_bits_of_the_whole_polynomial() {
        let lines = [(0.0, 0.0, 0.12), (-0.0, 7.5, -9.1e-3), (0.0, -0.0, 3e-9)];
        // A rate of zero is no line: its sums keep the signs of their zeros.
        let levels = [(0.0, 0.0, 0.0), (-0.0, -0.0, -0.0), (0.0, -0.0, -0.0)];
        for (zero, value, rate) in lines.into_iter().chain(levels) {
            let piece = Piece {
                start: 0.375,
                coefficients: [value, rate, zero, zero, zero, zero],
            };
            for n in [0.0, 0.375, -1.5, 17.37, 99_999.01, 1e-300, f64::MAX] {
                let s = n - piece.start;
                let terms = piece.coefficients.iter().rev();
                let whole = terms.fold(0.0, |sum, c| sum * s + c);
                assert_eq!(piece.value(n).to_bits(), f64::to_bits(whole));
                assert_eq!(piece.rate(n).to_bits(), piece.shifted(n)[1].to_bits());
            }
            for n in [f64::NAN, f64::INFINITY] {
                assert!(piece.value(n).is_nan() && piece.rate(n).is_nan());
            }
        }
    }

    #[test]
    fn a_line_is_one_where_no_other_piece_comes() {
        let mut law = PiecewisePolynomial::new();
        law.push(2.0, [7.0, -0.5, 0.0, 0.0, 0.0, 0.0]);
        law.push(3.0, [6.0, -0.25, 0.0, 0.0, 0.0, 0.0]);
        law.push(1.0, [5.25, -0.25, 0.125, 0.0, 0.0, 0.0]);
        law.push(1.0, [5.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(law.line_over(-1.0, 1.5), Some([7.0, -0.5]));
        assert_eq!(law.line_over(2.0, 4.5), Some([6.5, -0.25]));
        for (from, to) in [(1.5, 2.0), (4.0, 5.5), (5.25, 5.5), (6.25, 6.5)] {
            assert_eq!(law.line_over(from, to), None);
        }
        assert_eq!(PiecewisePolynomial::new().line_over(0.0, 1.0), None);
    }

    /// Batches within one piece and over several, with ends of pieces among them, and places that are none.
    #[test]
    fn a_batch_has_the_bits_that_its_places_have_alone() {
        let mut lines = PiecewisePolynomial::new();
        lines.push(2.0, [7.0, -0.5, 0.0, 0.0, 0.0, 0.0]);
        lines.push(3.0, [6.0, -0.25, 0.0, 0.0, 0.0, 0.0]);
        let only = PiecewisePolynomial::from_pieces(lines.pieces()[..1].to_vec(), 2.0);
        let laws = [lines, only, two_pieces(), PiecewisePolynomial::new()];
        let within = [0.1, 0.7, 1.3, 0.2, 1.9];
        let batches = [
            within.to_vec(),
            within.map(|n| n + 2.0).to_vec(),
            within.map(|n| 3.0 * n - 1.0).to_vec(),
            vec![2.0, 3.0, 4.0],
            vec![3.0, 2.0],
            vec![0.0, 1.0],
            vec![0.5, f64::NAN],
            vec![-f64::INFINITY, 0.5, f64::INFINITY],
            vec![],
        ];
        for (law, batch) in laws
            .iter()
            .flat_map(|law| batches.iter().map(move |b| (law, b)))
        {
            let bits = |numbers: &[f64]| -> Vec<Option<u64>> {
                let known = numbers.iter().map(|x| (!x.is_nan()).then_some(x.to_bits()));
                known.collect()
            };
            let (mut values, mut rates) = (vec![0.0; batch.len()], vec![0.0; batch.len()]);
            law.values(batch, &mut values);
            law.rates(batch, &mut rates);
            let alone: [Vec<f64>; 2] = [
                batch.iter().map(|n| law.value(*n)).collect(),
                batch.iter().map(|n| law.rate(*n)).collect(),
            ];
            assert_eq!([bits(&values), bits(&rates)], alone.map(|of| bits(&of)));
        }
    }

    #[test]
    fn a_quintic_has_both_its_ends() {
        let (from, to) = ([1.0, -2.0, 0.5], [3.0, 0.25, -4.0]);
        let piece = Piece {
            start: 2.0,
            coefficients: quintic(from, to, 1.5),
        };
        for (n, end) in [(2.0, from), (3.5, to)] {
            let [value, rate, second, ..] = piece.shifted(n);
            for (found, wanted) in [value, rate, 2.0 * second].iter().zip(end) {
                assert!((found - wanted).abs() < 1e-13, "{found} {wanted}");
            }
        }
        assert!((piece.shifted(2.7)[0] - piece.value(2.7)).abs() < 1e-15);
    }

    #[test]
    fn a_knot_belongs_to_the_piece_that_begins_there() {
        let law = two_pieces();
        assert_eq!(law.value(2.0), 34.0);
        assert_eq!(law.series(2.0)[1], -1.0);
        assert_eq!(law.series_before(2.0)[1], 80.5);
        assert_eq!(law.rate(2.0), 39.75);
        assert_eq!(law.knots(0.0, 3.0).collect::<Vec<_>>(), [2.0]);
        assert_eq!(law.knots(2.0, 3.0).count(), 0);
        assert_eq!(law.end(), 3.0);
    }

    #[test]
    fn a_window_gives_the_same_values_as_the_whole() {
        let (law, part) = (two_pieces(), two_pieces().window(2.5, 3.0));
        assert_eq!(part.pieces().len(), 1);
        assert_eq!(part.value(2.75), law.value(2.75));
        assert_eq!(two_pieces().window(2.0, 2.5).rate(2.0), law.rate(2.0));
    }

    #[test]
    fn without_pieces_there_is_no_value() {
        assert!(PiecewisePolynomial::new().value(0.0).is_nan());
        assert_eq!(PiecewisePolynomial::new().knots(0.0, 1.0).count(), 0);
    }
}
