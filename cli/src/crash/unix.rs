//! Signals, `exit`, standard input and output on Unix.
//!
//! The handlers run on the stacks that Rust gives its threads for this, because a stack overflow
//! leaves no other. In a handler nothing allocates and nothing waits: it reads the marks of this
//! thread, writes to descriptor 2, removes the drafts, and ends the process.
#![allow(unsafe_code)] // handlers of signals and of `exit` exist only behind the C library

use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::os::fd::AsFd;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use libc::{c_int, c_void, sigaction, siginfo_t};
use turnpath_files::remove_drafts;

use super::blame::Blame;

/// The exit status of a plugin that failed.
const PLUGIN_FAILED: c_int = 3;

/// What a plugin that fails sends its own process, and what that means.
const SIGNALS: [(c_int, &str); 6] = [
    (
        libc::SIGABRT,
        " ended the program: it called abort (SIGABRT)",
    ),
    (
        libc::SIGSEGV,
        " ended the program: it used memory that is not its own, or its stack overflowed (SIGSEGV)",
    ),
    (
        libc::SIGBUS,
        " ended the program: it used memory that is not there (SIGBUS)",
    ),
    (
        libc::SIGILL,
        " ended the program: it ran an invalid instruction (SIGILL)",
    ),
    (
        libc::SIGFPE,
        " ended the program: it divided a whole number by zero (SIGFPE)",
    ),
    (
        libc::SIGTRAP,
        " ended the program: it ran into a trap, as an abort is on some machines (SIGTRAP)",
    ),
];

/// Standard output as it was, once [`take_output`] has taken it.
static OUTPUT: OnceLock<File> = OnceLock::new();
/// The thread that ends the process already; zero for none.
static ENDING: AtomicUsize = AtomicUsize::new(0);
/// What handled the signals before, for those that no plugin sent.
static BEFORE: OnceLock<[sigaction; SIGNALS.len()]> = OnceLock::new();

/// Keeps standard output for the program's own answers: whatever else the process prints, plugins
/// above all, goes to standard error from here on, and to the end of the process.
///
/// # Errors
/// When the system has no descriptor left.
pub fn take_output() -> io::Result<()> {
    if OUTPUT.get().is_some() {
        return Ok(());
    }
    let kept = io::stdout().as_fd().try_clone_to_owned()?;
    rustix::stdio::dup2_stdout(io::stderr())?;
    // A second caller at the same time would keep standard error; the program calls this once.
    let _ = OUTPUT.set(kept.into());
    Ok(())
}

/// Writes an answer to standard output.
///
/// # Errors
/// Those of writing.
pub fn answer_to(text: &[u8]) -> io::Result<()> {
    match OUTPUT.get() {
        Some(mut output) => output.write_all(text),
        None => {
            let mut output = io::stdout();
            output.write_all(text)?;
            output.flush()
        }
    }
}

/// Standard output, if it is a terminal.
pub fn output_is_terminal() -> Option<impl AsFd> {
    let output = match OUTPUT.get() {
        Some(output) => output.as_fd().try_clone_to_owned(),
        None => io::stdout().as_fd().try_clone_to_owned(),
    };
    output.ok().filter(IsTerminal::is_terminal)
}

/// Takes standard input away from whatever else reads it, plugins above all: for them it is at its end.
///
/// # Errors
/// When the system has no descriptor left.
pub fn take_input() -> io::Result<File> {
    let kept = io::stdin().as_fd().try_clone_to_owned()?;
    rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
    Ok(kept.into())
}

/// Lets the system keep no core dump of this process when it dies.
pub fn leave_no_core() {
    let none = rustix::process::Rlimit {
        current: Some(0),
        maximum: Some(0),
    };
    // Where the limit cannot be set, a dump is kept.
    let _ = rustix::process::setrlimit(rustix::process::Resource::Core, none);
}

/// Sets the handlers that name the plugin that ends the process. Only the first call does it.
pub fn guard() {
    BEFORE.get_or_init(|| {
        // SAFETY: the function lives as long as the process, and takes and returns nothing.
        unsafe { libc::atexit(at_exit) };
        SIGNALS.map(|(signal, _)| set_handler(signal))
    });
}

