//! Places the nodes of blocks to come on threads that would wait.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::plan::Plan;

/// Calls `pass`, which makes the blocks of a path. Where the plan holds nodes, threads that have nothing else
/// to do meanwhile place those of blocks to come, the next ones first. What `pass` gives does not depend
/// on how many they place.
pub fn sampling_ahead<T: Send>(plan: &Plan<'_>, pass: impl FnOnce() -> T + Send) -> T {
    if !plan.holds_nodes() || rayon::current_num_threads() == 1 {
        return pass();
    }
    let has_ended = AtomicBool::new(false);
    let has_ended = &has_ended;
    rayon::scope_fifo(|scope| {
        for index in 0..plan.blocks() {
            scope.spawn_fifo(move |_| {
                if !has_ended.load(Ordering::Relaxed) {
                    plan.sample_ahead(index);
                }
            });
        }
        let given = pass();
        has_ended.store(true, Ordering::Relaxed);
        given
    })
}
