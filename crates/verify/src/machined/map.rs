//! Maps of the surface error, cell by cell, for paths of any length. The path comes block after
//! block, and each cell keeps the lowest error that a pass near it leaves.
//!
//! A cell needs only some of the passes. A pass that leaves the cell higher than the lowest error
//! so far by more than twice the largest interpolation error lies too far away, and so do the
//! passes behind it: none of them can be lower, and they are not computed. Where the height of the
//! nose may have several maxima, every pass within reach is computed.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Gradients, Part, Result, Scalar};

use super::grid::{Grid, GridPoint};
use super::sections::to_centres;
use super::turns::Turns;
use crate::cusp::Point;
use crate::lower_arc::lower_arc;
use crate::order::in_order;
use crate::touch::FirstTouch;

/// How far an error between the instants of the playback can exceed the largest error at them: as a
/// part of it, and in mm.
const BETWEEN_INSTANTS: (f64, f64) = (0.1, 1e-6);

/// A map of the surface error. Cells hold machined − wanted in mm as f32. The wanted height is
/// subtracted before the conversion, so it costs only 6e-8 of the error.
#[derive(Debug, Clone)]
pub struct Map {
    grid: Grid,
    part: Part,
    /// Infinite where no pass has cut so far.
    errors: Vec<f32>,
}

/// The nose that cuts a map, and how far its passes can be off.
pub struct Nose<'a> {
    touch: &'a FirstTouch,
    /// A pass that leaves a cell this much higher than the lowest error so far, mm, shows that no
    /// pass behind it cuts the cell lower.
    slack: f64,
}

impl<'a> Nose<'a> {
    /// The nose of a path. `largest_error` is the largest |played − true| of the path, mm; infinite
    /// if it is not known.
    pub fn new(touch: &'a FirstTouch, largest_error: f64) -> Self {
        let (share, more) = BETWEEN_INSTANTS;
        let known = touch.has_single_maximum() && largest_error.is_finite();
        let slack = match known {
            true => 2.0 * (1.0 + share) * largest_error + more,
            false => f64::INFINITY,
        };
        Self { touch, slack }
    }
}

impl Map {
    /// A map on which nothing is cut yet.
    pub fn new(grid: Grid, part: Part) -> Self {
        let errors = vec![f32::INFINITY; grid.rows() * grid.columns()];
        Self { grid, part, errors }
    }

    /// The grid of the map.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The errors of a row, mm; NaN outside the part and where no pass has cut.
    pub fn row(&self, row: usize) -> impl Iterator<Item = f32> + '_ {
        let columns = self.grid.columns();
        let cells = self.errors.iter().skip(row * columns).take(columns);
        cells.map(|error| if error.is_finite() { *error } else { f32::NAN })
    }

    /// Cuts with the next block of the path, rows in parallel.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn cut(&mut self, nose: &Nose<'_>, block: &PathBlock) -> Result<()> {
        let (grid, part) = (self.grid, self.part);
        for turns in Turns::of(block) {
            let rows = self.errors.par_chunks_mut(grid.columns().max(1));
            let cut = |buffers: &mut RowBuffers, (row, errors): (usize, &mut [f32])| {
                let points = (0..errors.len()).map(|column| grid.point(row, column));
                buffers.cut(nose, &turns, &part, points, errors)
            };
            in_order(rows.enumerate().map_init(RowBuffers::default, cut))?;
        }
        Ok(())
    }
}

/// A cell that these turns may cut.
struct Cell {
    column: usize,
    angle: f64,
    rho: f64,
    /// Wanted z, mm.
    wanted: f64,
    /// Signed X at which the nose would touch the wanted surface at this cell.
    target: f64,
}

/// A walk in one direction through the passes near a cell, on one side of the axis.
struct Walker {
    /// Index of the cell.
    cell: usize,
    /// 1 on the cell's side of the axis, −1 on the other.
    side: f64,
    turn: i64,
    step: i64,
    end: i64,
}

/// Buffers for one row of the map. They are used again for the next row.
#[derive(Default)]
struct RowBuffers {
    cells: Vec<Cell>,
    walkers: Vec<Walker>,
    centres: Vec<Point>,
    columns: Vec<usize>,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    zx: Vec<f64>,
    zy: Vec<f64>,
}

impl RowBuffers {
    fn cut(
        &mut self,
        nose: &Nose<'_>,
        turns: &Turns,
        part: &Part,
        points: impl Iterator<Item = GridPoint>,
        errors: &mut [f32],
    ) -> Result<()> {
        self.collect_cells(nose, turns, part, points)?;
        self.start_walkers(nose, turns);
        while !self.walkers.is_empty() {
            self.walk(nose, turns, errors)?;
        }
        Ok(())
    }

