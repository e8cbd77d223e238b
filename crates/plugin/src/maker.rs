//! Constructors of strategies that a program makes itself.

use std::fmt;
use std::sync::Arc;

use turnpath_core::{
    Compensator, FeedStrategy, Params, Result, Sampler, Slot, SpindleStrategy, SurfaceModel,
    VelocitySolver,
};

/// Makes the object of a strategy from its checked parameters.
pub type Make<T> = Arc<dyn Fn(&Params) -> Result<Box<T>> + Send + Sync>;

/// The constructor of a strategy that no crate registers, one variant for each slot. It may hold
/// values, which the function of a [`Build`](crate::Build) cannot.
#[derive(Clone)]
pub enum Maker {
    /// Makes a surface model.
    Surface(Make<dyn SurfaceModel>),
    /// Makes a feed strategy.
    Feed(Make<dyn FeedStrategy>),
    /// Makes a sampler.
    Sampler(Make<dyn Sampler>),
    /// Makes a compensator.
    Compensator(Make<dyn Compensator>),
    /// Makes a velocity solver.
    Velocity(Make<dyn VelocitySolver>),
    /// Makes a spindle strategy.
    Spindle(Make<dyn SpindleStrategy>),
}

impl Maker {
    /// The slot of what it makes.
    pub fn slot(&self) -> Slot {
        match self {
            Self::Surface(_) => Slot::Surface,
            Self::Feed(_) => Slot::Feed,
            Self::Sampler(_) => Slot::Sampler,
            Self::Compensator(_) => Slot::Compensator,
            Self::Velocity(_) => Slot::Velocity,
            Self::Spindle(_) => Slot::Spindle,
        }
    }
}

impl fmt::Debug for Maker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Maker").field(&self.slot()).finish()
    }
}
