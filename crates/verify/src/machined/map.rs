//! Surface error cell by cell, for paths of any length: block after block, each cell the lowest
//! of what the passes near it leave.
//!
//! A cell asks only the passes that can matter. One that leaves it higher than the lowest so far by
//! twice the largest interpolation error is further off than any that could be lower, and what lies
//! behind it is not looked at. Where the first touch may jump, every pass within reach is.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Gradients, Part, Result, Scalar};

use super::envelope::lower_arc;
use super::grid::{Grid, Place};
use super::sections::to_centres;
use super::turns::Turns;
use crate::cusp::Point;
use crate::touch::FirstTouch;

/// By how much errors of playback can exceed the largest of its instants, as a part and in mm.
const UNSEEN: (f64, f64) = (0.1, 1e-6);

/// A map in the making. Cells hold machined − wanted in mm as f32: a part of 6e-8 of the error,
/// since what was wanted is taken off before.
#[derive(Debug, Clone)]
pub struct Map {
    grid: Grid,
    part: Part,
    /// Infinite where nothing cut so far.
    errors: Vec<f32>,
}

/// What cuts, and how far from where it should a pass can be.
pub struct Nose<'a> {
    touch: &'a FirstTouch,
    /// Passes further from a cell than one that stands this much above the lowest so far, mm,
    /// leave it alone.
    slack: f64,
}

impl<'a> Nose<'a> {
    /// `largest_error`: the largest |played − true| of the path, mm; infinite where not known.
    pub fn new(touch: &'a FirstTouch, largest_error: f64) -> Self {
        let (share, more) = UNSEEN;
        let known = touch.is_single() && largest_error.is_finite();
        let slack = match known {
            true => 2.0 * (1.0 + share) * largest_error + more,
            false => f64::INFINITY,
        };
        Self { touch, slack }
    }
}

impl Map {
    /// Nothing cut yet.
    pub fn new(grid: Grid, part: Part) -> Self {
        let errors = vec![f32::INFINITY; grid.rows() * grid.columns()];
        Self { grid, part, errors }
    }

    /// Its grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Errors of a row, mm; NaN outside the part and where nothing cut.
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
            rows.enumerate()
                .try_for_each_init(Room::default, |room, (row, errors)| {
                    let places = (0..errors.len()).map(|column| grid.place(row, column));
                    room.cut(nose, &turns, &part, places, errors)
                })?;
        }
        Ok(())
    }
}

/// A cell that a stretch may cut.
struct Cell {
    column: usize,
    angle: f64,
    rho: f64,
    wanted: f64,
    /// Signed X at which the nose would touch the wanted surface here.
    target: f64,
}

/// One way from a cell through the passes of one side.
struct Walker {
    cell: usize,
    /// 1 on the cell's side of the axis, −1 on the other.
    side: f64,
    turn: i64,
    step: i64,
    end: i64,
}

/// Room for a row.
#[derive(Default)]
struct Room {
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

impl Room {
    fn cut(
        &mut self,
        nose: &Nose<'_>,
        turns: &Turns,
        part: &Part,
        places: impl Iterator<Item = Place>,
        errors: &mut [f32],
    ) -> Result<()> {
        self.take_cells(nose, turns, part, places)?;
        self.send_walkers(nose, turns);
        while !self.walkers.is_empty() {
            self.walk(nose, turns, errors)?;
        }
        Ok(())
    }

    /// The cells of the part that lie within reach of the stretch's ring.
    fn take_cells(
        &mut self,
        nose: &Nose<'_>,
        turns: &Turns,
        part: &Part,
        places: impl Iterator<Item = Place>,
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
        for (column, (x, y)) in places.enumerate() {
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

    /// How far from a cell the X of a pass can lie that cuts it: from the contact to the edge
    /// of the nose where X is that of the contact.
    fn margin(&self, nose: &Nose<'_>) -> f64 {
        let subject = nose.touch.subject();
        let reach = subject.tool.reach();
        match subject.compensates_nose {
            true => reach,
            false => reach + subject.tool.nose_radius,
        }
    }

    /// From the pass that comes nearest to touching each cell, both ways; on both sides of the
    /// axis where the nose reaches over it.
    fn send_walkers(&mut self, nose: &Nose<'_>, turns: &Turns) {
        let margin = self.margin(nose);
        self.walkers.clear();
        for (index, cell) in self.cells.iter().enumerate() {
            for side in [1.0, -1.0] {
                let place = side * cell.rho;
                if place + margin < turns.x.0 || place - margin > turns.x.1 {
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

    /// One pass onward for each walker; those that cannot come lower any more are done.
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
            let place = walker.side * cell.rho;
            if (place - centre.x).abs() > reach {
                return walker.comes_nearer(place, centre.x, turns.grows);
            }
            let error = lower_arc(*centre, radius, place) - cell.wanted;
            let lowest = &mut errors[cell.column];
            *lowest = lowest.min(error as f32);
            walker.onward() && error <= f64::from(*lowest) + nose.slack
        });
        Ok(())
    }
}

impl Cell {
    /// C, within a turn or so, of the passes on one side.
    fn angle_of(&self, side: f64) -> f64 {
        if side > 0.0 {
            self.angle
        } else {
            self.angle + PI
        }
    }
}

impl Walker {
    /// Goes on to the next pass, if there is one.
    fn onward(&mut self) -> bool {
        self.turn += self.step;
        self.turn != self.end
    }

    /// Goes on if the passes still come towards the place.
    fn comes_nearer(&mut self, place: f64, x: f64, grows: bool) -> bool {
        let rises = grows == (self.step > 0);
        (rises == (x < place)) && self.onward()
    }
}
