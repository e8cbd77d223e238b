//! The strategies of a task, with the names that messages need.

use std::sync::Arc;

use turnpath_core::{
    Compensator, FeedStrategy, Sampler, Slot, SpindleStrategy, StrategyError, SurfaceModel,
    VelocitySolver,
};

use crate::PipelineError;

/// A strategy in its slot, with its own name and its plugin's.
pub struct Link<T: ?Sized> {
    /// The slot it fills.
    pub slot: Slot,
    /// The strategy's name.
    pub name: String,
    /// The plugin that it belongs to, with its file where it has one.
    pub plugin: String,
    /// The strategy.
    pub strategy: Arc<T>,
}

impl<T: ?Sized> Link<T> {
    /// The pipeline's error for an error of this strategy, or of one that it called. `context`
    /// says what the strategy was doing, or for which part of the path.
    pub fn failed(&self, context: impl Into<Box<str>>, error: StrategyError) -> PipelineError {
        let context = context.into();
        if let StrategyError::Delegate {
            slot,
            entry,
            message,
        } = error
        {
            let message = message.into_owned();
            return PipelineError::InnerStrategy {
                slot,
                entry,
                context,
                message,
            };
        }
        PipelineError::Strategy {
            slot: self.slot,
            name: self.name.as_str().into(),
            plugin: self.plugin.as_str().into(),
            context,
            error,
        }
    }

    /// The error for an answer of this strategy that cannot be used.
    pub fn bad_answer(&self, what: impl Into<String>) -> PipelineError {
        PipelineError::BadAnswer {
            slot: self.slot,
            name: self.name.as_str().into(),
            plugin: self.plugin.as_str().into(),
            what: what.into(),
        }
    }
}

impl<T: ?Sized> Clone for Link<T> {
    fn clone(&self) -> Self {
        Self {
            slot: self.slot,
            name: self.name.clone(),
            plugin: self.plugin.clone(),
            strategy: Arc::clone(&self.strategy),
        }
    }
}

/// The two strategies that decide where a tool touches a part, and where its nose centre goes.
#[derive(Clone)]
pub struct LocusLinks {
    /// The surface to cut.
    pub surface: Link<dyn SurfaceModel>,
    /// The compensator, which gives the nose centre.
    pub compensator: Link<dyn Compensator>,
}

/// The strategies of a task, one in each slot.
#[derive(Clone)]
pub struct Chain {
    /// The surface to cut.
    pub surface: Link<dyn SurfaceModel>,
    /// The feed strategy, which gives the spiral law.
    pub feed: Link<dyn FeedStrategy>,
    /// The sampler, which places control points.
    pub sampler: Link<dyn Sampler>,
    /// The compensator, which gives the nose centre.
    pub compensator: Link<dyn Compensator>,
    /// The velocity solver, which gives the velocities at control points.
    pub velocity: Link<dyn VelocitySolver>,
    /// The spindle strategy, which gives the spindle law.
    pub spindle: Link<dyn SpindleStrategy>,
}

impl Chain {
    /// Those of its strategies that decide where a tool touches a part.
    pub fn locus_links(&self) -> LocusLinks {
        LocusLinks {
            surface: self.surface.clone(),
            compensator: self.compensator.clone(),
        }
    }
}
