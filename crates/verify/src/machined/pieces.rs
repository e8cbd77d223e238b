//! Pieces of the machined profile along a line, side by side in columns.

use std::ops::Range;

use turnpath_core::registers::{Loop, in_widest};

use super::envelope::Arc;
use super::samples::INNER;
use crate::cusp::Point;

/// Longest piece, as a part of the nose radius. On steep flanks a cubic follows an arc no further.
const LONGEST: f64 = 1.0 / 32.0;

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

    /// The longest piece, mm.
    pub fn longest(&self) -> f64 {
        LONGEST * self.radius
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

    /// Adds an arc from one signed position to another, mm, in pieces of equal length.
    pub fn divide(&mut self, centre: Point, from: f64, to: f64) {
        self.begin_at(from);
        let count = ((to - from) / self.longest()).ceil();
        let length = (to - from) / count;
        for i in 1..count as usize {
            self.add_piece(centre, from + length * i as f64);
        }
        self.add_piece(centre, to);
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
