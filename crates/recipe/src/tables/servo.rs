//! `[servo]`: how the machine's axes answer their commands, for all of them or one by one.

use std::f64::consts::TAU;

use turnpath_core::{Axis, AxisServo, Quantity, Servo};

use crate::diagnostic::Diagnostic;
use crate::presets::Preset;
use crate::read::{Bound, NOT_NEGATIVE, Section};

pub(super) const KEYS: &[&str] = &[
    "bandwidth",
    "damping",
    "delay",
    "velocity_feed_forward",
    "acceleration_feed_forward",
    "x_bandwidth",
    "x_damping",
    "x_delay",
    "x_velocity_feed_forward",
    "x_acceleration_feed_forward",
    "z_bandwidth",
    "z_damping",
    "z_delay",
    "z_velocity_feed_forward",
    "z_acceleration_feed_forward",
    "c_bandwidth",
    "c_damping",
    "c_delay",
    "c_velocity_feed_forward",
    "c_acceleration_feed_forward",
];

/// Damping where the recipe does not say it: the amplitude is then 1/sqrt 2 at the bandwidth, to
/// 1 %, and a step overshoots by 5 %.
const DAMPING: f64 = 0.7;
/// Of each axis, what is left out.
const PART: Bound = Bound {
    holds: |part| (0.0..=1.0).contains(&part),
    words: "between 0 and 1",
};
/// A delay that is longer is a mistake of units, and would be memory for nothing.
const SHORT: Bound = Bound {
    holds: |delay| (NOT_NEGATIVE.holds)(delay) && delay <= 1.0,
    words: "between 0 and 1 s",
};

/// Far beyond every axis on both sides, and within what the model can do the sums for.
const BANDWIDTH: Bound = Bound {
    holds: |omega| (TAU * 1e-3..=TAU * 1e6).contains(&omega),
    words: "between 0.001 and 1e6 Hz",
};
/// An axis that is damped more than this is none; the model would be left without a number.
const DAMPED: Bound = Bound {
    holds: |damping| damping > 0.0 && damping <= 100.0,
    words: "above zero, and 100 at the most",
};

/// What one axis, or all of them, are told to be.
#[derive(Clone, Copy, Default)]
struct Asked {
    frequency: Option<f64>,
    damping: Option<f64>,
    delay: Option<f64>,
    velocity_forward: Option<f64>,
    acceleration_forward: Option<f64>,
}

impl Asked {
    fn read(section: &mut Section<'_>, prefix: &str) -> Self {
        let key = |name: &str| format!("{prefix}{name}");
        let frequency = section.quantity(&key("bandwidth"), Quantity::RotationSpeed, BANDWIDTH);
        let delay = section.quantity(&key("delay"), Quantity::Time, SHORT);
        Self {
            frequency: frequency.map(|frequency| frequency.value),
            damping: number(section, &key("damping"), DAMPED),
            delay: delay.map(|delay| delay.value),
            velocity_forward: number(section, &key("velocity_feed_forward"), PART),
            acceleration_forward: number(section, &key("acceleration_feed_forward"), PART),
        }
    }

    /// The axis, what it leaves open from all axes' and from defaults; none without a bandwidth.
    fn axis(&self, all: &Self) -> Option<AxisServo> {
        let forward = |own: Option<f64>, all: Option<f64>| own.or(all).unwrap_or(0.0);
        Some(AxisServo {
            frequency: self.frequency.or(all.frequency)?,
            damping: self.damping.or(all.damping).unwrap_or(DAMPING),
            delay: self.delay.or(all.delay).unwrap_or(0.0),
            velocity_forward: forward(self.velocity_forward, all.velocity_forward),
            acceleration_forward: forward(self.acceleration_forward, all.acceleration_forward),
        })
    }
}

/// Reads `[servo]`; none without the table. A preset's bandwidth stands in for one that is not
/// given.
pub(crate) fn servo(section: &mut Section<'_>, preset: Option<&Preset>) -> Option<Servo> {
    section.table?;
    section.only(KEYS);
    let mut all = Asked::read(section, "");
    let [x, z, c] = Axis::ALL.map(|axis| {
        let letter = axis.letter().to_ascii_lowercase();
        Asked::read(section, &format!("{letter}_"))
    });
    all.frequency = all
        .frequency
        .or(preset.and_then(|preset| preset.servo_bandwidth));
    if all.frequency.is_none() {
        check_bandwidths(section);
    }
    Some(Servo {
        c: c.axis(&all)?,
        x: x.axis(&all)?,
        z: z.axis(&all)?,
    })
}

/// Complains where axes are left without a bandwidth, unless another message says why.
fn check_bandwidths(section: &mut Section<'_>) {
    let given = |key: &str| section.node(key).is_some();
    let each = ["x_bandwidth", "z_bandwidth", "c_bandwidth"];
    let misspelt = section
        .table
        .is_some_and(|table| table.has_like("bandwidth"));
    if given("bandwidth") || each.into_iter().all(given) {
        return;
    }
    if each.into_iter().any(given) {
        let diagnostic = Diagnostic::new(section.place.clone(), "an axis has no bandwidth")
            .label("`bandwidth`, or that of each axis, must be given")
            .help("bandwidth = \"70 Hz\" is for all axes that have none of their own");
        section.complain(diagnostic);
    } else if !misspelt {
        section.missing("bandwidth", "\"70 Hz\"");
    }
}

fn number(section: &mut Section<'_>, key: &str, bound: Bound) -> Option<f64> {
    let read = section.number(key)?;
    if (bound.holds)(read.value) {
        return Some(read.value);
    }
    let title = format!("`{key}` must be {}", bound.words);
    let label = format!("not {}", bound.words);
    section.complain(Diagnostic::new(read.place, title).label(label));
    None
}
