//! The lines on the leads.

use crate::coverage::SMALLEST_CROSSING;
use crate::lead::LeadReport;

use super::machine::{by_digits, exceeded};
use super::numbers::{duration, line, millimetres, path_place, small_length};

/// A lead ends where the cut begins: what rounds to 0.00 nm is a touch, mm.
const TOUCH: f64 = 5e-9;

/// The lines on the leads; `clears` is their verdict.
pub fn lead(lead: &LeadReport, clears: Option<bool>) -> String {
    let mut text = String::new();
    if let Some(layout) = &lead.layout {
        let (come, go) = (duration(layout.in_time), duration(layout.out_time));
        let rest = millimetres(layout.rest_clearance, 3);
        text += &line(
            "lead",
            format!("{come} in, {go} out; clears the part by {rest} at rest"),
        );
    }
    let label = if lead.layout.is_some() { "" } else { "lead" };
    text += &line(label, lowest(lead, clears));
    if let Some(warning) = lead_warning(lead) {
        text += &line("lead warning", warning);
    }
    text + &exceeded(&lead.limits, "lead ") + &by_digits(&lead.limits, "lead ")
}

/// The warning where X crosses the axis on a lead; `None` where it does not.
pub fn lead_warning(lead: &LeadReport) -> Option<String> {
    let crossing = small_length(lead.axis_crossing);
    let crosses = lead.axis_crossing > SMALLEST_CROSSING;
    crosses.then(|| format!("X crosses the axis by {crossing} on the way from or to the part"))
}

fn lowest(lead: &LeadReport, clears: Option<bool>) -> String {
    let lowest = lead.smallest_clearance;
    let height = small_length(lowest.abs());
    let way = match lowest {
        lowest if lowest.abs() < TOUCH => {
            "comes down to the wanted surface and no deeper".to_owned()
        }
        lowest if lowest < 0.0 => format!("digs {height} into the wanted surface at most"),
        _ => format!("stays {height} above the wanted surface"),
    };
    match clears {
        Some(false) => format!("{way}; EXCEEDED, at {}", path_place(&lead.at)),
        _ => format!("{way}; holds"),
    }
}
