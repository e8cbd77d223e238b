//! Spindle strategies.

use abi_stable::StableAbi;
use abi_stable::std_types::RSlice;
use turnpath_core::{Path, Result, SpindleAsk, SpindleLaw, SpindleStrategy};

use super::declaration::{declare, owned};
use super::loan::crossing;
use super::path::AbiLaw;
use super::reply::Value;

/// What the host asks of a spindle strategy. `numbers` may grow: the speed alone as yet.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiSpindleAsk<'a> {
    numbers: RSlice<'a, f64>,
    factors: RSlice<'a, f64>,
}

crossing! {
    ['a] SpindleAsk<'a> => AbiSpindleAsk<'w>, |ask| AbiSpindleAsk {
        numbers: std::slice::from_ref(&ask.speed).into(),
        factors: ask.factors.into(),
    };
    ['a] AbiSpindleAsk<'a> => SpindleAsk<'w>, |ask| SpindleAsk {
        speed: ask.numbers.first().copied().unwrap_or(f64::NAN),
        factors: &ask.factors,
    };
}

/// A spindle law crosses as t(N).
impl Value for SpindleLaw {
    type Wire = AbiLaw;

    fn send(self) -> AbiLaw {
        self.as_time().into()
    }

    fn receive(time: AbiLaw) -> Result<Self> {
        Ok(Self::from_time((&time).into()))
    }
}

declare! {
    SpindleStrategy => AbiSpindle, AbiSpindle_TO, IncomingSpindle<'b>;
    properties { follows_factors: bool = false }
    methods {
        fn plan(&self, path[&]: Path<'_>, ask[&]: SpindleAsk<'_>) -> Result<SpindleLaw>;
    }
    later {}
}
owned!(SpindleStrategy => AbiSpindle_TO, IncomingSpindle, OwnedSpindle);
