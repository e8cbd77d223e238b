//! What a long run says of itself while it runs.

/// What is being done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The spiral law is planned.
    Law,
    /// The path is played back and refined; the round counts from 1.
    Refine(u32),
    /// The path is made, measured and written.
    Write,
    /// What was written is read back and measured.
    ReadBack,
    /// Maps and profiles of what is cut.
    Map,
}

/// Is told how far a run is. Counts are blocks, of revolutions or of points.
pub trait Progress: Sync {
    /// A stage begins.
    fn begin(&self, stage: Stage, blocks: u64);
    /// So many more blocks are done.
    fn advance(&self, blocks: u64);
}

/// Says nothing.
pub struct Quiet;

impl Progress for Quiet {
    fn begin(&self, _: Stage, _: u64) {}
    fn advance(&self, _: u64) {}
}
