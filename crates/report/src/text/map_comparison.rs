//! A map against a surface, for a person.

use turnpath_core::printable_line;

use crate::map_comparison::{MapComparison, MapPlace};

use super::numbers::{grouped, line, signed_length, small_length};

/// The text on a map against a surface.
pub fn map_comparison(report: &MapComparison) -> String {
    let mut text = format!("{}\n", printable_line(&report.name));
    text += &line("map", printable_line(&report.map));
    text += &line("points", points(report));
    text += &line("map - surface", format!("PV {}", small_length(report.pv)));
    text += &line(
        "piston kept",
        format!(
            "RMS {}, mean {}",
            small_length(report.rms),
            signed_length(report.mean)
        ),
    );
    let removed = small_length(report.rms_without_piston);
    text += &line("piston removed", format!("RMS {removed}"));
    text + &line("worst", place(&report.worst))
}

fn points(report: &MapComparison) -> String {
    let mut text = format!("{} compared", grouped(report.points));
    let left_out = [
        (report.beyond_part, "beyond the part"),
        (
            report.without_height,
            "on the part without a height in the map",
        ),
        (
            report.without_surface,
            "on the part where the surface has no height",
        ),
    ];
    for (count, what) in left_out.into_iter().filter(|(count, _)| *count > 0) {
        text += &format!("; {} {what}", grouped(count));
    }
    text
}

fn place(place: &MapPlace) -> String {
    let (x, y) = (place.x, place.y);
    format!(
        "{} at x = {x:.3} mm, y = {y:.3} mm",
        signed_length(place.difference)
    )
}
