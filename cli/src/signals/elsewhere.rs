//! Ctrl-C on Windows. The system calls its handler on a thread of its own, where little is allowed:
//! it leaves a note, for which another thread looks.

use std::io;
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::background;

/// The status of a process that Ctrl-C ended, `STATUS_CONTROL_C_EXIT`.
const INTERRUPTED: u32 = 0xC000_013A;
/// How often the thread looks: a person does not notice the wait.
const LOOK: Duration = Duration::from_millis(20);

/// Calls `act` when the process is to end, and then ends it.
pub fn install(act: impl FnOnce() + Send + 'static) -> io::Result<()> {
    let is_to_end = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        flag::register(signal, is_to_end.clone())?;
    }
    let wait = move || {
        while !is_to_end.load(Ordering::Acquire) {
            thread::sleep(LOOK);
        }
        act();
        process::exit(INTERRUPTED.cast_signed());
    };
    background::start("signals", wait)
}
