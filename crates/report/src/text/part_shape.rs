//! The lines on the part's own shape.

use turnpath_core::printable_line;

use crate::part_shape::{PartCurvature, PartPlace, PartShape, RefusedCheck};
use crate::unit;

use super::numbers::{line, millimetres};

/// Columns of a figure before the space and its place.
const FIGURE: usize = 23;

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
    text += &row("most hollow", &curvature(hollow), &hollow.at);
    text + &row("most domed", &curvature(dome), &dome.at)
}

fn row(label: &str, figure: &str, at: &PartPlace) -> String {
    let (x, y) = (millimetres(at.x, 3), millimetres(at.y, 3));
    line(
        label,
        format!("{figure:<FIGURE$} at x = {x}, y = {y} (part)"),
    )
}

/// A curvature with its sign. A tip has none.
fn curvature(place: &PartCurvature) -> String {
    match place.curvature {
        _ if place.tip => "a tip, not smooth".to_owned(),
        0.0 => "curvature 0 /mm".to_owned(),
        curvature if curvature.abs() < 1e-3 => format!("curvature {curvature:.3e} /mm"),
        curvature if curvature.abs() < 1e2 => format!("curvature {curvature:.5} /mm"),
        curvature => format!("curvature {curvature:.3e} /mm"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_all_sizes_stand_apart_from_their_places() {
        let at = PartPlace { x: 0.0, y: 0.0 };
        for size in [1e-300, 0.02, 9.999_999, 99.999_999, 1342.177, 1.5e200] {
            for curvature in [size, -size] {
                let tip = false;
                let shown = super::curvature(&PartCurvature { curvature, tip, at });
                let line = row("most domed", &shown, &at);
                assert!(
                    line.contains("/mm at x") || line.contains("/mm  "),
                    "{line}"
                );
            }
        }
        let place = PartCurvature {
            curvature: 1342.177,
            tip: true,
            at,
        };
        assert_eq!(curvature(&place), "a tip, not smooth");
    }
}
