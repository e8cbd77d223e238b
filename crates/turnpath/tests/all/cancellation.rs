//! A run or a check that its observer cancels ends at once, and a run leaves nothing behind.

use std::sync::atomic::{AtomicU64, Ordering};

use turnpath::{Error, Fault, Observer, Outputs, Stage};

use crate::support::{REFINED_LATE, job};

/// Cancels when a stage has begun for the n-th time.
struct CancelAt {
    stage: fn(Stage) -> bool,
    times: u64,
    seen: AtomicU64,
}

impl CancelAt {
    fn new(stage: fn(Stage) -> bool, times: u64) -> Self {
        Self {
            stage,
            times,
            seen: AtomicU64::new(0),
        }
    }
}

impl Observer for CancelAt {
    fn begin(&self, stage: Stage, _: u64) {
        self.seen
            .fetch_add(u64::from((self.stage)(stage)), Ordering::Relaxed);
    }

    fn advance(&self, _: u64) {}

    fn is_cancelled(&self) -> bool {
        self.seen.load(Ordering::Relaxed) >= self.times
    }
}

#[test]
fn a_check_can_be_cancelled_in_every_stage() {
    let observers = [
        CancelAt::new(|stage| matches!(stage, Stage::Law), 1),
        CancelAt::new(|stage| matches!(stage, Stage::Refine(1)), 1),
        CancelAt::new(|stage| matches!(stage, Stage::Sample), 1),
    ];
    let job = job(&REFINED_LATE);
    for (index, observer) in observers.iter().enumerate() {
        let checked = job.check(observer);
        let is_cancelled = matches!(checked, Err(Error::Cancelled));
        assert!(is_cancelled, "stage {index}: {:?}", checked.err());
    }
}

#[test]
fn a_check_can_be_cancelled_in_the_sample_of_a_rough_path() {
    let observer = CancelAt::new(|stage| matches!(stage, Stage::Sample), 2);
    let job = job(&["passes.rough={ allowance = \"30 um\" }"]);
    let checked = job.check(&observer);
    let is_cancelled = matches!(checked, Err(Error::Cancelled));
    assert!(is_cancelled, "{:?}", checked.err());
}

/// Blocks that stages announced and that were done.
#[derive(Default)]
struct BlockCount {
    announced: AtomicU64,
    done: AtomicU64,
}

impl Observer for BlockCount {
    fn begin(&self, _: Stage, blocks: u64) {
        self.announced.fetch_add(blocks, Ordering::Relaxed);
    }

    fn advance(&self, blocks: u64) {
        self.done.fetch_add(blocks, Ordering::Relaxed);
    }
}

#[test]
fn a_check_does_as_many_blocks_as_its_stages_announce() {
    let observer = BlockCount::default();
    job(&REFINED_LATE).check(&observer).unwrap();
    let [announced, done] =
        [&observer.announced, &observer.done].map(|count| count.load(Ordering::Relaxed));
    assert_eq!(announced, done);
    // The sample has sixteen blocks, and each of them is played back at least once.
    assert!(announced >= 32, "{announced}");
}

/// The second path for a form can be cancelled too: nothing of the first one stays.
#[test]
fn a_run_can_be_cancelled_while_a_path_is_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let observer = CancelAt::new(|stage| stage == Stage::Form(2), 1);
    let outputs = Outputs::in_folder(folder.path().join("a/b"));
    let job = job(&["tolerance={ form = \"5 um\" }"]);
    let error = job.run(outputs, &observer).unwrap_err();
    assert!(matches!(error, Error::Cancelled), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A path that is refined is written twice, and dropped between.
#[test]
fn a_run_can_be_cancelled_in_every_stage_and_leaves_no_file_and_no_folder() {
    let observers = [
        CancelAt::new(|stage| matches!(stage, Stage::Law), 1),
        CancelAt::new(|stage| matches!(stage, Stage::Write), 1),
        CancelAt::new(|stage| matches!(stage, Stage::Refine(1)), 1),
        CancelAt::new(|stage| matches!(stage, Stage::Refine(2)), 1),
        CancelAt::new(|stage| matches!(stage, Stage::Write), 2),
        CancelAt::new(|stage| matches!(stage, Stage::ReadBack), 1),
    ];
    let job = job(&REFINED_LATE);
    for (index, observer) in observers.iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let outputs = Outputs::in_folder(folder.path().join("a/b"));
        let error = job.run(outputs, observer).unwrap_err();
        assert!(matches!(error, Error::Cancelled), "stage {index}: {error}");
        assert_eq!(error.fault(), Fault::Cancelled);
        let left = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(left, 0, "stage {index}");
    }
}
