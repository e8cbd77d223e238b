//! The table of an ablation on a terminal: never wider than 100 columns, nor than the terminal.
//!
//! A row begins with the value that varies; beside it stand the figures, below these their ratios
//! to the first run, below that what else does not hold. Where several keys vary, a row begins with
//! the last one's value, and the rows that share all others stand below a line with those. Where the
//! figures do not fit, several tables follow each other.

mod figures;
mod width;
mod words;

use serde_json::Value;
use unicode_width::UnicodeWidthStr;

use super::columns::{Best, Column, Form};

use figures::{Cell, Figures};
pub use width::of_terminal;
use words::{cut, padded, printable, wrapped};

/// What labels have at least.
const LEAST_LABEL: usize = 14;
/// How far the rows of a group stand to the right.
const INDENT: &str = " ";
/// Most lines of a reason or a label; all of it stands in the files.
const MOST_LINES: usize = 3;
/// What stands before a sentence.
const BESIDE: &str = "  ";
/// What two of the columns are.
const OF_LAW: &str = "law's: apart from where the feed runs out at the path's ends";
const PROGRAM: &str = "program: the lines that pmac-pvt makes of the points, measured";
const PLANNING: &str = "planning: processor time to make and measure the path";
/// Tolerances that have a column of their own.
const WITH_COLUMN: [&str; 2] = ["interpolation", "residual"];

/// The runs side by side, on so many columns of the terminal.
pub fn table(entries: &[Value], columns: &[&Column], widest: usize) -> String {
    let labels = Labels::of(entries, widest);
    let columns = columns.iter().map(|column| Figures::of(entries, column));
    let columns: Vec<Figures> = columns.collect();
    let parts = fitting(&columns, widest).into_iter();
    let parts: Vec<String> = parts.map(|part| labels.beside(part, entries)).collect();
    format!("{}{}", parts.join("\n"), legend(&columns, widest))
}

