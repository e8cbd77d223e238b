//! Progress with the remaining time, on a terminal only.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use turnpath::{AblationObserver, Observer, Stage};
use turnpath_core::printable_line;
use turnpath_core::tally::TALLIES;

use crate::args::WorkArgs;
use crate::message::note;

/// How the bar looks.
const STYLE: &str = "{msg:<32} {bar:30} {percent:>3} %, {eta} left";
/// The same where nobody knows how long it takes: before the first block and after the last.
const OPEN_STYLE: &str = "{msg:<32} {spinner} {elapsed}";
/// How often the bar is drawn while nothing advances.
const TICK: Duration = Duration::from_millis(250);

/// A bar on standard error, or nothing where that is no terminal.
pub struct Bar {
    bar: Mutex<ProgressBar>,
    /// The number of the path, where several may be made for a form.
    path: AtomicU32,
    is_shown: bool,
    /// The stage in progress and when it began, where their times are told.
    timed: Option<Mutex<Option<(String, Instant)>>>,
}

impl Bar {
    /// No stage yet.
    pub fn new(work: &WorkArgs) -> Self {
        Self {
            bar: Mutex::new(ProgressBar::hidden()),
            path: AtomicU32::new(0),
            is_shown: !work.quiet && std::io::stderr().is_terminal(),
            timed: work.verbose.then(Mutex::default),
        }
    }

    /// Takes the bar off the screen.
    pub fn clear(&self) {
        self.with(|bar| bar.finish_and_clear());
        self.tell_time(None);
        if self.timed.is_some() {
            let counts = TALLIES.map(|tally| format!("{} {}", tally.total(), tally.what));
            note(&format!("counted: {}", counts.join(", ")));
        }
    }

    /// Says how long the stage before took, and begins the next one.
    fn tell_time(&self, next: Option<String>) {
        let Some(mut timed) = self.timed.as_ref().and_then(|timed| timed.lock().ok()) else {
            return;
        };
        let next = next.map(|stage| (stage, Instant::now()));
        if let Some((stage, begun)) = std::mem::replace(&mut *timed, next) {
            note(&format!("{stage}: {:.3} s", begun.elapsed().as_secs_f64()));
        }
    }

    fn with(&self, act: impl FnOnce(&mut ProgressBar)) {
        if let Ok(mut bar) = self.bar.lock() {
            act(&mut bar);
        }
    }

    /// "path 2: " where a path is made again for a form.
    fn of_path(&self) -> String {
        match self.path.load(Ordering::Relaxed) {
            0 | 1 => String::new(),
            path => format!("path {path}: "),
        }
    }
}

impl Observer for Bar {
    fn begin(&self, stage: Stage, blocks: u64) {
        if let Stage::Form(path) = stage {
            self.path.store(path, Ordering::Relaxed);
        }
        let message = self.of_path() + &message_of(stage);
        if self.is_shown {
            self.with(|bar| bar.finish_and_clear());
        }
        self.tell_time(Some(message.clone()));
        if !self.is_shown {
            return;
        }
        let length = Some(blocks).filter(|blocks| *blocks > 0);
        self.with(|bar| {
            *bar = ProgressBar::with_draw_target(length, ProgressDrawTarget::stderr());
            look(bar, OPEN_STYLE);
            bar.set_message(message);
            bar.enable_steady_tick(TICK);
        });
    }

    fn advance(&self, blocks: u64) {
        self.with(|bar| {
            let first = bar.position() == 0;
            bar.inc(blocks);
            let Some(length) = bar.length() else {
                return;
            };
            if bar.position() >= length {
                look(bar, OPEN_STYLE);
            } else if first {
                look(bar, STYLE);
            }
        });
    }
}

fn look(bar: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
}

fn message_of(stage: Stage) -> String {
    match stage {
        Stage::Form(_) => "preparing".to_owned(),
        Stage::Law => "planning the feed".to_owned(),
        Stage::Refine(round) => format!("playing back, round {round}"),
        Stage::Sample => "making a sample of the path".to_owned(),
        Stage::Part => "looking at the part".to_owned(),
        Stage::Write => "measuring and writing".to_owned(),
        Stage::ReadBack => "reading programs back".to_owned(),
        Stage::Measure => "measuring the file".to_owned(),
        Stage::Compare => "comparing with the recipe's path".to_owned(),
        Stage::Map => "mapping what is cut".to_owned(),
    }
}

/// How the bar of several runs looks.
const RUNS_STYLE: &str = "{pos} of {len} runs made {bar:30} {eta} left";

/// A bar over several runs on standard error, or nothing where that is no terminal.
pub struct RunsBar {
    bar: Mutex<ProgressBar>,
    is_shown: bool,
}

impl RunsBar {
    /// No run yet.
    pub fn new(work: &WorkArgs) -> Self {
        Self {
            bar: Mutex::new(ProgressBar::hidden()),
            is_shown: !work.quiet && std::io::stderr().is_terminal(),
        }
    }

    fn with(&self, act: impl FnOnce(&mut ProgressBar)) {
        if let Ok(mut bar) = self.bar.lock() {
            act(&mut bar);
        }
    }
}

impl AblationObserver for RunsBar {
    fn begin(&self, runs: usize) {
        if runs == 0 || !self.is_shown {
            return;
        }
        self.with(|bar| {
            let runs = u64::try_from(runs).ok();
            *bar = ProgressBar::with_draw_target(runs, ProgressDrawTarget::stderr());
            look(bar, RUNS_STYLE);
            bar.enable_steady_tick(TICK);
        });
    }

    fn advance(&self) {
        self.with(|bar| bar.inc(1));
    }

    fn damaged(&self, record: &Path, why: &str) {
        let name = record.display().to_string();
        note(&printable_line(&format!(
            "{name} is damaged ({why}) and counts as no record"
        )));
    }

    fn end(&self) {
        self.with(|bar| bar.finish_and_clear());
    }
}
