//! Progress, and the wish to stop.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use turnpath::{AblationObserver, Observer, Stage};

/// What a command tells of its progress, and whether it shall stop. The main thread looks at it; the
/// command's own threads write into it, so no thread of the command waits for the interpreter.
#[pyclass(frozen, from_py_object, module = "turnpath._turnpath")]
#[derive(Debug, Clone, Default)]
pub struct Control(Arc<State>);

#[derive(Debug, Default)]
struct State {
    cancelled: AtomicBool,
    stage: Mutex<String>,
    total: AtomicU64,
    done: AtomicU64,
}

impl Control {
    fn start(&self, stage: String, total: u64) {
        let mut current = self.0.stage.lock().unwrap_or_else(PoisonError::into_inner);
        *current = stage;
        self.0.done.store(0, Ordering::Relaxed);
        self.0.total.store(total, Ordering::Relaxed);
    }

    fn wants_end(&self) -> bool {
        self.0.cancelled.load(Ordering::Relaxed)
    }
}

#[pymethods]
impl Control {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Asks the command to stop.
    fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// The stage, how much of it is done, and how much it has in all; 0 in all where that is not
    /// known.
    fn progress(&self) -> (String, u64, u64) {
        let stage = self.0.stage.lock().unwrap_or_else(PoisonError::into_inner);
        let load = |number: &AtomicU64| number.load(Ordering::Relaxed);
        (stage.clone(), load(&self.0.done), load(&self.0.total))
    }
}

impl Observer for Control {
    fn begin(&self, stage: Stage, blocks: u64) {
        let name = match stage {
            Stage::Form(path) => format!("path {path} for the form"),
            Stage::Law => "law".to_owned(),
            Stage::Refine(round) => format!("refine {round}"),
            Stage::Sample => "sample".to_owned(),
            Stage::Part => "part".to_owned(),
            Stage::Write => "write".to_owned(),
            Stage::ReadBack => "read back".to_owned(),
            Stage::Measure => "measure".to_owned(),
            Stage::Compare => "compare".to_owned(),
            Stage::Map => "map".to_owned(),
        };
        self.start(name, blocks);
    }

    fn advance(&self, blocks: u64) {
        self.0.done.fetch_add(blocks, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.wants_end()
    }
}

impl AblationObserver for Control {
    fn begin(&self, runs: usize) {
        self.start("runs".to_owned(), runs as u64);
    }

    fn advance(&self) {
        self.0.done.fetch_add(1, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.wants_end()
    }
}
