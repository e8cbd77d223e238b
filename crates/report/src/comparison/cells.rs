//! A column of the table: the figures of all runs with their ratios and marks.

use unicode_width::UnicodeWidthStr;

use crate::ablation::AblationRun;

use super::column::{Best, Column, Form, NOISE};
use super::wording::{NONE, ratio_of, written};

/// Marks the best figure of a column.
const BEST: &str = "*";
/// Marks a figure that exceeds its tolerance.
const EXCEEDS: &str = "!";

/// A run's figure in words.
pub struct Cell {
    text: String,
    /// To the run that all are compared with; empty without.
    pub ratio: String,
    pub is_best: bool,
    pub exceeds: bool,
}

/// A column in words.
pub struct FigureColumn {
    pub heading: &'static [&'static str],
    pub form: Form,
    /// Whether they cover only where the law is the feed strategy's own.
    pub of_law: bool,
    pub best: Best,
    /// A cell a run.
    pub cells: Vec<Cell>,
    width: usize,
}

impl FigureColumn {
    /// The figures of all runs, with their ratios to one of them.
    pub fn of(runs: &[AblationRun], column: &Column, base: Option<&AblationRun>) -> Self {
        let figure = |run: &AblationRun| column.tidied(run.measured()?);
        let numbers: Vec<Option<f64>> = runs.iter().map(figure).collect();
        let is_best = is_best(&numbers, column);
        let of_base = base.and_then(figure);
        let cell = |(row, (run, number)): (usize, (&AblationRun, &Option<f64>))| {
            let exceeds = column
                .holds
                .zip(run.verdict())
                .and_then(|(holds, verdict)| holds(verdict))
                .map(|holds| !holds);
            let ratio = number.zip(of_base).filter(|_| base != Some(run));
            let text = number.map(|number| written(number, column.form));
            Cell {
                is_best: is_best.get(row).copied().unwrap_or(false),
                text: text.unwrap_or_else(|| NONE.to_owned()),
                ratio: ratio.map_or(String::new(), |(number, base)| ratio_of(number, base)),
                exceeds: exceeds.unwrap_or(false),
            }
        };
        let cells: Vec<Cell> = runs.iter().zip(&numbers).enumerate().map(cell).collect();
        let widths = cells.iter().flat_map(Cell::widths);
        let head = column.heading.iter().map(|line| line.width());
        Self {
            width: widths.chain(head).max().unwrap_or(0),
            heading: column.heading,
            form: column.form,
            of_law: column.of_law,
            best: column.best,
            cells,
        }
    }

    /// The heading in one line, its broken words made whole.
    pub fn title(&self) -> String {
        let mut title = String::new();
        for line in self.heading {
            match title.strip_suffix('-') {
                Some(begun) => title = format!("{begun}{line}"),
                None if title.is_empty() => title += line,
                None => title = format!("{title} {line}"),
            }
        }
        title
    }

    /// Columns of the terminal that it takes: a space, the figure, its mark.
    pub fn whole_width(&self) -> usize {
        self.width + 2
    }

    /// Line `line` of a heading of `height` lines, the unit on the last.
    pub fn heading_line(&self, line: usize, height: usize) -> String {
        let skipped = height.saturating_sub(self.heading.len());
        let line = line.checked_sub(skipped);
        let line = line.and_then(|line| self.heading.get(line));
        self.aligned(line.unwrap_or(&""), "")
    }

    /// A run's figure with its marks.
    pub fn figure(&self, run: usize) -> String {
        let Some(cell) = self.cells.get(run) else {
            return self.aligned("", "");
        };
        let mark = if cell.is_best { BEST } else { "" };
        self.aligned(&cell.marked(), mark)
    }

    /// Its ratio to the run that all are compared with.
    pub fn ratio(&self, run: usize) -> String {
        let ratio = self.cells.get(run).map_or("", |cell| cell.ratio.as_str());
        self.aligned(ratio, "")
    }

    fn aligned(&self, text: &str, mark: &str) -> String {
        let before = " ".repeat(1 + self.width.saturating_sub(text.width()));
        format!("{before}{text}{mark:1}")
    }
}

impl Cell {
    /// The figure, or what stands where there is none.
    pub fn text(&self) -> &str {
        &self.text
    }

    fn marked(&self) -> String {
        let mark = if self.exceeds { EXCEEDS } else { "" };
        format!("{mark}{}", self.text)
    }

    fn widths(&self) -> [usize; 2] {
        [self.marked().width(), self.ratio.width()]
    }
}

