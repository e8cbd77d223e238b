//! Where the path goes.

use turnpath_core::toolpath::SectionBlock;

use crate::estimate::Estimate;

/// Takes the path while it is made. Blocks are encoded in parallel and taken in order.
pub trait Sink: Send + Sync {
    /// A block in the form that this sink keeps: bytes of files, counts, columns.
    type Block: Send;
    /// Why a block could not be encoded or taken.
    type Error: Send;

    /// Hears how long the path will be, before refinement, before its first block.
    ///
    /// # Errors
    /// When there is no room for it. The run then ends with [`RunError::Sink`].
    ///
    /// [`RunError::Sink`]: crate::RunError::Sink
    fn expect(&mut self, _: &Estimate) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Puts a block into the form that this sink keeps.
    ///
    /// # Errors
    /// When the form cannot carry the block. If the path may still be refined, the run drops the draft, refines the
    /// path and encodes it anew. Else it ends with [`RunError::Sink`].
    ///
    /// [`RunError::Sink`]: crate::RunError::Sink
    fn encode(&self, block: &SectionBlock<'_>) -> Result<Self::Block, Self::Error>;

    /// Takes the next block of the path, with its count of control points.
    ///
    /// # Errors
    /// When the block cannot be kept. The run then ends with [`RunError::Sink`].
    ///
    /// [`RunError::Sink`]: crate::RunError::Sink
    fn take(&mut self, points: usize, block: Self::Block) -> Result<(), Self::Error>;
}

/// A sink that keeps what it takes as a draft until the path is whole. A run may find in the middle of a
/// path that it is to be refined.
pub trait DraftSink: Sink {
    /// Forgets all that it took. The path then comes again from its first block.
    fn drop_draft(&mut self);
}
