//! What a column of the comparison is: a figure of a run, its heading and its form.

use crate::ablation::MeasuredRun;
use crate::verdict::Verdict;

/// A column of the comparison.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Its name, by which it is chosen.
    pub name: &'static str,
    /// Its heading in the table, line by line; the last line is the unit.
    pub heading: &'static [&'static str],
    /// Its heading in `ablation.csv`.
    pub csv: &'static str,
    /// The figure of a run in the heading's unit, if the run has one.
    pub figure: fn(&MeasuredRun) -> Option<f64>,
    /// How it is written.
    pub form: Form,
    /// Whether the figure's own tolerance holds, where it can have one and the recipe gives it.
    pub holds: Option<fn(&Verdict) -> Option<bool>>,
    /// Which of its figures is marked.
    pub best: Best,
    /// Whether it covers only where the law is the feed strategy's own.
    pub of_law: bool,
}

/// Figures below this are rounding: 1e-8 nm, or mm/s.
const ROUNDING: f64 = 1e-8;
/// The same for accelerations, mm/s²: they come from differences of positions over small steps of time,
/// by the square of which the rounding of the positions is divided. It is a thousand-millionth of g.
const ROUNDING_OF_ACCELERATION: f64 = 1e-5;
/// Figures that differ by less than this part differ by chance: by where the last step of a refinement
/// or of a search falls.
pub const NOISE: f64 = 0.01;

impl Column {
    /// A number of this column, 0 where it is rounding alone.
    pub fn tidy(&self, number: f64) -> f64 {
        let rounding = match self.name.contains("acceleration") {
            true => ROUNDING_OF_ACCELERATION,
            false => ROUNDING,
        };
        if number.abs() < rounding { 0.0 } else { number }
    }

    /// The figure of a run, 0 where it is rounding alone.
    pub fn tidied(&self, run: &MeasuredRun) -> Option<f64> {
        (self.figure)(run).map(|number| self.tidy(number))
    }
}

/// Which figure of a column is the best.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Best {
    /// The smallest.
    Smallest,
    /// The largest.
    Largest,
    /// None: it differs from call to call.
    None,
}

/// How a figure is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// A count, in full.
    Count,
    /// With four digits.
    Real,
    /// A count of bytes, in kB with four digits.
    Bytes,
    /// As a real, in seconds of the processor.
    Clock,
}
