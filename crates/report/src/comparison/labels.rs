//! The labels of a table's rows, and what stands beside each.

use unicode_width::UnicodeWidthStr;

use turnpath_core::printable_line;

use crate::ablation::AblationRun;

use super::cells::FigureColumn;
use super::wording::{cut, padded, wrapped};

/// How far the rows of a group stand to the right.
const INDENT: &str = " ";
/// Most lines of a reason or a label; all of it stands in the files.
const MOST_LINES: usize = 3;
/// What stands before a sentence.
const BESIDE: &str = "  ";
/// Tolerances that have a column of their own.
const WITH_COLUMN: [&str; 2] = ["interpolation", "residual"];

/// What stands on the left.
pub struct Labels {
    keys: Label,
    /// One a run.
    rows: Vec<Label>,
    /// Columns of the terminal that a line may take.
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
    /// The labels of all runs.
    pub fn of(runs: &[AblationRun], widest: usize) -> Self {
        let texts = |run: &AblationRun, of: fn(&(String, String)) -> &String| {
            let texts = run
                .varied
                .iter()
                .map(|pair| printable_line(of(pair)).into_owned());
            texts.collect::<Vec<_>>()
        };
        let keys = runs.first().map(|first| texts(first, |pair| &pair.0));
        let rows = runs.iter().map(|run| texts(run, |pair| &pair.1));
        Self {
            keys: Label::of(&keys.unwrap_or_default()),
            rows: rows.map(|values| Label::of(&values)).collect(),
            widest,
        }
    }

    /// A table of some columns.
    pub fn beside(&self, columns: &[FigureColumn], runs: &[AblationRun]) -> String {
        let taken: usize = columns.iter().map(FigureColumn::whole_width).sum();
        let labels = self.rows.iter().chain([&self.keys]);
        let needed = labels.map(|label| label.own.width()).max().unwrap_or(0);
        let width = needed.min(self.widest.saturating_sub(taken));
        let mut text = self.heading(columns, width);
        text += &"─".repeat(width + taken);
        text.push('\n');
        let mut group = None;
        for (row, (label, run)) in self.rows.iter().zip(runs).enumerate() {
            let is_new = group != Some(&label.group);
            if is_new || label.group.is_empty() {
                text += if row > 0 { "\n" } else { "" };
                text += &label.title(self.widest);
            }
            group = Some(&label.group);
            let beside = beside_label(row, run, columns, self.widest - width);
            text += &joined(&label.own, &beside, width);
        }
        text
    }

    /// The names of keys and columns.
    fn heading(&self, columns: &[FigureColumn], width: usize) -> String {
        let heading = heading_lines(columns);
        let (last, others) = heading
            .split_last()
            .map_or(("", &[][..]), |(last, others)| (last.as_str(), others));
        let beside = |label: &str, line: &str| format!("{}{line}", padded(label, width));
        let others = others.iter().map(|line| beside("", line));
        let all = others.chain([beside(&self.keys.own, last)]);
        let all: Vec<String> = all.map(|line| line.trim_end().to_owned()).collect();
        format!("{}{}\n", self.keys.title(self.widest), all.join("\n"))
    }
}

fn heading_lines(columns: &[FigureColumn]) -> Vec<String> {
    let heights = columns.iter().map(|column| column.heading.len());
    let height = heights.max().unwrap_or(0);
    let line = |line| {
        columns
            .iter()
            .map(move |one| one.heading_line(line, height))
    };
    (0..height).map(|index| line(index).collect()).collect()
}

/// What stands beside the label of a run, within `width`.
fn beside_label(
    row: usize,
    run: &AblationRun,
    columns: &[FigureColumn],
    width: usize,
) -> Vec<String> {
    if let Some(reason) = run.error() {
        return sentence(&format!("failed: {}", printable_line(reason)), width);
    }
    let mut lines: Vec<String> = vec![
        columns.iter().map(|column| column.figure(row)).collect(),
        columns.iter().map(|column| column.ratio(row)).collect(),
    ];
    let failures = other_failures(run);
    if !failures.is_empty() {
        let failures = format!("does not hold: {}", failures.join(", "));
        lines.extend(sentence(&failures, width));
    }
    lines
}

/// A sentence beside a label.
fn sentence(text: &str, width: usize) -> Vec<String> {
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
fn other_failures(run: &AblationRun) -> Vec<&'static str> {
    let failures = run.verdict().into_iter().flat_map(|one| one.failures());
    failures
        .filter(|name| !WITH_COLUMN.contains(name))
        .collect()
}

/// A label with what stands beside it, line by line.
fn joined(label: &str, beside: &[String], width: usize) -> String {
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
