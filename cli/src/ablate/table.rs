//! The table of an ablation on a terminal: never wider than 100 columns.
//!
//! A row begins with the values that vary, one a line; beside them stand the figures, and below
//! these their ratios to the first run. Where the figures do not fit, several tables follow each
//! other.

use serde_json::Value;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::figures::grouped;

use super::columns::{Column, Form, number};

/// Widest table.
const WIDEST: usize = 100;
/// What labels have at least.
const LEAST_LABEL: usize = 14;
/// Marks the smallest figure of a column.
const BEST: &str = "*";
/// Marks a figure that exceeds its tolerance.
const EXCEEDS: &str = "!";
/// Where there is no figure.
const NONE: &str = "–";
/// Figures below this are rounding: 1e-9 nm, or mm/s².
const ROUNDING: f64 = 1e-9;
/// Columns that a figure takes besides its own width: a space before it, and its mark.
const AROUND: usize = 2;

/// The runs side by side.
pub fn table(entries: &[Value], columns: &[&Column]) -> String {
    let labels = Labels::of(entries);
    let columns: Vec<Figures> = columns
        .iter()
        .map(|column| Figures::of(entries, column))
        .collect();
    let parts = fitting(&columns);
    let parts: Vec<String> = parts
        .iter()
        .map(|part| labels.beside(part, entries))
        .collect();
    format!("{}{}", parts.join("\n"), legend(&columns))
}

/// The columns in groups that fit beside the labels.
fn fitting(columns: &[Figures]) -> Vec<&[Figures]> {
    let mut groups = Vec::new();
    let mut rest = columns;
    while !rest.is_empty() {
        let mut width = LEAST_LABEL;
        let fits = rest.iter().take_while(|column| {
            width += column.width + AROUND;
            width <= WIDEST
        });
        let (group, left) = rest.split_at(fits.count().max(1));
        groups.push(group);
        rest = left;
    }
    groups
}

/// What the marks mean, as far as they occur.
fn legend(columns: &[Figures]) -> String {
    let any = |which: fn(&Cell) -> bool| columns.iter().flat_map(|one| &one.cells).any(which);
    let mut marks = Vec::new();
    if any(|cell| cell.is_best) {
        marks.push("* smallest of its column");
    }
    if any(|cell| cell.exceeds) {
        marks.push("! exceeds its tolerance");
    }
    if any(|cell| !cell.ratio.is_empty()) {
        marks.push("× ratio to the first run");
    }
    let has = |form: Form| columns.iter().any(|one| one.form == form);
    let mut text = String::from("\n");
    if !marks.is_empty() {
        text += &marks.join("   ");
        text.push('\n');
    }
    if has(Form::Bytes) {
        text += "program: the lines that pmac-pvt makes of the points, measured\n";
    }
    if has(Form::Clock) {
        text += "planning: processor time to make and measure the path\n";
    }
    text
}

/// A run's figure in words.
struct Cell {
    text: String,
    ratio: String,
    is_best: bool,
    exceeds: bool,
}

/// A column in words.
struct Figures {
    head: Vec<&'static str>,
    form: Form,
    cells: Vec<Cell>,
    width: usize,
}

impl Figures {
    fn of(entries: &[Value], column: &Column) -> Self {
        let tidy = |number: f64| if number.abs() < ROUNDING { 0.0 } else { number };
        let figures = entries.iter().map(|entry| number(entry, column));
        let numbers: Vec<Option<f64>> = figures.map(|number| number.map(tidy)).collect();
        let best = best(&numbers, column.form).filter(|_| column.has_best());
        let first = numbers.first().copied().flatten();
        let rows = entries.iter().zip(&numbers).enumerate();
        let cells: Vec<Cell> = rows
            .map(|(row, (entry, number))| {
                let fails = |pointer| entry.pointer(pointer) == Some(&Value::Bool(false));
                let ratio = number.zip(first).filter(|_| row > 0);
                let text = number.map_or(NONE.to_owned(), |number| written(number, column.form));
                Cell {
                    is_best: best.as_ref() == Some(&text),
                    text,
                    ratio: ratio.map_or(String::new(), |(number, first)| ratio_of(number, first)),
                    exceeds: column.within.is_some_and(fails),
                }
            })
            .collect();
        let widths = cells.iter().flat_map(|cell| {
            let mark = usize::from(cell.exceeds);
            [cell.text.width() + mark, cell.ratio.width()]
        });
        let head = column.head.iter().map(|line| line.width());
        Self {
            width: widths.chain(head).max().unwrap_or(0),
            head: column.head.to_vec(),
            form: column.form,
            cells,
        }
    }

