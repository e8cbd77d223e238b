//! The registry on Unix: a fixed number of places, each empty or with a path that is ready for
//! `unlink`. A place is taken and given back by one atomic exchange, so a signal handler may look at
//! it at any time.
#![allow(
    unsafe_code,
    reason = "a signal handler may neither lock nor allocate, so paths are C strings behind atomic \
              pointers"
)]

use std::ffi::{CStr, CString, c_char};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};

use super::kind::DraftKind;

type Slot = AtomicPtr<c_char>;

/// Places for files: a run has a few, an ablation one for each thread.
const FILES: usize = 256;
/// Places for folders. They are gathered on the stack of a signal handler, hence few.
const FOLDERS: usize = 64;
/// Places for claims: a process writes into few folders at a time.
const CLAIMS: usize = 32;

static FILE_SLOTS: [Slot; FILES] = [const { Slot::new(ptr::null_mut()) }; FILES];
static FOLDER_SLOTS: [Slot; FOLDERS] = [const { Slot::new(ptr::null_mut()) }; FOLDERS];
static CLAIM_SLOTS: [Slot; CLAIMS] = [const { Slot::new(ptr::null_mut()) }; CLAIMS];

/// A path in its place.
#[derive(Debug)]
pub struct Entry {
    slot: &'static Slot,
    path: *mut c_char,
}

// SAFETY: the pointer is only compared with that in the slot, and freed by whoever took it out of
// the slot; neither depends on the thread.
unsafe impl Send for Entry {}
// SAFETY: as above; a shared entry has no method at all.
unsafe impl Sync for Entry {}

impl Entry {
    /// Puts a path into a free place, if there is one and the path can be given to the system.
    pub fn new(kind: DraftKind, path: &Path) -> Option<Self> {
        let slots: &'static [Slot] = match kind {
            DraftKind::File => &FILE_SLOTS,
            DraftKind::Folder => &FOLDER_SLOTS,
            DraftKind::Claim => &CLAIM_SLOTS,
        };
        let path = CString::new(path.as_os_str().as_bytes()).ok()?.into_raw();
        let free = |slot: &&Slot| {
            let none = ptr::null_mut();
            slot.compare_exchange(none, path, Ordering::AcqRel, Ordering::Relaxed)
                .is_ok()
        };
        let Some(slot) = slots.iter().find(free) else {
            // SAFETY: `into_raw` gave the pointer, and no slot has taken it.
            drop(unsafe { CString::from_raw(path) });
            return None;
        };
        Some(Self { slot, path })
    }

    /// Frees the place. False if [`remove_all`] was faster.
    pub fn withdraw(self) -> bool {
        let none = ptr::null_mut();
        let mine = self
            .slot
            .compare_exchange(self.path, none, Ordering::AcqRel, Ordering::Relaxed)
            .is_ok();
        if mine {
            // SAFETY: `into_raw` gave the pointer, and the exchange took it out of the slot: nobody
            // else has it.
            drop(unsafe { CString::from_raw(self.path) });
        }
        mine
    }
}

/// Takes the path out of a place. It is never freed then, which a signal handler may not do.
fn take(slot: &Slot) -> Option<&'static CStr> {
    let path = slot.swap(ptr::null_mut(), Ordering::AcqRel);
    // SAFETY: a pointer in a slot is that of a C string, and whoever takes it out owns it. Nobody
    // frees this one, so it lives as long as the process.
    (!path.is_null()).then(|| unsafe { CStr::from_ptr(path) })
}

/// Removes all paths: files, folders, and, if asked for, claims and the folders that only a claim kept.
pub fn remove_all(claims: bool) {
    for path in FILE_SLOTS.iter().filter_map(take) {
        let _ = rustix::fs::unlink(path);
    }
    let mut folders = [None; FOLDERS];
    for (folder, slot) in folders.iter_mut().zip(&FOLDER_SLOTS) {
        *folder = take(slot);
    }
    remove_empty(&mut folders);
    if !claims {
        return;
    }
    for path in CLAIM_SLOTS.iter().filter_map(take) {
        let _ = rustix::fs::unlink(path);
    }
    remove_empty(&mut folders);
}

/// Removes the folders that are empty, from the inside out: until none can be removed any more.
fn remove_empty(folders: &mut [Option<&'static CStr>]) {
    let mut removed = true;
    while removed {
        removed = false;
        for folder in folders.iter_mut() {
            if folder.is_some_and(|path| rustix::fs::rmdir(path).is_ok()) {
                *folder = None;
                removed = true;
            }
        }
    }
}
