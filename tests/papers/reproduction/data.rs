//! docs/reproduction.toml: which figures there are, what makes them, and their bounds.

use serde::Deserialize;

use super::runs::{Call, Runs};

/// Where zero is expected, a smaller value is rounding.
const ROUNDING: f64 = 1e-9;

/// The whole list.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Page {
    /// `--set` values of every run.
    pub common: Vec<String>,
    pub section: Vec<Section>,
}

/// A paper, or a part of one.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    pub title: String,
    /// What stands before its tables.
    pub text: String,
    /// What stands after them.
    #[serde(default)]
    pub after: String,
    #[serde(default)]
    pub figure: Vec<Figure>,
    #[serde(default)]
    pub grid: Vec<Grid>,
}

/// One published figure beside turnpath's.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    pub what: String,
    /// Where the paper has it: "Table 1".
    pub at: String,
    /// The published value as a number, in the unit shown.
    pub published: Option<f64>,
    /// How the paper words it, where a number does not say all.
    pub worded: Option<String>,
    /// Factor from the summary's unit to the one shown.
    pub scale: Option<f64>,
    /// Digits after the point.
    pub decimals: Option<usize>,
    /// Digits in all, with a power of ten: for figures that are very small.
    pub digits: Option<usize>,
    #[serde(default)]
    pub unit: String,
    pub run: Option<Run>,
    /// A run by whose figure this one is divided.
    pub over: Option<Run>,
    /// The value of a figure that no run gives, and the test that holds it.
    pub held: Option<TestFigure>,
    /// What `run` must give, to `within` of it.
    pub expected: f64,
    /// Largest difference from `expected`, as a part of it.
    #[serde(default)]
    pub within: f64,
    /// Why it differs from the paper's, or what it needs.
    #[serde(default)]
    pub why: String,
}

/// How a figure is written.
pub struct NumberStyle<'a> {
    pub decimals: Option<usize>,
    pub digits: Option<usize>,
    pub unit: &'a str,
}

/// A run of the program and a figure of its summary.
#[derive(Deserialize, Clone)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// A recipe of docs/recipes, without its extension.
    pub recipe: String,
    #[serde(default)]
    pub set: Vec<String>,
    /// JSON pointer into the summary.
    pub pointer: String,
}

/// A test elsewhere.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TestFigure {
    pub file: String,
    pub test: String,
}

/// A table of one figure, or several, over rows and columns.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    pub title: String,
    /// What the first column is.
    pub corner: String,
    pub recipe: String,
    #[serde(default)]
    pub set: Vec<String>,
    /// Bound of all cells, as a part of what is expected.
    pub within: f64,
    /// Whether the largest of a row is set in bold.
    #[serde(default)]
    pub bold: bool,
    #[serde(default)]
    pub why: String,
    pub column: Vec<Column>,
    pub row: Vec<Row>,
}

/// A column of a grid.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Column {
    pub name: String,
    #[serde(default)]
    pub set: Vec<String>,
    pub pointer: String,
    pub scale: Option<f64>,
    pub decimals: Option<usize>,
    pub digits: Option<usize>,
}

/// A row of a grid.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    pub name: String,
    /// A recipe in place of the grid's.
    pub recipe: Option<String>,
    #[serde(default)]
    pub set: Vec<String>,
    /// The paper's values, as it prints them; none where it has none.
    #[serde(default)]
    pub published: Vec<String>,
    /// The name of the row with the paper's values.
    #[serde(default)]
    pub published_name: String,
    pub expected: Vec<f64>,
}

