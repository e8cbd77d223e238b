//! A run ends early where its observer cancels it or its sink fails, and nothing is taken after
//! that.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{MemorySink, Task, even, inward};
use turnpath_core::toolpath::SectionBlock;
use turnpath_pipeline::{DraftSink, Observer, Outcome, PipelineError, RunError, Sink, Stage};

/// Counts events until there are `last` of them.
struct Countdown {
    events: AtomicUsize,
    last: usize,
}

impl Countdown {
    fn to(last: usize) -> Self {
        let events = AtomicUsize::new(0);
        Self { events, last }
    }

    fn count(&self) {
        self.events.fetch_add(1, Ordering::SeqCst);
    }

    fn counted(&self) -> usize {
        self.events.load(Ordering::SeqCst)
    }

    fn is_over(&self) -> bool {
        self.counted() >= self.last
    }
}

/// A path of four blocks that is looked at for refinement, which it does not need.
fn task() -> Task {
    Task {
        feed: inward(200.0),
        refined: true,
        ..Task::default()
    }
}

/// A path of four blocks that needs two rounds of refinement at the least.
fn coarse_task() -> Task {
    Task {
        sampler: even(8.0),
        ..task()
    }
}

#[track_caller]
fn assert_cancelled<E>(result: Result<Outcome, RunError<E>>) {
    match result {
        Err(RunError::Pipeline(PipelineError::Cancelled)) => {}
        Err(RunError::Pipeline(other)) => panic!("{other}"),
        Err(RunError::Sink(_)) => panic!("the sink failed"),
        Ok(_) => panic!("a whole path"),
    }
}

/// Cancels when a stage begins so often.
struct CancelsAt {
    stage: Stage,
    reached: Countdown,
}

impl Observer for CancelsAt {
    fn begin(&self, stage: Stage, _: u64) {
        if stage == self.stage {
            self.reached.count();
        }
    }

    fn advance(&self, _: u64) {}

    fn is_cancelled(&self) -> bool {
        self.reached.is_over()
    }
}

/// A path that is refined is begun to be written twice, and what its sink took first is dropped.
#[test]
fn a_run_that_is_cancelled_as_a_stage_begins_takes_nothing() {
    let [first, second] = [Stage::Refine(1), Stage::Refine(2)];
    let stages = [
        (Stage::Law, 1),
        (Stage::Write, 1),
        (first, 1),
        (second, 1),
        (Stage::Write, 2),
    ];
    for (stage, times) in stages {
        let observer = CancelsAt {
            stage,
            reached: Countdown::to(times),
        };
        let mut sink = MemorySink::default();
        assert_cancelled(coarse_task().run_into(&mut sink, &observer));
        assert!(sink.deliveries.is_empty(), "{stage:?}");
    }
    let message = PipelineError::Cancelled.to_string();
    assert_eq!(message, "the work was cancelled");
}

/// Cancels once its sink has taken so many blocks.
struct CancelsAfter(Arc<Countdown>);

impl Observer for CancelsAfter {
    fn begin(&self, _: Stage, _: u64) {}

    fn advance(&self, _: u64) {}

    fn is_cancelled(&self) -> bool {
        self.0.is_over()
    }
}

/// Counts the blocks that it takes, and fails at the block `fails_at`.
struct CountingSink {
    taken: Arc<Countdown>,
    fails_at: usize,
}

/// The block at which the sink failed.
#[derive(Debug, PartialEq)]
struct Full(usize);

impl Sink for CountingSink {
    type Block = usize;
    type Error = Full;

    fn encode(&self, block: &SectionBlock<'_>) -> Result<usize, Full> {
        Ok(block.points.len())
    }

    fn take(&mut self, points: usize, block: usize) -> Result<(), Full> {
        assert_eq!(points, block);
        let before = self.taken.counted();
        if before == self.fails_at {
            return Err(Full(before));
        }
        self.taken.count();
        Ok(())
    }
}

impl DraftSink for CountingSink {
    fn drop_draft(&mut self) {
        panic!("this path is not refined");
    }
}

#[test]
fn nothing_is_taken_after_a_run_is_cancelled_in_the_middle() {
    for blocks in 1..4 {
        let taken = Arc::new(Countdown::to(blocks));
        let mut sink = CountingSink {
            taken: taken.clone(),
            fails_at: usize::MAX,
        };
        assert_cancelled(task().run_into(&mut sink, &CancelsAfter(taken.clone())));
        assert_eq!(taken.counted(), blocks);
    }
}

#[test]
fn the_error_of_a_sink_comes_back_as_it_is_and_ends_the_run() {
    let taken = Arc::new(Countdown::to(usize::MAX));
    let mut sink = CountingSink {
        taken: taken.clone(),
        fails_at: 2,
    };
    match task().run_into(&mut sink, &CancelsAfter(taken.clone())) {
        Err(RunError::Sink(error)) => assert_eq!(error, Full(2)),
        Err(RunError::Pipeline(other)) => panic!("{other}"),
        Ok(_) => panic!("a whole path"),
    }
    assert_eq!(taken.counted(), 2);
}
