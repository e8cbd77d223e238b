//! The lines on what stays uncut, and on the axis.

use crate::coverage::{AxisCrossing, Coverage, Overrun, SMALLEST_CROSSING, Uncut};
use crate::errors::Tolerances;
use crate::unit;
use crate::verdict::within;

use super::numbers::{against, line, small_length};

/// The verdict where the path does not come to an edge of the part.
const NOT_REACHED: &str = " not reached                EXCEEDED";

/// The verdict, where there is one, and each edge where more than the residual stays.
pub fn coverage(
    coverage: &Coverage,
    tolerance: &Tolerances,
    overrun: Overrun,
    verdict: Option<bool>,
) -> String {
    let mut texts = Vec::new();
    let allowed = tolerance.most_material().unwrap_or(f64::INFINITY);
    if let Some(holds) = verdict {
        texts.push(most_uncut(coverage, allowed, holds));
    }
    for (name, uncut) in coverage.edges() {
        if !within(uncut.height.unwrap_or(f64::INFINITY), allowed) {
            texts.push(edge(name, &uncut, overrun));
        }
    }
    if texts.is_empty() {
        texts.push(format!(
            "nowhere more than the {name} stays uncut",
            name = if tolerance.residual.is_some() {
                "residual"
            } else {
                "form"
            }
        ));
    }
    let labels = std::iter::once("coverage").chain(std::iter::repeat(""));
    let lines = labels.zip(&texts).map(|(label, text)| line(label, text));
    lines.collect()
}

/// The largest height that stays uncut against the one that may stay, mm.
pub fn most_uncut(coverage: &Coverage, allowed: f64, holds: bool) -> String {
    match coverage.largest() {
        largest if largest.is_finite() => against(largest, allowed, holds),
        _ => NOT_REACHED.to_owned(),
    }
}

fn edge(name: &str, uncut: &Uncut, overrun: Overrun) -> String {
    let (at, overrun) = (uncut.c * unit::deg::PER, key(overrun));
    match uncut.height {
        None => format!("{name} not reached at {at:.0} deg ({overrun})"),
        Some(height) => {
            let height = small_length(height);
            format!("{name} {height} uncut at {at:.0} deg ({overrun})")
        }
    }
}

/// The overrun as the recipe has it.
fn key(overrun: Overrun) -> String {
    match overrun {
        Overrun::Contact => "overrun = \"contact\"".to_owned(),
        Overrun::None => "overrun = \"none\"".to_owned(),
        Overrun::Length(length) => format!("overrun = \"{length} mm\""),
    }
}

/// The warning where X crosses the axis, as a line.
pub fn axis_crossing(crossing: &AxisCrossing) -> String {
    let warning = axis_crossing_warning(crossing);
    warning.map_or_else(String::new, |warning| line("warning", warning))
}

/// The warning where X crosses the axis; `None` where it does not.
pub fn axis_crossing_warning(crossing: &AxisCrossing) -> Option<String> {
    if crossing.x <= SMALLEST_CROSSING {
        return None;
    }
    let x = small_length(crossing.x);
    let why = match crossing.contact <= SMALLEST_CROSSING {
        true => "as the normal of a tilted centre asks",
        false => "since the feed goes on there",
    };
    Some(format!(
        "X crosses the axis by {x}, {why}; beyond it the part moves against the edge"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossing(x: f64) -> String {
        axis_crossing(&AxisCrossing { x, contact: 0.0 })
    }

    #[test]
    fn a_crossing_is_reported_and_rounding_is_not() {
        assert_eq!(crossing(1e-13), "");
        let text = crossing(0.0123);
        assert!(text.starts_with("  warning         X crosses the axis by 12.30 um, "));
    }
}
