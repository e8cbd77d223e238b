//! All columns of the comparison, in their order.

use super::{Best, Column, Form, column, real};

/// How many of [`ALL`] stand in the table where none are asked for.
pub const DEFAULT: usize = 11;

/// All columns; the first [`DEFAULT`] stand in the table unless others are asked for.
pub const ALL: &[Column] = &[
    column(
        "points",
        &["points"],
        "points",
        "/control_points",
        Form::Count,
    ),
    column(
        "added",
        &["added"],
        "points_added_by_refine",
        "/points_added_by_refine",
        Form::Count,
    ),
    real(
        "revolutions",
        &["revo-", "lu-", "tions"],
        "revolutions",
        "/revolutions",
    ),
    real("time", &["time", "s"], "cutting_time_s", "/cutting_time_s"),
    real(
        "error-max",
        &["error", "max", "nm"],
        "error_max_nm",
        "/interpolation_error_nm/max",
    )
    .held("/within/interpolation"),
    real(
        "error-rms",
        &["error", "RMS", "nm"],
        "error_rms_nm",
        "/interpolation_error_nm/rms",
    ),
    real(
        "residual",
        &["resi-", "dual", "nm"],
        "residual_nm",
        "/residual_nm/max",
    )
    .held("/within/residual"),
    real(
        "x-acceleration-law",
        &["law's", "X acc", "RMS", "mm/s²"],
        "x_acceleration_of_law_rms_mm_per_s2",
        "/axes_of_law/x/rms_acceleration",
    ),
    real(
        "z-acceleration",
        &["Z acc", "RMS", "mm/s²"],
        "z_acceleration_rms_mm_per_s2",
        "/axes/z/rms_acceleration",
    ),
    column(
        "program-size",
        &["pro-", "gram", "kB"],
        "program_bytes",
        "/program_bytes",
        Form::Bytes,
    ),
    column(
        "planning-time",
        &["plan-", "ning", "s"],
        "planning_time_s",
        "/planning_time_s",
        Form::Clock,
    )
    .best(Best::None),
    real(
        "x-acceleration",
        &["X acc", "RMS", "mm/s²"],
        "x_acceleration_rms_mm_per_s2",
        "/axes/x/rms_acceleration",
    ),
    real(
        "c-acceleration",
        &["C acc", "RMS", "deg/s²"],
        "c_acceleration_rms_deg_per_s2",
        "/axes/c/rms_acceleration",
    ),
    real(
        "x-velocity-max",
        &["X vel", "max", "mm/s"],
        "x_velocity_max_mm_per_s",
        "/axes/x/max_velocity",
    ),
    real(
        "z-velocity-max",
        &["Z vel", "max", "mm/s"],
        "z_velocity_max_mm_per_s",
        "/axes/z/max_velocity",
    ),
    real(
        "x-acceleration-max",
        &["X acc", "max", "mm/s²"],
        "x_acceleration_max_mm_per_s2",
        "/axes/x/max_acceleration",
    ),
    real(
        "z-acceleration-max",
        &["Z acc", "max", "mm/s²"],
        "z_acceleration_max_mm_per_s2",
        "/axes/z/max_acceleration",
    ),
    real(
        "x-jerk-max",
        &["X jerk", "max", "mm/s³"],
        "x_jerk_max_mm_per_s3",
        "/axes/x/max_jerk",
    ),
    real(
        "z-jerk-max",
        &["Z jerk", "max", "mm/s³"],
        "z_jerk_max_mm_per_s3",
        "/axes/z/max_jerk",
    ),
    real(
        "surface-pv",
        &["form", "PV", "nm"],
        "surface_error_pv_nm",
        "/surface_error_nm/pv",
    ),
    real(
        "surface-rms",
        &["form", "RMS", "nm"],
        "surface_error_rms_nm",
        "/surface_error_nm/rms",
    ),
    real(
        "surface-sq",
        &["form", "Sq", "nm"],
        "surface_error_sq_nm",
        "/surface_error_nm/sq",
    ),
    real(
        "surface-sa",
        &["form", "Sa", "nm"],
        "surface_error_sa_nm",
        "/surface_error_nm/sa",
    ),
    real(
        "slope-rms",
        &["slope", "RMS", "µrad"],
        "slope_error_rms_urad",
        "/slope_error_urad",
    ),
    real(
        "uncut",
        &["uncut", "%"],
        "uncut_percent",
        "/surface_error_nm/uncut_percent",
    ),
    real(
        "unreached",
        &["un-", "reached", "µm"],
        "unreached_height_um",
        "/unreached/height_um",
    ),
    real(
        "coverage-rim",
        &["uncut", "rim", "nm"],
        "uncut_at_rim_nm",
        "/coverage_nm/rim",
    ),
    real(
        "coverage-hole",
        &["uncut", "hole", "nm"],
        "uncut_at_hole_nm",
        "/coverage_nm/hole",
    ),
    real(
        "coverage-centre",
        &["uncut", "centre", "nm"],
        "uncut_at_centre_nm",
        "/coverage_nm/centre",
    ),
    real(
        "axis-crossing",
        &["X past", "axis", "µm"],
        "axis_crossing_x_um",
        "/axis_crossing_um/x",
    ),
    real(
        "point-error",
        &["points", "off", "nm"],
        "control_point_error_max_nm",
        "/control_point_error_nm/max",
    ),
    real(
        "x-velocity",
        &["X vel", "RMS", "mm/s"],
        "x_velocity_rms_mm_per_s",
        "/axes/x/rms_velocity",
    ),
    real(
        "x-jerk",
        &["X jerk", "RMS", "mm/s³"],
        "x_jerk_rms_mm_per_s3",
        "/axes/x/rms_jerk",
    ),
    real(
        "z-velocity",
        &["Z vel", "RMS", "mm/s"],
        "z_velocity_rms_mm_per_s",
        "/axes/z/rms_velocity",
    ),
    real(
        "z-jerk",
        &["Z jerk", "RMS", "mm/s³"],
        "z_jerk_rms_mm_per_s3",
        "/axes/z/rms_jerk",
    ),
    real(
        "c-velocity-max",
        &["C vel", "max", "deg/s"],
        "c_velocity_max_deg_per_s",
        "/axes/c/max_velocity",
    ),
    real(
        "c-acceleration-max",
        &["C acc", "max", "deg/s²"],
        "c_acceleration_max_deg_per_s2",
        "/axes/c/max_acceleration",
    ),
    real(
        "c-jerk-max",
        &["C jerk", "max", "deg/s³"],
        "c_jerk_max_deg_per_s3",
        "/axes/c/max_jerk",
    ),
    real(
        "c-jerk",
        &["C jerk", "RMS", "deg/s³"],
        "c_jerk_rms_deg_per_s3",
        "/axes/c/rms_jerk",
    ),
    real(
        "spindle-max",
        &["spin-", "dle", "rpm"],
        "highest_spindle_rpm",
        "/highest_spindle_rpm",
    )
    .best(Best::Largest),
    real("lead-in", &["lead-in", "s"], "lead_in_s", "/lead/in_s"),
    real(
        "lead-out",
        &["lead-", "out", "s"],
        "lead_out_s",
        "/lead/out_s",
    ),
    real(
        "servo-max",
        &["servo", "max", "nm"],
        "servo_error_max_nm",
        "/servo/predicted_error_nm/max",
    ),
    real(
        "servo-rms",
        &["servo", "RMS", "nm"],
        "servo_error_rms_nm",
        "/servo/predicted_error_nm/rms",
    ),
];
