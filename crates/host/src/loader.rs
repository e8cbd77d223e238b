//! Loads libraries. Their code is loaded one after the other. Then layouts are compared: those of
//! libraries that are not newer than this program side by side, and all others in order.

use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rayon::prelude::*;
use turnpath_core::printable_line;
use turnpath_plugin::Offer;
use turnpath_plugin::calls::Callee;
use turnpath_plugin::loading::SYMBOL_PREFIX;

use crate::library::CheckedCopy;
use crate::native::{self, Entry};
use crate::{LibraryFile, LoadError, Refusal, SourceHash};

/// Help for a complete file that the loader cannot map.
const NOEXEC_HINT: &str = "the folder for temporary files may be mounted without permission to \
                           execute; set TMPDIR to another";

/// A library that was loaded, and that the boundary has accepted.
#[derive(Debug)]
pub struct Library {
    /// The crate that exports the plugin.
    pub crate_name: String,
    /// That crate's version.
    pub version: String,
    /// The hash of the bytes that were loaded, from the first catalogue that loaded them.
    pub hash: SourceHash,
    /// The strategies of the plugin.
    pub offers: Vec<Offer>,
}

/// A library whose code is in this program.
struct LoadedCode {
    /// The symbol of its entry.
    symbol: String,
    hash: SourceHash,
    entry: Entry,
    /// What the entry offers, once the boundary has accepted it.
    offers: OnceLock<Vec<Offer>>,
}

/// Loads libraries in their order, up to the first whose code cannot be loaded. The code of the same bytes
/// is loaded only once in a program.
///
/// The initialisers of the libraries run one after the other, on this thread. The comparison of layouts takes
/// longer, so libraries that are not newer than this program are compared side by side.
///
/// # Errors
/// For each library: when it is not a plugin for this program, or cannot be loaded.
pub fn load(files: &[LibraryFile]) -> Vec<Result<Library, LoadError>> {
    let mut loaded = Vec::with_capacity(files.len());
    for file in files {
        let code = code_of(file);
        let ends_here = code.is_err();
        loaded.push(code);
        if ends_here {
            break;
        }
    }
    let side_by_side = loaded.into_par_iter().zip(files);
    let opened = side_by_side.map(|(code, file)| {
        let code = code?;
        open_if_not_newer(&code, file)?;
        Ok(code)
    });
    let opened: Vec<Result<Arc<LoadedCode>, LoadError>> = opened.collect();
    let in_order = opened.into_iter().zip(files);
    in_order
        .map(|(code, file)| library(&*code?, file))
        .collect()
}

/// Loads the code of a library.
fn code_of(file: &LibraryFile) -> Result<Arc<LoadedCode>, LoadError> {
    /// All that was loaded.
    static LOADED: Mutex<Vec<Arc<LoadedCode>>> = Mutex::new(Vec::new());
    let CheckedCopy { symbol, copy } = file.checked()?;
    // A panic while the lock is held leaves a valid list: each library in it is loaded.
    let mut loaded = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
    for code in loaded.iter().filter(|code| code.symbol == *symbol) {
        if code.hash.is_of_same_bytes(file.hash())? {
            return Ok(Arc::clone(code));
        }
    }
    let mark = callee(file).enter();
    let entry = native::load(copy.file(), symbol)
        .map_err(|reason| file.refused(refusal(&reason, copy.file(), file.path())))?;
    drop(mark);
    let code = Arc::new(LoadedCode {
        symbol: symbol.to_owned(),
        hash: file.hash().clone(),
        entry,
        offers: OnceLock::new(),
    });
    loaded.push(Arc::clone(&code));
    Ok(code)
}

/// Opens the entry of a library that is not newer than this program.
fn open_if_not_newer(code: &LoadedCode, file: &LibraryFile) -> Result<(), LoadError> {
    if code.offers.get().is_none() {
        let _mark = callee(file).enter();
        let offers = code.entry.offers_if_not_newer();
        if let Some(offers) = offers.map_err(|error| file.refused(error.into()))? {
            let _ = code.offers.set(offers);
        }
    }
    Ok(())
}

/// The library. Its entry is opened here if it was not opened before.
fn library(code: &LoadedCode, file: &LibraryFile) -> Result<Library, LoadError> {
    let offers = match code.offers.get() {
        Some(offers) => offers,
        None => {
            let _mark = callee(file).enter();
            let offers = code.entry.offers_of_newer();
            let offers = offers.map_err(|error| file.refused(error.into()))?;
            code.offers.get_or_init(|| offers)
        }
    };
    Ok(Library {
        crate_name: code.symbol.replacen(SYMBOL_PREFIX, "", 1),
        version: offers.first().map_or("", Offer::crate_version).to_owned(),
        hash: code.hash.clone(),
        offers: offers.clone(),
    })
}

fn callee(file: &LibraryFile) -> &'static Callee {
    let text = format!("the library {}", file.path().display());
    Callee::new(printable_line(&text).into_owned(), true)
}

/// The refusal of the system's loader, with the name of the user's file instead of that of the copy.
fn refusal(reason: &str, copy: &Path, path: &Path) -> Refusal {
    let (copy, path) = (copy.to_string_lossy(), path.to_string_lossy());
    let reason = reason
        .replace(&format!("{copy}: "), "")
        .replace(&*copy, &path);
    let cannot_map = reason.contains("failed to map") || reason.contains("not permitted");
    let hint = cannot_map.then_some(NOEXEC_HINT);
    Refusal::Loader { reason, hint }
}
