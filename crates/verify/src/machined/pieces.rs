//! Pieces of the machined profile along a line, side by side in columns.

use std::ops::Range;

use turnpath_core::registers::{Loop, in_widest};

use super::envelope::Arc;
use super::samples::INNER;
use crate::cusp::Point;

/// Longest piece, as a part of the nose radius, where an arc is no steeper than 45 degrees.
const LONGEST: f64 = 1.0 / 32.0;
/// The square of the cosine of 45 degrees. Where that of the slope is less, pieces are as many times shorter.
/// A cubic then departs from an arc by less than 5.2e-8 of the nose radius.
const STEEP: f64 = 0.5;
/// How often a piece is halved at most. It holds the departure up to a slope of 89 degrees. Where an arc ends
/// upright, no cubic follows it, however short.
const MOST_HALVINGS: usize = 12;

/// Pieces of arcs from left to right: their centres, and numbers at their nodes. A column of nodes has
/// the ends of all pieces, then the left inner node of each piece, then the right one.
#[derive(Default)]
pub(super) struct Pieces {
    /// The nose radius, mm.
    pub radius: f64,
    /// Sine and cosine of the line's angle.
    pub turned: (f64, f64),
    pub runs: Vec<PieceRun>,
    /// The nose's centre of each piece, mm.
    pub centre_x: Vec<f64>,
    pub centre_y: Vec<f64>,
    /// Signed positions of the nodes, mm.
    pub s: Vec<f64>,
    /// The nodes on the part, mm.
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// Wanted heights at the nodes, mm, once they are looked up.
    pub z: Vec<f64>,
    /// Wanted slopes there, once they are looked up.
    pub zx: Vec<f64>,
    pub zy: Vec<f64>,
}

/// Pieces without a gap between them. They share their ends, so a run has one end more than pieces.
#[derive(Debug, Clone, Copy)]
pub(super) struct PieceRun {
    /// Index of its first piece. The others follow.
    pub first: usize,
    /// Number of its pieces.
    pub pieces: usize,
    /// Index of its first end.
    pub first_end: usize,
}

impl PieceRun {
    /// The indices of the ends that two of its pieces share.
    pub fn joints(&self) -> Range<usize> {
        self.first_end + 1..self.first_end + self.pieces
    }
}

impl Pieces {
    /// Forgets all pieces.
    pub fn clear(&mut self) {
        self.runs.clear();
        for column in [&mut self.centre_x, &mut self.centre_y, &mut self.s] {
            column.clear();
        }
    }

    /// The longest piece where arcs are not steep, mm.
    fn longest(&self) -> f64 {
        LONGEST * self.radius
    }

    /// Whether a cubic follows all of an arc.
    #[inline(always)]
    pub fn takes_whole(&self, arc: &Arc) -> bool {
        let is_short = arc.to - arc.from <= self.longest();
        is_short && !self.is_too_steep(arc.centre, arc.from, arc.to)
    }

    /// Whether an arc around `centre` is too long for its slope at the steeper end.
    #[inline(always)]
    fn is_too_steep(&self, centre: Point, from: f64, to: f64) -> bool {
        let off = (from - centre.x).abs().max((to - centre.x).abs());
        // The square of the slope's cosine is this over the square of the radius.
        let square = self.radius * self.radius - off * off;
        STEEP * self.radius * (to - from) > LONGEST * square
    }

    /// Adds arcs that meet, with one piece each.
    pub fn add_whole(&mut self, arcs: &[Arc]) {
        if let Some(first) = arcs.first() {
            self.begin_at(first.from);
        }
        self.s.extend(arcs.iter().map(|arc| arc.to));
        self.centre_x.extend(arcs.iter().map(|arc| arc.centre.x));
        self.centre_y.extend(arcs.iter().map(|arc| arc.centre.y));
        if let Some(run) = self.runs.last_mut() {
            run.pieces += arcs.len();
        }
    }

    /// Begins a run at a signed position, unless the last one ends there.
    fn begin_at(&mut self, from: f64) {
        if self.s.last() != Some(&from) {
            self.runs.push(PieceRun {
                first: self.centre_x.len(),
                pieces: 0,
                first_end: self.s.len(),
            });
            self.s.push(from);
        }
    }

    /// Adds an arc from one signed position to another, mm, in pieces of equal length. They are halved where
    /// the arc is steep.
    pub fn divide(&mut self, centre: Point, from: f64, to: f64) {
        self.begin_at(from);
        let count = ((to - from) / self.longest()).ceil();
        let length = (to - from) / count;
        let mut begin = from;
        for i in 1..count as usize {
            let end = from + length * i as f64;
            self.add_in_halves(centre, begin, end, MOST_HALVINGS);
            begin = end;
        }
        self.add_in_halves(centre, begin, to, MOST_HALVINGS);
    }

    /// Adds a part of an arc to the last run. It is halved up to so many times, until it is not too steep.
    fn add_in_halves(&mut self, centre: Point, from: f64, to: f64, halvings: usize) {
        let middle = 0.5 * (from + to);
        let is_divisible = from < middle && middle < to;
        if halvings == 0 || !is_divisible || !self.is_too_steep(centre, from, to) {
            self.add_piece(centre, to);
            return;
        }
        self.add_in_halves(centre, from, middle, halvings - 1);
        self.add_in_halves(centre, middle, to, halvings - 1);
    }

