//! The rows of a file against the rows that its recipe gives.
//!
//! Both paths are read in order and merged by C, which grows along a path. A row of the file belongs
//! to the row of the recipe's path whose C is nearest. So a row that is lost or added moves no other
//! row out of its place. Times are compared from row to row: if the time of one segment is wrong, all
//! rows after it come late, and only one of them is at fault. So are C, X and Z of a file that says how far it
//! is from point to point.
//!
//! What a row that differs is worth is how far it moves the played path: the largest change of the
//! height above the first touch between the rows on both sides that have a partner.

mod cell;
mod distances;
mod row;

use turnpath_core::toolpath::{ControlPoint, SegmentShape};
use turnpath_core::{Result, StrategyError};

use crate::touch::FirstTouch;
use crate::worst_first::WorstFirst;

use cell::{Stretch, distance};
use distances::{Kinship, Neighbourhood, Shift};
pub use row::{Column, HalfDigits, PathRow};

/// If more than this part of a file's rows are not those of the recipe's path, then the file is
/// another maker's, and its rows say nothing about faults. A spoiled file has few wrong rows.
const OTHER_MAKER: f64 = 0.01;
/// So few wrong rows do not make a file another maker's, unless they are [`MOST`] of its rows.
const FEW: u64 = 16;
/// The part of the rows that is most of them.
const MOST: f64 = 0.5;
/// Most rows between two rows with a partner that are kept to be played: more than a revolution has.
/// They take 18 MB on either side.
const MOST_UNPAIRED: usize = 100_000;

/// What is wrong with a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RowFault {
    /// The recipe's path has it, and the file has not.
    Lost,
    /// The file has it, and the recipe's path has not.
    Added,
    /// It differs in these columns.
    Differs(Vec<Column>),
}

/// A row of a file that is not as the recipe gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct RowAnomaly {
    /// Number of the row in the file, counted from 1. For a row that is lost, it is the number that
    /// the row would have.
    pub row: u64,
    /// C of the row, unwrapped, rad.
    pub c: f64,
    /// X of the row, mm.
    pub x: f64,
    /// What is wrong with it.
    pub fault: RowFault,
    /// How far it moves the played path along z, mm. NaN if nothing is played there to compare with:
    /// at an end of the path that is lost, or where the surface has no height.
    pub worth: f64,
}

/// What a comparison found.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonFigures {
    /// Rows that are not as the recipe gives them.
    pub count: u64,
    /// The worst rows, the worst one first.
    pub worst: Vec<RowAnomaly>,
}

/// Two rows that belong together.
#[derive(Debug, Clone, Copy)]
struct RowPair {
    file: PathRow,
    remade: PathRow,
    differs: bool,
}

/// What is known about times.
#[derive(Debug, Clone, Copy)]
struct TimeShift {
    /// Time in the file − time in the recipe's path, of the last row whose time was right, s.
    right: f64,
    /// The same of the last row; `None` after a row without a partner, whose own time may be lost.
    last: Option<f64>,
}

/// A row with its number in the file.
#[derive(Debug, Clone, Copy)]
struct NumberedRow {
    /// As [`RowAnomaly::row`].
    row: u64,
    point: ControlPoint,
}

/// Rows between two pairs, those of the file or those of the recipe's path.
#[derive(Debug, Clone, Default)]
struct Unpaired {
    rows: Vec<NumberedRow>,
    /// Whether there were more than are kept.
    overflows: bool,
}

/// Compares two paths row by row. It keeps the rows since the last pair and the worst anomalies.
pub struct RowComparison {
    touch: FirstTouch,
    shape: SegmentShape,
    digits: HalfDigits,
    /// The row of the recipe's path that is compared next.
    waiting: Option<PathRow>,
    /// The next rows of the file, two at the most.
    ahead: Vec<PathRow>,
    ended: bool,
    /// Number of the file's row that is compared next.
    row: u64,
    last: Option<RowPair>,
    lost: Unpaired,
    added: Unpaired,
    late: Option<TimeShift>,
    /// How far the file's next row is moved, if the file says how far it is from point to point.
    moved: Option<Shift>,
    /// The anomaly of the last pair, whose segment after it is not known yet.
    open: Option<RowAnomaly>,
    wrong: u64,
    found: WorstFirst<RowAnomaly>,
}

