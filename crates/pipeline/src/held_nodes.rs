//! The nodes of a block, which are placed once, whichever thread wants them first.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use turnpath_core::NodeList;

use crate::Result;

/// The nodes of a block while they are held.
#[derive(Debug, Default)]
pub struct HeldNodes {
    /// Whether a thread has begun to place them.
    is_begun: AtomicBool,
    /// The nodes; `None` where the sampler gave up or gave a bad answer.
    nodes: OnceLock<Option<NodeList>>,
}

impl HeldNodes {
    /// The nodes; `place` places them if no thread did. While another thread places them, this one does
    /// other work of the pool, and waits once there is none. An error is not held: `place` gives it again to
    /// each thread that asks.
    ///
    /// `place` must not wait for the pool. A thread that did so could take up work that waits for the same
    /// nodes, and would wait for itself.
    pub fn get_or_place(&self, place: impl FnOnce() -> Result<NodeList>) -> Result<NodeList> {
        if !self.begin() {
            return self.wait().clone().map_or_else(place, Ok);
        }
        let _end = PlacingEnd(self);
        let nodes = place()?;
        let _ = self.nodes.set(Some(nodes.clone()));
        Ok(nodes)
    }

    /// Places the nodes if no thread has begun to. An error or a panic is left to the thread that wants the
    /// nodes.
    pub fn place_ahead(&self, place: impl FnOnce() -> Result<NodeList>) {
        if !self.begin() {
            return;
        }
        let _end = PlacingEnd(self);
        if let Ok(Ok(nodes)) = catch_unwind(AssertUnwindSafe(place)) {
            let _ = self.nodes.set(Some(nodes));
        }
    }

    /// Whether this is the first thread that wants the nodes.
    fn begin(&self) -> bool {
        !self.is_begun.swap(true, Ordering::Relaxed)
    }

    fn wait(&self) -> &Option<NodeList> {
        while self.nodes.get().is_none() {
            if rayon::yield_now() != Some(rayon::Yield::Executed) {
                // There is no other work, and the thread that places them waits for nobody.
                return self.nodes.wait();
            }
        }
        self.nodes.wait()
    }
}

/// The end of the placing of a block's nodes. An error or a panic leaves no nodes, so that no thread waits
/// for them for ever.
struct PlacingEnd<'a>(&'a HeldNodes);

impl Drop for PlacingEnd<'_> {
    fn drop(&mut self) {
        // Nodes that are there stay.
        let _ = self.0.nodes.set(None);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicUsize;

    use rayon::prelude::*;

    use super::*;
    use crate::PipelineError;

    fn some_nodes(block: usize) -> NodeList {
        let mut nodes = NodeList::default();
        nodes.push(block as f64);
        nodes
    }

    #[test]
    fn four_threads_place_each_block_once() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build();
        let placed = AtomicUsize::new(0);
        let place = |block: usize| {
            placed.fetch_add(1, Ordering::Relaxed);
            // Long enough that other threads ask meanwhile.
            std::thread::sleep(std::time::Duration::from_millis(1));
            Ok(some_nodes(block))
        };
        let held: Vec<HeldNodes> = (0..20).map(|_| HeldNodes::default()).collect();
        pool.unwrap().install(|| {
            (0..200usize).into_par_iter().for_each(|i| {
                let block = i % held.len();
                if i % 3 == 0 {
                    held[block].place_ahead(|| place(block));
                }
                let nodes = held[block].get_or_place(|| place(block)).unwrap();
                assert_eq!(nodes.revolutions(), [block as f64]);
            });
        });
        assert_eq!(placed.into_inner(), held.len());
    }

    #[test]
    fn threads_that_wait_for_an_error_get_it_each() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build();
        let held: Vec<HeldNodes> = (0..20).map(|_| HeldNodes::default()).collect();
        let fail = || {
            std::thread::sleep(std::time::Duration::from_millis(1));
            Err(PipelineError::Cancelled)
        };
        pool.unwrap().install(|| {
            (0..200usize).into_par_iter().for_each(|i| {
                let held = &held[i % 20];
                if i % 3 == 0 {
                    held.place_ahead(fail);
                }
                assert!(held.get_or_place(fail).is_err());
            });
        });
    }

    #[test]
    fn a_panic_leaves_no_thread_waiting() {
        let held = HeldNodes::default();
        let panics = || panic!("as a sampler may");
        held.place_ahead(panics);
        assert!(catch_unwind(AssertUnwindSafe(|| held.get_or_place(panics))).is_err());
        assert!(held.get_or_place(|| Ok(some_nodes(0))).is_ok());
    }

    #[test]
    fn an_error_is_given_to_each_thread_that_asks() {
        let held = HeldNodes::default();
        let fail = || Err(PipelineError::Cancelled);
        held.place_ahead(fail);
        for _ in 0..2 {
            assert!(held.get_or_place(fail).is_err());
        }
    }
}
