//! The table of an ablation on a terminal: never wider than it is asked to be.
//!
//! A row begins with the value that varies. Beside it stand the figures, below these their ratios
//! to the first run, and below that what else does not hold. Where several keys vary, a row begins
//! with the last one's value, and the rows that share all others stand below a line with those.
//! Where the figures do not fit, several tables follow each other.

use crate::ablation::AblationRun;

use super::cells::{Cell, FigureColumn};
use super::column::{Best, Column, Form};
use super::labels::Labels;
use super::wording::wrapped;

/// Columns of the terminal that labels have at least.
const LEAST_LABEL: usize = 14;
/// What two of the columns are.
const OF_LAW: &str = "law's: apart from where the feed runs out at the path's ends";
const PROGRAM: &str = "program: the lines that the post makes of the points, measured";
const PLANNING: &str = "planning: processor time to make the path, measuring aside";

/// The runs side by side, on so many columns of the terminal, with their ratios to one of them, the first
/// one of the ablation, or without ratios.
pub fn table(
    runs: &[AblationRun],
    columns: &[&Column],
    widest: usize,
    base: Option<&AblationRun>,
) -> String {
    let labels = Labels::of(runs, widest);
    let columns = columns.iter();
    let columns: Vec<FigureColumn> = columns
        .map(|column| FigureColumn::of(runs, column, base))
        .collect();
    let parts = fitting(&columns, widest).into_iter();
    let parts: Vec<String> = parts.map(|part| labels.beside(part, runs)).collect();
    format!("{}{}", parts.join("\n"), legend(&columns, widest))
}

/// The columns in groups that fit beside the labels.
fn fitting(columns: &[FigureColumn], widest: usize) -> Vec<&[FigureColumn]> {
    let mut groups = Vec::new();
    let mut rest = columns;
    while !rest.is_empty() {
        let mut width = LEAST_LABEL;
        let fits = rest.iter().take_while(|column| {
            width += column.whole_width();
            width <= widest
        });
        let (group, left) = rest.split_at(fits.count().max(1));
        groups.push(group);
        rest = left;
    }
    groups
}

/// What the marks and the figures mean, as far as they occur.
fn legend(columns: &[FigureColumn], widest: usize) -> String {
    let any = |which: fn(&Cell) -> bool| columns.iter().flat_map(|one| &one.cells).any(which);
    let best = |kind: Best| {
        let mut of_kind = columns.iter().filter(|one| one.best == kind);
        of_kind.any(|one| one.cells.iter().any(|cell| cell.is_best))
    };
    let marks = [
        (best(Best::Smallest), "* smallest, or within 1 % of it"),
        (best(Best::Largest), "* largest speed, or within 1 % of it"),
        (any(|cell| cell.exceeds), "! exceeds its tolerance"),
        (
            any(|cell| !cell.ratio.is_empty()),
            "× ratio to the first run",
        ),
    ];
    let marks = marks.into_iter().filter(|mark| mark.0).map(|mark| mark.1);
    let marks: Vec<&str> = marks.collect();
    let words = |text: &'static str| text.split(' ').collect::<Vec<_>>();
    let has = |form: Form| columns.iter().any(|one| one.form == form);
    let lines = [
        (!marks.is_empty(), wrapped(&marks, "   ", widest)),
        (
            columns.iter().any(|one| one.of_law),
            wrapped(&words(OF_LAW), " ", widest),
        ),
        (has(Form::Bytes), wrapped(&words(PROGRAM), " ", widest)),
        (has(Form::Clock), wrapped(&words(PLANNING), " ", widest)),
    ];
    let lines = lines.into_iter().filter(|line| line.0);
    let lines: String = lines.map(|(_, line)| line + "\n").collect();
    format!("\n{lines}")
}
