//! Places the nodes of blocks to come, while one thread goes on with the path.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::plan::Plan;

/// Calls `pass`, which makes the blocks of a path. Where the plan holds nodes, the other threads place those of
/// blocks to come meanwhile, the next ones first. What `pass` gives does not depend on how many they
/// place.
pub fn placing_ahead<T: Send>(plan: &Plan<'_>, pass: impl FnOnce() -> T + Send) -> T {
    if !plan.holds_nodes() || rayon::current_num_threads() == 1 {
        return pass();
    }
    let has_ended = AtomicBool::new(false);
    let has_ended = &has_ended;
    rayon::scope_fifo(|scope| {
        let _end = PassEnd(has_ended);
        for index in 0..plan.blocks() {
            scope.spawn_fifo(move |_| {
                if !has_ended.load(Ordering::Relaxed) {
                    plan.place_ahead(index);
                }
            });
        }
        pass()
    })
}

/// The end of the pass, also by a panic: no more blocks are begun.
struct PassEnd<'a>(&'a AtomicBool);

impl Drop for PassEnd<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}