    /// Line `line` of `height` of the head, the unit on the last.
    fn head_line(&self, line: usize, height: usize) -> &str {
        let skipped = height.saturating_sub(self.head.len());
        let line = line.checked_sub(skipped);
        line.and_then(|line| self.head.get(line)).unwrap_or(&"")
    }
}

/// The smallest number as it is written, unless all are the same.
fn best(numbers: &[Option<f64>], form: Form) -> Option<String> {
    let there = || {
        numbers
            .iter()
            .flatten()
            .copied()
            .filter(|number| number.is_finite())
    };
    let least = there().fold(f64::INFINITY, f64::min);
    let least = written(least, form);
    let differ = there().any(|number| written(number, form) != least);
    differ.then_some(least)
}

/// What stands on the left.
struct Labels {
    keys: Vec<String>,
    /// The values of each run, a line each.
    rows: Vec<Vec<String>>,
}

impl Labels {
    fn of(entries: &[Value]) -> Self {
        let varied = |entry: &Value| entry.get("varied").and_then(Value::as_object).cloned();
        let all: Vec<_> = entries
            .iter()
            .map(|entry| varied(entry).unwrap_or_default())
            .collect();
        let keys = all
            .first()
            .map(|first| first.keys().map(|key| printable(key)).collect());
        let values = |value: &Value| printable(value.as_str().unwrap_or_default());
        Self {
            keys: keys.unwrap_or_default(),
            rows: all
                .iter()
                .map(|varied| varied.values().map(values).collect())
                .collect(),
        }
    }

    /// The labels with some columns beside them.
    fn beside(&self, columns: &[Figures], entries: &[Value]) -> String {
        let taken: usize = columns.iter().map(|column| column.width + AROUND).sum();
        let needed = self
            .rows
            .iter()
            .flatten()
            .chain(&self.keys)
            .map(|label| label.width());
        let label = needed.max().unwrap_or(0).min(WIDEST.saturating_sub(taken));
        let mut text = String::new();
        let head = columns
            .iter()
            .map(|column| column.head.len())
            .max()
            .unwrap_or(0);
        let head = head.max(self.keys.len());
        for line in 0..head {
            let cells = columns
                .iter()
                .map(|one| (one.head_line(line, head), "", one.width));
            push_line(&mut text, self.keys.get(line), label, cells);
        }
        text += &"─".repeat(label + taken);
        text.push('\n');
        let lines = if self.keys.len() > 1 {
            self.keys.len()
        } else {
            2
        };
        for (index, row) in self.rows.iter().enumerate() {
            if index > 0 {
                text.push('\n');
            }
            match entries.get(index).and_then(|entry| entry.get("error")) {
                Some(reason) => push_failed(&mut text, row, label, &reason.to_string(), lines),
                None => push_row(&mut text, row, label, columns, index, lines),
            }
        }
        text
    }
}

/// The lines of a run: figures on the first, ratios on the second.
fn push_row(
    text: &mut String,
    labels: &[String],
    label: usize,
    columns: &[Figures],
    index: usize,
    lines: usize,
) {
    let cell = |column: &Figures, line: usize| -> (String, &'static str, usize) {
        let found = column.cells.get(index);
        let (said, mark) = match (found, line) {
            (Some(cell), 0) => {
                let exceeds = if cell.exceeds { EXCEEDS } else { "" };
                let best = if cell.is_best { BEST } else { "" };
                (format!("{exceeds}{}", cell.text), best)
            }
            (Some(cell), 1) => (cell.ratio.clone(), ""),
            _ => (String::new(), ""),
        };
        (said, mark, column.width)
    };
    for line in 0..lines {
        let cells: Vec<_> = columns.iter().map(|column| cell(column, line)).collect();
        let is_empty = labels.get(line).is_none() && cells.iter().all(|cell| cell.0.is_empty());
        if !is_empty {
            let cells = cells
                .iter()
                .map(|(said, mark, width)| (said.as_str(), *mark, *width));
            push_line(text, labels.get(line), label, cells);
        }
    }
}

