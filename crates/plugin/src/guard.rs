//! Turns panics of strategies into errors, and keeps them off the user's screen.

use std::borrow::Cow;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use turnpath_core::{Result, StrategyError};

thread_local! {
    /// The number of guarded calls that this thread is in, and the location of the last panic in
    /// one.
    static GUARD: RefCell<(usize, Option<String>)> = const { RefCell::new((0, None)) };
}

/// Runs a strategy's code. A panic in it becomes [`StrategyError::Panicked`].
///
/// Every dynamic library has its own copy of the standard library, so each library installs its own
/// quiet panic hook. Panics outside guarded calls reach the hook that was installed before.
pub fn guarded<T>(run: impl FnOnce() -> Result<T>) -> Result<T> {
    install_quiet_hook();
    GUARD.with_borrow_mut(|(depth, _)| *depth += 1);
    let answer = catch_unwind(AssertUnwindSafe(run));
    let location = GUARD.with_borrow_mut(|(depth, location)| {
        *depth -= 1;
        location.take()
    });
    answer.unwrap_or_else(|payload| {
        let what: Cow<'_, str> = if let Some(text) = payload.downcast_ref::<&str>() {
            Cow::Borrowed(text)
        } else if let Some(text) = payload.downcast_ref::<String>() {
            Cow::Owned(text.clone())
        } else {
            // The payload has the author's own type, which may panic when it is dropped.
            std::mem::forget(payload);
            Cow::Borrowed("a value that is not text")
        };
        let location = location.map_or_else(String::new, |location| format!(", at {location}"));
        Err(StrategyError::Panicked(format!("{what}{location}").into()))
    })
}

fn install_quiet_hook() {
    static INSTALLED: Once = Once::new();
    INSTALLED.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let guarded = GUARD.with_borrow_mut(|(depth, location)| {
                if *depth > 0 {
                    *location = info.location().map(ToString::to_string);
                }
                *depth > 0
            });
            if !guarded {
                before(info);
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_that_says_where() {
        let answer: Result<()> = guarded(|| panic!("no such radius"));
        let text = answer.unwrap_err().to_string();
        assert!(
            text.contains("no such radius") && text.contains("guard.rs:"),
            "{text}"
        );
    }

    #[test]
    fn answers_and_errors_pass_through() {
        assert_eq!(guarded(|| Ok(1)), Ok(1));
        let failed = StrategyError::failed("too steep");
        assert_eq!(guarded::<()>(|| Err(failed.clone())), Err(failed));
    }
}
