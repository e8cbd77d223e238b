//! What the meters measured, as parts of a report.

use turnpath_pipeline::{FeedCap, Leads};
use turnpath_recipe::Recipe;
use turnpath_report as report;
use turnpath_report::{LimitFigure, PathPlace};
use turnpath_verify::machined::{FormScope, MachinedFigures, PartPoint, SurfaceExtremes};
use turnpath_verify::{
    AxesMotion, AxisMotion, CertainMotion, CoverageFigures, CuttingSpeed, FollowingError,
    HighestSpeed, LeadFigures, PathFigures, Peak, ResidualFigures, ServoFigures, UncutHeight,
    UnreachedFigures,
};

/// The tolerances that a recipe asks for.
pub fn tolerances(recipe: &Recipe) -> report::Tolerances {
    report::Tolerances {
        interpolation: recipe.tolerances.interpolation,
        residual: recipe.tolerances.residual,
        form: recipe.tolerances.form,
        servo: recipe.tolerances.servo,
    }
}

/// Where the feed comes near to the largest one of the nose.
pub fn feed_cap(cap: Option<&FeedCap>) -> report::FeedCap {
    report::FeedCap {
        binds: cap.is_some(),
        from: cap.map(|cap| cap.from),
        to: cap.map(|cap| cap.to),
        feed: cap.map(|cap| cap.feed),
    }
}

/// The height from which on material counts as unreached, mm: the residual, or the form where the
/// recipe gives no residual.
pub fn material_threshold(recipe: &Recipe) -> f64 {
    let asked = recipe.tolerances;
    match asked.form {
        Some(form) => asked.residual.unwrap_or(form),
        // Without a form the path is made for the residual that the recipe gives.
        None => recipe.tolerance.residual,
    }
}

/// Which part of the machined surface counts for its form; `None` without a tolerance of it.
pub fn form_scope(recipe: &Recipe) -> Option<FormScope> {
    let overrun = report::Overrun::from(recipe.overrun);
    recipe.tolerances.form.map(|_| FormScope {
        covers_part: overrun.covers_part(),
        covers_centre: overrun.covers_centre(),
    })
}

/// What counts as the error of form, mm: peak to valley of the cut, and where a lead plunges below
/// the first touch by `-lead_clearance`, down to there.
pub fn form_error(form: Option<&SurfaceExtremes>, lead_clearance: Option<f64>) -> Option<f64> {
    let form = form?;
    let plunge = lead_clearance.filter(|clearance| *clearance < 0.0);
    let lowest = plunge.map_or(form.lowest.error, |z| z.min(form.lowest.error));
    Some(form.highest.error - lowest)
}

/// What was measured on the cut of a path.
pub struct CutFigures<'a> {
    /// The path as played.
    pub path: &'a PathFigures,
    /// The surface that it leaves.
    pub machined: Option<&'a MachinedFigures>,
    /// The form of that surface, where the recipe has a tolerance of it.
    pub form: Option<&'a SurfaceExtremes>,
    /// What is certain of its motion, where its numbers were rounded.
    pub certain: Option<&'a CertainMotion>,
    /// What the servos make of it, where that is asked.
    pub servo: Option<&'a ServoFigures>,
}

