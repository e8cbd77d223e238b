//! The figures of a run that stand in tables: where they are found, and how they are headed.

use serde_json::Value;

/// A figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Its name for `--columns`.
    pub name: &'static str,
    /// Its header in the table, the unit last.
    pub head: &'static [&'static str],
    /// Its header in `ablation.csv`.
    pub csv: &'static str,
    /// Where it stands in a run of `ablation.json`, a JSON pointer.
    pub pointer: &'static str,
    /// How it is written.
    pub form: Form,
    /// What tells whether its tolerance holds, if it has one.
    pub within: Option<&'static str>,
}

/// How a figure is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// In full.
    Count,
    /// With four digits.
    Real,
    /// In kB, four digits.
    Bytes,
    /// As a real; it differs from call to call, so none is the best.
    Clock,
}

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
    column(
        "revolutions",
        &["revo-", "lu-", "tions"],
        "revolutions",
        "/revolutions",
        Form::Real,
    ),
    column(
        "time",
        &["time", "s"],
        "cutting_time_s",
        "/cutting_time_s",
        Form::Real,
    ),
    column(
        "error-max",
        &["error", "max", "nm"],
        "error_max_nm",
        "/interpolation_error_nm/max",
        Form::Real,
    )
    .held("/within/interpolation"),
    column(
        "error-rms",
        &["error", "RMS", "nm"],
        "error_rms_nm",
        "/interpolation_error_nm/rms",
        Form::Real,
    ),
    column(
        "residual",
        &["resi-", "dual", "nm"],
        "residual_nm",
        "/residual_nm/max",
        Form::Real,
    )
    .held("/within/residual"),
    column(
        "x-acceleration-law",
        &["law's", "X acc", "RMS", "mm/s²"],
        "x_acceleration_of_law_rms_mm_per_s2",
        "/axes_of_law/x/rms_acceleration",
        Form::Real,
    ),
    column(
        "z-acceleration",
        &["Z acc", "RMS", "mm/s²"],
        "z_acceleration_rms_mm_per_s2",
        "/axes/z/rms_acceleration",
        Form::Real,
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
    ),
    column(
        "x-acceleration",
        &["X acc", "RMS", "mm/s²"],
        "x_acceleration_rms_mm_per_s2",
        "/axes/x/rms_acceleration",
        Form::Real,
    ),
    column(
        "c-acceleration",
        &["C acc", "RMS", "deg/s²"],
        "c_acceleration_rms_deg_per_s2",
        "/axes/c/rms_acceleration",
        Form::Real,
    ),
    column(
        "x-velocity-max",
        &["X vel", "max", "mm/s"],
        "x_velocity_max_mm_per_s",
        "/axes/x/max_velocity",
        Form::Real,
    ),
    column(
        "z-velocity-max",
        &["Z vel", "max", "mm/s"],
        "z_velocity_max_mm_per_s",
        "/axes/z/max_velocity",
        Form::Real,
    ),
    column(
        "x-acceleration-max",
        &["X acc", "max", "mm/s²"],
        "x_acceleration_max_mm_per_s2",
        "/axes/x/max_acceleration",
        Form::Real,
    ),
    column(
        "z-acceleration-max",
        &["Z acc", "max", "mm/s²"],
        "z_acceleration_max_mm_per_s2",
        "/axes/z/max_acceleration",
        Form::Real,
    ),
    column(
        "x-jerk-max",
        &["X jerk", "max", "mm/s³"],
        "x_jerk_max_mm_per_s3",
        "/axes/x/max_jerk",
        Form::Real,
    ),
    column(
        "z-jerk-max",
        &["Z jerk", "max", "mm/s³"],
        "z_jerk_max_mm_per_s3",
        "/axes/z/max_jerk",
        Form::Real,
    ),
    column(
        "surface-pv",
        &["form", "PV", "nm"],
        "surface_error_pv_nm",
        "/surface_error_nm/pv",
        Form::Real,
    ),
    column(
        "surface-rms",
        &["form", "RMS", "nm"],
        "surface_error_rms_nm",
        "/surface_error_nm/rms",
        Form::Real,
    ),
];

/// How many of [`ALL`] stand in the table where none are asked for.
const DEFAULT: usize = 11;

const fn column(
    name: &'static str,
    head: &'static [&'static str],
    csv: &'static str,
    pointer: &'static str,
    form: Form,
) -> Column {
    Column {
        name,
        head,
        csv,
        pointer,
        form,
        within: None,
    }
}

impl Column {
    const fn held(self, within: &'static str) -> Self {
        Self {
            within: Some(within),
            ..self
        }
    }

    /// Whether it speaks of the feed strategy's own law alone.
    pub fn is_of_law(&self) -> bool {
        self.pointer.starts_with("/axes_of_law/")
    }

    /// Whether its smallest figure is the best.
    pub fn has_best(&self) -> bool {
        self.form != Form::Clock
    }
}

/// The names that can be asked for.
pub fn names() -> Vec<&'static str> {
    ALL.iter().map(|column| column.name).collect()
}

/// The columns of these names in their order; the usual ones for none.
pub fn chosen(names: &[String]) -> Vec<&'static Column> {
    if names.is_empty() {
        return ALL.iter().take(DEFAULT).collect();
    }
    let of_name = |name: &String| ALL.iter().find(|column| column.name == name);
    names.iter().filter_map(of_name).collect()
}

/// A run's figure, if it has one.
pub fn figure<'a>(entry: &'a Value, column: &Column) -> Option<&'a Value> {
    entry
        .pointer(column.pointer)
        .filter(|value| !value.is_null())
}

/// The same as a number.
pub fn number(entry: &Value, column: &Column) -> Option<f64> {
    figure(entry, column)?.as_f64()
}
