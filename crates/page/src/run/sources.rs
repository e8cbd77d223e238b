//! What a run was made from: its chain, its recipe, and the hashes of its files.

use turnpath_report::{RecipeSource, RunReport};

use super::model::{FileAxes, StageChoice};
use crate::html::{element, escaped, row, section, with_links};

/// What X, Z and C of each file mean.
pub fn axes(files: &[FileAxes]) -> String {
    let rows: String = files
        .iter()
        .map(|FileAxes { file, notes }| row("td", &[file, &notes.x, &notes.z, &notes.c]))
        .collect();
    let head = row("th", &["file", "X", "Z", "C"]);
    let table = format!(
        "<div class=\"wide\"><table class=\"axes\"><thead>{head}</thead><tbody>{rows}</tbody></table></div>\n"
    );
    section("axes", "Axes and signs", &table)
}

/// The strategies with their parameters and sources.
pub fn chain(stages: &[StageChoice]) -> String {
    let stage = |stage: &StageChoice| {
        let given = stage.parameters.iter();
        let given = given.map(|(key, value)| format!("{key} = {value}"));
        let left_out = stage.defaults.iter();
        let left_out = left_out.map(|(key, value)| format!("{key} = {value} (default)"));
        let parameters = given.chain(left_out).map(|line| escaped(&line));
        let parameters = parameters.collect::<Vec<_>>().join("<br>");
        let cells = [
            escaped(&stage.slot),
            element("code", "", &escaped(&stage.name)),
            escaped(&stage.summary),
            element("code", "", &parameters),
            with_links(&stage.source),
        ];
        let cells = cells.iter().map(|cell| element("td", "", cell));
        element("tr", "", &cells.collect::<String>())
    };
    let head = row(
        "th",
        &["stage", "strategy", "what it does", "parameters", "source"],
    );
    let rows: String = stages.iter().map(stage).collect();
    let table = format!(
        "<div class=\"wide\"><table class=\"chain\"><thead>{head}</thead><tbody>{rows}</tbody></table></div>\n"
    );
    section("chain", "Chain", &table)
}

/// The recipe, with the changes to it.
pub fn recipe(report: &RunReport, text: Option<&str>) -> String {
    let mut html = String::new();
    if let Some(RecipeSource { file, sets, .. }) = &report.recipe {
        let mut line = file.clone();
        for set in sets {
            line += &format!(" --set '{set}'");
        }
        html += &element("p", "", &element("code", "", &escaped(&line)));
    }
    html += &match text {
        Some(text) => element("pre", "recipe", &escaped(text)),
        None => element(
            "p",
            "note",
            "The summary does not have the text of the recipe.",
        ),
    };
    section("recipe", "Recipe", &html)
}

/// The files with their hashes.
pub fn hashes(report: &RunReport) -> String {
    let mut rows = String::new();
    let mut add = |what: &str, name: &str, bytes: Option<u64>, sha256: &str| {
        let bytes = bytes.map(|bytes| bytes.to_string()).unwrap_or_default();
        rows += &row("td", &[what, name, &bytes, sha256]);
    };
    if let Some(recipe) = &report.recipe {
        add("recipe", &recipe.file, None, &recipe.sha256);
    }
    for file in &report.data_files {
        add("data", &file.file, Some(file.bytes), &file.sha256);
    }
    for plugin in &report.plugins {
        let name = format!("{} {}", plugin.name, plugin.version);
        add(
            "plugin",
            &name,
            None,
            plugin.sha256.as_deref().unwrap_or("built in"),
        );
    }
    for file in report.files.iter().flatten() {
        add("result", &file.file, Some(file.bytes), &file.sha256);
    }
    let head = row("th", &["what", "name", "bytes", "SHA-256"]);
    let table = format!(
        "<div class=\"wide\"><table class=\"hashes\"><thead>{head}</thead><tbody>{rows}</tbody></table></div>\n"
    );
    section("hashes", "Files and hashes", &table)
}
