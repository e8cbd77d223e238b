//! The table of an ablation on a terminal: never wider than 100 columns.
//!
//! A row begins with the values that vary, one a line; beside them stand the figures, below these
//! their ratios to the first run, below that what else does not hold. Where the figures do not fit,
//! several tables follow each other.

mod figures;
mod words;

use serde_json::Value;
use unicode_width::UnicodeWidthStr;

use super::columns::{Column, Form};

use figures::{Cell, Figures};
use words::{cut, padded, printable};

/// Widest table.
const WIDEST: usize = 100;
/// What labels have at least.
const LEAST_LABEL: usize = 14;
/// Tolerances that have a column of their own.
const WITH_COLUMN: [&str; 2] = ["interpolation", "residual"];

/// The runs side by side.
pub fn table(entries: &[Value], columns: &[&Column]) -> String {
    let labels = Labels::of(entries);
    let columns = columns.iter().map(|column| Figures::of(entries, column));
    let columns: Vec<Figures> = columns.collect();
    let parts = fitting(&columns).into_iter();
    let parts: Vec<String> = parts.map(|part| labels.beside(part, entries)).collect();
    format!("{}{}", parts.join("\n"), legend(&columns))
}

/// The columns in groups that fit beside the labels.
fn fitting(columns: &[Figures]) -> Vec<&[Figures]> {
    let mut groups = Vec::new();
    let mut rest = columns;
    while !rest.is_empty() {
        let mut width = LEAST_LABEL;
        let fits = rest.iter().take_while(|column| {
            width += column.whole_width();
            width <= WIDEST
        });
        let (group, left) = rest.split_at(fits.count().max(1));
        groups.push(group);
        rest = left;
    }
    groups
}

/// What the marks and the figures mean, as far as they occur.
fn legend(columns: &[Figures]) -> String {
    let any = |which: fn(&Cell) -> bool| columns.iter().flat_map(|one| &one.cells).any(which);
    let marks = [
        (any(|cell| cell.is_best), "* smallest of its column"),
        (any(|cell| cell.exceeds), "! exceeds its tolerance"),
        (
            any(|cell| !cell.ratio.is_empty()),
            "× ratio to the first run",
        ),
    ];
    let marks: Vec<&str> = marks
        .into_iter()
        .filter(|mark| mark.0)
        .map(|mark| mark.1)
        .collect();
    let has = |form: Form| columns.iter().any(|one| one.form == form);
    let lines = [
        (!marks.is_empty(), marks.join("   ")),
        (
            has(Form::Bytes),
            "program: the lines that pmac-pvt makes of the points, measured".to_owned(),
        ),
        (
            has(Form::Clock),
            "planning: processor time to make and measure the path".to_owned(),
        ),
    ];
    let lines = lines.into_iter().filter(|line| line.0);
    let lines: String = lines.map(|(_, line)| line + "\n").collect();
    format!("\n{lines}")
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
        let first = all.first();
        let keys = first.map(|first| first.keys().map(|key| printable(key)).collect());
        let value = |value: &Value| printable(value.as_str().unwrap_or_default());
        let rows = all.iter();
        let rows = rows.map(|varied| varied.values().map(value).collect());
        Self {
            keys: keys.unwrap_or_default(),
            rows: rows.collect(),
        }
    }

    /// A table of some columns.
    fn beside(&self, columns: &[Figures], entries: &[Value]) -> String {
        let taken: usize = columns.iter().map(Figures::whole_width).sum();
        let labels = self.rows.iter().flatten().chain(&self.keys);
        let needed = labels.map(|label| label.width()).max().unwrap_or(0);
        let width = needed.min(WIDEST.saturating_sub(taken));
        let mut text = lines(&self.keys, &self.head(columns), width);
        text += &"─".repeat(width + taken);
        text.push('\n');
        let rows = self.rows.iter().zip(entries).enumerate();
        let rows = rows.map(|(run, (labels, entry))| {
            lines(labels, &said(run, entry, columns, WIDEST - width), width)
        });
        text + &rows.collect::<Vec<_>>().join("\n")
    }

    fn head(&self, columns: &[Figures]) -> Vec<String> {
        let heights = columns.iter().map(|column| column.head.len());
        let height = heights.max().unwrap_or(0).max(self.keys.len());
        let line = |line| columns.iter().map(move |one| one.head_line(line, height));
        (0..height).map(|index| line(index).collect()).collect()
    }
}

/// What stands beside the labels of a run, within `width`.
fn said(run: usize, entry: &Value, columns: &[Figures], width: usize) -> Vec<String> {
    if let Some(reason) = entry.get("error") {
        let reason = printable(reason.as_str().unwrap_or_default());
        return vec![cut(&format!("  failed: {reason}"), width)];
    }
    let mut said: Vec<String> = vec![
        columns.iter().map(|column| column.figure(run)).collect(),
        columns.iter().map(|column| column.ratio(run)).collect(),
    ];
    let beyond = beyond(entry);
    if !beyond.is_empty() {
        let beyond = format!("  does not hold: {}", beyond.join(", "));
        said.push(cut(&printable(&beyond), width));
    }
    said
}

/// What does not hold of a run and has no column where that shows.
fn beyond(entry: &Value) -> Vec<&str> {
    let within = entry.get("within").and_then(Value::as_object);
    let fails = within
        .into_iter()
        .flatten()
        .filter(|(_, holds)| *holds == false);
    let names = fails.map(|(name, _)| name.as_str());
    names.filter(|name| !WITH_COLUMN.contains(name)).collect()
}

/// Labels with what stands beside them, line by line.
fn lines(labels: &[String], beside: &[String], width: usize) -> String {
    let line = |index: usize| {
        let label = labels.get(index).map_or("", String::as_str);
        let beside = beside.get(index).map_or("", String::as_str);
        format!("{}{beside}", padded(label, width))
    };
    let last = (0..labels.len().max(beside.len())).map(line);
    let lines = last.map(|line| line.trim_end().to_owned());
    let lines: Vec<String> = lines.filter(|line| !line.is_empty()).collect();
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests;
