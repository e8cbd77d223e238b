//! Spindle strategies.

use turnpath_core::{Path, Result, SpindleAsk, SpindleLaw, SpindleStrategy};

use super::declaration::prelude::*;
use super::loan::composite;

composite! {
    SpindleAsk => AbiSpindleAsk { speed: f64, factors: &'a [f64] }
}

declare! {
    SpindleStrategy: Deref AsPtr, Send Sync => AbiSpindle, AbiSpindle_TO, IncomingSpindle<'b>;
    properties { follows_factors: bool = false }
    methods {
        fn plan(&self, path[&]: Path<'_>, ask[&]: SpindleAsk<'_>) -> Result<SpindleLaw>;
    }
    owned by OwnedSpindle
}
