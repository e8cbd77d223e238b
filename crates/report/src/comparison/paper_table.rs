//! The comparison as a table for a paper or a page: Markdown, LaTeX, or CSV of the chosen columns.

use crate::ablation::AblationRun;

use super::cells::{Cell, FigureColumn};
use super::column::Column;
use super::csv_table::figure;

/// The language of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// A table with bars.
    Markdown,
    /// A `tabular` with the rules of the package `booktabs`.
    Latex,
    /// Comma-separated values with all digits.
    Csv,
}

/// What the marks mean.
const NOTE_BEST: &str = "bold: the best of its column, and what is within 1 % of it";
const NOTE_EXCEEDS: &str = "dagger: exceeds its tolerance";

/// The runs side by side in a language; `with_ratios` puts the ratio to the first run beside each
/// figure, except in CSV.
pub fn paper_table(
    runs: &[AblationRun],
    columns: &[&Column],
    language: Language,
    with_ratios: bool,
) -> String {
    if language == Language::Csv {
        return csv(runs, columns);
    }
    let figures: Vec<FigureColumn> = columns
        .iter()
        .map(|column| FigureColumn::of(runs, column))
        .collect();
    let table = Table {
        keys: keys(runs),
        headings: figures.iter().map(|column| column.title()).collect(),
        rows: runs
            .iter()
            .enumerate()
            .map(|(row, run)| words(run, row, &figures, language, with_ratios))
            .collect(),
        notes: notes(&figures),
    };
    match language {
        Language::Latex => table.latex(),
        Language::Markdown | Language::Csv => table.markdown(),
    }
}

/// A table in words, already in its language.
struct Table {
    /// What varies.
    keys: Vec<String>,
    headings: Vec<String>,
    rows: Vec<Vec<String>>,
    notes: Vec<&'static str>,
}

impl Table {
    fn markdown(&self) -> String {
        let heading = self.keys.iter().chain(&self.headings);
        let heading: Vec<String> = heading
            .map(|text| escaped(text, Language::Markdown))
            .collect();
        let left = self.keys.iter().map(|_| "---");
        let rules: Vec<&str> = left.chain(self.headings.iter().map(|_| "---:")).collect();
        let mut text = format!("| {} |\n| {} |\n", heading.join(" | "), rules.join(" | "));
        for row in &self.rows {
            text += &format!("| {} |\n", row.join(" | "));
        }
        match self.notes.is_empty() {
            true => text,
            false => format!("{text}\n{}\n", self.notes.join("; ")),
        }
    }

    fn latex(&self) -> String {
        let heading = self.keys.iter().chain(&self.headings);
        let heading: Vec<String> = heading.map(|text| escaped(text, Language::Latex)).collect();
        let (left, right) = ("l".repeat(self.keys.len()), "r".repeat(self.headings.len()));
        let mut text = format!("% \\usepackage{{booktabs}}\n\\begin{{tabular}}{{{left}{right}}}\n");
        text += &format!("\\toprule\n{} \\\\\n\\midrule\n", heading.join(" & "));
        for row in &self.rows {
            text += &format!("{} \\\\\n", row.join(" & "));
        }
        text += "\\bottomrule\n\\end{tabular}\n";
        self.notes
            .iter()
            .fold(text, |text, note| format!("{text}% {note}\n"))
    }
}

fn keys(runs: &[AblationRun]) -> Vec<String> {
    let varied = runs.first().map(|run| run.varied.iter());
    varied
        .into_iter()
        .flatten()
        .map(|(key, _)| key.clone())
        .collect()
}

/// A row: the values that vary, and the figures, or why there are none.
fn words(
    run: &AblationRun,
    row: usize,
    columns: &[FigureColumn],
    language: Language,
    with_ratios: bool,
) -> Vec<String> {
    let values = run.varied.iter();
    let mut words: Vec<String> = values.map(|(_, value)| escaped(value, language)).collect();
    if let Some(error) = run.error() {
        words.push(escaped(&format!("failed: {error}"), language));
        let left = columns.len().saturating_sub(1);
        words.extend(std::iter::repeat_n(String::new(), left));
        return words;
    }
    let cells = columns.iter().filter_map(|column| column.cells.get(row));
    words.extend(cells.map(|cell| cell_words(cell, language, with_ratios)));
    words
}

fn cell_words(cell: &Cell, language: Language, with_ratio: bool) -> String {
    let figure = escaped(cell.text(), language);
    let dagger = match (cell.exceeds, language) {
        (false, _) => "",
        (true, Language::Latex) => "$^\\dagger$",
        (true, _) => "†",
    };
    let figure = match (cell.is_best, language) {
        (false, _) => figure,
        (true, Language::Latex) => format!("\\textbf{{{figure}}}"),
        (true, _) => format!("**{figure}**"),
    };
    match cell.ratio.as_str() {
        ratio if with_ratio && !ratio.is_empty() => {
            format!("{figure}{dagger} ({})", escaped(ratio, language))
        }
        _ => format!("{figure}{dagger}"),
    }
}

