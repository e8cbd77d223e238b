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

/// The runs side by side in a language, with the ratio to one of them beside each figure, except in CSV.
pub fn paper_table(
    runs: &[AblationRun],
    columns: &[&Column],
    language: Language,
    base: Option<&AblationRun>,
) -> String {
    if language == Language::Csv {
        return csv(runs, columns);
    }
    let figures: Vec<FigureColumn> = columns
        .iter()
        .map(|column| FigureColumn::of(runs, column, base))
        .collect();
    let table = Table {
        keys: keys(runs),
        headings: figures.iter().map(|column| column.title()).collect(),
        rows: runs
            .iter()
            .enumerate()
            .map(|(row, run)| words(run, row, &figures, language))
            .collect(),
        notes: notes(&figures, base, language),
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
    notes: Vec<String>,
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
) -> Vec<String> {
    let values = run.varied.iter();
    let mut words: Vec<String> = values.map(|(_, value)| escaped(value, language)).collect();
    if let Some(error) = run.error() {
        let reason = escaped(&format!("failed: {error}"), language);
        if language == Language::Latex {
            // One cell over all columns of figures, since those are as wide as numbers.
            words.push(format!(
                "\\multicolumn{{{}}}{{l}}{{{reason}}}",
                columns.len().max(1)
            ));
            return words;
        }
        words.push(reason);
        let left = columns.len().saturating_sub(1);
        words.extend(std::iter::repeat_n(String::new(), left));
        return words;
    }
    let cells = columns.iter().filter_map(|column| column.cells.get(row));
    words.extend(cells.map(|cell| cell_words(cell, language)));
    words
}

fn cell_words(cell: &Cell, language: Language) -> String {
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
        ratio if !ratio.is_empty() => {
            format!("{figure}{dagger} ({})", escaped(ratio, language))
        }
        _ => format!("{figure}{dagger}"),
    }
}

/// What the marks mean, as far as they occur, and to which run the ratios are.
fn notes(columns: &[FigureColumn], base: Option<&AblationRun>, language: Language) -> Vec<String> {
    let any = |which: fn(&Cell) -> bool| columns.iter().flat_map(|one| &one.cells).any(which);
    let values = base.map(|run| run.varied.iter().map(|(_, value)| value.as_str()));
    let values: Vec<&str> = values.into_iter().flatten().collect();
    let base = escaped(&format!("×: ratio to {}", values.join(", ")), language);
    let notes = [
        (any(|cell| cell.is_best), NOTE_BEST.to_owned()),
        (any(|cell| cell.exceeds), NOTE_EXCEEDS.to_owned()),
        (any(|cell| !cell.ratio.is_empty()), base),
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
        (Language::Latex, '<') => "\\textless{}".to_owned(),
        (Language::Latex, '>') => "\\textgreater{}".to_owned(),
        (Language::Latex, '|') => "\\textbar{}".to_owned(),
        (Language::Latex, '"') => "''".to_owned(),
        (Language::Latex, '°') => "$^\\circ$".to_owned(),
        (Language::Latex, '−') => "$-$".to_owned(),
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
        let runs = runs();
        paper_table(&runs, &columns, language, runs.first())
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

        bold: the best of its column, and what is within 1 % of it; dagger: exceeds its tolerance; ×: ratio to a\_1
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
        b\textbar{}c & \multicolumn{2}{l}{failed: 100 \% \& more} \\
        \bottomrule
        \end{tabular}
        % bold: the best of its column, and what is within 1 % of it
        % dagger: exceeds its tolerance
        % $\times$: ratio to a\_1
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
