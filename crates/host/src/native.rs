//! The system's loader. Only this file of the host has `unsafe` code.
#![allow(unsafe_code)] // loading native code cannot be checked by the compiler

use std::error::Error;
use std::path::Path;

use turnpath_plugin::Offer;
use turnpath_plugin::loading::{self, OpenError, SYMBOL_PREFIX};

/// The address of a plugin's entry, in a library that stays loaded for the rest of the program.
#[derive(Debug, Clone, Copy)]
pub struct Entry(*const u8);

// SAFETY: it is an address, which stays valid. Only the opening reads through it, and what the
// boundary writes there goes through an atomic pointer or a lock.
unsafe impl Send for Entry {}
// SAFETY: as above.
unsafe impl Sync for Entry {}

impl Entry {
    /// The strategies of the plugin, after a comparison of layouts, if the library has nothing that
    /// this program lacks, and fits it; else `None`. Several entries may be opened in this way at the
    /// same time.
    ///
    /// # Errors
    /// When the boundary refuses the library.
    pub fn offers_if_not_newer(self) -> Result<Option<Vec<Offer>>, OpenError> {
        // SAFETY: `load` took the address from a symbol with the boundary's prefix, in a library that
        // stays loaded.
        unsafe { loading::open_if_not_newer(self.0) }
    }

    /// The strategies of a newer library. One such entry is opened after the other.
    ///
    /// # Errors
    /// When the boundary refuses the library.
    pub fn offers_of_newer(self) -> Result<Vec<Offer>, OpenError> {
        // SAFETY: as above.
        unsafe { loading::open_newer(self.0) }
    }
}

/// Loads a library for the rest of the program, and finds the entry that it exports as `symbol`.
///
/// All symbols are resolved at once, so that a missing one is found here. The symbols stay private
/// to the library. The library is never unloaded, not even when its entry is refused: objects and
/// texts from it may be in use anywhere, and threads that it started may run.
///
/// # Errors
/// The message of the system's loader, when it refuses the library. Also when the symbol does not
/// begin with [`SYMBOL_PREFIX`].
pub fn load(file: &Path, symbol: &str) -> Result<Entry, String> {
    if !symbol.starts_with(SYMBOL_PREFIX) {
        return Err(format!("`{symbol}` is not the entry of a plugin"));
    }
    // SAFETY: the library's initialisers run. A user who trusts a plugin vouches that they behave. The
    // file is a copy of bytes that were checked when they were read: complete, and for this machine. A
    // process that tries a library gets the copy's name from the one that checked it.
    let library = unsafe { open_library(file) }.map_err(reason)?;
    // SAFETY: symbols with the boundary's prefix are statics, so the address may be taken as a pointer
    // of any type.
    let entry = unsafe { library.get::<*const u8>(symbol) }.map(|symbol| *symbol);
    std::mem::forget(library);
    entry.map(Entry).map_err(reason)
}

#[cfg(unix)]
unsafe fn open_library(file: &Path) -> Result<libloading::os::unix::Library, libloading::Error> {
    use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: passed on to the caller.
    unsafe { Library::open(Some(file), RTLD_NOW | RTLD_LOCAL) }
}

#[cfg(not(unix))]
unsafe fn open_library(file: &Path) -> Result<libloading::Library, libloading::Error> {
    // SAFETY: passed on to the caller.
    unsafe { libloading::Library::new(file) }
}

/// The source of the error has the reason; the error itself says only which call failed.
fn reason(error: libloading::Error) -> String {
    let source = error.source().map(ToString::to_string);
    source.unwrap_or_else(|| error.to_string())
}
