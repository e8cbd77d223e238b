//! The verdict of a run: what holds and what does not, with the figures.

use turnpath_report::text::{grouped, limit_amount, limit_name, warnings};
use turnpath_report::{RunReport, unit};

use crate::html::{element, escaped, row};
use crate::words::{number, small_length};

/// The verdict in a sentence, and a row for each tolerance.
pub fn verdict(report: &RunReport) -> String {
    let verdict = report.verdict();
    let failed: Vec<&str> = verdict.failures().collect();
    let (class, sentence) = match failed.as_slice() {
        [] => (
            "verdict holds",
            "All tolerances and limits hold.".to_owned(),
        ),
        failed => (
            "verdict exceeded",
            format!("EXCEEDED: {}.", failed.join(", ")),
        ),
    };
    let mut html = element("p", class, &escaped(&sentence));
    html += &warnings_list(report);
    html += &facts(report);
    let rows: String = verdict
        .entries()
        .filter_map(|(name, holds)| Some((name, holds?)))
        .map(|(name, holds)| match name {
            "machine" => limit_rows(report),
            _ => {
                let (found, limit) = figures(report, name);
                row("td", &[name, &found, &limit, word(holds)])
            }
        })
        .collect();
    if !rows.is_empty() {
        let head = row("th", &["held to a limit", "found", "limit", "verdict"]);
        html += &format!(
            "<table class=\"verdicts\"><thead>{head}</thead><tbody>{rows}</tbody></table>\n"
        );
    }
    html
}

/// What a person should read beside the verdict.
fn warnings_list(report: &RunReport) -> String {
    let warnings = warnings(report);
    let items: String = warnings
        .iter()
        .map(|warning| element("li", "", &escaped(warning)))
        .collect();
    match items.is_empty() {
        true => items,
        false => {
            element("p", "", "No limit is held to these:") + &element("ul", "warnings", &items)
        }
    }
}

fn word(holds: bool) -> &'static str {
    if holds { "holds" } else { "EXCEEDED" }
}

/// A row for each limit of the machine that was measured, on the cut and on the leads.
fn limit_rows(report: &RunReport) -> String {
    let machine = report
        .path
        .machine
        .iter()
        .flat_map(|machine| &machine.limits);
    let lead = report.path.lead.iter().flat_map(|lead| &lead.limits);
    let rows = machine
        .map(|limit| ("", limit))
        .chain(lead.map(|limit| ("lead: ", limit)));
    let rows = rows.filter_map(|(of, figure)| {
        let limit = &figure.limit;
        let (amount, _) = figure.decisive()?;
        let name = format!("{of}{}", limit_name(limit.axis, limit.derivative));
        let (found, most) = (
            limit_amount(limit, amount),
            limit_amount(limit, limit.value),
        );
        Some(row("td", &[&name, &found, &most, word(figure.holds()?)]))
    });
    rows.collect()
}

/// What was found and what the limit is, where one number says it.
fn figures(report: &RunReport, name: &str) -> (String, String) {
    let (path, tolerance) = (&report.path, &report.path.tolerance);
    let lengths = |found: Option<f64>, limit: Option<f64>| {
        let text =
            |length: Option<f64>| length.map_or_else(|| "no number".to_owned(), small_length);
        (text(found), limit.map(small_length).unwrap_or_default())
    };
    match name {
        "interpolation" => lengths(Some(path.interpolation_error.max), tolerance.interpolation),
        "residual" => lengths(path.residual.max, tolerance.residual),
        "form" => lengths(path.form.as_ref().and_then(|form| form.pv), tolerance.form),
        "coverage" => match path.coverage.largest() {
            largest if largest.is_finite() => lengths(Some(largest), tolerance.most_material()),
            _ => (
                "not reached".to_owned(),
                lengths(None, tolerance.most_material()).1,
            ),
        },
        "servo" => lengths(
            path.servo.map(|servo| servo.predicted_error.max),
            tolerance.servo,
        ),
        "lead" => {
            let deepest = path
                .lead
                .as_ref()
                .map(|lead| (-lead.smallest_clearance).max(0.0));
            lengths(deepest, tolerance.deepest())
        }
        "programs" => (
            count(report.programs.len(), "program", "programs"),
            String::new(),
        ),
        "passes" => (
            count(report.rough_paths.len(), "pass", "passes"),
            String::new(),
        ),
        _ => Default::default(),
    }
}

fn count(of: usize, one: &str, many: &str) -> String {
    format!("{of} {}", if of == 1 { one } else { many })
}

/// The figures that one looks for first.
fn facts(report: &RunReport) -> String {
    let path = &report.path;
    let mut facts = vec![
        ("control points", grouped(report.control_points)),
        ("revolutions", format!("{:.2}", report.revolutions)),
        ("cutting time", format!("{} s", number(report.cutting_time))),
    ];
    if let Some(error) = &path.surface_error {
        facts.push(("surface error, PV", small_length(error.pv)));
        facts.push(("surface error, RMS", small_length(error.rms)));
    }
    if let Some(spokes) = &path.spokes {
        let amplitude = small_length(spokes.amplitude);
        facts.push((
            "largest spokes",
            format!("{amplitude}, {} a turn", spokes.per_turn),
        ));
    }
    if let Some(arms) = &path.arms {
        let (amplitude, pitch) = (small_length(arms.amplitude), number(arms.pitch));
        let apart = format!("{amplitude}, {} arms, {pitch} mm apart", arms.per_turn);
        facts.push(("largest spiral arms", apart));
    }
    if let Some(highest) = &path.highest_spindle {
        let speed = number(highest.speed * unit::rpm::PER);
        facts.push(("highest spindle speed", format!("{speed} rpm")));
    }
    let fact = |(name, value): &(&str, String)| {
        format!(
            "<div><dt>{}</dt><dd>{}</dd></div>",
            escaped(name),
            escaped(value)
        )
    };
    element("dl", "facts", &facts.iter().map(fact).collect::<String>())
}
