//! The registry where no signal handler may ask for it: a list behind a mutex.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::kind::DraftKind;

/// The number of an entry, its kind and its path.
type Line = (u64, DraftKind, PathBuf);

static LINES: Mutex<Vec<Line>> = Mutex::new(Vec::new());
static NEXT: AtomicU64 = AtomicU64::new(0);

/// A path in the list.
#[derive(Debug)]
pub struct Entry(u64);

impl Entry {
    /// Adds a path.
    pub fn new(kind: DraftKind, path: &Path) -> Option<Self> {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        lines().push((number, kind, path.to_owned()));
        Some(Self(number))
    }

    /// Takes the path off the list. False if [`remove_all`] was faster.
    pub fn withdraw(self) -> bool {
        let mut lines = lines();
        let before = lines.len();
        lines.retain(|(number, ..)| *number != self.0);
        lines.len() < before
    }
}

/// Removes all paths: files, folders, and, if asked for, claims and the folders that only a claim
/// kept.
/// Folders were added from the outside in.
pub fn remove_all(claims: bool) {
    let taken = std::mem::take(&mut *lines());
    let of_kind = |kind| taken.iter().rev().filter(move |line| line.1 == kind);
    let kinds = [DraftKind::File, DraftKind::Claim].into_iter();
    for kind in kinds.filter(|kind| claims || *kind == DraftKind::File) {
        for (.., path) in of_kind(kind) {
            let _ = fs::remove_file(path);
        }
        for (.., path) in of_kind(DraftKind::Folder) {
            let _ = fs::remove_dir(path);
        }
    }
}

fn lines() -> MutexGuard<'static, Vec<Line>> {
    LINES.lock().unwrap_or_else(PoisonError::into_inner)
}
