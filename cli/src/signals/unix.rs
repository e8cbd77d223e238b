//! SIGINT, SIGTERM and SIGHUP.

use std::ffi::c_int;
use std::io;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, mpsc};
use std::{mem, ptr, thread};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::flag;
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;

/// Calls `act` when a signal is to end the process, and then ends it by that signal, as the shell
/// that waits for it expects.
pub fn install(act: impl FnOnce() + Send + 'static) -> io::Result<()> {
    // With a handler the write that exceeds the limit on files fails, and says so.
    if !is_ignored(SIGXFSZ) {
        flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
    }
    let (tell, told) = mpsc::channel();
    // The thread is there before the handlers are: a signal that has one always ends the program.
    let wait = move || {
        let ending = [SIGINT, SIGTERM, SIGHUP].into_iter();
        let handled = Signals::new(ending.filter(|signal| !is_ignored(*signal)));
        let (mut signals, done) = match handled {
            Ok(signals) => (Some(signals), Ok(())),
            Err(error) => (None, Err(error)),
        };
        // The caller waits for it.
        let _ = tell.send(done);
        if let Some(signal) = signals
            .as_mut()
            .and_then(|signals| signals.forever().next())
        {
            act();
            let _ = emulate_default_handler(signal);
        }
    };
    let name = "signals".to_owned();
    thread::Builder::new().name(name).spawn(wait)?;
    told.recv()
        .unwrap_or_else(|gone| Err(io::Error::other(gone)))
}

/// Whether whoever started the program wants it to go on, as `nohup` does.
#[allow(
    unsafe_code,
    reason = "no library asks for the present action of a signal without a change of it"
)]
fn is_ignored(signal: c_int) -> bool {
    // SAFETY: a `sigaction` is a structure of C that may be all zeros. The call writes the present
    // action into it and changes none, since the new action is null.
    let action = unsafe {
        let mut present: libc::sigaction = mem::zeroed();
        match libc::sigaction(signal, ptr::null(), &raw mut present) {
            0 => present.sa_sigaction,
            _ => libc::SIG_DFL,
        }
    };
    action == libc::SIG_IGN
}