impl RowComparison {
    /// A comparison of paths that are played in this `shape`. Worths are measured by `touch`.
    pub fn new(touch: FirstTouch, shape: SegmentShape, digits: HalfDigits) -> Self {
        Self {
            touch,
            shape,
            digits,
            waiting: None,
            ahead: Vec::new(),
            ended: false,
            row: 1,
            last: None,
            lost: Unpaired::default(),
            added: Unpaired::default(),
            late: None,
            moved: None,
            open: None,
            wrong: 0,
            found: WorstFirst::default(),
        }
    }

    /// The comparison with a file that says how far it is from point to point: one wrong number moves all
    /// rows behind it.
    #[must_use]
    pub fn of_distances(self) -> Self {
        let moved = Some(Shift::default());
        Self { moved, ..self }
    }

    /// Takes the next row of the recipe's path, and as many rows of the file as belong before it.
    /// `next` gives the file's next row.
    ///
    /// # Errors
    /// When the file's next row cannot be read, or the surface fails.
    pub fn push<E: From<StrategyError>>(
        &mut self,
        remade: PathRow,
        next: &mut dyn FnMut() -> std::result::Result<Option<PathRow>, E>,
    ) -> std::result::Result<(), E> {
        match self.waiting.replace(remade) {
            Some(waiting) => self.place(waiting, Some(&remade), next),
            None => Ok(()),
        }
    }

    /// Whether a file with so many rows is another maker's, by the rows that were compared so far.
    /// Rows that are lost do not count: a file that was cut short is still the program's own.
    pub fn is_of_other_maker(&self, rows: u64) -> bool {
        let (wrong, rows) = (self.wrong as f64, rows as f64);
        wrong > MOST * rows || (self.wrong > FEW && wrong > OTHER_MAKER * rows)
    }

    /// Ends both paths.
    ///
    /// # Errors
    /// As [`Self::push`].
    pub fn finish<E: From<StrategyError>>(
        &mut self,
        next: &mut dyn FnMut() -> std::result::Result<Option<PathRow>, E>,
    ) -> std::result::Result<(), E> {
        if let Some(waiting) = self.waiting.take() {
            self.place(waiting, None, next)?;
        }
        loop {
            self.look_ahead(next)?;
            if self.ahead.is_empty() {
                return Ok(());
            }
            self.add_row();
        }
    }

    /// What was found.
    pub fn into_figures(mut self) -> ComparisonFigures {
        self.found_all(self.open.clone());
        self.rate_unpaired(f64::NAN);
        ComparisonFigures {
            count: self.found.count(),
            worst: self.found.into_items(),
        }
    }

    fn found_all(&mut self, anomalies: impl IntoIterator<Item = RowAnomaly>) {
        for anomaly in anomalies {
            self.found.add(anomaly.worth, anomaly);
        }
    }

    /// Reads the file until its next two rows are known.
    fn look_ahead<E>(
        &mut self,
        next: &mut dyn FnMut() -> std::result::Result<Option<PathRow>, E>,
    ) -> std::result::Result<(), E> {
        while self.ahead.len() < 2 && !self.ended {
            match next()? {
                Some(row) => self.ahead.push(row),
                None => self.ended = true,
            }
        }
        Ok(())
    }

