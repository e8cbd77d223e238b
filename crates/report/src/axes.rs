//! Motion of the axes over a path.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use turnpath_core::{Axis, Derivative};

use crate::place::PathPlace;
use crate::unit;

/// One derivative of an axis' position: mm or rad, and powers of s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Largest amount.
    pub max: f64,
    /// Root mean square over time.
    pub rms: f64,
    /// Where the largest is.
    pub at: PathPlace,
}

/// One axis over a path, in mm or rad.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisMotion {
    /// First derivative.
    pub velocity: Motion,
    /// Second derivative.
    pub acceleration: Motion,
    /// Third derivative, within segments.
    pub jerk: Motion,
}

impl AxisMotion {
    /// One of the derivatives.
    pub fn of(&self, derivative: Derivative) -> &Motion {
        match derivative {
            Derivative::Velocity => &self.velocity,
            Derivative::Acceleration => &self.acceleration,
            Derivative::Jerk => &self.jerk,
        }
    }
}

/// All three axes. Files hold X and Z in mm, C in deg.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Axes {
    /// The radial slide.
    #[serde(with = "linear")]
    pub x: AxisMotion,
    /// The slide that sets the depth.
    #[serde(with = "linear")]
    pub z: AxisMotion,
    /// The spindle.
    #[serde(with = "rotary")]
    pub c: AxisMotion,
}

impl Axes {
    /// One of the axes.
    pub fn of(&self, axis: Axis) -> &AxisMotion {
        match axis {
            Axis::X => &self.x,
            Axis::Z => &self.z,
            Axis::C => &self.c,
        }
    }
}

/// Where an axis' largest amounts are.
#[derive(Serialize, Deserialize)]
struct LargestAt {
    max_velocity: PathPlace,
    max_acceleration: PathPlace,
    max_jerk: PathPlace,
}

macro_rules! file_axis {
    ($(#[$doc:meta])* $module:ident, $unit:literal, $($suffix:literal),*) => {
        $(#[$doc])*
        mod $module {
            use super::*;

            file_axis!(@struct $unit, $($suffix),*);

            pub fn serialize<S: Serializer>(axis: &AxisMotion, to: S) -> Result<S::Ok, S::Error> {
                let AxisMotion { velocity, acceleration, jerk } = *axis;
                let file = FileAxis {
                    max_velocity: velocity.max,
                    rms_velocity: velocity.rms,
                    max_acceleration: acceleration.max,
                    rms_acceleration: acceleration.rms,
                    max_jerk: jerk.max,
                    rms_jerk: jerk.rms,
                    at: LargestAt {
                        max_velocity: velocity.at,
                        max_acceleration: acceleration.at,
                        max_jerk: jerk.at,
                    },
                };
                file.serialize(to)
            }

            pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<AxisMotion, D::Error> {
                let file = FileAxis::deserialize(from)?;
                let motion = |max, rms, at| Motion { max, rms, at };
                let LargestAt { max_velocity, max_acceleration, max_jerk } = file.at;
                Ok(AxisMotion {
                    velocity: motion(file.max_velocity, file.rms_velocity, max_velocity),
                    acceleration: motion(
                        file.max_acceleration,
                        file.rms_acceleration,
                        max_acceleration,
                    ),
                    jerk: motion(file.max_jerk, file.rms_jerk, max_jerk),
                })
            }
        }
    };
    (@struct $unit:literal, $mv:literal, $rv:literal, $ma:literal, $ra:literal, $mj:literal, $rj:literal) => {
        #[derive(Serialize, Deserialize)]
        struct FileAxis {
            #[serde(rename = $mv, with = $unit)]
            max_velocity: f64,
            #[serde(rename = $rv, with = $unit)]
            rms_velocity: f64,
            #[serde(rename = $ma, with = $unit)]
            max_acceleration: f64,
            #[serde(rename = $ra, with = $unit)]
            rms_acceleration: f64,
            #[serde(rename = $mj, with = $unit)]
            max_jerk: f64,
            #[serde(rename = $rj, with = $unit)]
            rms_jerk: f64,
            at: LargestAt,
        }
    };
}

file_axis!(
    /// A slide in mm and s.
    linear,
    "unit::mm",
    "max_velocity_mm_per_s",
    "rms_velocity_mm_per_s",
    "max_acceleration_mm_per_s2",
    "rms_acceleration_mm_per_s2",
    "max_jerk_mm_per_s3",
    "rms_jerk_mm_per_s3"
);
file_axis!(
    /// The spindle in deg and s.
    rotary,
    "unit::deg",
    "max_velocity_deg_per_s",
    "rms_velocity_deg_per_s",
    "max_acceleration_deg_per_s2",
    "rms_acceleration_deg_per_s2",
    "max_jerk_deg_per_s3",
    "rms_jerk_deg_per_s3"
);
