//! The runs as a table that the page's script sorts.

use turnpath_report::AblationRun;
use turnpath_report::comparison::{Column, Form, by_name, usual};

use crate::html::{element, escaped, section};
use crate::words::number;

/// Columns besides the usual ones.
const MORE: [&str; 3] = ["surface-pv", "surface-rms", "spindle-max"];
/// The name of a run that varies nothing.
const RECIPE: &str = "the recipe";

/// The values that vary, as the name of a run.
pub fn label(run: &AblationRun) -> String {
    let values: Vec<&str> = run.varied.iter().map(|(_, value)| value.as_str()).collect();
    match values.is_empty() {
        true => RECIPE.to_owned(),
        false => values.join(", "),
    }
}

/// The table.
pub fn table(runs: &[AblationRun]) -> String {
    let columns = usual()
        .into_iter()
        .chain(MORE.iter().filter_map(|name| by_name(name)));
    let has_figure = |column: &&Column| {
        let mut measured = runs.iter().filter_map(AblationRun::measured);
        measured.any(|run| (column.figure)(run).is_some())
    };
    let columns: Vec<&Column> = columns.filter(has_figure).collect();
    let keys = runs.first().map_or(&[][..], |run| &run.varied);
    let head = keys.iter().map(|(key, _)| heading(key));
    let head: String = head
        .chain(columns.iter().map(|column| heading(&title(column))))
        .collect();
    let rows: String = runs.iter().map(|run| row(run, &columns)).collect();
    let note =
        "A click on a heading sorts by it. Figures that exceed their tolerance are marked by !.";
    let html = format!(
        "<p class=\"note\">{note}</p><div class=\"wide\"><table class=\"runs\"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>\n"
    );
    section("runs", "Runs", &html)
}

fn heading(text: &str) -> String {
    format!("<th scope=\"col\" tabindex=\"0\">{}</th>", escaped(text))
}

/// A heading of one line and its unit below it.
fn title(column: &Column) -> String {
    let mut words = String::new();
    let (lines, unit) = match column.heading {
        [lines @ .., unit] if !lines.is_empty() && column.form != Form::Count => (lines, *unit),
        lines => (lines, ""),
    };
    for line in lines {
        match words.strip_suffix('-') {
            Some(begun) => words = format!("{begun}{line}"),
            None if words.is_empty() => words = (*line).to_owned(),
            None => words = format!("{words} {line}"),
        }
    }
    // A hyphenated word may go on into the line of the unit.
    match words.strip_suffix('-') {
        Some(begun) => format!("{begun}{unit}"),
        None => format!("{words}\n{unit}").trim_end().to_owned(),
    }
}

fn row(run: &AblationRun, columns: &[&Column]) -> String {
    let varied = run
        .varied
        .iter()
        .map(|(_, value)| element("td", "", &escaped(value)));
    let varied: String = varied.collect();
    let cells = match run.error() {
        Some(error) => {
            let span = columns.len().max(1);
            format!(
                "<td colspan=\"{span}\">{}</td>",
                escaped(&format!("failed: {error}"))
            )
        }
        None => columns.iter().map(|column| cell(run, column)).collect(),
    };
    format!("<tr>{varied}{cells}</tr>\n")
}

fn cell(run: &AblationRun, column: &Column) -> String {
    let figure = run.measured().and_then(|run| column.tidied(run));
    let Some(figure) = figure else {
        return "<td class=\"number\"></td>".to_owned();
    };
    let figure = match column.form {
        Form::Bytes => figure / 1e3,
        Form::Count | Form::Real | Form::Clock => figure,
    };
    let holds = column
        .holds
        .zip(run.verdict())
        .and_then(|(holds, verdict)| holds(verdict));
    let text = match column.form {
        Form::Count => format!("{figure}"),
        _ => number(figure),
    };
    match holds {
        Some(false) => {
            format!("<td class=\"number exceeded\" data-value=\"{figure}\">! {text}</td>")
        }
        _ => format!("<td class=\"number\" data-value=\"{figure}\">{text}</td>"),
    }
}
