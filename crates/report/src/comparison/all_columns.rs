//! All columns of the comparison, in their order.

use crate::ablation::MeasuredRun;
use crate::lead::LeadLayout;
use crate::path::PathReport;
use crate::unit;
use crate::verdict::Verdict;

use super::column::{Best, Column, Form};

/// How many of [`ALL`] stand in the table where none are asked for.
const DEFAULT: usize = 11;

/// All columns; the first [`DEFAULT`] stand in the table unless others are asked for.
const ALL: &[Column] = &[
    column("points", &["points"], "points", Form::Count, |run| {
        count(run.report.control_points)
    }),
    column(
        "added",
        &["added"],
        "points_added_by_refine",
        Form::Count,
        |run| count(run.report.points_added_by_refine),
    ),
    column(
        "revolutions",
        &["revo-", "lu-", "tions"],
        "revolutions",
        Form::Real,
        |run| Some(run.report.revolutions),
    ),
    column(
        "time",
        &["time", "s"],
        "cutting_time_s",
        Form::Real,
        |run| Some(run.report.cutting_time),
    ),
    column(
        "error-max",
        &["error", "max", "nm"],
        "error_max_nm",
        Form::Real,
        |run| nm(path(run).interpolation_error.max),
    )
    .held(|verdict| verdict.interpolation),
    column(
        "error-rms",
        &["error", "RMS", "nm"],
        "error_rms_nm",
        Form::Real,
        |run| nm(path(run).interpolation_error.rms),
    ),
    column(
        "residual",
        &["resi-", "dual", "nm"],
        "residual_nm",
        Form::Real,
        |run| nm(path(run).residual.max?),
    )
    .held(|verdict| verdict.residual),
    column(
        "x-acceleration-law",
        &["law's", "X acc", "RMS", "mm/s²"],
        "x_acceleration_of_law_rms_mm_per_s2",
        Form::Real,
        |run| Some(run.report.axes_of_law?.x.acceleration.rms),
    )
    .of_law(),
    column(
        "z-acceleration",
        &["Z acc", "RMS", "mm/s²"],
        "z_acceleration_rms_mm_per_s2",
        Form::Real,
        |run| Some(path(run).axes.z.acceleration.rms),
    ),
    column(
        "program-size",
        &["pro-", "gram", "kB"],
        "program_bytes",
        Form::Bytes,
        |run| count(run.program_bytes?),
    ),
    column(
        "planning-time",
        &["plan-", "ning", "s"],
        "planning_time_s",
        Form::Clock,
        |run| run.planning_time,
    )
    .best(Best::None),
    column(
        "measuring-time",
        &["mea-", "su-", "ring", "s"],
        "measuring_time_s",
        Form::Clock,
        |run| run.measuring_time,
    )
    .best(Best::None),
    column(
        "x-acceleration",
        &["X acc", "RMS", "mm/s²"],
        "x_acceleration_rms_mm_per_s2",
        Form::Real,
        |run| Some(path(run).axes.x.acceleration.rms),
    ),
    column(
        "c-acceleration",
        &["C acc", "RMS", "deg/s²"],
        "c_acceleration_rms_deg_per_s2",
        Form::Real,
        |run| deg(path(run).axes.c.acceleration.rms),
    ),
    column(
        "x-velocity-max",
        &["X vel", "max", "mm/s"],
        "x_velocity_max_mm_per_s",
        Form::Real,
        |run| Some(path(run).axes.x.velocity.max),
    ),
    column(
        "z-velocity-max",
        &["Z vel", "max", "mm/s"],
        "z_velocity_max_mm_per_s",
        Form::Real,
        |run| Some(path(run).axes.z.velocity.max),
    ),
    column(
        "x-acceleration-max",
        &["X acc", "max", "mm/s²"],
        "x_acceleration_max_mm_per_s2",
        Form::Real,
        |run| Some(path(run).axes.x.acceleration.max),
    ),
    column(
        "z-acceleration-max",
        &["Z acc", "max", "mm/s²"],
        "z_acceleration_max_mm_per_s2",
        Form::Real,
        |run| Some(path(run).axes.z.acceleration.max),
    ),
    column(
        "x-jerk-max",
        &["X jerk", "max", "mm/s³"],
        "x_jerk_max_mm_per_s3",
        Form::Real,
        |run| Some(path(run).axes.x.jerk.max),
    ),
    column(
        "z-jerk-max",
        &["Z jerk", "max", "mm/s³"],
        "z_jerk_max_mm_per_s3",
        Form::Real,
        |run| Some(path(run).axes.z.jerk.max),
    ),
    column(
        "surface-pv",
        &["sur-", "face", "PV", "nm"],
        "surface_error_pv_nm",
        Form::Real,
        |run| nm(path(run).surface_error?.pv),
    ),
    column(
        "surface-rms",
        &["sur-", "face", "RMS", "nm"],
        "surface_error_rms_nm",
        Form::Real,
        |run| nm(path(run).surface_error?.rms),
    ),
    column(
        "surface-sq",
        &["sur-", "face", "Sq", "nm"],
        "surface_error_sq_nm",
        Form::Real,
        |run| nm(path(run).surface_error?.sq),
    ),
    column(
        "surface-sa",
        &["sur-", "face", "Sa", "nm"],
        "surface_error_sa_nm",
        Form::Real,
        |run| nm(path(run).surface_error?.sa),
    ),
    column(
        "slope-rms",
        &["slope", "RMS", "µrad"],
        "slope_error_rms_urad",
        Form::Real,
        |run| Some(path(run).surface_error?.slope_rms * unit::urad::PER),
    ),
    column(
        "uncut",
        &["uncut", "%"],
        "uncut_percent",
        Form::Real,
        |run| Some(path(run).surface_error?.uncut * unit::percent::PER),
    ),
    column(
        "unreached",
        &["un-", "reached", "µm"],
        "unreached_height_um",
        Form::Real,
        |run| um(run.report.unreached?.height),
    ),
    column(
        "coverage-rim",
        &["uncut", "rim", "nm"],
        "uncut_at_rim_nm",
        Form::Real,
        |run| nm(path(run).coverage.rim?.height?),
    ),
    column(
        "coverage-hole",
        &["uncut", "hole", "nm"],
        "uncut_at_hole_nm",
        Form::Real,
        |run| nm(path(run).coverage.hole?.height?),
    ),
    column(
        "coverage-centre",
        &["uncut", "centre", "nm"],
        "uncut_at_centre_nm",
        Form::Real,
        |run| nm(path(run).coverage.centre?.height?),
    ),
    column(
        "axis-crossing",
        &["X past", "axis", "µm"],
        "axis_crossing_x_um",
        Form::Real,
        |run| um(path(run).axis_crossing.x),
    ),
    column(
        "point-error",
        &["points", "off", "nm"],
        "control_point_error_max_nm",
        Form::Real,
        |run| nm(path(run).control_point_error.max),
    ),
    column(
        "x-velocity",
        &["X vel", "RMS", "mm/s"],
        "x_velocity_rms_mm_per_s",
        Form::Real,
        |run| Some(path(run).axes.x.velocity.rms),
    ),
    column(
        "x-jerk",
        &["X jerk", "RMS", "mm/s³"],
        "x_jerk_rms_mm_per_s3",
        Form::Real,
        |run| Some(path(run).axes.x.jerk.rms),
    ),
    column(
        "z-velocity",
        &["Z vel", "RMS", "mm/s"],
        "z_velocity_rms_mm_per_s",
        Form::Real,
        |run| Some(path(run).axes.z.velocity.rms),
    ),
    column(
        "z-jerk",
        &["Z jerk", "RMS", "mm/s³"],
        "z_jerk_rms_mm_per_s3",
        Form::Real,
        |run| Some(path(run).axes.z.jerk.rms),
    ),
    column(
        "c-velocity-max",
        &["C vel", "max", "deg/s"],
        "c_velocity_max_deg_per_s",
        Form::Real,
        |run| deg(path(run).axes.c.velocity.max),
    ),
    column(
        "c-acceleration-max",
        &["C acc", "max", "deg/s²"],
        "c_acceleration_max_deg_per_s2",
        Form::Real,
        |run| deg(path(run).axes.c.acceleration.max),
    ),
    column(
        "c-jerk-max",
        &["C jerk", "max", "deg/s³"],
        "c_jerk_max_deg_per_s3",
        Form::Real,
        |run| deg(path(run).axes.c.jerk.max),
    ),
    column(
        "c-jerk",
        &["C jerk", "RMS", "deg/s³"],
        "c_jerk_rms_deg_per_s3",
        Form::Real,
        |run| deg(path(run).axes.c.jerk.rms),
    ),
    column(
        "spindle-max",
        &["spin-", "dle", "rpm"],
        "highest_spindle_rpm",
        Form::Real,
        |run| Some(path(run).highest_spindle?.speed * unit::rpm::PER),
    )
    .best(Best::Largest),
    column(
        "lead-in",
        &["lead-in", "s"],
        "lead_in_s",
        Form::Real,
        |run| Some(lead(run)?.in_time),
    ),
    column(
        "lead-out",
        &["lead-", "out", "s"],
        "lead_out_s",
        Form::Real,
        |run| Some(lead(run)?.out_time),
    ),
    column(
        "servo-max",
        &["servo", "max", "nm"],
        "servo_error_max_nm",
        Form::Real,
        |run| nm(path(run).servo?.predicted_error.max),
    )
    .held(|verdict| verdict.servo),
    column(
        "servo-rms",
        &["servo", "RMS", "nm"],
        "servo_error_rms_nm",
        Form::Real,
        |run| nm(path(run).servo?.predicted_error.rms),
    ),
    column(
        "form",
        &["form", "judged", "nm"],
        "form_error_nm",
        Form::Real,
        |run| nm(path(run).form.as_ref()?.pv?),
    )
    .held(|verdict| verdict.form),
    column(
        "form-residual",
        &["split", "resi-", "dual", "nm"],
        "form_residual_nm",
        Form::Real,
        |run| nm(path(run).form.as_ref()?.split.as_ref()?.residual),
    )
    .best(Best::None),
    column(
        "form-interpolation",
        &["split", "inter-", "pol.", "nm"],
        "form_interpolation_nm",
        Form::Real,
        |run| nm(path(run).form.as_ref()?.split.as_ref()?.interpolation),
    )
    .best(Best::None),
    column(
        "form-rounds",
        &["paths", "made"],
        "form_rounds",
        Form::Count,
        |run| count(path(run).form.as_ref()?.split.as_ref()?.rounds.into()),
    )
    .best(Best::None),
];

