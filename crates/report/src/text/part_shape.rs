//! The lines on the part's own shape.

use turnpath_core::printable_line;

use crate::part_shape::{PartPlace, PartShape, RefusedCheck};
use crate::unit;

use super::numbers::{line, millimetres};

/// Columns of a figure before its place.
const FIGURE: usize = 24;

/// The text on a check that ended early. Why it did is for its caller to say.
pub fn refused_check(report: &RefusedCheck) -> String {
    let name = printable_line(&report.name);
    format!("{name}\n{}", part_shape(&report.part))
}

/// The lines on the part's own shape.
pub fn part_shape(part: &PartShape) -> String {
    let height = |height: f64| format!("z = {}", millimetres(height, 6));
    let angle = part.steepest.angle * unit::deg::PER;
    let mut text = row("lowest", &height(part.lowest.height), &part.lowest.at);
    text += &row("highest", &height(part.highest.height), &part.highest.at);
    text += &row("steepest", &format!("by {angle:.2} deg"), &part.steepest.at);
    let [hollow, dome] = [&part.most_hollow, &part.most_domed];
    text += &row("most hollow", &curvature(hollow.curvature), &hollow.at);
    text + &row("most domed", &curvature(dome.curvature), &dome.at)
}

fn row(label: &str, figure: &str, at: &PartPlace) -> String {
    let (x, y) = (millimetres(at.x, 3), millimetres(at.y, 3));
    line(
        label,
        format!("{figure:<FIGURE$}at x = {x}, y = {y} (part)"),
    )
}

/// A curvature with its sign.
fn curvature(curvature: f64) -> String {
    match curvature {
        0.0 => "curvature 0 /mm".to_owned(),
        _ if curvature.abs() < 1e-3 => format!("curvature {curvature:.3e} /mm"),
        _ => format!("curvature {curvature:.5} /mm"),
    }
}
