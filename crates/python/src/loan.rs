//! References that a call lends to Python, which knows no lifetimes.
//!
//! An object of Python may outlive the call that it was made for: somebody keeps it, or another
//! thread has it. A [`Loan`] gives its reference only while the call lasts, and the call does not end
//! before the last use has. A channel to the thread that holds the reference would need no `unsafe`,
//! but would change threads at each question, which costs more than most answers.
#![allow(unsafe_code)]

use std::fmt;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// A reference that may be used until its call ends.
pub struct Loan<T: ?Sized + 'static>(Arc<Ledger<T>>);

impl<T: ?Sized> Clone for Loan<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T: ?Sized> fmt::Debug for Loan<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Loan")
    }
}

struct Ledger<T: ?Sized + 'static> {
    state: Mutex<State<T>>,
    returned: Condvar,
}

struct State<T: ?Sized + 'static> {
    /// The reference; `None` after the call.
    value: Option<&'static T>,
    /// How many uses are in progress.
    uses: usize,
}

impl<T: ?Sized> Ledger<T> {
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        // Nothing panics while it holds the lock.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Ends a loan when the call ends, also by a panic.
struct End<'a, T: ?Sized + 'static>(&'a Ledger<T>);

impl<T: ?Sized> Drop for End<'_, T> {
    fn drop(&mut self) {
        let mut state = self.0.lock();
        state.value = None;
        while state.uses > 0 {
            let returned = self.0.returned.wait(state);
            state = returned.unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Counts a use while it is in progress.
struct Use<'a, T: ?Sized + 'static>(&'a Ledger<T>);

impl<T: ?Sized> Drop for Use<'_, T> {
    fn drop(&mut self) {
        self.0.lock().uses -= 1;
        self.0.returned.notify_all();
    }
}

impl<T: ?Sized + Sync> Loan<T> {
    /// Gives up the interpreter's lock and answers `ask` with the reference.
    ///
    /// # Errors
    /// When the call that lent the reference has ended.
    pub fn with<R: Send>(&self, py: Python<'_>, ask: impl FnOnce(&T) -> R + Send) -> PyResult<R> {
        py.detach(|| {
            let mut state = self.0.lock();
            let value = state.value?;
            state.uses += 1;
            drop(state);
            let _use = Use(&*self.0);
            Some(ask(value))
        })
        .ok_or_else(|| PyRuntimeError::new_err("the call that this was made for has ended"))
    }

    /// Lends a reference during `call`. The caller has lengthened its lifetime, and must not hold the
    /// interpreter's lock: the loan ends only after its last use, which may need it.
    ///
    /// # Safety
    /// `value` is valid until this function has returned.
    pub unsafe fn during<R>(value: &'static T, call: impl FnOnce(Self) -> R) -> R {
        let lent = Arc::new(Ledger {
            state: Mutex::new(State {
                value: Some(value),
                uses: 0,
            }),
            returned: Condvar::new(),
        });
        let _end = End(&*lent);
        call(Self(Arc::clone(&lent)))
    }
}

macro_rules! lender {
    ($name:ident, $object:path, $what:literal) => {
        #[doc = concat!("Lends ", $what, " during `call`. The caller must not hold the interpreter's lock.")]
        pub fn $name<R>(value: &dyn $object, call: impl FnOnce(Loan<dyn $object>) -> R) -> R {
            // SAFETY: only the lifetime changes. `during` gives the reference to nobody after `call`
            // has returned, and returns only when nobody uses it any more; until then `value` lives.
            unsafe {
                let value: &'static (dyn $object + 'static) = std::mem::transmute(value);
                Loan::during(value, call)
            }
        }
    };
}

lender!(lend_locus, turnpath_core::Locus, "a locus");
lender!(lend_surface, turnpath_core::SurfaceModel, "a surface");