    /// Finds the partner of a row of the recipe's path; `after` is the row that follows it.
    fn place<E: From<StrategyError>>(
        &mut self,
        remade: PathRow,
        after: Option<&PathRow>,
        next: &mut dyn FnMut() -> std::result::Result<Option<PathRow>, E>,
    ) -> std::result::Result<(), E> {
        loop {
            self.look_ahead(next)?;
            let Some(file) = self.ahead.first().copied() else {
                self.lose_row(&remade);
                return Ok(());
            };
            let by_distances = self.kinship_by_distances(&remade, after);
            match by_distances.unwrap_or_else(|| self.kinship_by_c(&file, &remade, after)) {
                Kinship::Added => self.add_row(),
                Kinship::PartnerOfNext => {
                    self.lose_row(&remade);
                    return Ok(());
                }
                Kinship::Partner => {
                    self.ahead.remove(0);
                    return Ok(self.pair(file, remade)?);
                }
            }
        }
    }

    /// What the file's next row is, by the distances around it. Only a file of distances shows it.
    fn kinship_by_distances(&self, remade: &PathRow, after: Option<&PathRow>) -> Option<Kinship> {
        let last = self.last.as_ref().filter(|_| self.moved.is_some())?;
        let around = Neighbourhood {
            last: [&last.file, &last.remade],
            file: [self.ahead.first(), self.ahead.get(1)],
            remade: [Some(remade), after],
        };
        around.kinship(&self.digits)
    }

    /// What the file's next row is, by the nearest C.
    fn kinship_by_c(&self, file: &PathRow, remade: &PathRow, after: Option<&PathRow>) -> Kinship {
        let as_meant = |row: &PathRow| self.moved.map_or(*row, |moved| moved.taken_from(row));
        let off = |row: &PathRow| row.point.c - remade.point.c;
        let of_file = off(&as_meant(file));
        let is_nearer = |second: &PathRow| off(&as_meant(second)).abs() < of_file.abs();
        // A row of a wild C comes before one whose C is right: it is the wild one that has no partner.
        if self.ahead.get(1).is_some_and(is_nearer) {
            Kinship::Added
        } else if after.is_some_and(|after| 2.0 * of_file > off(after)) {
            Kinship::PartnerOfNext
        } else {
            Kinship::Partner
        }
    }

    fn lose_row(&mut self, row: &PathRow) {
        let row = NumberedRow {
            row: self.row,
            point: row.point,
        };
        let beyond = self.lost.push(row);
        self.found_all(beyond.map(|row| row.anomaly(RowFault::Lost)));
        self.forget_time();
    }

    /// Counts the file's next row as added.
    fn add_row(&mut self) {
        let row = NumberedRow {
            row: self.row,
            point: self.ahead.remove(0).point,
        };
        let beyond = self.added.push(row);
        self.found_all(beyond.map(|row| row.anomaly(RowFault::Added)));
        self.forget_time();
        self.row += 1;
        self.wrong += 1;
    }

    /// The time of a row that follows one without a partner says nothing.
    fn forget_time(&mut self) {
        if let Some(shift) = &mut self.late {
            shift.last = None;
        }
    }

    fn pair(&mut self, file: PathRow, remade: PathRow) -> Result<()> {
        let mut columns = self.differing(&file, &remade);
        if !self.time_is_right(&file, &remade) {
            columns.insert(0, Column::Time);
        }
        let differs = !columns.is_empty();
        self.wrong += u64::from(differs);
        let row = NumberedRow {
            row: self.row,
            point: file.point,
        };
        let anomaly = differs.then(|| row.anomaly(RowFault::Differs(columns)));
        self.row += 1;
        let pair = RowPair {
            file,
            remade,
            differs,
        };
        let worth = self.close_cell(&pair)?;
        let follow = |open: RowAnomaly| RowAnomaly {
            worth: larger(open.worth, worth),
            ..open
        };
        let before = self.open.take().map(follow);
        self.found_all(before);
        // The path's first row has no segment before it.
        let worth = if self.last.is_some() { worth } else { 0.0 };
        self.open = anomaly.map(|anomaly| RowAnomaly { worth, ..anomaly });
        self.last = Some(pair);
        Ok(())
    }

