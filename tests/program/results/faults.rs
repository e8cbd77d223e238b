//! Each operation on files fails once, and is once the last before the process ends. After each the
//! folder has the result before or the new one, and no draft.
//!
//! A run is this test program, called for the test `child_of_the_faults` alone: it watches its own
//! operations, and spoils the one that the environment names.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, ExitCode, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGKILL, SIGTERM};
use signal_hook::low_level::raise;
use turnpath::Catalogue;
use turnpath_files::{Operation, watch_operations};

use super::Bench;
use super::before::{After, Before, RUN};
use super::whole::{FolderState, entries, state_of};

/// The number of the operation that a child spoils, from 0 on, and how.
const SPOIL: &str = "TURNPATH_TEST_SPOIL";
/// The file that a child writes its operations to; it begins with the one that was spoilt.
const LOG: &str = "TURNPATH_TEST_LOG";
/// How long a child that has got a signal waits before it goes on.
const PAUSE: Duration = Duration::from_millis(20);

/// What happens instead of an operation, or before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Fault {
    Error(errno::Name),
    Signal(&'static str, i32),
}

/// The errors, by the numbers that Unix systems share.
mod errno {
    /// A name and its number.
    pub type Name = (&'static str, i32);
    pub const ENOSPC: Name = ("ENOSPC", 28);
    pub const EIO: Name = ("EIO", 5);
    pub const EINTR: Name = ("EINTR", 4);
}

const FAULTS: [Fault; 6] = [
    Fault::Error(errno::ENOSPC),
    Fault::Signal("SIGKILL", SIGKILL),
    Fault::Error(errno::EIO),
    Fault::Signal("SIGINT", SIGINT),
    Fault::Error(errno::EINTR),
    Fault::Signal("SIGTERM", SIGTERM),
];

impl Fault {
    fn name(self) -> &'static str {
        match self {
            Self::Error((name, _)) | Self::Signal(name, _) => name,
        }
    }

    fn of_name(name: &str) -> Option<Self> {
        FAULTS.into_iter().find(|fault| fault.name() == name)
    }

    /// Does it. A signal that is handled lets the operation go on, as it does elsewhere.
    fn strike(self) -> io::Result<()> {
        match self {
            Self::Error((_, number)) => Err(io::Error::from_raw_os_error(number)),
            Self::Signal(_, signal) => {
                raise(signal)?;
                thread::sleep(PAUSE);
                Ok(())
            }
        }
    }
}

/// The operations of a child so far.
static DONE: Mutex<Vec<Operation>> = Mutex::new(Vec::new());
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// The run of a child. In a call of all tests there is none.
#[test]
fn child_of_the_faults() {
    let Ok(spoil) = std::env::var(SPOIL) else {
        return;
    };
    let log = std::env::var_os(LOG).unwrap();
    let spoil = spoil.split_once(' ').map(|(at, fault)| {
        let at: usize = at.parse().unwrap();
        (at, Fault::of_name(fault).unwrap())
    });
    let log_of_watcher = log.clone();
    assert!(watch_operations(move |operation, _| {
        DONE.lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(operation);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        match spoil {
            Some((at, fault)) if at == number => {
                fs::write(&log_of_watcher, format!("{operation:?}"))?;
                fault.strike()
            }
            _ => Ok(()),
        }
    }));
    let words = ["turnpath"].into_iter().chain(RUN.split_whitespace());
    let status = turnpath_cli::main_with(words, Catalogue::linked());
    if spoil.is_none() {
        let done = DONE.lock().unwrap_or_else(PoisonError::into_inner);
        fs::write(log, format!("{done:?}")).unwrap();
    }
    let code = (0..=4).find(|code| ExitCode::from(*code) == status);
    std::process::exit(code.unwrap().into());
}

/// Runs a child; gives how it ended and what it logged.
fn run_child(bench: &Bench, spoil: &str) -> (ExitStatus, String) {
    let program = std::env::current_exe().unwrap();
    let words = [
        "--exact",
        "results::faults::child_of_the_faults",
        "--nocapture",
    ];
    let log = bench.path("log");
    let mut child: Command = bench.command_of(&program, words);
    child.env(SPOIL, spoil).env(LOG, &log);
    let status = child.stdout(Stdio::null()).stderr(Stdio::null()).status();
    let logged = fs::read_to_string(&log).unwrap_or_default();
    (status.unwrap(), logged)
}

/// The operations of a run that nothing disturbs, and its result.
fn clean(before: &Before) -> (Vec<String>, FolderState) {
    let bench = before.copy();
    let (status, logged) = run_child(&bench, "nothing");
    assert_eq!(status.code(), Some(0), "{status}");
    assert_eq!(entries(&bench.path("elsewhere")), ["map.xyz"]);
    let list = logged.trim_matches(['[', ']']);
    let operations = list.split(", ").map(str::to_owned).collect();
    (operations, state_of(&bench.path("out")))
}

