//! `[machine]`: the limits that the path must hold, from a preset, from keys of their own, or both.

use turnpath_core::{Axis, Derivative, Machine};

use crate::diagnostic::Diagnostic;
use crate::presets::Preset;
use crate::read::{POSITIVE, Section};
use crate::suggest::{did_you_mean, listed, quoted};

pub(super) const KEYS: &[&str] = &[
    "preset",
    "x_velocity",
    "x_acceleration",
    "x_jerk",
    "z_velocity",
    "z_acceleration",
    "z_jerk",
    "c_velocity",
    "c_acceleration",
    "c_jerk",
];

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
    section.report_unknown_keys(KEYS);
    if !KEYS.iter().any(|key| table.has_like(key)) {
        let title = "[machine] sets no limit";
        let diagnostic = Diagnostic::new(section.span.clone(), title)
            .with_label("a preset or a limit belongs here")
            .with_help(
                "add a line such as: preset = \"generic-sts\" or: x_acceleration = \"1 m/s^2\"",
            )
            .with_help(format!("keys of [machine]: {}", listed(KEYS)));
        section.report(diagnostic);
    }
    let preset = preset(section);
    let mut machine = preset.map_or_else(Machine::default, |preset| preset.machine);
    for axis in Axis::ALL {
        for derivative in Derivative::ALL {
            let kind = derivative.quantity(axis);
            if let Some(own) = section.quantity(&derivative.key(axis), kind, POSITIVE) {
                *machine.limit_mut(axis, derivative) = Some(own.value);
            }
        }
    }
    MachineTable { machine, preset }
}

fn preset(section: &mut Section<'_>) -> Option<&'static Preset> {
    let name = section.text("preset")?;
    let preset = Preset::named(&name.value);
    if preset.is_none() {
        let names = Preset::names();
        let title = format!("no machine named {}", quoted(&name.value));
        let diagnostic = Diagnostic::new(name.span, title)
            .with_label("unknown preset")
            .with_helps(did_you_mean(&name.value, &names))
            .with_help(format!("presets: {}", listed(&names)))
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
    let span = section.node("speed").map(|node| node.span.clone());
    let span = span.unwrap_or_else(|| section.span.clone());
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
    fn the_keys_are_the_preset_and_every_limit_of_every_axis() {
        let limits = Axis::ALL
            .into_iter()
            .flat_map(|axis| Derivative::ALL.map(|derivative| derivative.key(axis)));
        let keys: Vec<String> = std::iter::once("preset".to_owned()).chain(limits).collect();
        assert_eq!(KEYS, keys);
    }
}
