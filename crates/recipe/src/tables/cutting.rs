//! `[tolerance]` and `[spindle]`: how accurate the part must be, and how fast the spindle turns.

use std::f64::consts::TAU;

use turnpath_core::kind::{Length, RotationSpeed, Text};
use turnpath_core::{FormBudget, Param, Tolerance};

use crate::diagnostic::Diagnostic;
use crate::read::Section;
use crate::table_info::TableInfo;

/// The smallest tolerance, 0.001 nm in mm: ten times the rounding error of a metre in double
/// precision.
const MEASURABLE: f64 = 1e-9;
/// The slowest spindle, 1e-6 rpm in rad/s: one turn in two years.
const SLOWEST: f64 = 1e-6 * TAU / 60.0;
/// The fastest spindle, 1e6 rpm in rad/s: more than any spindle reaches.
const FASTEST: f64 = 1e6 * TAU / 60.0;

const INTERPOLATION: Param<Option<Length>> = Param::length(
    "interpolation",
    "largest distance of the played tool centre from the true one, along z; required without `form`",
)
.min(MEASURABLE)
.example("100 nm")
.optional();
const RESIDUAL: Param<Option<Length>> = Param::length(
    "residual",
    "highest cusp between passes, along the profile's normal; required without `form`",
)
.min(MEASURABLE)
.example("100 nm")
.optional();
const FORM: Param<Option<Length>> = Param::length(
    "form",
    "peak to valley of the machined surface minus the wanted one, along z, everything included; \
     divided between `residual` and `interpolation` where they are left out",
)
.min(MEASURABLE)
.example("150 nm")
.optional();
const SERVO_ERROR: Param<Option<Length>> = Param::length(
    "servo",
    "largest error on the surface that the model of `[servo]` predicts, along z",
)
.min(MEASURABLE)
.example("50 nm")
.optional();

/// The spindle strategy of a recipe that names none.
pub(crate) const DEFAULT_SPINDLE: &str = "constant";

const SPINDLE_USE: Param<Text> = Param::text(
    "use",
    "the spindle strategy, a name that `turnpath list spindle` shows",
)
.default(DEFAULT_SPINDLE);
const SPEED: Param<RotationSpeed> = Param::rotation_speed(
    "speed",
    "largest speed of the spindle, at most `c_velocity` of `[machine]`; a constant spindle turns at this \
     speed over the whole cut",
)
.min(SLOWEST)
.max(FASTEST)
.example("500 rpm");

pub(super) const TOLERANCE: TableInfo = TableInfo {
    name: "tolerance",
    summary: "how accurate the part must be",
    required: true,
    keys: &[
        INTERPOLATION.info(),
        RESIDUAL.info(),
        FORM.info(),
        SERVO_ERROR.info(),
    ],
};

pub(super) const SPINDLE: TableInfo = TableInfo {
    name: "spindle",
    summary: "how fast the spindle turns",
    required: true,
    keys: &[SPINDLE_USE.info(), SPEED.info()],
};

/// The tolerances that a recipe gives, mm: a form, or both of interpolation and residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AskedTolerances {
    /// Largest |played − true| tool centre along z.
    pub interpolation: Option<f64>,
    /// Highest cusp along the profile's normal.
    pub residual: Option<f64>,
    /// Peak to valley of machined − wanted along z.
    pub form: Option<f64>,
    /// Largest error on the surface that the model of the servos predicts. The recipe has `[servo]`
    /// then.
    pub servo: Option<f64>,
}

impl AskedTolerances {
    /// How the form may be divided; `None` without a form.
    pub fn budget(&self) -> Option<FormBudget> {
        let budget = |form| FormBudget::new(form, self.interpolation, self.residual);
        self.form.map(budget)
    }

    /// What a path is made for at first; `None` if a tolerance is missing.
    fn of_path(&self) -> Option<Tolerance> {
        match self.budget() {
            Some(budget) => Some(budget.first()),
            None => Some(Tolerance {
                interpolation: self.interpolation?,
                residual: self.residual?,
            }),
        }
    }
}

/// `[tolerance]`.
pub(crate) struct ToleranceTable {
    /// What the path is made for at first.
    pub(crate) path: Tolerance,
    /// What the recipe gives.
    pub(crate) asked: AskedTolerances,
}

/// Reads `[tolerance]`. With `form` either of the other two may be left out.
pub(crate) fn tolerance(section: &mut Section<'_>) -> Option<ToleranceTable> {
    if !section.is_there(&TOLERANCE) {
        return None;
    }
    let params = section.bind(&TOLERANCE);
    let asked = AskedTolerances {
        interpolation: params.find(INTERPOLATION)?,
        residual: params.find(RESIDUAL)?,
        form: params.find(FORM)?,
        servo: params.find(SERVO_ERROR)?,
    };
    if section.node(FORM.name()).is_none() {
        section.require(&INTERPOLATION.info());
        section.require(&RESIDUAL.info());
    }
    let path = asked.of_path()?;
    Some(ToleranceTable { path, asked })
}

/// Reports a tolerance of the servos without a model of them.
pub(crate) fn check_servo_tolerance(section: &mut Section<'_>, has_servo: bool) {
    if has_servo || section.node(SERVO_ERROR.name()).is_none() {
        return;
    }
    let span = section.nearest_span(SERVO_ERROR.name());
    let diagnostic = Diagnostic::new(span, "`tolerance.servo` needs the table [servo]")
        .with_label("no model of the axes predicts this error")
        .with_help("add the line [servo] and below it, for example: bandwidth = \"70 Hz\"");
    section.report(diagnostic);
}

/// Reads what belongs to the host in `[spindle]`: the speed in rad/s.
pub(crate) fn spindle(section: &mut Section<'_>) -> Option<f64> {
    if !section.is_there(&SPINDLE) {
        return None;
    }
    // The other keys belong to the strategy, if the recipe names one.
    match section.node(SPINDLE_USE.name()) {
        None => section.report_unknown_keys(&SPINDLE),
        Some(_) => section.report_misspelling(SPEED.name(), &SPINDLE),
    }
    section.values(&[SPEED.info()]).find(SPEED)
}