/// The lines of a run that failed: its reason on the first.
fn push_failed(text: &mut String, labels: &[String], label: usize, reason: &str, lines: usize) {
    let reason = format!("failed: {}", printable(reason.trim_matches('"')));
    for line in 0..lines.min(labels.len().max(1)) {
        let mut said = padded(labels.get(line), label);
        if line == 0 {
            said += "  ";
            said += &cut(&reason, WIDEST - label - 2);
        }
        text.push_str(said.trim_end());
        text.push('\n');
    }
}

/// A label, and figures with their marks, each right-aligned in its width.
fn push_line<'a>(
    text: &mut String,
    label: Option<&String>,
    width: usize,
    cells: impl Iterator<Item = (&'a str, &'a str, usize)>,
) {
    let mut line = padded(label, width);
    for (said, mark, width) in cells {
        let before = " ".repeat(1 + width.saturating_sub(said.width()));
        line += &format!("{before}{said}{mark:1}");
    }
    text.push_str(line.trim_end());
    text.push('\n');
}

/// A label in so many columns.
fn padded(label: Option<&String>, width: usize) -> String {
    let label = cut(label.map_or("", String::as_str), width);
    let missing = width.saturating_sub(label.width());
    label + &" ".repeat(missing)
}

/// A text in so many columns at most, its end left out if it is longer.
fn cut(text: &str, width: usize) -> String {
    if text.width() <= width {
        return text.to_owned();
    }
    let mut left = width.saturating_sub(1);
    let fits = |c: &char| {
        let fitting = left.checked_sub(c.width().unwrap_or(0));
        left = fitting.unwrap_or(0);
        fitting.is_some()
    };
    let mut start: String = text.chars().take_while(fits).collect();
    start.push('…');
    start
}

/// The text without control characters, which a recipe could use to repaint the terminal.
fn printable(text: &str) -> String {
    let shown = |c: char| if c.is_control() { '\u{FFFD}' } else { c };
    text.chars().map(shown).collect()
}

fn written(number: f64, form: Form) -> String {
    match form {
        // Counts are whole and far below 2^53.
        Form::Count if number < 1e7 => grouped(number as u64),
        Form::Count => format!("{}M", four_digits(number / 1e6)),
        Form::Bytes => four_digits(number / 1e3),
        Form::Real | Form::Clock => four_digits(number),
    }
}

fn four_digits(number: f64) -> String {
    match number.abs() {
        0.0 => "0".to_owned(),
        v if !v.is_finite() => NONE.to_owned(),
        v if v < 1e-6 => format!("{number:.0e}"),
        v if !(0.01..1e5).contains(&v) => format!("{number:.1e}"),
        v if v < 0.1 => format!("{number:.4}"),
        v if v < 10.0 => format!("{number:.3}"),
        v if v < 100.0 => format!("{number:.2}"),
        v if v < 1000.0 => format!("{number:.1}"),
        v => grouped(v.round() as u64),
    }
}

/// "×1.23"; nothing where there is no ratio.
fn ratio_of(number: f64, first: f64) -> String {
    match number / first {
        ratio if !ratio.is_finite() => String::new(),
        0.0 => "×0".to_owned(),
        ratio if !(0.01..1e4).contains(&ratio) => format!("×{ratio:.0e}"),
        ratio if ratio < 10.0 => format!("×{ratio:.2}"),
        ratio if ratio < 100.0 => format!("×{ratio:.1}"),
        ratio => format!("×{ratio:.0}"),
    }
}

#[cfg(test)]
mod tests;