fn set_handler(signal: c_int) -> sigaction {
    // SAFETY: a `sigaction` is numbers and a set of signals, for which zero is a value.
    let (mut action, mut before): (sigaction, sigaction) = unsafe { std::mem::zeroed() };
    let handler: extern "C" fn(c_int, *mut siginfo_t, *mut c_void) = on_signal;
    action.sa_sigaction = handler as *const () as usize;
    action.sa_flags = libc::SA_SIGINFO | libc::SA_ONSTACK;
    // SAFETY: both point to whole values, and `on_signal` calls only what a handler may call.
    unsafe { libc::sigaction(signal, &action, &mut before) };
    before
}

/// A signal that may come from a plugin's code.
extern "C" fn on_signal(signal: c_int, info: *mut siginfo_t, _: *mut c_void) {
    let index = SIGNALS.iter().position(|(known, _)| *known == signal);
    let blame = match sent_by_another_process(info) {
        true => None,
        false => Blame::find(),
    };
    if let (Some(blame), Some((_, what))) = (blame, index.and_then(|index| SIGNALS.get(index))) {
        end(blame.message(what));
    }
    // No plugin: whatever handled the signal before gets it again, as soon as this returns.
    remove_drafts();
    let before = BEFORE
        .get()
        .zip(index)
        .and_then(|(all, index)| all.get(index));
    match before {
        // SAFETY: the action is the one that the system gave for this signal.
        Some(before) => unsafe {
            libc::sigaction(signal, before, std::ptr::null_mut());
        },
        // SAFETY: the default needs no code of this process.
        None => unsafe {
            libc::signal(signal, libc::SIG_DFL);
        },
    }
    // A fault comes again by itself once this returns, with its place, which the handler before asks
    // for. A signal that was sent does not.
    if was_sent(info) {
        // SAFETY: the signal is blocked until this returns, so `raise` only leaves it pending.
        unsafe { libc::raise(signal) };
    }
}

/// Whether the signal was sent, by whomever, and is no fault of an instruction.
fn was_sent(info: *mut siginfo_t) -> bool {
    // SAFETY: the system gives a whole `siginfo_t` to a handler with `SA_SIGINFO`.
    unsafe { (*info).si_code <= 0 }
}

/// Whether somebody sent the signal from outside, with `kill`.
fn sent_by_another_process(info: *mut siginfo_t) -> bool {
    // SAFETY: the system gives a whole `siginfo_t` to a handler with `SA_SIGINFO`; a signal that
    // was sent, which has a code of zero or below, has the sender in it.
    was_sent(info) && unsafe { (*info).si_pid() != libc::getpid() }
}

/// `exit`, from wherever it is called. The program itself calls it when nothing is in progress.
extern "C" fn at_exit() {
    if let Some(blame) = Blame::find() {
        end(blame.message(" ended the program: it called exit"));
    }
}

/// Ends the process with the status of a plugin that failed, after this message. It may be called in
/// a handler.
pub fn end<const N: usize>(message: [&str; N]) -> ! {
    // SAFETY: it only asks; no thread has the number zero.
    let this = unsafe { libc::pthread_self() } as usize;
    let ending = ENDING.compare_exchange(0, this, Ordering::SeqCst, Ordering::SeqCst);
    if ending == Err(this) {
        // Ending has failed on its way: another fault, or `exit` within.
        // SAFETY: it ends the process at once, without the handlers of `exit`.
        unsafe { libc::_exit(PLUGIN_FAILED) };
    }
    if ending.is_err() {
        // Another thread says why and ends the process.
        loop {
            // SAFETY: it only waits.
            unsafe { libc::pause() };
        }
    }
    for piece in message {
        // SAFETY: the piece is that long. Nobody can be told that standard error takes nothing.
        unsafe { libc::write(libc::STDERR_FILENO, piece.as_ptr().cast(), piece.len()) };
    }
    remove_drafts();
    // SAFETY: it ends the process at once, without the handlers of `exit`.
    unsafe { libc::_exit(PLUGIN_FAILED) }
}

/// Ends the process at once without a message, for one whose end nobody hears of; drafts go.
pub fn end_unheard() -> ! {
    remove_drafts();
    // SAFETY: it ends the process at once, without the handlers of `exit`.
    unsafe { libc::_exit(PLUGIN_FAILED) }
}
