//! The highest and the lowest point of a machined surface.

use turnpath_core::Scalar;

use super::samples::{Candidates, NODES, Samples};

/// A point of the part and the surface error there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartPoint {
    /// Machined − wanted along z, mm.
    pub error: f64,
    /// x on the part, mm.
    pub x: f64,
    /// y on the part, mm.
    pub y: f64,
}

impl PartPoint {
    /// The point at signed position `s`, mm, on the line at `angle`, rad.
    pub(super) fn on_line(angle: f64, s: f64, error: f64) -> Self {
        let (sin, cos) = Scalar::sin_cos(angle);
        let (x, y) = (s * cos, s * sin);
        Self { error, x, y }
    }
}

/// The extremes of a machined surface. Where its height is no number they are infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceExtremes {
    /// The point where most material is left.
    pub highest: PartPoint,
    /// The point where most material is missing or least is left.
    pub lowest: PartPoint,
}

impl SurfaceExtremes {
    /// Peak to valley, mm.
    pub fn pv(&self) -> f64 {
        self.highest.error - self.lowest.error
    }

    /// The extremes over lines, each given with its angle, rad; `None` if no line has any.
    pub(super) fn over<'a>(lines: impl Iterator<Item = (f64, &'a LineExtremes)>) -> Option<Self> {
        let mut over: Option<Self> = None;
        for (angle, line) in lines {
            let Some([highest, lowest]) = line.0 else {
                continue;
            };
            let at = |(error, s): (f64, f64)| PartPoint::on_line(angle, s, error);
            let found = over.get_or_insert(Self {
                highest: at(highest),
                lowest: at(lowest),
            });
            if highest.0 > found.highest.error {
                found.highest = at(highest);
            }
            if lowest.0 < found.lowest.error {
                found.lowest = at(lowest);
            }
        }
        over
    }
}

/// The highest and the lowest error of one line, mm, each with its signed position, mm.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LineExtremes(Option<[(f64, f64); 2]>);

impl LineExtremes {
    /// Includes the error at a signed position, both in mm. An error that is no number counts as
    /// infinite both ways: nothing is known about the surface there, so it holds no tolerance.
    pub fn include(&mut self, error: f64, s: f64) {
        let (above, below) = match error.is_nan() {
            true => (f64::INFINITY, f64::NEG_INFINITY),
            false => (error, error),
        };
        let [highest, lowest] = self.0.get_or_insert([(above, s), (below, s)]);
        if above > highest.0 {
            *highest = (above, s);
        }
        if below < lowest.0 {
            *lowest = (below, s);
        }
    }

    /// Includes pieces of the machined profile. In most groups nothing lies beyond what is known, which
    /// shows without looking at each piece.
    #[inline(always)]
    pub fn include_samples(&mut self, samples: &Samples) {
        if !self.contains(samples) {
            self.include_each(samples, &samples.candidates());
        }
    }

    /// Includes one piece after the other. The candidates of a piece may be numbers where the error at a
    /// node is none.
    fn include_each(&mut self, samples: &Samples, candidates: &Candidates) {
        for i in 0..samples.count {
            let nodes = samples.s.iter().zip(&samples.error);
            for (s, error) in nodes.filter(|(_, error)| error[i].is_nan()) {
                self.include(error[i], s[i]);
            }
            for (s, error) in candidates.s.iter().zip(&candidates.error) {
                self.include(error[i], s[i]);
            }
        }
    }

