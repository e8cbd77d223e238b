//! What is allowed in a recipe but seldom meant.

use std::f64::consts::{PI, TAU};

use turnpath_core::{Axis, DEG, Derivative, Misfit, Scalar, Task, Tolerance};
use turnpath_pipeline::SMALLEST_SEGMENT;
use turnpath_post::Layout;
use turnpath_recipe::Recipe;
use turnpath_report::{ProgramDigits, Remark, RemarkSubject};
use turnpath_verify::PlaybackFigures;

use crate::posts::{layout, posts};

/// Seconds of a minute: a format has the feed of its approach per minute.
const MINUTE: f64 = 60.0;

/// What remarks are made on besides the recipe: its path, or what is expected of it.
pub struct PathSubject {
    /// The tolerances that the path was made for.
    pub tolerance: Tolerance,
    /// Time of the cutting section, s.
    pub cutting_time: f64,
    /// Time of both leads, s; zero for a path without.
    pub lead_time: f64,
    /// Revolutions of the cutting section.
    pub revolutions: f64,
    /// Control points of the cutting section.
    pub control_points: f64,
    /// The largest acceleration of Z where it is known, mm/s².
    pub z_acceleration: Option<f64>,
}

/// The remarks on a recipe and its path. `cut_angle` is the steepest angle of the surface along the cut
/// to the horizontal, rad; below 0 where it rises nowhere.
pub fn remarks(recipe: &Recipe, path: &PathSubject, cut_angle: f64) -> Vec<Remark> {
    let limited = recipe
        .machine
        .limits()
        .any(|limit| limit.axis == Axis::Z && limit.derivative == Derivative::Acceleration);
    // The digits do not depend on the nose.
    let layouts = posts(recipe).map(|post| layout(recipe, post, true));
    let subject = RemarkSubject {
        aperture: 2.0 * recipe.part.aperture_radius,
        residual: path.tolerance.residual,
        interpolation: path.tolerance.interpolation,
        form: recipe.tolerances.form,
        cutting_time: path.cutting_time,
        segment_time: path.cutting_time / path.control_points.max(1.0),
        free_z_acceleration: path.z_acceleration.filter(|_| !limited),
        slope_along_cut: Scalar::tan(cut_angle.max(0.0)),
        digits: layouts.map(|layout| digits(&layout, path)).collect(),
    };
    let layouts = posts(recipe).map(|post| layout(recipe, post, true));
    let depths = layouts.filter_map(|layout| several_depths(&layout, path));
    subject.remarks().into_iter().chain(depths).collect()
}

/// The remark on a path whose error exceeds the tolerance where refinement makes no shorter segments.
pub fn shortest_segments(tolerance: &Tolerance, playback: &PlaybackFigures) -> Option<Remark> {
    let is_shortest = playback.segment_time < 2.0 * SMALLEST_SEGMENT;
    (is_shortest && playback.max() > tolerance.interpolation).then_some(Remark::ShortestSegments {
        segment_time: playback.segment_time,
        shortest: SMALLEST_SEGMENT,
    })
}

/// The remark on a tool whose edge ends before the tips of the cusps at the steepest contact, which has this angle to
/// the horizontal, rad. Where the nose may leave seams, what it leaves is measured instead.
pub fn short_edge(task: &Task, path: &PathSubject, steepest: f64) -> Option<Remark> {
    let (tool, part) = (&task.tool, &task.part);
    let included_angle = tool
        .included_angle
        .filter(|_| tool.misfit == Misfit::Refuse)?;
    let edge = 0.5 * included_angle - steepest;
    // Passes are a mean feed apart, and no farther than cusps of the residual allow on a flat.
    let feed = (part.aperture_radius - part.inner_radius) / path.revolutions;
    let half_spacing = 0.5 * feed / (Scalar::cos(steepest) * tool.nose_radius);
    let of_residual = Scalar::acos((1.0 - path.tolerance.residual / tool.nose_radius).max(0.0));
    let meeting = Scalar::asin(half_spacing.min(1.0)).min(of_residual);
    (edge < meeting).then_some(Remark::ShortEdge {
        edge,
        meeting,
        included_angle: (2.0 * (steepest + meeting)).min(PI),
    })
}

/// The remark on a loop over depths, whose program takes longer than the path.
fn several_depths(layout: &Layout, path: &PathSubject) -> Option<Remark> {
    let format = &layout.format;
    let depths = format.depths?;
    let one = 10_u64.pow(format.position_decimals) as f64;
    // Z goes down from the plane of the approach, which is above the first depth, to the highest place of the
    // path: the first point of a path from rest to rest lies there but for the last digits.
    let way = format.approach_height + depths.rise() as f64 / one;
    let once = path.cutting_time + path.lead_time + way / format.approach_feed * MINUTE;
    Some(Remark::SeveralDepths {
        post: layout.post.name.to_owned(),
        depths: u32::try_from(depths.count).unwrap_or(u32::MAX),
        step: depths.step as f64 / one,
        time: depths.count as f64 * once,
    })
}

fn digits(layout: &Layout, path: &PathSubject) -> ProgramDigits {
    let Layout { post, format } = layout;
    let c = TAU * path.revolutions;
    let largest = if format.c_wrapped { c.min(TAU) } else { c };
    let rounding = format.held_rounding(largest / DEG);
    ProgramDigits {
        post: post.name,
        position_decimals: format.position_decimals,
        velocity_decimals: post.writes_velocities().then_some(format.velocity_decimals),
        velocity_time: format.velocity_time(),
        held_c: rounding.map(|rounding| (c, DEG * rounding)),
        delivered_decimals: post.delivered_decimals,
    }
}
