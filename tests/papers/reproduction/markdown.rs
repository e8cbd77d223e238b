//! The page as Markdown.

use super::data::{Figure, Grid, NumberStyle, Page, Row, Section};
use super::runs::Runs;

const HEAD: &str = "\
<!-- Made by `cargo xtask reference reproduction` from reproduction.toml: edit that, not this. -->

# Reproduction

What the papers print, and what turnpath gives for the same part. Every figure of turnpath comes \
from a run of the program, or from the test that is named. `cargo xtask long` makes the runs again, \
and holds each figure against its bound and this page against the runs. `cargo test --workspace \
--test papers reproduction` does so for the small parts. Recipes, changes and bounds: [reproduction.toml](reproduction.toml).
";

/// The whole page.
pub fn markdown(page: &Page, runs: &Runs) -> String {
    let sections = page.section.iter();
    let sections: Vec<String> = sections
        .map(|section| section_text(page, section, runs))
        .collect();
    format!("{HEAD}\n{}", sections.join("\n"))
}

fn section_text(page: &Page, section: &Section, runs: &Runs) -> String {
    let mut parts = vec![format!("## {}\n", section.title)];
    if !section.text.is_empty() {
        parts.push(format!("{}\n", section.text.trim_end()));
    }
    if !section.figure.is_empty() {
        parts.push(list(page, &section.figure, runs));
    }
    for grid in &section.grid {
        parts.push(grid_text(page, grid, runs));
    }
    if !section.after.is_empty() {
        parts.push(format!("{}\n", section.after.trim_end()));
    }
    parts.join("\n")
}

/// A list of figures as a table.
fn list(page: &Page, figures: &[Figure], runs: &Runs) -> String {
    let rows = figures.iter().map(|figure| {
        let value = page.value(figure, runs);
        let published = match (&figure.worded, figure.published) {
            (Some(words), _) => words.clone(),
            (None, Some(number)) => figure.shown().written(number),
            (None, None) => "–".to_owned(),
        };
        let difference = figure.published.map(|published| value / published - 1.0);
        let held = figure.held.as_ref();
        let held = held.map_or(String::new(), |held| format!("`{}`", held.file));
        let why = [figure.why.as_str(), &held];
        let why = why.into_iter().filter(|text| !text.is_empty());
        row(&[
            figure.what.clone(),
            figure.at.clone(),
            published,
            figure.shown().written(value),
            difference.map_or(String::new(), percent),
            why.collect::<Vec<_>>().join("; "),
        ])
    });
    let head = [
        "figure",
        "in the paper",
        "published",
        "turnpath",
        "difference",
        "why they differ",
    ];
    table(&head.map(str::to_owned), rows.collect())
}

fn grid_text(page: &Page, grid: &Grid, runs: &Runs) -> String {
    let names = grid.column.iter().map(|column| column.name.clone());
    let head: Vec<String> = std::iter::once(grid.corner.clone()).chain(names).collect();
    let rows = grid.row.iter().flat_map(|one| {
        let published = (!one.published.is_empty()).then(|| {
            let name = std::iter::once(one.published_name.clone());
            let cells: Vec<String> = name.chain(one.published.iter().cloned()).collect();
            row(&cells)
        });
        published
            .into_iter()
            .chain([grid_row(page, grid, one, runs)])
    });
    let table = table(&head, rows.collect());
    let why = match grid.why.trim_end() {
        "" => String::new(),
        why => format!("\n{why}\n"),
    };
    format!("{}\n\n{table}{why}", grid.title.trim_end())
}

fn grid_row(page: &Page, grid: &Grid, one: &Row, runs: &Runs) -> String {
    let columns = grid.column.iter();
    let values: Vec<f64> = columns
        .map(|column| page.cell_value(grid, one, column, runs))
        .collect();
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let cells = values.iter().zip(&grid.column).map(|(value, column)| {
        let written = column.shown().written(*value);
        match grid.bold && *value == largest {
            true => format!("**{written}**"),
            false => written,
        }
    });
    let cells: Vec<String> = std::iter::once(one.name.clone()).chain(cells).collect();
    row(&cells)
}

fn row(cells: &[String]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

fn table(head: &[String], rows: Vec<String>) -> String {
    let rule = "|---".repeat(head.len());
    format!("{}{rule}|\n{}", row(head), rows.concat())
}

/// A difference as a part of the published figure: nothing below half a tenth of a percent, and a
/// factor from ten on.
fn percent(part: f64) -> String {
    if part >= 9.0 {
        return format!("× {:.0}", 1.0 + part);
    }
    match 100.0 * part {
        small if small.abs() < 0.05 => String::new(),
        large if large.abs() >= 9.95 => format!("{large:+.0} %").replace('-', "−"),
        percent => format!("{percent:+.1} %").replace('-', "−"),
    }
}

impl NumberStyle<'_> {
    /// A figure with its unit.
    fn written(&self, value: f64) -> String {
        let number = match (self.digits, self.decimals) {
            (Some(digits), _) => significant(value, digits),
            (None, decimals) => grouped(value, decimals.unwrap_or(0)),
        };
        let number = number.replace('-', "−");
        match self.unit {
            "" => number,
            unit => format!("{number} {unit}"),
        }
    }
}

/// A number in so many digits, with a power of ten below a thousandth.
fn significant(value: f64, digits: usize) -> String {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent = text.split_once('e').map(|(_, exponent)| exponent.parse());
    match exponent {
        Some(Ok(exponent @ -3..)) => {
            let decimals = digits as i32 - 1 - exponent;
            let rounded = text.parse().unwrap_or(value);
            grouped(rounded, usize::try_from(decimals).unwrap_or(0))
        }
        _ => text,
    }
}

/// A number with its thousands set apart.
fn grouped(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let (whole, rest) = text.split_once('.').unwrap_or((&text, ""));
    let mut apart = String::new();
    for (index, digit) in whole.chars().enumerate() {
        if index > 0 && (whole.len() - index) % 3 == 0 {
            apart.push(',');
        }
        apart.push(digit);
    }
    let sign = if value < 0.0 { "-" } else { "" };
    let point = if rest.is_empty() { "" } else { "." };
    format!("{sign}{apart}{point}{rest}")
}
