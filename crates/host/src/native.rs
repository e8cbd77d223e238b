//! The system's loader. Only this file of the host has `unsafe` code.
#![allow(unsafe_code)] // loading native code cannot be checked by the compiler

use std::error::Error;
use std::path::Path;

use turnpath_plugin::Offer;
use turnpath_plugin::loading::{self, OpenError};

/// Why a library could not be opened.
pub enum NativeError {
    /// The system's loader refused it; this is the loader's message.
    Loader(String),
    /// The loader accepted it, but the boundary refused it.
    Open(OpenError),
}

/// Loads a library for the rest of the program, and opens the entry that it exports as `symbol`.
///
/// All symbols are resolved at once, so that a missing one is found here. The symbols stay private
/// to the library. The library is never unloaded, not even when its entry is refused: objects and
/// texts from it may be in use anywhere, and threads that it started may run.
pub fn load(file: &Path, symbol: &str) -> Result<Vec<Offer>, NativeError> {
    // SAFETY: the library's initialisers run. A user who trusts a plugin vouches that they behave.
    // The caller has checked that the file is complete and for this machine.
    let library = unsafe { open_library(file) }.map_err(loader_error)?;
    // SAFETY: the symbol is a static, so its address may be taken as a pointer of any type.
    let entry = unsafe { library.get::<*const u8>(symbol) }.map(|symbol| *symbol);
    std::mem::forget(library);
    let entry = entry.map_err(loader_error)?;
    // SAFETY: the symbol's name begins with the boundary's prefix, and the library was forgotten,
    // so it stays loaded.
    unsafe { loading::open(entry) }.map_err(NativeError::Open)
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
fn loader_error(error: libloading::Error) -> NativeError {
    NativeError::Loader(
        error
            .source()
            .map_or_else(|| error.to_string(), ToString::to_string),
    )
}
