//! Spindle strategies across the boundary.

use abi_stable::StableAbi;
use abi_stable::sabi_trait;
use abi_stable::std_types::{RBox, RSlice};
use turnpath_core::{Path, Result, SpindleAsk, SpindleLaw, SpindleStrategy};

use super::data::{AbiLaw, Answer, answer, result};
use super::panic_safe_box::PanicSafeBox;
use super::path::{AbiPath, lend_path};

/// What the host asks of a spindle strategy.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiSpindleAsk<'a> {
    speed: f64,
    factors: RSlice<'a, f64>,
}

impl<'a> From<&'a SpindleAsk<'_>> for AbiSpindleAsk<'a> {
    fn from(ask: &'a SpindleAsk<'_>) -> Self {
        Self {
            speed: ask.speed,
            factors: ask.factors.into(),
        }
    }
}

impl AbiSpindleAsk<'_> {
    fn receive(&self) -> SpindleAsk<'_> {
        SpindleAsk {
            speed: self.speed,
            factors: &self.factors,
        }
    }
}

#[sabi_trait]
pub trait AbiSpindle: Send + Sync {
    fn follows_factors(&self) -> Answer<bool>;
    /// Gives t(N).
    #[sabi(last_prefix_field)]
    fn plan(&self, path: AbiPath<'_>, ask: AbiSpindleAsk<'_>) -> Answer<AbiLaw>;
}

/// A spindle strategy that belongs to its plugin.
pub type OwnedSpindle = AbiSpindle_TO<'static, RBox<()>>;

/// The author's strategy, wrapped for the boundary.
pub struct OutgoingSpindle(pub PanicSafeBox<dyn SpindleStrategy>);

impl AbiSpindle for OutgoingSpindle {
    fn follows_factors(&self) -> Answer<bool> {
        answer(|| Ok(self.0.follows_factors()))
    }

    fn plan(&self, path: AbiPath<'_>, ask: AbiSpindleAsk<'_>) -> Answer<AbiLaw> {
        answer(|| {
            let law = path.receive(|path| self.0.plan(path, &ask.receive()))?;
            Ok(law.as_time().into())
        })
    }
}

/// A plugin's spindle strategy, wrapped as a strategy of the core. The wrapper reads once whether
/// the strategy follows factors, when it is built.
pub struct IncomingSpindle {
    spindle: OwnedSpindle,
    follows_factors: bool,
}

impl IncomingSpindle {
    /// Asks the strategy whether it follows factors, and wraps it.
    pub fn new(spindle: OwnedSpindle) -> Result<Self> {
        let follows_factors = result(spindle.follows_factors())?;
        Ok(Self {
            spindle,
            follows_factors,
        })
    }
}

impl SpindleStrategy for IncomingSpindle {
    fn plan(&self, path: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        let time = result(lend_path(path, |path| self.spindle.plan(path, ask.into())))?;
        Ok(SpindleLaw::from_time((&time).into()))
    }

    fn follows_factors(&self) -> bool {
        self.follows_factors
    }
}