    /// Whether bounds show that all errors of these pieces lie between the lowest and the highest that are
    /// known: those at the ends exactly, others to rounding. Bounds that are no numbers show nothing.
    #[inline(always)]
    fn contains(&self, samples: &Samples) -> bool {
        let Some([(highest, _), (lowest, _)]) = self.0 else {
            return false;
        };
        let [low, high] = samples.bounds();
        let mut all_within = true;
        for column in [&samples.error[0], &samples.error[NODES - 1], &low, &high] {
            for error in column {
                all_within &= (lowest <= *error) & (*error <= highest);
            }
        }
        all_within
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::machined::samples::{INNER, WIDTH};

    fn line(errors: &[(f64, f64)]) -> LineExtremes {
        let mut line = LineExtremes::default();
        errors
            .iter()
            .for_each(|(error, s)| line.include(*error, *s));
        line
    }

    fn over(lines: &[LineExtremes]) -> Option<SurfaceExtremes> {
        SurfaceExtremes::over([0.0, FRAC_PI_2].into_iter().zip(lines))
    }

    #[test]
    fn the_extremes_are_those_of_all_lines_that_have_any() {
        let lines = [line(&[(2.0, 1.0), (-1.0, 3.0)]), line(&[(5.0, -4.0)])];
        let found = over(&lines).unwrap();
        assert_eq!((found.highest.error, found.lowest.error), (5.0, -1.0));
        assert_eq!((found.highest.y, found.lowest.x), (-4.0, 3.0));
        let alone = over(&[line(&[]), line(&[(7.0, 2.0)])]).unwrap();
        assert_eq!((alone.pv(), alone.lowest.y), (0.0, 2.0));
        assert_eq!(over(&[line(&[]), line(&[])]), None);
    }

    #[test]
    fn an_error_that_is_no_number_is_infinite_at_its_place() {
        let lines = [line(&[(2.0, 1.0)]), line(&[(1.0, 1.0), (f64::NAN, -2.5)])];
        let found = over(&lines).unwrap();
        assert_eq!(found.pv(), f64::INFINITY);
        assert_eq!((found.highest.y, found.lowest.y), (-2.5, -2.5));
    }

    /// So many pieces of length 3, each 10 to the right of the one before, with the same errors.
    fn samples(count: usize, errors: [f64; 4]) -> Samples {
        let column = |s: f64| std::array::from_fn(|i| s + 10.0 * i as f64);
        Samples {
            count,
            s: [0.0, 1.0, 2.0, 3.0].map(column),
            error: errors.map(|error| [error; WIDTH]),
        }
    }

    /// An inner node does not reach the ends of a piece, nor the level places of its cubic.
    #[test]
    fn no_node_of_a_piece_is_left_out() {
        for (node, piece) in (0..4).flat_map(|node| [0, WIDTH - 1].map(|piece| (node, piece))) {
            let mut pieces = samples(WIDTH, [0.5; 4]);
            let mut line = line(&[(9.0, 0.0), (-9.0, 0.0)]);
            line.include_samples(&pieces);
            assert_eq!(over(&[line]).unwrap().pv(), 18.0);
            pieces.error[node][piece] = f64::NAN;
            line.include_samples(&pieces);
            assert_eq!(over(&[line]).unwrap().pv(), f64::INFINITY);
        }
    }

    /// The nodes of the last piece lie within what is known, and its parabola ends beyond it.
    #[test]
    fn a_level_place_between_the_nodes_counts() {
        for sign in [1.0, -1.0] {
            let mut pieces = samples(WIDTH, [0.0; 4]);
            for (k, t) in [-1.0, -INNER, INNER, 1.0].into_iter().enumerate() {
                pieces.error[k][WIDTH - 1] = sign * (1.0 - t * t);
            }
            let mut line = line(&[(0.9, 0.0), (-0.9, 0.0)]);
            line.include_samples(&pieces);
            let found = over(&[line]).unwrap();
            let farthest = if sign > 0.0 {
                found.highest
            } else {
                found.lowest
            };
            assert!((sign * farthest.error - 1.0).abs() < 1e-15);
            assert!((farthest.x - 311.5).abs() < 1e-12);
            assert_eq!(found.pv().min(1.95), found.pv());
        }
    }

    /// The first of equal extremes counts, and lanes without a piece do not.
    #[test]
    fn pieces_are_included_one_after_the_other() {
        let mut pieces = samples(3, [0.0; 4]);
        for column in &mut pieces.error {
            *column = [7.0; WIDTH];
            column[..4].copy_from_slice(&[0.0, 1.0, 1.0, 1.0]);
        }
        let mut line = LineExtremes::default();
        line.include_samples(&pieces);
        line.include_samples(&samples(WIDTH, [1.0, 0.0, 0.0, 1.0]));
        let found = over(&[line]).unwrap();
        assert_eq!((found.highest.error, found.highest.x), (1.0, 10.0));
        assert_eq!((found.lowest.error < 0.0, found.lowest.x), (true, 1.5));
    }
}