/// Which numbers are the best, and what differs from it by chance alone. None is, where all are.
fn is_best(numbers: &[Option<f64>], column: &Column) -> Vec<bool> {
    let sign = match column.best {
        Best::Smallest => 1.0,
        Best::Largest => -1.0,
        Best::None => return vec![false; numbers.len()],
    };
    let finite = |number: &Option<f64>| number.filter(|number| number.is_finite());
    let there = numbers
        .iter()
        .filter_map(finite)
        .map(|number| sign * number);
    let best = there.fold(f64::INFINITY, f64::min);
    let limit = best + NOISE * best.abs();
    let is_near: Vec<bool> = numbers
        .iter()
        .map(|number| finite(number).is_some_and(|number| sign * number <= limit))
        .collect();
    let differ = numbers.iter().zip(&is_near);
    let differ = differ.filter(|(number, is_near)| finite(number).is_some() && !**is_near);
    match differ.count() {
        0 => vec![false; numbers.len()],
        _ => is_near,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::by_name;
    use crate::sample::{failed_run, measured_run};

    fn best_of(name: &str, numbers: &[Option<f64>]) -> Vec<bool> {
        is_best(numbers, by_name(name).unwrap())
    }

    #[test]
    fn figures_that_differ_by_chance_have_no_best() {
        let best = |numbers: &[Option<f64>]| best_of("time", numbers);
        assert_eq!(best(&[Some(1.0), None, Some(1.009)]), [false; 3]);
        assert_eq!(best(&[Some(2.0), None, Some(1.0)]), [false, false, true]);
        assert_eq!(
            best(&[Some(2.0), Some(1.0), Some(1.009)]),
            [false, true, true]
        );
        assert_eq!(best(&[Some(f64::NAN), Some(1.0)]), [false; 2]);
        assert_eq!(best(&[None, None]), [false; 2]);
    }

    #[test]
    fn of_speeds_the_largest_is_the_best_and_of_times_of_the_processor_none() {
        let numbers = [Some(100.0), None, Some(300.0)];
        assert_eq!(best_of("spindle-max", &numbers), [false, false, true]);
        assert_eq!(best_of("planning-time", &numbers), [false; 3]);
    }

    #[test]
    fn an_acceleration_that_is_rounding_alone_is_zero() {
        let [law, error] = ["x-acceleration-law", "error-max"].map(|name| by_name(name).unwrap());
        assert_eq!([law.tidy(6e-7), law.tidy(-0.44)], [0.0, -0.44]);
        assert_eq!([error.tidy(6e-7), error.tidy(6e-9)], [6e-7, 0.0]);
    }

    /// Ratios stay those to the first run when the rows are in another order.
    #[test]
    fn rows_in_another_order_keep_their_ratios() {
        let entry = |name: &str, points: u64| {
            let varied = vec![("sampler".to_owned(), name.to_owned())];
            measured_run(varied, |run| run.report.control_points = points)
        };
        let (first, other) = (entry("a", 200), entry("b", 100));
        let column = by_name("points").unwrap();
        let rows = [other, first.clone()];
        let cells = FigureColumn::of(&rows, column, Some(&first)).cells;
        let ratios: Vec<&str> = cells.iter().map(|cell| cell.ratio.as_str()).collect();
        assert_eq!(ratios, ["×0.50", ""]);
        let without = FigureColumn::of(&rows, column, None).cells;
        assert!(without.iter().all(|cell| cell.ratio.is_empty()));
    }

    /// Marks and ratios where figures tie but for chance, are zero, or are not there.
    #[test]
    fn ties_are_all_marked_and_zero_or_nothing_has_no_ratio() {
        let entry = |added: u64, time: f64| {
            measured_run(Vec::new(), |run| {
                run.report.points_added_by_refine = added;
                run.report.cutting_time = time;
                run.report.path.lead = None;
            })
        };
        let entries = [
            entry(0, 99.994),
            entry(7, 99.996),
            entry(0, 100.02),
            failed_run(Vec::new(), "it has no law"),
            failed_run(Vec::new(), "it panicked"),
            entry(0, 250.0),
        ];
        let cells = |name: &str| {
            let column = by_name(name).unwrap();
            let cells = FigureColumn::of(&entries, column, entries.first())
                .cells
                .into_iter();
            cells
                .map(|cell| (cell.text, cell.is_best, cell.ratio))
                .collect::<Vec<_>>()
        };
        let row =
            |text: &str, is_best: bool, ratio: &str| (text.to_owned(), is_best, ratio.to_owned());
        let added = [
            row("0", true, ""),
            row("7", false, ""),
            row("0", true, ""),
            row("–", false, ""),
            row("–", false, ""),
            row("0", true, ""),
        ];
        assert_eq!(cells("added"), added);
        let times = [
            row("99.99", true, ""),
            row("100.0", true, "×1.00"),
            row("100.0", true, "×1.00"),
            row("–", false, ""),
            row("–", false, ""),
            row("250.0", false, "×2.50"),
        ];
        assert_eq!(cells("time"), times);
        let nothing = row("–", false, "");
        assert!(cells("lead-in").iter().all(|cell| *cell == nothing));
    }
}
