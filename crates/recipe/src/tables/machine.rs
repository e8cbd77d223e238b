//! `[machine]`: the limits that the path must hold, from a preset, from keys of their own, or both.

use turnpath_core::kind::Choice;
use turnpath_core::{Axis, Derivative, Machine, Param, ParamValue, Params};

use crate::diagnostic::Diagnostic;
use crate::presets::{NAMES, Preset};
use crate::read::Section;
use crate::suggest::{did_you_mean, listed, quoted};
use crate::table_info::TableInfo;

const PRESET: Param<Option<Choice>> =
    Param::choice("preset", NAMES, "a machine that turnpath knows").optional();

/// A key that replaces a limit of the preset.
macro_rules! limit {
    ($kind:ident $name:literal, $what:literal) => {
        Param::$kind($name, concat!($what, "; left out: that of the preset"))
            .positive()
            .optional()
            .info()
    };
}

pub(super) const MACHINE: TableInfo = TableInfo {
    name: "machine",
    summary: "the limits of the machine: the path is checked against these, and against no others",
    required: false,
    keys: &[
        PRESET.info(),
        limit!(velocity "x_velocity", "largest velocity"),
        limit!(acceleration "x_acceleration", "largest acceleration"),
        limit!(jerk "x_jerk", "largest jerk within cubics"),
        limit!(velocity "z_velocity", "largest velocity"),
        limit!(acceleration "z_acceleration", "largest acceleration"),
        limit!(jerk "z_jerk", "largest jerk within cubics"),
        limit!(rotation_speed "c_velocity", "largest speed of the spindle"),
        limit!(angular_acceleration "c_acceleration", "largest acceleration of the spindle"),
        limit!(angular_jerk "c_jerk", "largest jerk of the spindle"),
    ],
};

/// `[machine]`. Without the table there is neither a limit nor a preset.
#[derive(Default)]
pub(crate) struct MachineTable {
    pub(crate) machine: Machine,
    pub(crate) preset: Option<&'static Preset>,
}

/// Reads `[machine]`.
pub(crate) fn machine(section: &mut Section<'_>) -> MachineTable {
    let Some(table) = section.table else {
        return MachineTable::default();
    };
    let params = section.bind_but(&MACHINE, &[PRESET.name()]);
    let keys: Vec<&str> = MACHINE.names().collect();
    if !keys.iter().any(|key| table.has_like(key)) {
        let title = "[machine] sets no limit";
        let diagnostic = Diagnostic::new(section.span.clone(), title)
            .with_label("a preset or a limit belongs here")
            .with_help(
                "add a line such as: preset = \"generic-sts\" or: x_acceleration = \"1 m/s^2\"",
            )
            .with_help(format!("keys of [machine]: {}", listed(&keys)));
        section.report(diagnostic);
    }
    let preset = preset(section);
    let mut machine = preset.map_or_else(Machine::default, |preset| preset.machine);
    for axis in Axis::ALL {
        for derivative in Derivative::ALL {
            if let Some(own) = limit(&params, &derivative.key(axis)) {
                *machine.limit_mut(axis, derivative) = Some(own);
            }
        }
    }
    MachineTable { machine, preset }
}

fn limit(params: &Params, key: &str) -> Option<f64> {
    let mut values = params.iter();
    match values.find(|(name, _)| *name == key) {
        Some((_, ParamValue::Number(limit))) => Some(*limit),
        _ => None,
    }
}

fn preset(section: &mut Section<'_>) -> Option<&'static Preset> {
    let name = section.text(PRESET.name())?;
    let preset = Preset::named(&name.value);
    if preset.is_none() {
        let title = format!("no machine named {}", quoted(&name.value));
        let diagnostic = Diagnostic::new(name.span, title)
            .with_label("unknown preset")
            .with_helps(did_you_mean(&name.value, NAMES))
            .with_help(format!("presets: {}", listed(NAMES)))
            .with_help("or give the limits of your machine: x_acceleration = \"1 m/s^2\"");
        section.report(diagnostic);
    }
    preset
}

/// Reports a spindle speed above the limit of the machine.
pub(crate) fn check_spindle(section: &mut Section<'_>, speed: f64, machine: &Machine) {
    let Some(limit) = machine.c.velocity.filter(|limit| speed > *limit) else {
        return;
    };
    let span = section.nearest_span("speed");
    let most = Derivative::Velocity.quantity(Axis::C).format(limit);
    let title = "the spindle turns faster than the machine's C axis can";
    let diagnostic = Diagnostic::new(span, title)
        .with_label(format!("above {most}, the limit `c_velocity` of [machine]"))
        .with_help("choose a lower speed, or set c_velocity to what the machine can do");
    section.report(diagnostic);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_keys_are_the_preset_and_every_limit_of_every_axis_in_its_quantity() {
        let limits = Axis::ALL
            .into_iter()
            .flat_map(|axis| Derivative::ALL.map(|derivative| (axis, derivative)));
        let [preset, declared @ ..] = MACHINE.keys else {
            panic!("no keys");
        };
        assert_eq!(preset.name, PRESET.name());
        let declared: Vec<_> = declared
            .iter()
            .map(|key| (key.name.to_owned(), key.kind.quantity()))
            .collect();
        let expected: Vec<_> = limits
            .map(|(axis, derivative)| (derivative.key(axis), Some(derivative.quantity(axis))))
            .collect();
        assert_eq!(declared, expected);
    }
}
