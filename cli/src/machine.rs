//! The machine's limits: what a path makes of them, for the summary and for a person.

use serde::Serialize;
use turnpath_core::{Axis, DEG, Limit, Quantity};
use turnpath_recipe::Recipe;
use turnpath_verify::{AxesMotion, LimitFigure};

use crate::figures::{line, millimetres};
use crate::summary::{Place, holds};

/// Revolutions a minute in rad/s.
pub const RPM: f64 = std::f64::consts::TAU / 60.0;

/// The machine of a recipe.
#[derive(Debug, Serialize)]
pub struct MachineOf {
    /// The preset that the recipe names.
    preset: Option<&'static str>,
    /// Where the preset's figures come from.
    source: Option<&'static str>,
    /// Whether the recipe has limits of its own.
    own_limits: bool,
}

/// What a path makes of a machine's limits.
#[derive(Debug, Serialize)]
pub struct MachineFigures {
    #[serde(flatten)]
    machine: MachineOf,
    limits: Vec<LimitOf>,
    #[serde(skip)]
    figures: Vec<LimitFigure>,
}

/// One limit; mm or deg, and s.
#[derive(Debug, Serialize)]
struct LimitOf {
    limit: String,
    value: f64,
    measured: Option<f64>,
    holds: Option<bool>,
    at: Option<Place>,
}

/// A machine before there is a path.
#[derive(Debug, Serialize)]
pub struct MachineAsked {
    #[serde(flatten)]
    machine: MachineOf,
    limits: Vec<LimitAsked>,
}

#[derive(Debug, Serialize)]
struct LimitAsked {
    limit: String,
    value: f64,
}

/// The highest speed of the spindle at which all limits hold for the cut; leads are made anew for
/// another speed.
#[derive(Debug, Serialize, Default)]
pub struct HighestSpindle {
    highest_spindle_rpm: Option<f64>,
    highest_spindle_bound_by: Option<String>,
    #[serde(skip)]
    limit: Option<Limit>,
}

impl MachineOf {
    /// The recipe's machine, if it has any limit.
    fn new(recipe: &Recipe) -> Option<Self> {
        recipe.machine.has_limits().then(|| Self {
            preset: recipe.preset.map(|preset| preset.name),
            source: recipe.preset.map(|preset| preset.source),
            own_limits: recipe.preset.map(|preset| preset.machine) != Some(recipe.machine),
        })
    }

    fn name(&self) -> String {
        match self.preset {
            Some(name) if self.own_limits => format!("{name} and own limits"),
            Some(name) => name.to_owned(),
            None => "own limits".to_owned(),
        }
    }
}

impl MachineFigures {
    /// The motion against the recipe's machine; none without limits.
    pub fn new(axes: &AxesMotion, recipe: &Recipe) -> Option<Self> {
        let figures = axes.against(&recipe.machine);
        Some(Self {
            machine: MachineOf::new(recipe)?,
            limits: figures.iter().map(LimitOf::new).collect(),
            figures,
        })
    }

    /// Whether every limit holds of which there is a figure; none where there is none.
    pub fn hold(&self) -> Option<bool> {
        let mut verdicts = self.figures.iter().filter_map(verdict).peekable();
        verdicts.peek()?;
        Some(verdicts.all(|holds| holds))
    }

    /// The lines on limits that do not hold, each after the name of what was measured.
    pub fn exceeded(&self, of: &str) -> String {
        let lines = self
            .figures
            .iter()
            .filter_map(|figure| exceeded(figure, of));
        lines.collect()
    }

    /// The lines for a person.
    pub fn lines(&self) -> String {
        let mut text = self.exceeded("");
        let name = self.machine.name();
        let unmeasured = self.figures.iter().filter(|figure| figure.peak.is_none());
        let apart: Vec<String> = unmeasured.map(|figure| named(&figure.limit)).collect();
        text += &match (self.hold(), apart.as_slice()) {
            (Some(true), []) => line("machine", format!("{name}: all limits hold")),
            (Some(true), _) => line("machine", format!("{name}: the other limits hold")),
            _ => String::new(),
        };
        if !apart.is_empty() {
            let apart = apart.join(", ");
            text += &line("", format!("not measured on straight segments: {apart}"));
        }
        text
    }
}

impl MachineAsked {
    /// The recipe's machine, if it has any limit.
    pub fn new(recipe: &Recipe) -> Option<Self> {
        let limit = |limit: Limit| LimitAsked {
            limit: limit.key(),
            value: limit.value / unit(limit.axis),
        };
        Some(Self {
            machine: MachineOf::new(recipe)?,
            limits: recipe.machine.limits().map(limit).collect(),
        })
    }

    /// The lines for a person.
    pub fn lines(&self, recipe: &Recipe) -> String {
        let all = recipe.machine.limits();
        let limits: Vec<String> = all
            .map(|limit| format!("{} {}", named(&limit), shown(&limit, limit.value)))
            .collect();
        let mut text = line("machine", self.machine.name());
        text += &line("", limits.join(", "));
        if let Some(source) = self.machine.source {
            text += &line("", format!("source: {source}"));
        }
        if let Some(most) = recipe.machine.c.velocity {
            let (speed, most) = (recipe.spindle_speed / RPM, most / RPM);
            let (speed, most) = (significant(speed), significant(most));
            text += &line("spindle", format!("{speed} rpm of {most} rpm holds"));
        }
        text
    }
}

