//! Progress and cancellation of a long run.

use crate::{PipelineError, Result};

/// A stage of a run, or of a check. The stages of a run come in this order, but for a path that needs refinement: it
/// is begun to be written, then refined, and then written from its beginning. A check plans the law, plays a sample
/// back if the path is refined, makes the sample, and looks at the part. Then come the stages of each rough path, up to
/// its sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// A path made for a tolerance of form; the count of paths is from 1. The stages of the path
    /// follow.
    Form(u32),
    /// Planning the spiral law; how long that takes is not known.
    Law,
    /// Making some blocks of the path, from which its size is known before it is made.
    Sample,
    /// Looking at the part, as far as that was not done beside the stages before: the largest nose, heights and
    /// slopes.
    Part,
    /// Making, playing back, measuring and writing the path.
    Write,
    /// Playing the path back and refining it; the round counts from 1. Its blocks are those that this
    /// round makes again: in the first round those at which writing has not arrived.
    Refine(u32),
    /// Reading back and measuring what was written.
    ReadBack,
    /// Measuring a path in a file; how many blocks it has is not known.
    Measure,
    /// Making a path again and comparing a file with it.
    Compare,
    /// Making maps and profiles of the surface that is cut.
    Map,
}

/// Watches a run, and may cancel it. All counts are blocks, of revolutions or of points.
pub trait Observer: Sync {
    /// A stage of so many blocks begins.
    fn begin(&self, stage: Stage, blocks: u64);
    /// So many more blocks of the stage are done.
    fn advance(&self, blocks: u64);
    /// The thread that gives blocks to the sink begins (`true`) or ends to measure them. What comes before
    /// and between is making the path, where one thread does all; with more of them the next blocks are made
    /// meanwhile.
    fn measures(&self, _begins: bool) {}
    /// Whether the run should stop. The run asks between the steps of the law, before each batch of
    /// blocks, and before each block that it gives to the sink. A sample asks before each of its
    /// blocks. Where the answer is yes the work ends with [`PipelineError::Cancelled`].
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// An observer that does nothing and never cancels.
pub struct SilentObserver;

impl Observer for SilentObserver {
    fn begin(&self, _: Stage, _: u64) {}
    fn advance(&self, _: u64) {}
}

/// Ends the run where its observer has cancelled it.
pub fn stop_if_cancelled(observer: &dyn Observer) -> Result<()> {
    match observer.is_cancelled() {
        true => Err(PipelineError::Cancelled),
        false => Ok(()),
    }
}
