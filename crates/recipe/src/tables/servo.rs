//! `[servo]`: how the machine's axes follow their commands, for all axes or for each axis.

use std::f64::consts::TAU;

use turnpath_core::kind::{Frequency, Number, Time};
use turnpath_core::{AxisServo, Param, Params, Servo};

use crate::diagnostic::Diagnostic;
use crate::presets::Preset;
use crate::read::Section;
use crate::table_info::TableInfo;

/// Damping if the recipe does not give it. With it the amplitude at the bandwidth is 1/sqrt 2, to
/// 1 %, and a step overshoots by 5 %.
const USUAL_DAMPING: f64 = 0.7;
/// No real axis is damped more than this; with more damping the model gives no finite number.
const MOST_DAMPING: f64 = 100.0;
/// The longest delay, s. A longer one is a mistake in the unit, and would take memory for nothing.
const LONGEST_DELAY: f64 = 1.0;
/// 0.001 Hz and 1e6 Hz in rad/s: far beyond every real axis on both sides, and within the range that
/// the model can compute.
const BANDWIDTHS: [f64; 2] = [TAU * 1e-3, TAU * 1e6];

const fn bandwidth(name: &'static str, help: &'static str) -> Param<Option<Frequency>> {
    let [least, largest] = BANDWIDTHS;
    let param = Param::frequency(name, help).min(least).max(largest);
    param.example("70 Hz").optional()
}

const fn damping(name: &'static str, help: &'static str) -> Param<Number> {
    Param::number(name, help).positive().max(MOST_DAMPING)
}

const fn delay(name: &'static str, help: &'static str) -> Param<Time> {
    let param = Param::time(name, help).min(0.0).max(LONGEST_DELAY);
    param.example("1 ms")
}

/// A part of the commanded velocity or acceleration.
const fn forward(name: &'static str, help: &'static str) -> Param<Number> {
    Param::number(name, help).min(0.0).max(1.0)
}

const BANDWIDTH: Param<Option<Frequency>> = bandwidth(
    "bandwidth",
    "natural frequency ω₀/2π; left out: that of the preset where its source has one, else required",
);
const DAMPING: Param<Number> = damping("damping", "damping ratio ζ").default(USUAL_DAMPING);
const DELAY: Param<Time> = delay("delay", "how much later the axis responds").default(0.0);
const VELOCITY_FORWARD: Param<Number> = forward(
    "velocity_feed_forward",
    "share k_v of the velocity that is fed forward",
)
.default(0.0);
const ACCELERATION_FORWARD: Param<Number> = forward(
    "acceleration_feed_forward",
    "share k_a of the acceleration that is fed forward",
)
.default(0.0);

/// The keys of one axis.
struct AxisKeys {
    bandwidth: Param<Option<Frequency>>,
    damping: Param<Option<Number>>,
    delay: Param<Option<Time>>,
    velocity_forward: Param<Option<Number>>,
    acceleration_forward: Param<Option<Number>>,
}

macro_rules! axis_keys {
    ($prefix:literal) => {
        AxisKeys {
            bandwidth: bandwidth(
                concat!($prefix, "bandwidth"),
                "of this axis alone; left out: `bandwidth`",
            ),
            damping: damping(
                concat!($prefix, "damping"),
                "of this axis alone; left out: `damping`",
            )
            .optional(),
            delay: delay(
                concat!($prefix, "delay"),
                "of this axis alone; left out: `delay`",
            )
            .optional(),
            velocity_forward: forward(
                concat!($prefix, "velocity_feed_forward"),
                "of this axis alone; left out: `velocity_feed_forward`",
            )
            .optional(),
            acceleration_forward: forward(
                concat!($prefix, "acceleration_feed_forward"),
                "of this axis alone; left out: `acceleration_feed_forward`",
            )
            .optional(),
        }
    };
}

const X: AxisKeys = axis_keys!("x_");
const Z: AxisKeys = axis_keys!("z_");
const C: AxisKeys = axis_keys!("c_");

pub(super) const SERVO: TableInfo = TableInfo {
    name: "servo",
    summary: "how the axes respond; a key without a prefix is for all axes that have no key of their own",
    required: false,
    keys: &[
        BANDWIDTH.info(),
        DAMPING.info(),
        DELAY.info(),
        VELOCITY_FORWARD.info(),
        ACCELERATION_FORWARD.info(),
        X.bandwidth.info(),
        X.damping.info(),
        X.delay.info(),
        X.velocity_forward.info(),
        X.acceleration_forward.info(),
        Z.bandwidth.info(),
        Z.damping.info(),
        Z.delay.info(),
        Z.velocity_forward.info(),
        Z.acceleration_forward.info(),
        C.bandwidth.info(),
        C.damping.info(),
        C.delay.info(),
        C.velocity_forward.info(),
        C.acceleration_forward.info(),
    ],
};

/// What the recipe has for all axes.
struct AllAxes {
    frequency: Option<f64>,
    damping: f64,
    delay: f64,
    velocity_forward: f64,
    acceleration_forward: f64,
}

impl AllAxes {
    fn of(params: &Params, preset: Option<&Preset>) -> Option<Self> {
        let from_preset = preset.and_then(|preset| preset.servo_bandwidth);
        Some(Self {
            frequency: params.find(BANDWIDTH)?.or(from_preset),
            damping: params.find(DAMPING)?,
            delay: params.find(DELAY)?,
            velocity_forward: params.find(VELOCITY_FORWARD)?,
            acceleration_forward: params.find(ACCELERATION_FORWARD)?,
        })
    }

    /// One axis. A key that the axis leaves out is taken from the keys of all axes. `None` if there
    /// is no bandwidth.
    fn axis(&self, params: &Params, keys: AxisKeys) -> Option<AxisServo> {
        Some(AxisServo {
            frequency: params.find(keys.bandwidth)?.or(self.frequency)?,
            damping: params.find(keys.damping)?.unwrap_or(self.damping),
            delay: params.find(keys.delay)?.unwrap_or(self.delay),
            velocity_forward: params
                .find(keys.velocity_forward)?
                .unwrap_or(self.velocity_forward),
            acceleration_forward: params
                .find(keys.acceleration_forward)?
                .unwrap_or(self.acceleration_forward),
        })
    }
}

/// Reads `[servo]`; `None` without the table. If the recipe gives no bandwidth, the preset's is
/// used.
pub(crate) fn servo(section: &mut Section<'_>, preset: Option<&Preset>) -> Option<Servo> {
    section.table?;
    let params = section.bind(&SERVO);
    let all = AllAxes::of(&params, preset)?;
    if all.frequency.is_none() {
        check_bandwidths(section);
    }
    Some(Servo {
        c: all.axis(&params, C)?,
        x: all.axis(&params, X)?,
        z: all.axis(&params, Z)?,
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
