//! The page of an ablation: its runs in a table, and side by side in pictures.

mod comparison;
mod table;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use turnpath_report::{AblationReport, AblationRun, ErrorSketch};

use comparison::{Comparison, comparisons};

use crate::document::document;
use crate::html::{element, escaped, figure, section};

/// The data of an ablation's page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AblationPage {
    /// What the ablation gave.
    pub report: AblationReport,
}

/// The data that the script draws.
#[derive(Serialize)]
struct Drawn<'a> {
    kind: &'static str,
    /// The runs that have a path.
    runs: Vec<DrawnRun<'a>>,
    comparisons: Vec<Comparison>,
}

#[derive(Serialize)]
struct DrawnRun<'a> {
    name: String,
    /// The values that vary.
    values: Vec<&'a str>,
    sketch: Option<&'a ErrorSketch>,
}

/// The page of an ablation.
pub fn ablation_page(page: &AblationPage) -> String {
    let runs = &page.report.runs;
    let measured = runs
        .iter()
        .filter_map(|run| Some((table::label(run), run.measured()?)));
    let measured: Vec<_> = measured.collect();
    let varied = runs.iter().filter(|run| run.measured().is_some());
    let values = varied.map(|run| run.varied.iter().map(|(_, value)| value.as_str()).collect());
    let name = measured
        .first()
        .map_or("Ablation", |(_, run)| run.report.name.as_str());
    let version = measured
        .first()
        .map_or("", |(_, run)| run.report.turnpath.as_str());
    let drawn = Drawn {
        kind: "ablation",
        runs: measured
            .iter()
            .zip(values)
            .map(|((name, run), values)| DrawnRun {
                name: name.clone(),
                values,
                sketch: run.sketch.as_ref(),
            })
            .collect(),
        comparisons: comparisons(&measured),
    };
    let failed = runs.len() - measured.len();
    let counts = match failed {
        0 => format!("{} runs", runs.len()),
        failed => format!("{} runs, {failed} failed", runs.len()),
    };
    let body = [
        format!(
            "<header><p class=\"made-by\">turnpath {}</p><h1>{}: ablation</h1><p>{counts}</p>{}</header>\n<main>\n",
            escaped(version),
            escaped(name),
            without_record(runs)
        ),
        table::table(runs),
        figures(&drawn),
        "</main>\n".to_owned(),
    ];
    document(&format!("{name}: ablation"), &body.concat(), &drawn)
}

/// How many runs have no record, for each reason why.
fn without_record(runs: &[AblationRun]) -> String {
    let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
    for reason in runs.iter().filter_map(|run| run.not_recorded.as_deref()) {
        *reasons.entry(reason).or_default() += 1;
    }
    let line = |(reason, count): (&str, usize)| {
        let which = match count {
            1 => "One run has no record, and is made each time".to_owned(),
            count => format!("{count} runs have no record, and are made each time"),
        };
        element("p", "", &escaped(&format!("{which}: {reason}")))
    };
    reasons.into_iter().map(line).collect()
}

fn figures(drawn: &Drawn<'_>) -> String {
    let front = "The line joins the runs that no other run beats in one figure without losing in the \
                 other. What differs by less than 1 % counts as equal.";
    let mut html = String::new();
    for comparison in &drawn.comparisons {
        html += &figure(comparison.id, "", comparison.title, front);
    }
    if drawn.runs.iter().any(|run| run.sketch.is_some()) {
        let maps = "Machined − wanted along z of each run, all on one scale. A cell has the mean along \
                    the radius over a 192nd of the part's radius. The scale is that of the \
                    inner 95 % of the radius, without the 5 % highest and lowest cells of all.";
        html += &figure("error-maps", "whole", "Error maps", maps);
        html += &figure(
            "radial-means",
            "",
            "Radial means",
            "The mean of each error map on rings.",
        );
        let spectra = "The harmonics of the error as played, averaged over 64 turns.";
        html += &figure("spectra", "", "Angular spectra", spectra);
    }
    section("pictures", "Pictures", &element("div", "figures", &html))
}
