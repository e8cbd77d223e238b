//! The lines on what was measured: each error against its tolerance, motion against limits.

use crate::cutting_speed::CuttingSpeed;
use crate::errors::PlayedCusp;
use crate::path::PathReport;
use crate::place::SurfacePoint;
use crate::spokes::Spokes;
use crate::surface_error::{RealNose, SurfaceError};
use crate::unit;
use crate::verdict::Verdict;

use super::coverage::{axis_crossing, coverage};
use super::form::form;
use super::machine::{highest_spindle, machine};
use super::numbers::{against_any, line, millimetres, path_place, significant, small_length};

/// The lines on the cut.
pub fn path(path: &PathReport, verdict: &Verdict) -> String {
    let tolerance = &path.tolerance;
    let error = &path.interpolation_error;
    let limit = against_any(error.max, tolerance.interpolation, verdict.interpolation);
    let (rms, at) = (small_length(error.rms), path_place(&error.at));
    let mut text = line("interpolation", limit);
    text += &line("", format!("{rms:>12} rms; the largest at {at}"));
    text += &line("residual", residual(path, verdict));
    text += &played_cusp(path.played_cusp.as_ref());
    text += &surface_error(path.surface_error.as_ref());
    text += &spokes(path.spokes.as_ref());
    text += &arms(path);
    text += &real_nose(path.real_nose.as_ref());
    if let Some(warning) = gouge_warning(path) {
        text += &line("warning", warning);
    }
    if let Some(report) = &path.form {
        text += &form(report, verdict.form);
    }
    text += &coverage(&path.coverage, tolerance, path.overrun, verdict.coverage);
    text += &axis_crossing(&path.axis_crossing);
    text += &cutting_speed(path.cutting_speed.as_ref());
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

/// A cutting speed below this, mm/s, is shown as 0.
const LEAST_SHOWN: f64 = 5e-4;

/// The line on cutting speed. A spindle whose speed changes adds the range of it.
fn cutting_speed(speed: Option<&CuttingSpeed>) -> String {
    let Some(speed) = speed else {
        return String::new();
    };
    let [mean, most] = [speed.mean, speed.most].map(significant);
    let least = match speed.least < LEAST_SHOWN {
        true => "0".to_owned(),
        false => significant(speed.least),
    };
    let spindle = [speed.spindle_least, speed.spindle_most];
    let [lowest, highest] = spindle.map(|speed| significant(speed * unit::rpm::PER));
    // Two speeds that differ by rounding may have other words and the same digits.
    let same = lowest.parse::<f64>().ok() == highest.parse::<f64>().ok();
    let spindle = match same {
        true => format!("at {highest} rpm"),
        false => format!("at {lowest} to {highest} rpm"),
    };
    let text = format!("{least} to {most} mm/s, {mean} mm/s mean, {spindle}");
    line("cutting speed", text)
}

/// The second line on cusps: as played.
fn played_cusp(cusp: Option<&PlayedCusp>) -> String {
    cusp.map_or_else(String::new, |cusp| {
        let (max, at) = (small_length(cusp.max), path_place(&cusp.at));
        let text = format!("{max:>12} as played, with the interpolation error; at {at}");
        line("", text)
    })
}

/// The line on spokes.
fn spokes(spokes: Option<&Spokes>) -> String {
    spokes.map_or_else(String::new, |spokes| {
        let amplitude = small_length(spokes.amplitude);
        let [from, to] = [spokes.from, spokes.to].map(|mm| millimetres(mm, 4));
        let periods = spokes.per_turn;
        let text = format!("{amplitude:>12} with {periods} periods a turn, from {from} to {to}");
        line("spokes", text)
    })
}

/// The line on spiral arms, where they are larger than the spokes.
fn arms(path: &PathReport) -> String {
    let of_spokes = path.spokes.map_or(0.0, |spokes| spokes.amplitude);
    let larger = path.arms.filter(|arms| arms.amplitude > of_spokes);
    larger.map_or_else(String::new, |arms| {
        let amplitude = small_length(arms.amplitude);
        let [pitch, from, to] = [arms.pitch, arms.from, arms.to].map(|mm| millimetres(mm, 4));
        let count = arms.per_turn;
        let text = format!("{amplitude:>12} with {count} arms, {pitch} apart, from {from} to {to}");
        line("spiral arms", text)
    })
}

/// A gouge that is deeper than the interpolation error times this, and by this more, mm, lies between the instants of
/// the playback. Beside seams its depth is known to some nanometres.
const GOUGE_BEYOND: (f64, f64) = (1.5, 10e-6);

/// The warning where the machined surface has a gouge of which the interpolation error knows nothing; `None` where it
/// has none. A nose that the path takes as a point has a warning of its own.
pub fn gouge_warning(path: &PathReport) -> Option<String> {
    let (factor, more) = GOUGE_BEYOND;
    let lowest = path.surface_error.as_ref()?.lowest;
    let depth = -lowest.error;
    let is_unknown = depth > factor * path.interpolation_error.max + more;
    (is_unknown && path.real_nose.is_none()).then(|| {
        let [x, y] = [lowest.x, lowest.y].map(|mm| millimetres(mm, 4));
        format!(
            "the machined surface lies {} too low at x = {x}, y = {y}, and the interpolation error does not \
             show it: a feature of the part lies between two instants of a segment; give shorter steps",
            small_length(depth)
        )
    })
}

/// The warning where the path takes the nose radius as 0, as lines.
fn real_nose(nose: Option<&RealNose>) -> String {
    let lines = nose.map(|nose| {
        let (gouge, left) = real_nose_warning(nose);
        let left = left.map(|left| line("", left));
        line("warning", gouge) + &left.unwrap_or_default()
    });
    lines.unwrap_or_default()
}

/// The warning where the path takes the nose radius as 0: how deep the real nose goes, and what it leaves.
pub fn real_nose_warning(nose: &RealNose) -> (String, Option<String>) {
    let point = |point: &SurfacePoint| {
        let amount = small_length(point.error.abs());
        let [x, y] = [point.x, point.y].map(|mm| millimetres(mm, 4));
        format!("{amount} at x = {x}, y = {y}")
    };
    let gouge = match nose.lowest.error < 0.0 {
        true => format!("gouges {}", point(&nose.lowest)),
        false => "gouges nowhere".to_owned(),
    };
    let text = format!("the path takes the nose radius as 0; the real nose {gouge}");
    let leaves = nose.highest.error > 0.0;
    let left = leaves.then(|| format!("and leaves up to {}", point(&nose.highest)));
    (text, left)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn nose(lowest: f64, highest: f64) -> RealNose {
        let point = |error| SurfacePoint {
            error,
            x: 2.5,
            y: -0.01,
        };
        RealNose {
            pv: highest - lowest,
            highest: point(highest),
            lowest: point(lowest),
        }
    }

    #[test]
    fn a_person_reads_what_the_real_nose_gouges_and_leaves() {
        assert_eq!(real_nose(None), "");
        assert_eq!(
            real_nose(Some(&nose(-7.7e-3, 1e-4))),
            "  warning         the path takes the nose radius as 0; the real nose gouges 7700.00 nm \
             at x = 2.5000 mm, y = -0.0100 mm\n                  and leaves up to 100.00 nm at x = \
             2.5000 mm, y = -0.0100 mm\n"
        );
        let never = real_nose(Some(&nose(1e-6, 1e-4)));
        assert!(never.contains("the real nose gouges nowhere\n"), "{never}");
        let always = real_nose(Some(&nose(-1e-4, -1e-6)));
        assert!(!always.contains("leaves"), "{always}");
    }

    #[test]
    fn a_range_of_speeds_whose_ends_look_alike_is_one_speed() {
        let line = |least: f64, most: f64| {
            cutting_speed(Some(&CuttingSpeed {
                least: 1.0,
                mean: 2.0,
                most: 3.0,
                spindle_least: least / unit::rpm::PER,
                spindle_most: most / unit::rpm::PER,
            }))
        };
        for (least, most, wanted) in [
            (999.96, 1000.0, "at 1000 rpm\n"),
            (9.9996, 10.0, "at 10.00 rpm\n"),
            (10.0, 10.0, "at 10.00 rpm\n"),
            (999.9, 1000.0, "at 999.9 to 1000 rpm\n"),
        ] {
            let said = line(least, most);
            assert!(said.ends_with(wanted), "{said}");
        }
    }
}