/// The columns in groups that fit beside the labels.
fn fitting(columns: &[Figures], widest: usize) -> Vec<&[Figures]> {
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
fn legend(columns: &[Figures], widest: usize) -> String {
    let any = |which: fn(&Cell) -> bool| columns.iter().flat_map(|one| &one.cells).any(which);
    let best = |kind: Best| {
        let mut of_kind = columns.iter().filter(|one| one.best == kind);
        of_kind.any(|one| one.cells.iter().any(|cell| cell.is_best))
    };
    let marks = [
        (best(Best::Smallest), "* smallest of its column"),
        (best(Best::Largest), "* largest speed of the spindle"),
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

/// What stands on the left.
struct Labels {
    keys: Label,
    /// One a run.
    rows: Vec<Label>,
    /// What a line may take.
    widest: usize,
}

/// Values that vary, or their keys.
struct Label {
    /// All but the last, which rows may share; empty where one key varies.
    group: String,
    /// The last.
    own: String,
}

impl Label {
    fn of(values: &[String]) -> Self {
        let (last, others) = values
            .split_last()
            .map_or(("", &[][..]), |(last, others)| (last.as_str(), others));
        let indent = if others.is_empty() { "" } else { INDENT };
        Self {
            group: others.join(", "),
            own: format!("{indent}{last}"),
        }
    }

    /// The line above a group.
    fn title(&self, widest: usize) -> String {
        match self.group.as_str() {
            "" => String::new(),
            group => folded(group, widest).join("\n") + "\n",
        }
    }
}

impl Labels {
    fn of(entries: &[Value], widest: usize) -> Self {
        let varied = |entry: &Value| entry.get("varied").and_then(Value::as_object).cloned();
        let all: Vec<_> = entries
            .iter()
            .map(|entry| varied(entry).unwrap_or_default())
            .collect();
        let first = all.first();
        let keys = first.map(|first| first.keys().map(|key| printable(key)).collect());
        let keys: Vec<String> = keys.unwrap_or_default();
        let value = |value: &Value| printable(value.as_str().unwrap_or_default());
        let values = all.iter();
        let values = values.map(|varied| varied.values().map(value).collect::<Vec<_>>());
        Self {
            keys: Label::of(&keys),
            rows: values.map(|values| Label::of(&values)).collect(),
            widest,
        }
    }

    /// A table of some columns.
    fn beside(&self, columns: &[Figures], entries: &[Value]) -> String {
        let taken: usize = columns.iter().map(Figures::whole_width).sum();
        let labels = self.rows.iter().chain([&self.keys]);
        let needed = labels.map(|label| label.own.width()).max().unwrap_or(0);
        let width = needed.min(self.widest.saturating_sub(taken));
        let mut text = self.heading(columns, width);
        text += &"─".repeat(width + taken);
        text.push('\n');
        let mut group = None;
        for (run, (label, entry)) in self.rows.iter().zip(entries).enumerate() {
            let is_new = group != Some(&label.group);
            if is_new || label.group.is_empty() {
                text += if run > 0 { "\n" } else { "" };
                text += &label.title(self.widest);
            }
            group = Some(&label.group);
            text += &lines(
                &label.own,
                &said(run, entry, columns, self.widest - width),
                width,
            );
        }
        text
    }

    /// The names of keys and columns.
    fn heading(&self, columns: &[Figures], width: usize) -> String {
        let head = self.head(columns);
        let (last, others) = head
            .split_last()
            .map_or(("", &[][..]), |(last, others)| (last.as_str(), others));
        let beside = |label: &str, line: &str| format!("{}{line}", padded(label, width));
        let others = others.iter().map(|line| beside("", line));
        let all = others.chain([beside(&self.keys.own, last)]);
        let all: Vec<String> = all.map(|line| line.trim_end().to_owned()).collect();
        format!("{}{}\n", self.keys.title(self.widest), all.join("\n"))
    }

    fn head(&self, columns: &[Figures]) -> Vec<String> {
        let heights = columns.iter().map(|column| column.head.len());
        let height = heights.max().unwrap_or(0);
        let line = |line| columns.iter().map(move |one| one.head_line(line, height));
        (0..height).map(|index| line(index).collect()).collect()
    }
}

/// What stands beside the labels of a run, within `width`.
fn said(run: usize, entry: &Value, columns: &[Figures], width: usize) -> Vec<String> {
    if let Some(reason) = entry.get("error") {
        let reason = printable(reason.as_str().unwrap_or_default());
        return told(&format!("failed: {reason}"), width);
    }
    let mut said: Vec<String> = vec![
        columns.iter().map(|column| column.figure(run)).collect(),
        columns.iter().map(|column| column.ratio(run)).collect(),
    ];
    let beyond = beyond(entry);
    if !beyond.is_empty() {
        let beyond = format!("does not hold: {}", beyond.join(", "));
        said.extend(told(&printable(&beyond), width));
    }
    said
}

/// A sentence beside a label.
fn told(text: &str, width: usize) -> Vec<String> {
    let lines = folded(text, width.saturating_sub(BESIDE.width()));
    let lines = lines.into_iter();
    lines.map(|line| format!("{BESIDE}{line}")).collect()
}

/// A text in lines within `width`, its end left out where it takes too many.
fn folded(text: &str, width: usize) -> Vec<String> {
    let words: Vec<&str> = text.split(' ').collect();
    let lines = wrapped(&words, " ", width);
    let (shown, rest) = match lines.match_indices('\n').nth(MOST_LINES - 1) {
        Some((end, _)) => (&lines[..end], "…"),
        None => (lines.as_str(), ""),
    };
    let shown = format!("{shown}{rest}");
    shown.lines().map(|line| cut(line, width)).collect()
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

/// A label with what stands beside it, line by line.
fn lines(label: &str, beside: &[String], width: usize) -> String {
    let text = label.trim_start();
    let indent = label.strip_suffix(text).unwrap_or_default();
    let label = folded(text, width.saturating_sub(indent.width()));
    let line = |index: usize| {
        let label = label.get(index).map(|line| format!("{indent}{line}"));
        let beside = beside.get(index).map_or("", String::as_str);
        format!("{}{beside}", padded(&label.unwrap_or_default(), width))
    };
    let all = (0..beside.len().max(label.len())).map(line);
    let all = all.map(|line| line.trim_end().to_owned());
    let all: Vec<String> = all.filter(|line| !line.is_empty()).collect();
    all.join("\n") + "\n"
}

#[cfg(test)]
mod tests;
