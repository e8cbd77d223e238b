//! Calls of the program with limits to time and memory, and what is wrong with their ends.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fmt;
use std::fs::{self, File};
use std::process::{Command, ExitStatus};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::support::bench::{Bench, TURNPATH};

/// Longest time that a call may take: far more than its processor time, since the tests may share
/// the machine.
const LONGEST: Duration = Duration::from_secs(300);
/// Most processor time of a call, s. A lead that no limit lets end takes a third of it.
const MOST_TIME: &str = "30";
/// The signal that ends a call whose processor time is used up, SIGXCPU.
const TIME_IS_UP: i32 = 24;
/// Time between two looks whether a call has ended.
const PAUSE: Duration = Duration::from_millis(2);
/// Most address space of a call, KiB: four times what a run of a small part takes.
const MOST_MEMORY: &str = "4194304";
/// How a call begins that sets the limits of its memory and of its processor time. Elsewhere than on
/// Unix there are none.
const WITH_LIMITS: &str = "ulimit -v \"$1\"; ulimit -S -t \"$2\"; shift 2; exec \"$@\"";
/// The environment variable that names the cases to try: `17`, or `0..60`.
const ASKED_CASES: &str = "TURNPATH_CASES";
/// Words of a message that the program itself did not write.
const OF_A_PANIC: [&str; 3] = ["thread '", "panicked at", "RUST_BACKTRACE"];

/// How a call ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum End {
    /// By itself, with this status.
    Status(i32),
    /// By a signal.
    Signal,
    /// Not in the time that it had.
    Never,
}

/// A call's end and what it printed.
pub struct Call {
    pub end: End,
    pub stdout: String,
    pub stderr: String,
}

impl Call {
    /// Calls the program in a folder.
    pub fn new(bench: &Bench, args: &[String]) -> Self {
        let mut command = command(bench, args);
        let (out, err) = (bench.path(".stdout"), bench.path(".stderr"));
        command.stdout(File::create(&out).expect("a file for the output"));
        command.stderr(File::create(&err).expect("a file for the messages"));
        let mut child = command.spawn().expect("the program starts");
        let begin = Instant::now();
        let end = loop {
            if let Some(status) = child.try_wait().expect("the program is watched") {
                break end_of(status);
            }
            if begin.elapsed() > LONGEST {
                child.kill().expect("the program is ended");
                child.wait().expect("the program has ended");
                break End::Never;
            }
            std::thread::sleep(PAUSE);
        };
        let text = |path| {
            let bytes = fs::read(&path).expect("what was printed");
            fs::remove_file(path).expect("the file goes");
            String::from_utf8_lossy(&bytes).into_owned()
        };
        Self {
            end,
            stdout: text(out),
            stderr: text(err),
        }
    }

    /// The JSON that was printed.
    pub fn report(&self) -> Option<Value> {
        serde_json::from_str(&self.stdout).ok()
    }

    /// What is wrong with any end: a panic, a signal, no end, a status without its message, or JSON
    /// that is none.
    pub fn complaint(&self) -> Option<String> {
        let Self { stdout, stderr, .. } = self;
        if OF_A_PANIC.iter().any(|words| stderr.contains(words)) {
            return Some(format!("a panic: {self}"));
        }
        match self.end {
            End::Signal => Some(format!("a signal: {self}")),
            End::Never => Some(format!("no end: {self}")),
            End::Status(0 | 1) => {
                let answers = self.report().is_some() || stdout.is_empty();
                (!answers).then(|| format!("no JSON: {self}"))
            }
            End::Status(2..=4) => {
                // `check` says the shape of a part whose recipe it refuses.
                let refuses = |report: Value| report["refused"].is_string();
                let is_refusal = self.end == End::Status(2) && self.report().is_some_and(refuses);
                let told = stderr.contains("error: ") && (stdout.is_empty() || is_refusal);
                (!told).then(|| format!("no message: {self}"))
            }
            End::Status(_) => Some(format!("not a documented status: {self}")),
        }
    }
}

