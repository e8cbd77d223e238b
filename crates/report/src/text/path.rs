//! The lines on what was measured: each error against its tolerance, motion against limits.

use crate::path::PathReport;
use crate::surface_error::SurfaceError;
use crate::unit;
use crate::verdict::Verdict;

use super::coverage::{axis_crossing, coverage};
use super::form::form;
use super::machine::{highest_spindle, machine};
use super::numbers::{against_any, line, millimetres, path_place, small_length};

/// The lines on the cut.
pub fn path(path: &PathReport, verdict: &Verdict) -> String {
    let tolerance = &path.tolerance;
    let error = &path.interpolation_error;
    let limit = against_any(error.max, tolerance.interpolation, verdict.interpolation);
    let (rms, at) = (small_length(error.rms), path_place(&error.at));
    let mut text = line("interpolation", limit);
    text += &line("", format!("{rms:>12} rms; the largest at {at}"));
    text += &line("residual", residual(path, verdict));
    text += &surface_error(path.surface_error.as_ref());
    if let Some(report) = &path.form {
        text += &form(report, verdict.form);
    }
    text += &coverage(&path.coverage, tolerance, path.overrun, verdict.coverage);
    text += &axis_crossing(&path.axis_crossing);
    if let Some(report) = &path.machine {
        text += &machine(report);
    }
    text + &highest_spindle(path.highest_spindle.as_ref())
}

fn residual(path: &PathReport, verdict: &Verdict) -> String {
    match path.residual.max {
        Some(max) => against_any(max, path.tolerance.residual, verdict.residual),
        None => "not measured: no turn has a neighbour".to_owned(),
    }
}

fn surface_error(error: Option<&SurfaceError>) -> String {
    let Some(error) = error else {
        return line("surface error", "not measured: nothing of the part is cut");
    };
    let (pv, rms) = (small_length(error.pv), small_length(error.rms));
    let [x, y] = [error.highest.x, error.highest.y].map(|mm| millimetres(mm, 4));
    let text = format!("{pv:>12} PV, {rms} rms; the highest at x = {x}, y = {y}");
    let uncut = error.uncut * unit::percent::PER;
    let uncut = match uncut > 0.0 {
        true => line("", format!("{uncut:>10.3} % of the part is not cut")),
        false => String::new(),
    };
    line("surface error", text) + &uncut
}
