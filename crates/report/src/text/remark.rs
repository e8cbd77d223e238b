//! The lines on what is allowed but seldom meant, and on the cap of the feed.

use turnpath_core::DEG;

use crate::feed_cap::FeedCap;
use crate::remark::Remark;
use crate::unit;

use super::numbers::{duration, line, millimetres, significant, small_length};

/// A line for each remark.
pub fn remarks(remarks: &[Remark]) -> String {
    remarks
        .iter()
        .map(|remark| line("remark", sentence(remark)))
        .collect()
}

/// A remark as a sentence.
pub fn sentence(remark: &Remark) -> String {
    match remark {
        Remark::RoughResidual { residual } => {
            let residual = small_length(*residual);
            format!("a residual of {residual} is far above that of an optical surface")
        }
        Remark::SmallAperture { aperture } => {
            format!(
                "an aperture of {} is that of a grain",
                small_length(*aperture)
            )
        }
        Remark::FastZ { acceleration } => {
            let acceleration = significant(acceleration / 1e3);
            format!("Z accelerates by {acceleration} m/s², and [machine] has no limit for it")
        }
        Remark::ShortestSegments {
            segment_time,
            shortest,
        } => {
            let (segment_time, shortest) = (significant(segment_time * 1e3), shortest * 1e3);
            format!(
                "the interpolation error exceeds its tolerance in a segment of {segment_time} ms, and \
                 refinement makes none below {shortest} ms: turn the spindle slower, so that segments \
                 take longer"
            )
        }
        Remark::ShortEdge {
            edge,
            meeting,
            included_angle,
        } => {
            let [edge, meeting, included_angle] =
                [edge, meeting, included_angle].map(|angle| angle / DEG);
            format!(
                "the edge ends {edge:.3} deg beyond the steepest contact, and neighbouring passes meet \
                 {meeting:.3} deg beyond their contacts: cusps are higher there, and the rim may stay \
                 uncut; an included angle of {included_angle:.2} deg is enough"
            )
        }
        Remark::LongCut { cutting_time } => {
            format!(
                "the cut takes {}, longer than a working day",
                duration(*cutting_time)
            )
        }
        Remark::CoarseDigits {
            post,
            position_decimals,
            rounding,
            tolerance,
        } => {
            let (rounding, tolerance) = (small_length(*rounding), small_length(*tolerance));
            format!(
                "{}position_decimals = {position_decimals} rounds positions by up to {rounding}, and \
                 the interpolation tolerance is {tolerance}",
                of_post(post)
            )
        }
        Remark::CoarseNumbers {
            post,
            c,
            c_rounding,
            rounding,
            tolerance,
        } => {
            let (rounding, tolerance) = (small_length(*rounding), small_length(*tolerance));
            let (c, c_rounding) = (c / DEG, significant(c_rounding / DEG));
            format!(
                "{}the controller knows C = {c:.0} deg to {c_rounding} deg, on which the surface rises \
                 by up to {rounding}, and the interpolation tolerance is {tolerance}; write \
                 c_wrap = \"0-360\" or positioning = \"incremental\"",
                of_post(post)
            )
        }
        Remark::SeveralDepths {
            post,
            depths,
            step,
            time,
        } => {
            let first = small_length(f64::from(depths.saturating_sub(1)) * step);
            format!(
                "{}the program plays the path {depths} times, in {} together, leads and approaches with it and \
                 rapid moves not: the first is {first} above the path, and the last is the path. All other \
                 figures are those of the last",
                of_post(post),
                duration(*time)
            )
        }
        Remark::NeedsDigits {
            post,
            position_decimals,
            delivered_decimals,
        } => format!(
            "{}the program has {position_decimals} decimals, and the controller keeps \
             {delivered_decimals} on delivery; the program's header says what the machine needs",
            of_post(post)
        ),
        Remark::CoarseVelocityDigits {
            post,
            velocity_decimals,
            rounding,
            segment_time,
            tolerance,
        } => {
            let (rounding, tolerance) = (small_length(*rounding), small_length(*tolerance));
            let time = significant(segment_time * 1e3);
            format!(
                "{}velocity_decimals = {velocity_decimals} moves the middle of a segment of {time} ms \
                 by up to {rounding}, and the interpolation tolerance is {tolerance}",
                of_post(post)
            )
        }
        Remark::FilledPoints { filled, points } => {
            format!("{filled} of {points} points of the map have no height; they were filled")
        }
        Remark::BeyondData {
            on_part,
            distance,
            radius,
            c,
            continuation,
        } => {
            let what = if *on_part { "part" } else { "overrun" };
            let (distance, radius) = (millimetres(*distance, 3), millimetres(*radius, 3));
            let angle = c / DEG;
            format!(
                "the {what} leaves the data of the surface by {distance} at radius {radius}, \
                 C = {angle:.1} deg; there it goes on {continuation}"
            )
        }
        Remark::FittedSurface {
            points,
            error,
            tolerance,
        } => {
            let (error, tolerance) = (small_length(*error), small_length(*tolerance));
            format!(
                "a spline of {points} points stands for the surface; it lies up to {error} off, and \
                 the interpolation tolerance is {tolerance}"
            )
        }
        Remark::NotByteExact { strategies, plugin } => format!(
            "the bytes of the path may differ on another machine: {} of {plugin} may call functions \
             that are not the same everywhere",
            strategies.join(", ")
        ),
    }
}

/// A post's name before what is said of its program.
fn of_post(post: &str) -> String {
    match post {
        "" => String::new(),
        post => format!("{post}: "),
    }
}

/// The lines on the cap of the feed; empty where it binds nowhere.
pub fn feed_cap(cap: &FeedCap) -> String {
    let (Some(from), Some(to), Some(feed)) = (cap.from, cap.to, cap.feed) else {
        return String::new();
    };
    let feed = significant(feed * unit::um::PER);
    let (from, to) = (millimetres(from, 3), millimetres(to, 3));
    let what = format!("within a tenth of the largest feed of the nose, {feed} um/rev,");
    let whatever = format!("from ρ = {from} to {to}, whatever the residual");
    line("feed cap", what) + &line("", whatever)
}
