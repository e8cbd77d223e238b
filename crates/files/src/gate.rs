//! One at a time makes a draft or gives a name, and nobody does once the process is to end.

use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

use crate::registry::{remove_drafts, remove_drafts_but_claims};

static GATE: Mutex<()> = Mutex::new(());

/// How often a process that is to end looks whether the gate is free.
const LOOK: Duration = Duration::from_millis(1);

/// Waits for the gate. Nothing slow happens while it is held.
pub fn enter() -> MutexGuard<'static, ()> {
    GATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does a step that begins a draft elsewhere and registers it: a process that is to end waits for the
/// step, and nobody begins one once it does. The step is short.
pub fn begin_draft<T>(step: impl FnOnce() -> T) -> T {
    let _gate = enter();
    step()
}

/// Holds the gate, unless it is held already: by this thread, which then has it anyway, or by
/// another, which is rare.
pub fn enter_if_free() -> Option<MutexGuard<'static, ()>> {
    match GATE.try_lock() {
        Ok(guard) => Some(guard),
        Err(TryLockError::Poisoned(error)) => Some(error.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}

/// Waits for the end of the process if [`end_writing`] has begun it. Work that fails because its drafts
/// are gone calls this before it says so: the process ends by the signal, and not with that failure.
pub fn wait_if_ending() {
    drop(enter());
}

/// Removes all drafts, for a process that ends next. Names that are being given are waited for; then
/// no draft is made and no name is given any more: whoever tries waits for the end of the process. So
/// a result is the old or the new.
///
/// The wait is at most `patience`. After that names may still be given until the process ends, so the
/// files of the claims stay, and no other writer comes between. The next one completes the result.
///
/// This waits and sleeps: a signal handler calls [`remove_drafts`] instead.
pub fn end_writing(patience: Duration) {
    let start = Instant::now();
    loop {
        match GATE.try_lock() {
            Ok(guard) => break std::mem::forget(guard),
            Err(TryLockError::Poisoned(error)) => break std::mem::forget(error.into_inner()),
            Err(TryLockError::WouldBlock) if start.elapsed() >= patience => {
                return remove_drafts_but_claims();
            }
            Err(TryLockError::WouldBlock) => thread::sleep(LOOK),
        }
    }
    remove_drafts();
}
