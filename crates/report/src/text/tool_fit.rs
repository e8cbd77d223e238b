//! The lines on what the part asks of the tool: its three figures in columns, then the sectional
//! curves.

use crate::tool_fit::{AngleMargin, ContactPlace, Margins, NoseMargin, Region, Sections, ToolFit};
use crate::unit;

use super::numbers::{line, millimetres};

/// Angles below this round to zero and are shown as none, deg.
const LEVEL: f64 = 0.005;
/// Columns of a limit with its margin.
const LIMIT: usize = 44;
/// Columns of a section's figure before its place.
const SECTION: usize = 24;

/// The lines on the tool.
pub fn tool_fit(fit: &ToolFit) -> String {
    margins(&fit.margins) + &sections(&fit.sections)
}

fn margins(margins: &Margins) -> String {
    let mut text = nose(&margins.nose_radius);
    text += &angle("included angle", &margins.included_angle);
    text + &angle("clearance angle", &margins.clearance_angle)
}

fn nose(nose: &NoseMargin) -> String {
    let limit = match (nose.most, nose.margin) {
        (Some(most), Some(margin)) => {
            let (most, margin) = (millimetres(most, 4), millimetres(margin, 4));
            format!("at most  {most:>12}, {margin:>12} to spare")
        }
        _ => "any fits: no hollow limits it".to_owned(),
    };
    row(
        "nose radius",
        &millimetres(nose.given, 4),
        &limit,
        nose.at.as_ref(),
    )
}

fn angle(label: &str, angle: &AngleMargin) -> String {
    let degrees = |rad: f64| format!("{:.2} deg", rad * unit::deg::PER);
    let least = degrees(angle.least);
    let (given, limit) = match (angle.given, angle.margin) {
        (Some(given), Some(margin)) => {
            let limit = format!("at least {least:>12}, {:>12} to spare", degrees(margin));
            (degrees(given), limit)
        }
        _ => {
            let limit = format!("at least {least:>12}, check not made");
            ("not given".to_owned(), limit)
        }
    };
    row(label, &given, &limit, angle.at.as_ref())
}

fn row(label: &str, given: &str, limit: &str, at: Option<&ContactPlace>) -> String {
    let at = at.map_or(String::new(), place);
    let text = format!("{given:>11}; {limit:<LIMIT$} {at}");
    line(label, text.trim_end())
}

fn sections(sections: &Sections) -> String {
    let mut text = String::new();
    for (label, slope) in [
        ("rises outward", &sections.rises_outward),
        ("falls outward", &sections.falls_outward),
        ("rises along cut", &sections.rises_along_cut),
        ("falls along cut", &sections.falls_along_cut),
    ] {
        let angle = slope.angle * unit::deg::PER;
        let slopes = angle >= LEVEL;
        let figure = match slopes {
            true => format!("by {angle:.2} deg"),
            false => "nowhere".to_owned(),
        };
        text += &section(label, &figure, slopes, &slope.at);
    }
    text
}

fn section(label: &str, figure: &str, somewhere: bool, at: &ContactPlace) -> String {
    let at = if somewhere { place(at) } else { String::new() };
    line(label, format!("{figure:<SECTION$}{at}").trim_end())
}

fn place(at: &ContactPlace) -> String {
    let (x, y) = (millimetres(at.x, 3), millimetres(at.y, 3));
    let on = match at.on {
        Region::Part => "part",
        Region::Overrun => "overrun",
    };
    format!("at x = {x}, y = {y} ({on})")
}
