//! Signals that end the program: the drafts go first, and a result is the old or the new.
//!
//! A thread of its own waits for them. So they end the program whatever the other threads do, also
//! while a plugin does not return.

#[cfg(not(unix))]
mod elsewhere;
#[cfg(unix)]
mod unix;

use std::sync::Once;
use std::time::Duration;

#[cfg(not(unix))]
use elsewhere as system;
#[cfg(unix)]
use unix as system;

/// How long a result that is getting its names is waited for. That takes milliseconds; on a disk
/// that does not answer the next writer does it.
const PATIENCE: Duration = Duration::from_secs(5);

/// From now on an interrupt and its like remove the drafts before they end the program. Where the
/// system refuses that, they end it as they always do, and the next writer removes the drafts.
pub fn remove_drafts_on_signals() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let _ = system::install(|| turnpath_files::end_writing(PATIENCE));
    });
}
