//! Plugins that end the process: they are named, drafts are removed, and the exit status is 3.
//!
//! [`system`] has what the system calls: handlers of signals, of `exit`, and the descriptor of
//! standard output. [`watchdog`] ends a call that takes too long. `blame` finds the strategy; only
//! handlers of signals ask it.

#[cfg(unix)]
mod blame;
#[cfg(not(unix))]
#[path = "elsewhere.rs"]
mod system;
#[cfg(unix)]
#[path = "unix.rs"]
mod system;
mod watchdog;

pub use system::{
    answer_to, end_unheard, guard, leave_no_core, output_is_terminal, take_input, take_output,
};
pub use watchdog::{TimeLimit, watch};