/// The figures of a path with what its recipe holds them to.
pub fn path(
    recipe: &Recipe,
    cut: &CutFigures<'_>,
    lead: Option<report::LeadReport>,
) -> report::PathReport {
    let figures = cut.path;
    let (playback, points) = (&figures.playback, &figures.points);
    let overrun = report::Overrun::from(recipe.overrun);
    let clearance = lead.as_ref().map(|lead| lead.smallest_clearance);
    let highest = figures.axes.highest_speed(&recipe.machine, cut.certain);
    report::PathReport {
        tolerance: tolerances(recipe),
        overrun,
        interpolation_error: report::InterpolationError {
            max: playback.max(),
            rms: playback.rms(),
            at: place(playback.at_c, playback.at_x),
        },
        control_point_error: report::ControlPointError {
            max: points.max(),
            at: place(points.at_c, points.at_x),
        },
        control_point_offset: points.offset,
        residual: residual(&figures.residual, overrun),
        played_cusp: cut.machined.and_then(|machined| machined.cusp).map(|cusp| {
            report::PlayedCusp {
                max: cusp.height,
                at: place(cusp.at_theta, cusp.at_rho),
            }
        }),
        coverage: coverage(&figures.coverage),
        axis_crossing: report::AxisCrossing {
            x: figures.coverage.x_beyond_axis,
            contact: figures.coverage.contact_beyond_axis,
        },
        surface_error: cut.machined.map(surface_error),
        spokes: figures.spoke.map(|spoke| report::Spokes {
            amplitude: spoke.amplitude,
            per_turn: spoke.per_turn,
            from: spoke.from,
            to: spoke.to,
        }),
        arms: figures.arms.map(|arms| report::Arms {
            amplitude: arms.amplitude,
            per_turn: arms.per_turn,
            pitch: arms.pitch,
            from: arms.from,
            to: arms.to,
        }),
        real_nose: cut
            .machined
            .and_then(|machined| machined.real_nose)
            .map(|nose| report::RealNose {
                pv: nose.pv(),
                highest: surface_point(&nose.highest),
                lowest: surface_point(&nose.lowest),
            }),
        form: recipe.tolerances.form.map(|tolerance| report::FormReport {
            tolerance,
            pv: form_error(cut.form, clearance),
            split: None,
        }),
        axes: axes(&figures.axes),
        cutting_speed: Some(cutting_speed(&figures.cutting_speed)),
        machine: machine_source(recipe).map(|machine| report::MachineReport {
            machine,
            limits: limits(&figures.axes, cut.certain, recipe),
        }),
        highest_spindle: highest.map(|highest| report::HighestSpindle {
            speed: highest_spindle(recipe, &highest, &figures.axes),
            bound_by: (highest.bound_by.axis, highest.bound_by.derivative),
        }),
        lead,
        servo: cut.servo.map(servo_report),
    }
}

/// The highest speed of a recipe's spindle, rad/s. A constant spindle has one speed, the mean of
/// the path as played. Any other schedule scales as a whole, so its largest speed scales with it.
fn highest_spindle(recipe: &Recipe, highest: &HighestSpeed, axes: &AxesMotion) -> f64 {
    match recipe.has_constant_spindle() {
        true => highest.speed,
        false => highest.factor * axes.c.velocity.amount,
    }
}

fn cutting_speed(figures: &CuttingSpeed) -> report::CuttingSpeed {
    report::CuttingSpeed {
        least: figures.least,
        mean: figures.mean(),
        most: figures.most,
        spindle_least: figures.spindle_least,
        spindle_most: figures.spindle_most,
    }
}

fn place(c: f64, x: f64) -> PathPlace {
    PathPlace { c, x }
}

fn peak_place(peak: &Peak) -> PathPlace {
    place(peak.at_c, peak.at_x)
}

/// The cusps of a path, which runs so far beyond the part.
pub fn residual(figures: &ResidualFigures, overrun: report::Overrun) -> report::Residual {
    report::Residual {
        max: figures.highest(),
        at: place(figures.at_theta, figures.at_rho),
        left_out: match figures.cusps {
            0 => report::LeftOut::Everything,
            _ if overrun.covers_centre() => report::LeftOut::Nothing,
            _ => report::LeftOut::InnermostTurn,
        },
    }
}

/// What a path leaves uncut.
pub fn coverage(figures: &CoverageFigures) -> report::Coverage {
    let uncut = |uncut: Option<UncutHeight>| {
        uncut.map(|uncut| report::Uncut {
            height: Some(uncut.height).filter(|height| height.is_finite()),
            c: uncut.at_theta,
        })
    };
    report::Coverage {
        rim: uncut(figures.rim),
        hole: uncut(figures.hole),
        centre: uncut(figures.centre),
    }
}

