//! Typical machines: their limits, each with its source.
//!
//! A preset has a limit only if a published figure gives it or it follows from one. An unknown
//! limit is left out and not checked; a recipe can add the limits of its own machine. There are no
//! presets for fast tool servos: the published strokes and bandwidths do not say which of them a
//! servo reaches at the same time.

use std::f64::consts::TAU;

use turnpath_core::{AxisLimits, Machine};

/// A machine that a recipe can name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preset {
    /// The machine's name in a recipe.
    pub name: &'static str,
    /// The limits that are known.
    pub machine: Machine,
    /// The bandwidth of the machine's servo as ω, rad/s. `[servo]` takes it if it gives no
    /// bandwidth of its own.
    pub servo_bandwidth: Option<f64>,
    /// Where the figures come from.
    pub source: &'static str,
}

/// No limit is known.
const UNKNOWN: AxisLimits = AxisLimits {
    velocity: None,
    acceleration: None,
    jerk: None,
};

/// Half the travel of Precitech's slow tool servo at 2 Hz, mm.
const STS_AMPLITUDE: f64 = 5.0;
/// 2 Hz in rad/s.
const STS_FREQUENCY: f64 = TAU * 2.0;
/// The bandwidth of Precitech's slow tool servo, 70 Hz in rad/s.
const STS_BANDWIDTH: f64 = TAU * 70.0;
/// The largest acceleration of the motion at 2 Hz, mm/s².
const STS_ACCELERATION: f64 = STS_AMPLITUDE * STS_FREQUENCY * STS_FREQUENCY;

/// The names of all presets.
pub const NAMES: &[&str] = &["generic-sts", "precitech-sts"];

/// All presets.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "generic-sts",
        machine: Machine {
            x: UNKNOWN,
            z: AxisLimits {
                velocity: Some(50.0),
                acceleration: Some(500.0),
                jerk: Some(200e3),
            },
            c: UNKNOWN,
        },
        servo_bandwidth: None,
        source: "not a real machine: round figures below those of precitech-sts, for a first look; \
            X and C have no limits",
    },
    Preset {
        name: "precitech-sts",
        machine: Machine {
            x: UNKNOWN,
            z: AxisLimits {
                velocity: Some(STS_AMPLITUDE * STS_FREQUENCY),
                acceleration: Some(STS_ACCELERATION),
                jerk: Some(STS_ACCELERATION * STS_BANDWIDTH),
            },
            c: UNKNOWN,
        },
        servo_bandwidth: Some(STS_BANDWIDTH),
        source: "slow tool servo of the lathes Precitech Nanoform 200, 350 and 700, from \
            Precitech's table of servo tools (AZoM, article 11751): 10 mm travel at 2 Hz, \
            bandwidth 70 Hz. Derived: velocity and acceleration of a sine of 5 mm at 2 Hz, which \
            the servo can follow, so it may reach more; jerk of that acceleration at 70 Hz. X and \
            C are not in the table",
    },
];

impl Preset {
    /// The preset of this name.
    pub(crate) fn named(name: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_has_a_name_of_its_own_a_limit_and_a_source() {
        let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
        assert_eq!(names, NAMES);
        for (i, preset) in PRESETS.iter().enumerate() {
            assert_eq!(Preset::named(preset.name), Some(preset));
            assert!(PRESETS[..i].iter().all(|other| other.name != preset.name));
            assert!(preset.machine.has_limits() && !preset.source.is_empty());
            assert!(preset.machine.limits().all(|limit| limit.value > 0.0));
        }
    }

    #[test]
    fn a_sine_of_5_mm_at_2_hz_has_these_largest_rates() {
        let z = Preset::named("precitech-sts").expect("a preset").machine.z;
        let near = |value: Option<f64>, expected: f64| {
            assert!(value.is_some_and(|value| (value / expected - 1.0).abs() < 1e-3));
        };
        near(z.velocity, 62.83);
        near(z.acceleration, 789.6);
        near(z.jerk, 347.3e3);
    }

    #[test]
    fn the_generic_machine_can_do_less_than_the_others() {
        let generic = Preset::named("generic-sts").expect("a preset").machine;
        for limit in generic.limits() {
            for preset in PRESETS {
                let other = preset.machine.limit(limit.axis, limit.derivative);
                assert!(other.is_none_or(|other| limit.value <= other));
            }
        }
    }
}
