//! The page of a run.

mod figures;
mod model;
mod sources;
mod verdict;

use serde::Serialize;
use turnpath_report::{PathSketch, RunReport, text};

use crate::document::document;
use crate::html::{element, escaped, section};

pub use model::{BestFit, FileAxes, RunPage, StageChoice, SurfaceSketch};

/// The data that the script draws.
#[derive(Serialize)]
struct Drawn<'a> {
    kind: &'static str,
    report: &'a RunReport,
    sketch: Option<&'a PathSketch>,
    surface: &'a SurfaceSketch,
}

/// The page of a run.
pub fn run_page(page: &RunPage) -> String {
    let report = &page.report;
    let title = escaped(&report.name);
    let body = [
        format!(
            "<header><p class=\"made-by\">turnpath {}</p><h1>{title}</h1>\n",
            escaped(&report.turnpath)
        ),
        verdict::verdict(report),
        "</header>\n<main>\n".to_owned(),
        figures::figures(page),
        sources::axes(&page.axes),
        sources::chain(&page.chain),
        all_figures(report),
        sources::recipe(report, page.recipe.as_deref()),
        sources::hashes(report),
        "</main>\n".to_owned(),
    ];
    let drawn = Drawn {
        kind: "run",
        report,
        sketch: page.sketch.as_ref(),
        surface: &page.surface,
    };
    document(&report.name, &body.concat(), &drawn)
}

/// The text of the program.
fn all_figures(report: &RunReport) -> String {
    let text = text::run(report, &[]);
    let html = element("pre", "", &escaped(&text));
    section("figures", "All figures", &html)
}