fn surface_error(figures: &MachinedFigures) -> report::SurfaceError {
    report::SurfaceError {
        pv: figures.pv(),
        rms: figures.rms,
        sq: figures.sq,
        sa: figures.sa,
        mean: figures.mean,
        highest: surface_point(&figures.highest),
        lowest: surface_point(&figures.lowest),
        slope_rms: figures.rms_slope,
        uncut: figures.uncut,
    }
}

fn surface_point(point: &PartPoint) -> report::SurfacePoint {
    report::SurfacePoint {
        error: point.error,
        x: point.x,
        y: point.y,
    }
}

/// Motion of the axes.
pub fn axes(motion: &AxesMotion) -> report::Axes {
    report::Axes {
        x: axis(&motion.x),
        z: axis(&motion.z),
        c: axis(&motion.c),
    }
}

fn axis(motion: &AxisMotion) -> report::AxisMotion {
    let of = |peak: &Peak, rms: f64| report::Motion {
        max: peak.amount,
        rms,
        at: peak_place(peak),
    };
    report::AxisMotion {
        velocity: of(&motion.velocity, motion.rms_velocity()),
        acceleration: of(&motion.acceleration, motion.rms_acceleration()),
        jerk: of(&motion.jerk, motion.rms_jerk()),
    }
}

/// Where the limits of a recipe's machine come from; `None` without limits.
pub fn machine_source(recipe: &Recipe) -> Option<report::MachineSource> {
    let preset = recipe.preset;
    recipe.machine.has_limits().then(|| report::MachineSource {
        preset: preset.map(|preset| preset.name.to_owned()),
        source: preset.map(|preset| preset.source.to_owned()),
        own_limits: preset.map(|preset| preset.machine) != Some(recipe.machine),
    })
}

fn limits(
    motion: &AxesMotion,
    certain: Option<&CertainMotion>,
    recipe: &Recipe,
) -> Vec<LimitFigure> {
    let figures = motion.against(&recipe.machine, certain).into_iter();
    let figure = figures.map(|figure| LimitFigure {
        limit: figure.limit,
        measured: figure.peak.map(|peak| (peak.amount, peak_place(&peak))),
        certain: figure.certain.map(|peak| (peak.amount, peak_place(&peak))),
    });
    figure.collect()
}

/// The leads of a path; `leads` is how a run made them, which a file does not say. `certain` is what is certain of
/// their motion, where their numbers were rounded.
pub fn lead(
    figures: &LeadFigures,
    leads: Option<&Leads>,
    certain: Option<&CertainMotion>,
    recipe: &Recipe,
) -> report::LeadReport {
    report::LeadReport {
        layout: leads.map(|leads| report::LeadLayout {
            in_time: leads.in_time,
            out_time: leads.out_time,
            turns_in: leads.turns_in,
            turns_out: leads.turns_out,
            control_points: leads.points,
            rest_clearance: leads.rest_clearance(),
        }),
        smallest_clearance: figures.clearance,
        at: place(figures.at_c, figures.at_x),
        axis_crossing: figures.x_beyond_axis,
        acceleration_step: report::AccelerationStep {
            x: figures.jumps.x,
            z: figures.jumps.z,
            c: figures.jumps.c,
        },
        axes: axes(&figures.axes),
        limits: limits(&figures.axes, certain, recipe),
    }
}

fn servo_report(figures: &ServoFigures) -> report::ServoReport {
    let linear = |error: &FollowingError| report::LinearLag {
        max: error.max,
        rms: error.rms(),
    };
    report::ServoReport {
        following_error: report::FollowingErrors {
            x: linear(&figures.x),
            z: linear(&figures.z),
            c: report::RotaryLag {
                max: figures.c.max,
                rms: figures.c.rms(),
            },
        },
        predicted_error: report::PredictedError {
            max: figures.max(),
            rms: figures.rms(),
            at: place(figures.at_c, figures.at_x),
        },
    }
}

/// What the nose leaves standing.
pub fn unreached(figures: &UnreachedFigures) -> report::Unreached {
    report::Unreached {
        height: figures.height,
        volume: figures.volume,
        at: place(figures.at_theta, figures.at_rho),
        area_fraction: figures.area_fraction,
    }
}
