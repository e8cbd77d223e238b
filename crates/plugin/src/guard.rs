//! Panics of strategies become errors, and stay off the user's screen.

use std::borrow::Cow;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use turnpath_core::{Result, StrategyError};

thread_local! {
    /// How many guarded calls this thread is in, and where the last panic in one was.
    static GUARD: RefCell<(usize, Option<String>)> = const { RefCell::new((0, None)) };
}

/// Runs a strategy's code; a panic in it becomes [`StrategyError::Panicked`].
///
/// Every dynamic library has its own copy of the standard library, so each installs its own
/// quiet panic hook; panics outside guarded calls reach the hook that was there before.
pub fn guarded<T>(run: impl FnOnce() -> Result<T>) -> Result<T> {
    install_quiet_hook();
    GUARD.with_borrow_mut(|(depth, _)| *depth += 1);
    let answer = catch_unwind(AssertUnwindSafe(run));
    let place = GUARD.with_borrow_mut(|(depth, place)| {
        *depth -= 1;
        place.take()
    });
    answer.unwrap_or_else(|payload| {
        let what: Cow<'_, str> = if let Some(text) = payload.downcast_ref::<&str>() {
            Cow::Borrowed(text)
        } else if let Some(text) = payload.downcast_ref::<String>() {
            Cow::Owned(text.clone())
        } else {
            // It is the author's own type, and may panic when it is dropped.
            std::mem::forget(payload);
            Cow::Borrowed("a value that is not text")
        };
        let place = place.map_or_else(String::new, |place| format!(", at {place}"));
        Err(StrategyError::Panicked(format!("{what}{place}").into()))
    })
}

fn install_quiet_hook() {
    static INSTALLED: Once = Once::new();
    INSTALLED.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let guarded = GUARD.with_borrow_mut(|(depth, place)| {
                if *depth > 0 {
                    *place = info.location().map(ToString::to_string);
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
