//! Who ended the process, as far as the marks of the host's calls show it.

use turnpath::calls::{self, Callee};

/// Who ended the process.
#[derive(Clone, Copy)]
pub struct Blame {
    callee: &'static Callee,
    own_thread: bool,
}

impl Blame {
    /// The strategy that this thread calls, or else one of a library that another thread calls: a
    /// plugin may start threads. A signal handler may ask this.
    pub fn find() -> Option<Self> {
        let here = calls::on_this_thread().map(|callee| (callee, false));
        let elsewhere = || calls::of_a_library_on_any_thread().map(|callee| (callee, true));
        let (callee, own_thread) = here.or_else(elsewhere)?;
        Some(Self { callee, own_thread })
    }

    /// The message in pieces. Where another thread than the caller's ended the process, it may be one of
    /// the program's own, so the strategy is not accused but named. The pieces are there already, so that nothing allocates; `what` follows the strategy's name.
    pub fn message(&self, what: &'static str) -> [&'static str; 5] {
        let thread = match self.own_thread {
            true => " may have, on a thread of its own,",
            false => "",
        };
        ["error: ", self.callee.text(), thread, what, "\n"]
    }
}
