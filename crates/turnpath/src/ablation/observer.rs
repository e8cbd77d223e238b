//! Progress of an ablation.

use std::path::Path;

/// Watches an ablation. Each method may be called from several threads.
pub trait AblationObserver: Sync {
    /// So many runs are to be made; those with a record are not counted.
    fn begin(&self, runs: usize) {
        let _ = runs;
    }

    /// One more run is done, whether it succeeded or not.
    fn advance(&self) {}

    /// A record is damaged, and counts as none.
    fn damaged(&self, record: &Path, why: &str) {
        let _ = (record, why);
    }

    /// All runs are done, or the work ended early.
    fn end(&self) {}

    /// Whether the work shall stop. Runs that are done keep their records.
    fn is_cancelled(&self) -> bool {
        false
    }
}

impl AblationObserver for turnpath_pipeline::SilentObserver {}
