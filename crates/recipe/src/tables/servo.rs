//! `[servo]`: how the machine's axes follow their commands, for all axes or for each axis.

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

/// Damping if the recipe does not give it. With it the amplitude at the bandwidth is 1/sqrt 2, to
/// 1 %, and a step overshoots by 5 %.
const DAMPING: f64 = 0.7;
/// A feed-forward is a fraction of the commanded velocity or acceleration.
const FEED_FORWARD: Bound = Bound {
    holds: |fraction| (0.0..=1.0).contains(&fraction),
    words: "between 0 and 1",
};
/// A longer delay is a mistake in the unit, and would take memory for nothing.
const DELAY: Bound = Bound {
    holds: |delay| (NOT_NEGATIVE.holds)(delay) && delay <= 1.0,
    words: "between 0 and 1 s",
};

/// Far beyond every real axis on both sides, and within the range that the model can compute.
const BANDWIDTH: Bound = Bound {
    holds: |omega| (TAU * 1e-3..=TAU * 1e6).contains(&omega),
    words: "between 0.001 and 1e6 Hz",
};
/// No real axis is damped more than this; with more damping the model gives no finite number.
const DAMPING_RANGE: Bound = Bound {
    holds: |damping| damping > 0.0 && damping <= 100.0,
    words: "above zero and at most 100",
};

/// The keys of one axis, or those of all axes.
#[derive(Clone, Copy, Default)]
struct AxisKeys {
    frequency: Option<f64>,
    damping: Option<f64>,
    delay: Option<f64>,
    velocity_forward: Option<f64>,
    acceleration_forward: Option<f64>,
}

impl AxisKeys {
    fn read(section: &mut Section<'_>, prefix: &str) -> Self {
        let key = |name: &str| format!("{prefix}{name}");
        let frequency = section.quantity(&key("bandwidth"), Quantity::RotationSpeed, BANDWIDTH);
        let delay = section.quantity(&key("delay"), Quantity::Time, DELAY);
        Self {
            frequency: frequency.map(|frequency| frequency.value),
            damping: number(section, &key("damping"), DAMPING_RANGE),
            delay: delay.map(|delay| delay.value),
            velocity_forward: number(section, &key("velocity_feed_forward"), FEED_FORWARD),
            acceleration_forward: number(section, &key("acceleration_feed_forward"), FEED_FORWARD),
        }
    }

    /// The axis. A key that the axis leaves out is taken from the keys of all axes, else from the
    /// defaults. `None` if there is no bandwidth.
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

/// Reads `[servo]`; `None` without the table. If the recipe gives no bandwidth, the preset's is
/// used.
pub(crate) fn servo(section: &mut Section<'_>, preset: Option<&Preset>) -> Option<Servo> {
    section.table?;
    section.report_unknown_keys(KEYS);
    let mut all = AxisKeys::read(section, "");
    let [x, z, c] = Axis::ALL.map(|axis| {
        let letter = axis.letter().to_ascii_lowercase();
        AxisKeys::read(section, &format!("{letter}_"))
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

/// Reports axes without a bandwidth, unless another message reports the cause.
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
        let diagnostic = Diagnostic::new(section.span.clone(), "an axis has no bandwidth")
            .with_label("give `bandwidth`, or a bandwidth for each axis")
            .with_help(
                "bandwidth = \"70 Hz\" applies to every axis without a bandwidth of its own",
            );
        section.report(diagnostic);
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
    section.report(Diagnostic::new(read.span, title).with_label(label));
    None
}