/// Spoils one operation of a run, and checks the folder at once and after the next writer.
fn spoil_operation(
    before: &Before,
    new: &FolderState,
    at: usize,
    operation: &str,
    fault: Fault,
) -> After {
    let case = format!("{} before operation {at}, {operation}", fault.name());
    let bench = before.copy();
    let (status, logged) = run_child(&bench, &format!("{at} {}", fault.name()));
    assert_eq!(logged, operation, "{case}: it was not tried");
    let out = bench.path("out");
    let at_once = state_of(&out);
    match fault {
        Fault::Error(errno::EINTR) => {
            assert_eq!(status.code(), Some(0), "{case}");
            assert_eq!(at_once, *new, "{case}");
        }
        Fault::Error(_) => assert!(matches!(status.code(), Some(0 | 4)), "{case}: {status}"),
        // A signal may come when all is done.
        Fault::Signal(_, signal) => {
            let ended = status.signal() == Some(signal) || status.code() == Some(0);
            assert!(ended, "{case}: {status}");
        }
    }
    if status.code() == Some(0) {
        assert_eq!(at_once, *new, "{case}");
    }
    let after = before.settle(&out, new, &case);
    if fault != Fault::Signal("SIGKILL", SIGKILL) {
        let elsewhere = entries(&bench.path("elsewhere"));
        assert!(
            elsewhere.iter().all(|name| name == "map.xyz"),
            "{case}: {elsewhere:?}"
        );
    }
    after
}

/// How often each result was there, by operation and fault.
type Table = BTreeMap<(String, Fault), BTreeMap<After, usize>>;

/// Spoils each operation with those faults of which `takes` says so.
fn spoil_all(takes: impl Fn(usize, usize) -> bool) -> (Table, usize) {
    let before = Before::make();
    let (operations, new) = clean(&before);
    assert!(
        matches!(new, FolderState::Result(_)) && new != before.result,
        "{new:?}"
    );
    let (mut table, mut tried) = (Table::new(), 0);
    for (at, operation) in operations.iter().enumerate() {
        let faults = FAULTS.into_iter().enumerate();
        for (_, fault) in faults.filter(|(index, _)| takes(at, *index)) {
            let after = spoil_operation(&before, &new, at, operation, fault);
            let cell = table.entry((operation.clone(), fault)).or_default();
            *cell.entry(after).or_default() += 1;
            tried += 1;
        }
    }
    println!(
        "{} operations, {tried} spoilt\n{}",
        operations.len(),
        page(&table)
    );
    (table, operations.len())
}

/// The table of docs/reliability.md.
fn page(table: &Table) -> String {
    let mut text = "| operation | fault | points | old result | new result | mixed |\n".to_owned();
    text += "|---|---|---|---|---|---|\n";
    for ((operation, fault), counts) in table {
        let count = |after| counts.get(&after).copied().unwrap_or_default();
        let (old, new) = (count(After::Old), count(After::New));
        let fault = fault.name();
        let _ = writeln!(
            text,
            "| {operation} | {fault} | {} | {old} | {new} | 0 |",
            old + new
        );
    }
    text
}

/// Each operation with one of the six faults, another for the next operation.
#[test]
fn an_operation_that_fails_or_is_the_last_leaves_a_whole_result() {
    let (table, operations) = spoil_all(|at, fault| at % FAULTS.len() == fault);
    let tried: usize = table.values().flat_map(BTreeMap::values).sum();
    assert_eq!(tried, operations);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_every_operation_with_every_fault_leaves_a_whole_result() {
    let (table, operations) = spoil_all(|_, _| true);
    let tried: usize = table.values().flat_map(BTreeMap::values).sum();
    assert_eq!(tried, operations * FAULTS.len());
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/reliability.md");
    let written = fs::read_to_string(&path).unwrap();
    let (begin, end) = (
        "<!-- the test of faults writes this table -->\n\n",
        "\n<!-- end -->",
    );
    let (head, rest) = written.split_once(begin).unwrap();
    let (old, tail) = rest.split_once(end).unwrap();
    if std::env::var_os("RELIABILITY_PAGE").is_some_and(|word| word == "write") {
        fs::write(&path, format!("{head}{begin}{}{end}{tail}", page(&table))).unwrap();
    } else {
        // Whether a handled signal comes before or after a commit is a matter of moments.
        let of_moments = |line: &&str| line.contains("SIGINT") || line.contains("SIGTERM");
        let fixed = |text: &str| -> Vec<String> {
            let lines = text.lines().filter(|line| !of_moments(line));
            lines.map(str::to_owned).collect()
        };
        let hint = "RELIABILITY_PAGE=write writes the table anew";
        assert_eq!(fixed(old), fixed(&page(&table)), "{hint}");
    }
}
