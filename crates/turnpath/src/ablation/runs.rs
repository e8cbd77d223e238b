//! The runs that are still to be made: several at a time, one thread each.
//!
//! A run has one thread to itself: its processor time compares with that of any other run, on
//! however many threads, and memory is that of as many runs as there are threads.

use std::num::NonZero;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use rayon::ThreadPoolBuilder;
use turnpath_recipe::Variant;
use turnpath_report::MeasuredRun;

use crate::error::{Error, Fault};

use super::observer::AblationObserver;
use super::variant::{self, Sources};

/// What a variant gave, or why it gave nothing.
pub type Outcome = Result<MeasuredRun, Error>;

/// Makes the runs that have no record, and gives all in order. `keep` gets each when it is made or
/// has failed; a file that cannot be written ends the work.
pub fn complete(
    variants: &[Variant],
    sources: Sources<'_>,
    recorded: Vec<Option<MeasuredRun>>,
    threads: Option<NonZero<usize>>,
    observer: &dyn AblationObserver,
    keep: impl Fn(usize, &Outcome) -> Result<(), Error> + Sync,
) -> Result<Vec<Outcome>, Error> {
    let missing: Vec<(usize, &Variant)> = variants
        .iter()
        .enumerate()
        .filter(|(index, _)| !matches!(recorded.get(*index), Some(Some(_))))
        .collect();
    let threads = threads.or_else(|| thread::available_parallelism().ok());
    let threads = threads.map_or(1, NonZero::get);
    observer.begin(missing.len());
    let work = Work {
        missing: &missing,
        sources,
        next: AtomicUsize::new(0),
        done: Mutex::new(Vec::new()),
        observer,
    };
    let workers = threads.min(missing.len());
    let ended: Result<(), Error> = thread::scope(|scope| {
        let workers_started: Vec<_> = (0..workers)
            .map(|_| scope.spawn(|| work.go_on(&keep)))
            .collect();
        let ended = workers_started
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|_| Err(Error::RunLost)));
        ended.collect::<Vec<_>>().into_iter().collect()
    });
    observer.end();
    ended?;
    let mut outcomes: Vec<Option<Outcome>> = recorded.into_iter().map(|run| run.map(Ok)).collect();
    for (index, outcome) in work
        .done
        .into_inner()
        .unwrap_or_else(|lock| lock.into_inner())
    {
        if let Some(place) = outcomes.get_mut(index) {
            *place = Some(outcome);
        }
    }
    let missing = |outcome: Option<Outcome>| outcome.unwrap_or_else(|| Err(Error::RunLost));
    Ok(outcomes.into_iter().map(missing).collect())
}

struct Work<'a> {
    missing: &'a [(usize, &'a Variant)],
    sources: Sources<'a>,
    next: AtomicUsize,
    done: Mutex<Vec<(usize, Outcome)>>,
    observer: &'a dyn AblationObserver,
}

impl Work<'_> {
    /// Makes run after run until none is left.
    fn go_on(
        &self,
        keep: &(impl Fn(usize, &Outcome) -> Result<(), Error> + Sync),
    ) -> Result<(), Error> {
        let pool = ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.map_err(|error| Error::Threads(error.into()))?;
        while let Some((index, variant)) = self.take_next() {
            if self.observer.is_cancelled() {
                return Err(Error::Cancelled);
            }
            let outcome =
                pool.install(|| variant::run(&variant.recipe, self.sources, self.observer));
            let kept = match &outcome {
                Err(error) if ends_the_work(error) => Ok(()),
                outcome => keep(index, outcome),
            };
            if let Err(error) = kept.and_then(|()| self.put(index, outcome)) {
                // The other workers end with their runs.
                self.next.store(self.missing.len(), Ordering::Relaxed);
                return Err(error);
            }
        }
        Ok(())
    }

    fn take_next(&self) -> Option<(usize, &Variant)> {
        let next = self.next.fetch_add(1, Ordering::Relaxed);
        self.missing.get(next).copied()
    }

    fn put(&self, index: usize, outcome: Outcome) -> Result<(), Error> {
        let outcome = match outcome {
            Err(error) if ends_the_work(&error) => return Err(error),
            outcome => outcome,
        };
        let mut done = self.done.lock().unwrap_or_else(|lock| lock.into_inner());
        done.push((index, outcome));
        self.observer.advance();
        Ok(())
    }
}

/// Whether the other runs would fail in the same way, or are not wanted any more.
fn ends_the_work(error: &Error) -> bool {
    matches!(error.fault(), Fault::Files | Fault::Cancelled)
}
