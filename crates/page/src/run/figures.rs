//! The places of a run's figures, with their titles and what they show.

use turnpath_report::{Direction, unit};

use super::model::{BestFit, RunPage};
use crate::html::{element, escaped, figure, section};
use crate::words::number;

/// What stands where the page has no data of the path.
const NO_SKETCH: &str = "The run wrote no file of its path that can be read, so this page has no \
                         figures of the path. With \"csv\" in `data` of [output] it has them.";

/// All figures of a run.
pub fn figures(page: &RunPage) -> String {
    let path = match &page.sketch {
        None => surface_figures(page) + &element("p", "note", &escaped(NO_SKETCH)),
        Some(sketch) => {
            let mut html = error_figures();
            if sketch.error.map.is_none() {
                html = element("p", "note", "Nothing of the part is cut.");
            }
            html + &surface_figures(page) + &path_figures(page)
        }
    };
    let axes = element("p", "note", &escaped(&axes(page)));
    let figures = element("div", "figures", &path);
    section("pictures", "Pictures", &(axes + &figures))
}

/// What the axes of the pictures and of the path mean.
fn axes(page: &RunPage) -> String {
    let way = match page.report.direction {
        Direction::Inward => "X falls, from the rim to the axis",
        Direction::Outward => "X grows, from the axis to the rim",
    };
    format!(
        "The part is seen as the tool faces it: x to the right, y upwards, z out of the part towards \
         the tool. At C and X the tool is above x = X cos C, y = X sin C. As C grows, the part turns \
         clockwise as the tool sees it; here {way}. What the axes of each file mean, whose C may run the \
         other way, stands below."
    )
}

fn error_figures() -> String {
    [
        figure(
            "error-map",
            "square",
            "Error map",
            "Machined − wanted along z, seen from the tool. A cell has the mean along the radius over \
             a 192nd of the part's radius, so single cusps do not show. The scale is that \
             of the inner 95 % of the radius, without the 0.2 % highest and lowest cells.",
        ),
        figure(
            "radial-mean",
            "",
            "Radial mean",
            "The mean of the error map on each ring.",
        ),
        figure(
            "spectrum",
            "",
            "Angular spectrum",
            "The amplitude of each harmonic of the error as played, averaged over 64 turns, at its \
             largest. What stands out from 3 periods a turn on are spokes. Spiral arms, which turn from \
             turn to turn, leave little here: the verdict names the largest.",
        ),
        figure(
            "profile",
            "",
            "Profiles",
            "The error map along two lines through the axis; s is the signed radius.",
        ),
    ]
    .concat()
}

fn path_figures(page: &RunPage) -> String {
    let limits = match page.report.path.machine {
        Some(_) => "Dashed lines are the machine's limits.",
        None => "The recipe gives no limits of the machine.",
    };
    let turns = "Each entry is a turn, or some neighbouring ones.";
    let coverage = "The highest cusp on each section, and below it what stays uncut at the edges of \
                    the part. Dashed lines are tolerances.";
    [
        figure(
            "spiral",
            "square",
            "Spiral",
            "Places of the tool, thinned out. The colour is the largest |played − true| from each to \
             the next.",
        ),
        figure("along", "tall", "Feed, points, spindle, error", turns),
        figure("x-axis", "tall", "Motion of X", &format!("The largest amounts on each turn. {limits}")),
        figure("z-axis", "tall", "Motion of Z", &format!("The largest amounts on each turn. {limits}")),
        figure("angle", "tall", "Residual and coverage", coverage),
    ]
    .concat()
}

fn surface_figures(page: &RunPage) -> String {
    let best = match page.surface.best {
        None => return figure("surface", "square", "Surface", "The wanted height along z."),
        Some(BestFit::Plane) => ("Deviation from the best plane", "The plane".to_owned()),
        Some(BestFit::Sphere { radius }) => (
            "Deviation from the best sphere",
            format!("The sphere of {} mm radius", number(radius * unit::mm::PER)),
        ),
    };
    let caption = format!("{} has the least mean square distance along z.", best.1);
    figure("surface", "square", "Surface", "The wanted height along z.")
        + &figure("deviation", "square", best.0, &caption)
}