    /// Adds a piece to the last run.
    fn add_piece(&mut self, centre: Point, to: f64) {
        self.s.push(to);
        self.centre_x.push(centre.x);
        self.centre_y.push(centre.y);
        if let Some(run) = self.runs.last_mut() {
            run.pieces += 1;
        }
    }

    /// Places the inner nodes of all pieces, and all nodes on the part.
    pub fn place_nodes(&mut self) {
        let nodes = self.s.len() + 2 * self.centre_x.len();
        for column in [&mut self.s, &mut self.x, &mut self.y] {
            column.resize(nodes, 0.0);
        }
        in_widest(Places(self));
    }

    /// The index of the left end of a piece.
    pub fn left_end(&self, piece: usize) -> usize {
        // Each run before it has one end more than pieces.
        piece + self.runs.partition_point(|run| run.first <= piece) - 1
    }

    /// A column of nodes in three: the ends of all pieces, their left inner nodes, their right ones.
    #[inline(always)]
    pub fn by_place<'a>(&self, of_nodes: &'a [f64]) -> [&'a [f64]; 3] {
        let pieces = self.centre_x.len();
        let (rest, right) = of_nodes.split_at(of_nodes.len() - pieces);
        let (ends, left) = rest.split_at(rest.len() - pieces);
        [ends, left, right]
    }
}

/// The loop that places nodes.
struct Places<'a>(&'a mut Pieces);

impl Loop for Places<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(all) = self;
        let pieces = all.centre_x.len();
        let ends = all.s.len() - 2 * pieces;
        let (ends, inner) = all.s.split_at_mut(ends);
        let (left, right) = inner.split_at_mut(pieces);
        for run in &all.runs {
            let of_run = run.first..run.first + run.pieces;
            let ends = &ends[run.first_end..=run.first_end + run.pieces];
            let inner = left[of_run.clone()].iter_mut().zip(&mut right[of_run]);
            for ((left, right), (from, to)) in inner.zip(ends.iter().zip(&ends[1..])) {
                let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
                (*left, *right) = (middle - INNER * half, middle + INNER * half);
            }
        }
        let (sin, cos) = all.turned;
        for ((s, x), y) in all.s.iter().zip(&mut all.x).zip(&mut all.y) {
            (*x, *y) = (s * cos, s * sin);
        }
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::{DEG, Scalar};

    use super::*;

    /// The ends of the pieces of an arc.
    fn ends(radius: f64, from: f64, to: f64) -> Vec<f64> {
        let mut pieces = Pieces {
            radius,
            ..Pieces::default()
        };
        pieces.divide(Point::new(0.0, radius), from, to);
        assert_eq!(pieces.runs.len(), 1);
        assert_eq!(pieces.runs[0].pieces + 1, pieces.s.len());
        pieces.s
    }

    #[test]
    fn up_to_45_degrees_all_pieces_of_an_arc_are_equally_long() {
        let ends = ends(2.0, -1.4, 1.4);
        assert_eq!(ends.len(), 46);
        let each = ends.windows(2).map(|pair| pair[1] - pair[0]);
        for length in each {
            assert!((length * 45.0 / 2.8 - 1.0).abs() < 1e-12, "{length}");
        }
    }

    /// A fourth derivative f departs from the cubic through the nodes ±1 and ±1/√5 of a piece by up to
    /// f h⁴/120, with half its length h. That of an arc is 3 R² (R² + 4 u²)/(R² − u²)^3.5.
    #[test]
    fn a_cubic_follows_all_pieces_of_an_arc_up_to_89_degrees() {
        let radius: f64 = 2.0;
        for degrees in [50.0, 70.0, 82.0, 89.0] {
            let steepest = radius * Scalar::sin_cos(degrees * DEG).0;
            let ends = ends(radius, -steepest, steepest);
            assert!(ends.len() < 300, "{}", ends.len());
            for pair in ends.windows(2) {
                let (square, off) = (radius * radius, pair[0].abs().max(pair[1].abs()));
                let bend = 3.0 * square * (square + 4.0 * off * off);
                let lift = square - off * off;
                let fourth = bend / (lift * lift * lift * lift.sqrt());
                let half = 0.5 * (pair[1] - pair[0]);
                let departure = fourth * half * half * half * half / 120.0;
                assert!(departure < 5.2e-8 * radius, "{pair:?}");
            }
        }
    }

    #[test]
    fn an_arc_of_a_rounding_is_one_piece() {
        let ends = ends(2.0, 2.0, 2.0 + 2.0 * f64::EPSILON);
        assert!(ends.len() < 5, "{ends:?}");
    }

    /// The slope has no bound there.
    #[test]
    fn an_arc_that_ends_upright_has_a_bounded_number_of_pieces() {
        let ends = ends(2.0, -2.0, 2.0);
        assert!(
            ends.is_sorted() && (200..400).contains(&ends.len()),
            "{}",
            ends.len()
        );
    }
}