fn notes(columns: &[FigureColumn]) -> Vec<&'static str> {
    let any = |which: fn(&Cell) -> bool| columns.iter().flat_map(|one| &one.cells).any(which);
    let notes = [
        (any(|cell| cell.is_best), NOTE_BEST),
        (any(|cell| cell.exceeds), NOTE_EXCEEDS),
    ];
    notes
        .into_iter()
        .filter(|(occurs, _)| *occurs)
        .map(|(_, note)| note)
        .collect()
}

/// A text whose signs mean nothing in the language.
fn escaped(text: &str, language: Language) -> String {
    let one = |sign: char| match (language, sign) {
        (Language::Markdown, '|' | '*' | '_' | '`' | '\\' | '<' | '[') => format!("\\{sign}"),
        (Language::Latex, '&' | '%' | '$' | '#' | '_' | '{' | '}') => format!("\\{sign}"),
        (Language::Latex, '\\') => "\\textbackslash{}".to_owned(),
        (Language::Latex, '~') => "\\textasciitilde{}".to_owned(),
        (Language::Latex, '^') => "\\textasciicircum{}".to_owned(),
        (Language::Latex, '²') => "$^2$".to_owned(),
        (Language::Latex, '³') => "$^3$".to_owned(),
        (Language::Latex, '×') => "$\\times$".to_owned(),
        (Language::Latex, '–') => "--".to_owned(),
        (Language::Latex, 'µ' | 'μ') => "$\\mu$".to_owned(),
        (_, '\n' | '\r') => " ".to_owned(),
        _ => sign.to_string(),
    };
    text.chars().map(one).collect()
}

fn csv(runs: &[AblationRun], columns: &[&Column]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let heading = keys(runs).into_iter();
    let heading = heading.chain(columns.iter().map(|column| column.csv.to_owned()));
    let heading = heading.chain(["reason".to_owned()]);
    let mut rows = vec![heading.collect::<Vec<String>>()];
    for run in runs {
        let values = run.varied.iter().map(|(_, value)| value.clone());
        let figures = columns.iter().map(|column| figure(run, column));
        let reason = run.error().unwrap_or_default().to_owned();
        rows.push(values.chain(figures).chain([reason]).collect());
    }
    // The sink is memory, and every row is as long as the first.
    let written = rows.iter().try_for_each(|row| writer.write_record(row));
    let bytes = written.ok().and_then(|()| writer.into_inner().ok());
    String::from_utf8(bytes.unwrap_or_default()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::by_name;
    use crate::sample::{failed_run, measured_run};

    fn runs() -> Vec<AblationRun> {
        let run = |name: &str, points: u64, holds: bool| {
            let varied = vec![("sampler_name".to_owned(), name.to_owned())];
            measured_run(varied, |run| {
                run.report.control_points = points;
                run.report.path.interpolation_error.max = 5e-5;
                run.report.within.interpolation = Some(holds);
            })
        };
        let failed = failed_run(
            vec![("sampler_name".to_owned(), "b|c".to_owned())],
            "100 % & more",
        );
        vec![
            run("a_1", 2000, true),
            run("d", 1005, false),
            run("e", 1000, true),
            failed,
        ]
    }

    fn table(language: Language) -> String {
        let columns = ["points", "error-max"].map(|name| by_name(name).unwrap());
        paper_table(&runs(), &columns, language, true)
    }

    #[test]
    fn a_table_of_markdown_marks_the_best_and_what_comes_near_it() {
        insta::assert_snapshot!(table(Language::Markdown), @r"
        | sampler\_name | points | error max nm |
        | --- | ---: | ---: |
        | a\_1 | 2,000 | 50.00 |
        | d | **1,005** (×0.50) | 50.00† (×1.00) |
        | e | **1,000** (×0.50) | 50.00 (×1.00) |
        | b\|c | failed: 100 % & more |  |

        bold: the best of its column, and what is within 1 % of it; dagger: exceeds its tolerance
        ");
    }

    #[test]
    fn a_table_of_latex_has_no_sign_that_latex_would_take() {
        insta::assert_snapshot!(table(Language::Latex), @r"
        % \usepackage{booktabs}
        \begin{tabular}{lrr}
        \toprule
        sampler\_name & points & error max nm \\
        \midrule
        a\_1 & 2,000 & 50.00 \\
        d & \textbf{1,005} ($\times$0.50) & 50.00$^\dagger$ ($\times$1.00) \\
        e & \textbf{1,000} ($\times$0.50) & 50.00 ($\times$1.00) \\
        b|c & failed: 100 \% \& more &  \\
        \bottomrule
        \end{tabular}
        % bold: the best of its column, and what is within 1 % of it
        % dagger: exceeds its tolerance
        ");
    }

    #[test]
    fn a_table_of_values_has_all_digits_and_the_reason() {
        insta::assert_snapshot!(table(Language::Csv), @r"
        sampler_name,points,error_max_nm,reason
        a_1,2000,50.0,
        d,1005,50.0,
        e,1000,50.0,
        b|c,,,100 % & more
        ");
    }
}