    /// Collects the cells of the part that lie within reach of the ring of these turns.
    fn collect_cells(
        &mut self,
        nose: &Nose<'_>,
        turns: &Turns,
        part: &Part,
        points: impl Iterator<Item = GridPoint>,
    ) -> Result<()> {
        let subject = nose.touch.subject();
        let margin = self.margin(nose);
        let (low, high) = (turns.x.0 - margin, turns.x.1 + margin);
        let on_part = |rho: f64| part.inner_radius <= rho && rho <= part.aperture_radius;
        let near = |rho: f64| (low <= rho && rho <= high) || (low <= -rho && -rho <= high);
        for column in [&mut self.x, &mut self.y] {
            column.clear();
        }
        self.columns.clear();
        for (column, (x, y)) in points.enumerate() {
            let rho = (x * x + y * y).sqrt();
            if on_part(rho) && near(rho) {
                self.columns.push(column);
                self.x.push(x);
                self.y.push(y);
            }
        }
        for column in [&mut self.z, &mut self.zx, &mut self.zy] {
            column.resize(self.x.len(), 0.0);
        }
        let out = Gradients {
            z: &mut self.z,
            zx: &mut self.zx,
            zy: &mut self.zy,
        };
        subject.surface.gradient(&self.x, &self.y, out)?;
        self.cells.clear();
        for (i, column) in self.columns.iter().enumerate() {
            let (x, y) = (self.x[i], self.y[i]);
            let rho = (x * x + y * y).sqrt();
            let radial = (x * self.zx[i] + y * self.zy[i]) / rho;
            let slope = if rho > 0.0 { radial } else { self.zx[i] };
            let offset = match subject.compensates_nose {
                true => -subject.tool.nose_radius * slope / (1.0 + slope * slope).sqrt(),
                false => 0.0,
            };
            self.cells.push(Cell {
                column: *column,
                angle: Scalar::atan2(y, x),
                rho,
                wanted: self.z[i],
                target: rho + offset,
            });
        }
        Ok(())
    }

    /// The largest distance between a cell and the X of a pass that cuts it, mm. It is larger by
    /// the nose radius where X is that of the contact.
    fn margin(&self, nose: &Nose<'_>) -> f64 {
        let subject = nose.touch.subject();
        let reach = subject.tool.reach();
        match subject.compensates_nose {
            true => reach,
            false => reach + subject.tool.nose_radius,
        }
    }

    /// Starts walkers at the pass that comes nearest to touching each cell, in both directions, and
    /// on both sides of the axis where the nose reaches over it.
    fn start_walkers(&mut self, nose: &Nose<'_>, turns: &Turns) {
        let margin = self.margin(nose);
        self.walkers.clear();
        for (index, cell) in self.cells.iter().enumerate() {
            for side in [1.0, -1.0] {
                let s = side * cell.rho;
                if s + margin < turns.x.0 || s - margin > turns.x.1 {
                    continue;
                }
                let angle = cell.angle_of(side);
                let (first, end) = turns.passes(angle);
                let start = turns.first_beyond(angle, side * cell.target);
                let ways = [(start, 1, end), (start - 1, -1, first - 1)];
                self.walkers.extend(ways.map(|(turn, step, end)| Walker {
                    cell: index,
                    side,
                    turn,
                    step,
                    end,
                }));
            }
        }
        self.walkers.retain(|walker| walker.turn != walker.end);
    }

    /// Moves each walker on by one pass. Walkers that can find no lower pass are dropped.
    fn walk(&mut self, nose: &Nose<'_>, turns: &Turns, errors: &mut [f32]) -> Result<()> {
        let tool = &nose.touch.subject().tool;
        let (radius, reach) = (tool.nose_radius, tool.reach());
        let Self {
            cells,
            walkers,
            centres,
            ..
        } = self;
        let angle = |walker: &Walker| cells[walker.cell].angle_of(walker.side);
        centres.clear();
        centres.extend(
            walkers
                .iter()
                .map(|walker| turns.at(angle(walker) + TAU * walker.turn as f64)),
        );
        to_centres(nose.touch, walkers.iter().map(angle), centres)?;
        let mut centres = centres.iter();
        walkers.retain_mut(|walker| {
            let (Some(centre), Some(cell)) = (centres.next(), cells.get(walker.cell)) else {
                return false;
            };
            let s = walker.side * cell.rho;
            if (s - centre.x).abs() > reach {
                return walker.comes_nearer(s, centre.x, turns.grows);
            }
            let error = lower_arc(*centre, radius, s) - cell.wanted;
            let lowest = &mut errors[cell.column];
            *lowest = lowest.min(error as f32);
            walker.advance() && error <= f64::from(*lowest) + nose.slack
        });
        Ok(())
    }
}

impl Cell {
    /// C of the passes on one side, up to whole turns, rad.
    fn angle_of(&self, side: f64) -> f64 {
        if side > 0.0 {
            self.angle
        } else {
            self.angle + PI
        }
    }
}

impl Walker {
    /// Moves on to the next pass, if there is one.
    fn advance(&mut self) -> bool {
        self.turn += self.step;
        self.turn != self.end
    }

    /// Moves on if the passes still come towards the signed radius `s`.
    fn comes_nearer(&mut self, s: f64, x: f64, grows: bool) -> bool {
        let rises = grows == (self.step > 0);
        (rises == (x < s)) && self.advance()
    }
}
