//! The five strategies of a job, with the names that messages need.

use std::sync::Arc;

use turnpath_core::{
    Compensator, FeedStrategy, Sampler, Slot, StrategyError, SurfaceModel, VelocitySolver,
};

use crate::PipelineError;

/// A strategy in its slot, with its own name and its plugin's.
pub struct Link<T: ?Sized> {
    /// The slot it fills.
    pub slot: Slot,
    /// The strategy's name.
    pub name: String,
    /// The plugin that it comes from, with its file where it has one.
    pub plugin: String,
    /// The strategy.
    pub strategy: Arc<T>,
}

impl<T: ?Sized> Link<T> {
    /// An error of this strategy, or of one that it asked; `place` says while doing what.
    pub fn failed(&self, place: impl Into<String>, error: StrategyError) -> PipelineError {
        let place = place.into();
        if let StrategyError::Delegate { slot, message } = error {
            let message = message.into_owned();
            return PipelineError::Asked {
                slot,
                place,
                message,
            };
        }
        PipelineError::Strategy {
            slot: self.slot,
            name: self.name.clone(),
            plugin: self.plugin.clone(),
            place,
            error,
        }
    }

    /// A complaint about an answer that this strategy gave.
    pub fn bad_answer(&self, what: impl Into<String>) -> PipelineError {
        let (slot, name, plugin) = (self.slot, self.name.clone(), self.plugin.clone());
        PipelineError::BadAnswer {
            slot,
            name,
            plugin,
            what: what.into(),
        }
    }
}

/// The five strategies of a job.
pub struct Chain {
    /// What is cut.
    pub surface: Link<dyn SurfaceModel>,
    /// How far the tool feeds.
    pub feed: Link<dyn FeedStrategy>,
    /// Where control points lie.
    pub sampler: Link<dyn Sampler>,
    /// Where the nose centre goes.
    pub compensator: Link<dyn Compensator>,
    /// Which velocities the cubics take.
    pub velocity: Link<dyn VelocitySolver>,
}
