//! The runs that are still to be made: several at a time, one thread each.
//!
//! A run has one thread to itself: its processor time compares with that of any other run, on
//! however many threads, and memory is that of as many runs as there are threads.

use std::num::NonZero;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use rayon::ThreadPoolBuilder;
use turnpath_host::Catalogue;
use turnpath_recipe::Variant;

use crate::failure::Failure;
use crate::progress::RunsBar;

use super::Outcome;
use super::one::{Made, make};

/// Makes the runs that are not there yet, and gives all in order. `keep` gets each when it is made;
/// a file that cannot be written ends the work.
pub fn make_rest(
    variants: &[Variant],
    catalogue: &Catalogue,
    before: Vec<Option<Made>>,
    threads: Option<usize>,
    keep: impl Fn(usize, &Made) -> Result<(), Failure> + Sync,
) -> Result<Vec<Outcome>, Failure> {
    let missing: Vec<(usize, &Variant)> = variants
        .iter()
        .enumerate()
        .filter(|(index, _)| !matches!(before.get(*index), Some(Some(_))))
        .collect();
    let threads =
        threads.unwrap_or_else(|| thread::available_parallelism().map_or(1, NonZero::get));
    let bar = RunsBar::new(missing.len());
    let work = Work {
        missing: &missing,
        catalogue,
        next: AtomicUsize::new(0),
        done: Mutex::new(Vec::new()),
        bar: &bar,
    };
    let workers = threads.min(missing.len());
    let ended: Result<(), Failure> = thread::scope(|scope| {
        let started: Vec<_> = (0..workers)
            .map(|_| scope.spawn(|| work.go_on(&keep)))
            .collect();
        let ended = started
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|_| Err(fell())));
        ended.collect::<Vec<_>>().into_iter().collect()
    });
    bar.clear();
    ended?;
    let mut outcomes: Vec<Option<Outcome>> = before.into_iter().map(|made| made.map(Ok)).collect();
    for (index, outcome) in work
        .done
        .into_inner()
        .unwrap_or_else(|lock| lock.into_inner())
    {
        if let Some(place) = outcomes.get_mut(index) {
            *place = Some(outcome);
        }
    }
    let missing = |outcome: Option<Outcome>| outcome.unwrap_or_else(|| Err(fell()));
    Ok(outcomes.into_iter().map(missing).collect())
}

/// A worker that is gone; its own message was printed by then.
fn fell() -> Failure {
    Failure::Plugin("error: a run ended unexpectedly".to_owned())
}

struct Work<'a> {
    missing: &'a [(usize, &'a Variant)],
    catalogue: &'a Catalogue,
    next: AtomicUsize,
    done: Mutex<Vec<(usize, Outcome)>>,
    bar: &'a RunsBar,
}

impl Work<'_> {
    /// Makes run after run until none is left.
    fn go_on(
        &self,
        keep: &(impl Fn(usize, &Made) -> Result<(), Failure> + Sync),
    ) -> Result<(), Failure> {
        let pool = ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.map_err(|error| Failure::call(format!("no thread to work on: {error}")))?;
        while let Some((index, variant)) = self.take_next() {
            let outcome = pool.install(|| make(&variant.recipe, self.catalogue));
            let kept = match &outcome {
                Ok(made) => keep(index, made),
                Err(_) => Ok(()),
            };
            if let Err(failure) = kept.and_then(|()| self.put(index, outcome)) {
                // The other workers end with their runs.
                self.next.store(self.missing.len(), Ordering::Relaxed);
                return Err(failure);
            }
        }
        Ok(())
    }

    fn take_next(&self) -> Option<(usize, &Variant)> {
        let next = self.next.fetch_add(1, Ordering::Relaxed);
        self.missing.get(next).copied()
    }

    fn put(&self, index: usize, outcome: Outcome) -> Result<(), Failure> {
        if let Err(failure @ Failure::File(_)) = outcome {
            return Err(failure);
        }
        let mut done = self.done.lock().unwrap_or_else(|lock| lock.into_inner());
        done.push((index, outcome));
        self.bar.advance();
        Ok(())
    }
}
