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