/// All columns.
pub fn all() -> Vec<&'static Column> {
    ALL.iter().collect()
}

/// The names of all columns.
pub fn names() -> Vec<&'static str> {
    ALL.iter().map(|column| column.name).collect()
}

/// The columns that stand in the table unless others are asked for.
pub fn usual() -> Vec<&'static Column> {
    ALL.iter().take(DEFAULT).collect()
}

/// The column of this name, if there is one.
pub fn by_name(name: &str) -> Option<&'static Column> {
    ALL.iter().find(|column| column.name == name)
}

const fn column(
    name: &'static str,
    heading: &'static [&'static str],
    csv: &'static str,
    form: Form,
    figure: fn(&MeasuredRun) -> Option<f64>,
) -> Column {
    Column {
        name,
        heading,
        csv,
        figure,
        form,
        holds: None,
        best: Best::Smallest,
        of_law: false,
    }
}

impl Column {
    const fn held(self, holds: fn(&Verdict) -> Option<bool>) -> Self {
        Self {
            holds: Some(holds),
            ..self
        }
    }

    const fn best(self, best: Best) -> Self {
        Self { best, ..self }
    }

    const fn of_law(self) -> Self {
        Self {
            of_law: true,
            ..self
        }
    }
}

fn path(run: &MeasuredRun) -> &PathReport {
    &run.report.path
}

fn lead(run: &MeasuredRun) -> Option<LeadLayout> {
    path(run).lead.as_ref()?.layout
}

fn count(number: u64) -> Option<f64> {
    Some(number as f64)
}

fn nm(length: f64) -> Option<f64> {
    Some(length * unit::nm::PER)
}

fn um(length: f64) -> Option<f64> {
    Some(length * unit::um::PER)
}

fn deg(angle: f64) -> Option<f64> {
    Some(angle * unit::deg::PER)
}
