//! The slots of the pipeline, one for each kind of strategy.

use serde::{Deserialize, Serialize};

/// The six slots of the pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[repr(u8)]
pub enum Slot {
    /// The surface model.
    Surface,
    /// The feed strategy.
    Feed,
    /// The sampler.
    Sampler,
    /// The compensator.
    Compensator,
    /// The PVT velocity solver.
    Velocity,
    /// The spindle strategy.
    Spindle,
}

impl Slot {
    /// All slots, in the order in which listings show them.
    pub const ALL: [Slot; 6] = [
        Slot::Surface,
        Slot::Feed,
        Slot::Sampler,
        Slot::Compensator,
        Slot::Velocity,
        Slot::Spindle,
    ];

    /// The slot's table in a recipe, and its name on the command line.
    pub const fn key(self) -> &'static str {
        match self {
            Slot::Surface => "surface",
            Slot::Feed => "feed",
            Slot::Sampler => "sampler",
            Slot::Compensator => "compensator",
            Slot::Velocity => "velocity",
            Slot::Spindle => "spindle",
        }
    }

    /// The kind of strategy that fills the slot, in words.
    pub const fn noun(self) -> &'static str {
        match self {
            Slot::Surface => "surface model",
            Slot::Feed => "feed strategy",
            Slot::Sampler => "sampler",
            Slot::Compensator => "compensator",
            Slot::Velocity => "velocity solver",
            Slot::Spindle => "spindle strategy",
        }
    }
}

impl std::fmt::Display for Slot {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.key())
    }
}