impl HighestSpindle {
    /// Of a path that was measured.
    pub fn new(axes: &AxesMotion, recipe: &Recipe) -> Self {
        axes.highest_speed(&recipe.machine)
            .map_or_else(Self::default, |highest| Self {
                highest_spindle_rpm: Some(highest.speed / RPM),
                highest_spindle_bound_by: Some(highest.bound_by.key()),
                limit: Some(highest.bound_by),
            })
    }

    /// The line for a person; empty without a bound.
    pub fn line(&self) -> String {
        match (self.highest_spindle_rpm, self.limit) {
            (Some(rpm), Some(limit)) => {
                let (rpm, limit) = (significant(rpm), named(&limit));
                line(
                    "spindle",
                    format!("the cut holds all limits up to {rpm} rpm; {limit} binds"),
                )
            }
            _ => String::new(),
        }
    }
}

impl LimitOf {
    fn new(figure: &LimitFigure) -> Self {
        let LimitFigure { limit, peak } = figure;
        let unit = unit(limit.axis);
        Self {
            limit: limit.key(),
            value: limit.value / unit,
            measured: peak.map(|peak| peak.amount / unit),
            holds: verdict(figure),
            at: peak.map(|peak| Place::of(&peak)),
        }
    }
}

/// Whether a limit holds; none without a figure.
fn verdict(figure: &LimitFigure) -> Option<bool> {
    figure
        .peak
        .map(|peak| holds(peak.amount, figure.limit.value))
}

/// The line on a limit that does not hold.
fn exceeded(figure: &LimitFigure, of: &str) -> Option<String> {
    let peak = figure.peak.filter(|_| verdict(figure) == Some(false))?;
    let limit = &figure.limit;
    let (found, most) = (shown(limit, peak.amount), shown(limit, limit.value));
    let place = format!(
        "at C = {:.2} deg, X = {}",
        peak.at_c / DEG,
        millimetres(peak.at_x, 4)
    );
    let text = format!("{found:>12} of {most:<11} EXCEEDED, {place}");
    // A label may be as long as its column, and an amount too.
    Some(line(&format!("{of}{} ", named(limit)), text))
}

/// The unit of an axis in files, in inner units.
fn unit(axis: Axis) -> f64 {
    match axis {
        Axis::X | Axis::Z => 1.0,
        Axis::C => DEG,
    }
}

/// "X acceleration".
fn named(limit: &Limit) -> String {
    format!("{} {}", limit.axis.letter(), limit.derivative.name())
}

/// An amount of what a limit is of, as a person reads it.
fn shown(limit: &Limit, amount: f64) -> String {
    let (scale, unit) = match limit.derivative.quantity(limit.axis) {
        Quantity::RotationSpeed => (RPM, "rpm"),
        Quantity::AngularAcceleration => (1.0, "rad/s²"),
        Quantity::AngularJerk => (1.0, "rad/s³"),
        Quantity::Acceleration if amount >= METRE => (METRE, "m/s²"),
        Quantity::Acceleration => (1.0, "mm/s²"),
        Quantity::Jerk if amount >= METRE => (METRE, "m/s³"),
        Quantity::Jerk => (1.0, "mm/s³"),
        _ => (1.0, "mm/s"),
    };
    format!("{} {unit}", significant(amount / scale))
}

/// A metre in mm.
const METRE: f64 = 1e3;

/// A number with four digits that tell something.
fn significant(value: f64) -> String {
    match value {
        v if !v.is_finite() => "no number".to_owned(),
        v if !(1e-3..1e6).contains(&v) => format!("{v:.3e}"),
        v if v >= 1e3 => format!("{v:.0}"),
        v if v >= 1e2 => format!("{v:.1}"),
        v if v >= 1e1 => format!("{v:.2}"),
        v if v >= 1.0 => format!("{v:.3}"),
        v => format!("{v:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use turnpath_core::Derivative;
    use turnpath_verify::Peak;

    fn figure(axis: Axis, derivative: Derivative, value: f64, amount: f64) -> LimitFigure {
        let peak = Peak {
            amount,
            at_c: 90.0 * DEG,
            at_x: 1.25,
        };
        LimitFigure {
            limit: Limit {
                axis,
                derivative,
                value,
            },
            peak: Some(peak),
        }
    }

    #[test]
    fn a_limit_that_does_not_hold_is_told_with_its_place() {
        let told = exceeded(
            &figure(Axis::X, Derivative::Acceleration, 1000.0, 1300.0),
            "",
        );
        assert_eq!(
            told.as_deref(),
            Some(
                "  X acceleration    1.300 m/s² of 1.000 m/s²  EXCEEDED, at C = 90.00 deg, \
                 X = 1.2500 mm\n"
            )
        );
        let told = exceeded(
            &figure(Axis::C, Derivative::Velocity, 10.0 * RPM, 20.0 * RPM),
            "",
        );
        assert!(told.is_some_and(|told| told.contains("20.00 rpm of 10.00 rpm")));
    }

    #[test]
    fn a_limit_holds_up_to_a_thousandth_above_it() {
        let of = |amount| verdict(&figure(Axis::Z, Derivative::Jerk, 100.0, amount));
        assert_eq!((of(100.09), of(100.11)), (Some(true), Some(false)));
        assert_eq!(of(f64::INFINITY), Some(false));
    }

    #[test]
    fn numbers_keep_four_digits() {
        let shown = [0.0, 0.01234, 1.23456, 123.456, 12345.6, 1.5e7].map(significant);
        let expected = ["0.000e0", "0.0123", "1.235", "123.5", "12346", "1.500e7"];
        assert_eq!(shown, expected);
    }
}