impl Page {
    /// All figures of all lists.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.section.iter().flat_map(|section| &section.figure)
    }

    /// Leaves out the figures that need a run of such a recipe.
    pub fn leave_out(&mut self, recipe: impl Fn(&str) -> bool) {
        for section in &mut self.section {
            section.figure.retain(|figure| {
                let mut runs = figure.run.iter().chain(&figure.over);
                !runs.any(|run| recipe(&run.recipe))
            });
        }
    }

    /// All runs that figures and cells need, with the common changes.
    pub fn calls(&self) -> Vec<Call> {
        let of_figures = self
            .figures()
            .flat_map(|one| one.run.iter().chain(&one.over));
        let of_figures = of_figures.map(|run| self.call(&run.recipe, &[&run.set]));
        let grids = self.section.iter().flat_map(|section| &section.grid);
        let of_grids = grids.flat_map(|grid| {
            let cells = grid.row.iter();
            let cells = cells.flat_map(|row| grid.column.iter().map(move |column| (row, column)));
            cells.map(|(row, column)| self.cell(grid, row, column))
        });
        of_figures.chain(of_grids).collect()
    }

    /// The call of a recipe with changes, the common ones first.
    fn call(&self, recipe: &str, sets: &[&[String]]) -> Call {
        let all = std::iter::once(self.common.as_slice()).chain(sets.iter().copied());
        Call {
            recipe: recipe.to_owned(),
            set: all.flatten().cloned().collect(),
        }
    }

    /// The call of a grid's cell.
    fn cell(&self, grid: &Grid, row: &Row, column: &Column) -> Call {
        let recipe = row.recipe.as_ref().unwrap_or(&grid.recipe);
        self.call(recipe, &[&grid.set, &row.set, &column.set])
    }

    /// A figure's value in the unit shown; that of its test where no run gives it.
    pub fn value(&self, figure: &Figure, runs: &Runs) -> f64 {
        let Some(run) = &figure.run else {
            return figure.expected;
        };
        let of = |run: &Run| runs.figure(&self.call(&run.recipe, &[&run.set]), &run.pointer);
        let divisor = figure.over.as_ref().map_or(1.0, of);
        of(run) / divisor * figure.scale.unwrap_or(1.0)
    }

    /// A cell's value in the unit shown.
    pub fn cell_value(&self, grid: &Grid, row: &Row, column: &Column, runs: &Runs) -> f64 {
        let value = runs.figure(&self.cell(grid, row, column), &column.pointer);
        value * column.scale.unwrap_or(1.0)
    }

    /// A complaint about each figure outside its bound.
    pub fn complaints(&self, runs: &Runs) -> Vec<String> {
        let lists = self.figures().filter_map(|figure| {
            let value = self.value(figure, runs);
            off(&figure.what, value, figure.expected, figure.within)
        });
        let grids = self.section.iter().flat_map(|section| &section.grid);
        let cells = grids.flat_map(|grid| {
            let rows = grid.row.iter();
            rows.flat_map(move |row| {
                let cells = grid.column.iter().zip(&row.expected);
                cells.filter_map(move |(column, expected)| {
                    let value = self.cell_value(grid, row, column, runs);
                    let what = format!("{}, {}, {}", grid.title, row.name, column.name);
                    off(&what, value, *expected, grid.within)
                })
            })
        });
        lists.chain(cells).collect()
    }
}

impl Figure {
    /// How it is written.
    pub fn shown(&self) -> NumberStyle<'_> {
        NumberStyle {
            decimals: self.decimals,
            digits: self.digits,
            unit: &self.unit,
        }
    }

    /// How far the figure is from the published one, as a part of that, by what is expected.
    pub fn expected_difference(&self) -> Option<f64> {
        self.published
            .map(|published| self.expected / published - 1.0)
    }
}

impl Column {
    /// How its figures are written.
    pub fn shown(&self) -> NumberStyle<'_> {
        NumberStyle {
            decimals: self.decimals,
            digits: self.digits,
            unit: "",
        }
    }
}

/// Why a value is outside its bound; none if it is within.
fn off(what: &str, value: f64, expected: f64, within: f64) -> Option<String> {
    let holds = (value - expected).abs() <= (within * expected.abs()).max(ROUNDING);
    (!holds).then(|| format!("{what}: {value}, not {expected} within {within}"))
}