    /// The columns, the time excepted, in which two rows differ. A row of distances differs only where its own
    /// distance does.
    fn differing(&mut self, file: &PathRow, remade: &PathRow) -> Vec<Column> {
        let Some(moved) = &mut self.moved else {
            return self.digits.differing(file, remade);
        };
        let follows_its_partner = self.lost.rows.is_empty() && self.added.rows.is_empty();
        let here = Shift::between(file, remade, &self.digits);
        if !follows_its_partner {
            // Rows that are lost or added have moved it.
            *moved = here;
        }
        let columns = self.digits.differing(&moved.taken_from(file), remade);
        if !columns.is_empty() {
            *moved = here;
        }
        columns
    }

    /// Whether a row comes as long after the row before it as in the recipe's path.
    fn time_is_right(&mut self, file: &PathRow, remade: &PathRow) -> bool {
        let shift = file.point.t - remade.point.t;
        let at = file.point.t.abs().max(remade.point.t.abs());
        let Some(known) = &mut self.late else {
            self.late = Some(TimeShift {
                right: shift,
                last: Some(shift),
            });
            return true;
        };
        let same = |other: f64| self.digits.same_shift(shift, other, at);
        let is_right = same(known.right) || known.last.is_none_or(same);
        if is_right {
            known.right = shift;
        }
        known.last = Some(shift);
        is_right
    }

    /// Measures what is played from the last pair to this one, if it differs, and gives the rows
    /// between both their worth.
    fn close_cell(&mut self, pair: &RowPair) -> Result<f64> {
        let Some(last) = self.last else {
            self.rate_unpaired(f64::NAN);
            return Ok(f64::NAN);
        };
        let unpaired = !(self.lost.rows.is_empty() && self.added.rows.is_empty());
        if !(unpaired || last.differs || pair.differs) {
            return Ok(0.0);
        }
        let worth = match self.lost.overflows || self.added.overflows {
            true => f64::NAN,
            false => {
                let file = self.added.between(&last.file, &pair.file, self.shape);
                let remade = self.lost.between(&last.remade, &pair.remade, self.shape);
                distance(&self.touch, &file, &remade)?
            }
        };
        self.rate_unpaired(worth);
        Ok(worth)
    }

    /// Gives the rows without a partner their worth.
    fn rate_unpaired(&mut self, worth: f64) {
        let lost = std::mem::take(&mut self.lost).rows.into_iter();
        let added = std::mem::take(&mut self.added).rows.into_iter();
        let lost = lost.map(|row| row.anomaly(RowFault::Lost));
        let all = lost.chain(added.map(|row| row.anomaly(RowFault::Added)));
        self.found_all(all.map(|anomaly| RowAnomaly { worth, ..anomaly }));
    }
}

impl NumberedRow {
    /// The anomaly of this row, whose worth is not known yet.
    fn anomaly(&self, fault: RowFault) -> RowAnomaly {
        RowAnomaly {
            row: self.row,
            c: self.point.c,
            x: self.point.x,
            fault,
            worth: f64::NAN,
        }
    }
}

/// The larger worth; NaN if one of them is not known.
fn larger(one: f64, other: f64) -> f64 {
    match one.is_nan() || other.is_nan() {
        true => f64::NAN,
        false => one.max(other),
    }
}

impl Unpaired {
    /// Keeps a row, or gives it back if there are too many: its worth will not be known.
    fn push(&mut self, row: NumberedRow) -> Option<NumberedRow> {
        if self.rows.len() < MOST_UNPAIRED {
            self.rows.push(row);
            return None;
        }
        self.overflows = true;
        Some(row)
    }

    /// What is played from the row before to the row after.
    fn between(&self, before: &PathRow, after: &PathRow, shape: SegmentShape) -> Stretch {
        let own = self.rows.iter().map(|row| row.point);
        let [before, after] = [before.point, after.point].map(std::iter::once);
        Stretch::new(before.chain(own).chain(after), shape)
    }
}