impl fmt::Display for Call {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let short = |text: &str| text.chars().take(600).collect::<String>();
        let (out, err) = (short(&self.stdout), short(&self.stderr));
        write!(f, "{:?}\n{out}\n{err}", self.end)
    }
}

fn end_of(status: ExitStatus) -> End {
    #[cfg(unix)]
    if std::os::unix::process::ExitStatusExt::signal(&status) == Some(TIME_IS_UP) {
        return End::Never;
    }
    status.code().map_or(End::Signal, End::Status)
}

#[cfg(unix)]
fn command(bench: &Bench, args: &[String]) -> Command {
    let before = ["-c", WITH_LIMITS, "sh", MOST_MEMORY, MOST_TIME, TURNPATH].map(str::to_owned);
    bench.command_of("/bin/sh".as_ref(), before.iter().chain(args))
}

#[cfg(not(unix))]
fn command(bench: &Bench, args: &[String]) -> Command {
    let _ = (WITH_LIMITS, MOST_MEMORY, MOST_TIME, TIME_IS_UP, TURNPATH);
    bench.command(args)
}

/// A line's words as arguments.
pub fn words(line: &str) -> Vec<String> {
    line.split_whitespace().map(str::to_owned).collect()
}

/// The cases that somebody asks for in place of those of a test.
fn asked_cases() -> Option<Vec<u64>> {
    let asked = std::env::var(ASKED_CASES).ok()?;
    let number = |word: &str| word.trim().parse().ok();
    let range = match asked.split_once("..") {
        Some((first, end)) => number(first).zip(number(end)),
        None => number(&asked).map(|one: u64| (one, one + 1)),
    };
    let (first, end) = range.expect("TURNPATH_CASES is a number or a range of numbers");
    Some((first..end).collect())
}

/// What a case gave: how its call ended, and what is wrong with that.
pub struct Outcome {
    pub end: End,
    pub complaint: Option<String>,
}

/// How often calls ended how.
pub struct Tally(Vec<(End, usize)>);

impl Tally {
    /// How many calls ended so.
    pub fn count(&self, end: End) -> usize {
        let of_end = self.0.iter().find(|(one, _)| *one == end);
        of_end.map_or(0, |(_, count)| *count)
    }

    /// How many calls there were.
    pub fn calls(&self) -> usize {
        self.0.iter().map(|(_, count)| count).sum()
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = self.0.iter().map(|(end, count)| format!("{end:?} {count}"));
        f.write_str(&parts.collect::<Vec<_>>().join(", "))
    }
}

/// Tries all cases, or those that are asked for, two at a time, and fails with all complaints.
#[track_caller]
pub fn try_all(
    what: &str,
    cases: impl IntoIterator<Item = u64>,
    outcome: impl Fn(&Bench, u64) -> Outcome + Sync,
) -> Tally {
    let cases = asked_cases().unwrap_or_else(|| cases.into_iter().collect());
    let (next, seen) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            let bench = Bench::empty();
            let outcome = outcome(&bench, *case);
            let complaint = outcome.complaint.or_else(|| {
                let left = !bench.scratch_is_empty();
                (left && outcome.end != End::Never).then(|| "temporary files are left".to_owned())
            });
            let complaint = complaint.map(|complaint| format!("{what} {case}: {complaint}"));
            let mut seen = seen.lock().expect("no test panics here");
            seen.push((*case, outcome.end, complaint));
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let mut seen = seen.into_inner().expect("no test panics here");
    seen.sort();
    let mut tally: Vec<(End, usize)> = Vec::new();
    for (_, end, _) in &seen {
        match tally.iter_mut().find(|(one, _)| one == end) {
            Some((_, count)) => *count += 1,
            None => tally.push((*end, 1)),
        }
    }
    tally.sort();
    let tally = Tally(tally);
    println!("{what}: {} calls: {tally}", seen.len());
    let wrong: Vec<String> = seen.into_iter().filter_map(|(.., wrong)| wrong).collect();
    assert!(
        wrong.is_empty(),
        "{} wrong:\n{}",
        wrong.len(),
        wrong.join("\n\n")
    );
    tally
}
