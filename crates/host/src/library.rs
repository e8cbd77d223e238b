//! One library. It is read once; the bytes that were hashed are checked and loaded.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use rayon::prelude::*;
use turnpath_core::printable_line;
use turnpath_plugin::Offer;
use turnpath_plugin::calls::Callee;
use turnpath_plugin::loading::SYMBOL_PREFIX;

use crate::hash::sha256_hex;
use crate::native::{self, NativeError};
use crate::private_copy::PrivateCopy;
use crate::{LoadError, Refusal, image};

/// Largest library. A plugin with all its debug information has a tenth of that; the limit is on the
/// memory that a file can take.
const MOST_BYTES: u64 = 1 << 28;
/// The extensions of libraries. A plugin folder may hold other files too.
const EXTENSIONS: [&str; 3] = ["so", "dylib", "dll"];
/// Help for a complete file that the loader cannot map.
const NOEXEC_HINT: &str = "the folder for temporary files may be mounted without permission to \
                           execute; set TMPDIR to another";

/// The bytes of a library's file. They are hashed, checked and loaded; the file is not read again.
pub struct LibraryFile {
    path: PathBuf,
    bytes: Vec<u8>,
    /// The hash of the bytes, once it is asked for.
    sha256: OnceLock<String>,
    /// The symbol of the entry, once the bytes are checked.
    symbol: OnceLock<Result<String, Refusal>>,
    /// Where the loader finds the bytes, once it is asked for.
    copy: OnceLock<PrivateCopy>,
}

/// What the loader gets of a library.
#[derive(Debug, Clone)]
pub struct Loadable {
    /// A copy of its bytes. It goes with the [`LibraryFile`].
    pub file: PathBuf,
    /// The symbol of its entry.
    pub symbol: String,
}

impl Loadable {
    /// Loads the library, as a [`Catalogue`](crate::Catalogue) of another process will. Nothing comes of a
    /// library that the loader or the boundary refuses.
    pub fn try_load(&self) {
        let _ = native::load(&self.file, &self.symbol);
    }
}

impl fmt::Debug for LibraryFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("LibraryFile");
        shown
            .field("path", &self.path)
            .field("sha256", &self.sha256());
        shown.finish_non_exhaustive()
    }
}

/// A loaded library.
#[derive(Debug, Clone)]
pub struct Library {
    /// The crate that exports the plugin.
    pub crate_name: String,
    /// That crate's version.
    pub version: String,
    /// The strategies of the plugin.
    pub offers: Vec<Offer>,
}

impl LibraryFile {
    /// Reads a library.
    ///
    /// # Errors
    /// When there is no such file, or it cannot be read or is too large.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, LoadError> {
        let file = file.as_ref();
        let unreadable = |source: io::Error| match source.kind() {
            io::ErrorKind::NotFound => LoadError::NoFile {
                path: file.to_owned(),
            },
            _ => LoadError::Unreadable {
                path: file.to_owned(),
                source,
            },
        };
        let path = fs::canonicalize(file).map_err(unreadable)?;
        // A device or a pipe may never end, or not even open.
        let metadata = fs::metadata(&path).map_err(unreadable)?;
        if !metadata.is_file() {
            return Err(LoadError::NoFile { path });
        }
        if metadata.len() > MOST_BYTES {
            return Err(too_large(path));
        }
        // One byte more, so that the end is found without more room.
        let mut bytes = Vec::with_capacity(metadata.len() as usize + 1);
        let reader = File::open(&path).map_err(unreadable)?;
        // The file may have grown.
        reader
            .take(MOST_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(unreadable)?;
        if bytes.len() as u64 > MOST_BYTES {
            return Err(too_large(path));
        }
        Ok(Self {
            path,
            bytes,
            sha256: OnceLock::new(),
            symbol: OnceLock::new(),
            copy: OnceLock::new(),
        })
    }

    /// Reads the libraries that lie directly in a folder, in the order of their names: the files
    /// `*.so`, `*.dylib` and `*.dll`.
    ///
    /// # Errors
    /// When the folder or one of the libraries cannot be read.
    pub fn read_folder(folder: impl AsRef<Path>) -> Result<Vec<Self>, LoadError> {
        let files = libraries_in(folder.as_ref())?;
        let read: Vec<_> = files.par_iter().map(Self::read).collect();
        read.into_iter().collect()
    }

    /// The absolute path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// SHA-256 of the bytes, in lower-case hexadecimal.
    pub fn sha256(&self) -> &str {
        self.sha256.get_or_init(|| sha256_hex(&self.bytes))
    }

    /// What the loader will get, so that another process can try it; `None` if the library is refused before.
    ///
    /// # Errors
    /// When the bytes cannot be copied.
    pub fn loadable(&self) -> Result<Option<Loadable>, LoadError> {
        let Ok(symbol) = self.symbol() else {
            return Ok(None);
        };
        Ok(Some(Loadable {
            file: self.copy()?.file().to_owned(),
            symbol: symbol.to_owned(),
        }))
    }

    /// The symbol of the entry.
    fn symbol(&self) -> Result<&str, LoadError> {
        let check = || image::entry_symbol(&self.bytes, &self.stem());
        let symbol = self.symbol.get_or_init(check).as_deref();
        symbol.map_err(|refusal| self.refused(refusal.clone()))
    }

    fn copy(&self) -> Result<&PrivateCopy, LoadError> {
        if let Some(copy) = self.copy.get() {
            return Ok(copy);
        }
        let copy = PrivateCopy::of(&self.bytes).map_err(|source| LoadError::NoCopy {
            path: self.path.clone(),
            folder: std::env::temp_dir(),
            source,
        })?;
        Ok(self.copy.get_or_init(|| copy))
    }

    /// Checks and loads the library. The same bytes are loaded only once in a program.
    ///
    /// # Errors
    /// When the library is not a plugin for this program, or cannot be loaded.
    pub(crate) fn load(&self) -> Result<Library, LoadError> {
        static LOADED: Mutex<Option<HashMap<(String, String), Library>>> = Mutex::new(None);
        let symbol = self.symbol()?;
        // A panic while the lock is held leaves a valid map: each library in it is loaded.
        let mut loaded = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
        let loaded = loaded.get_or_insert_default();
        let key = (self.sha256().to_owned(), symbol.to_owned());
        if let Some(library) = loaded.get(&key) {
            return Ok(library.clone());
        }
        let library = self.load_anew(symbol)?;
        loaded.insert(key, library.clone());
        Ok(library)
    }

    fn stem(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }

    fn refused(&self, refusal: Refusal) -> LoadError {
        let path = self.path.clone();
        LoadError::Refused { path, refusal }
    }

    fn load_anew(&self, symbol: &str) -> Result<Library, LoadError> {
        let copy = self.copy()?;
        let text = format!("the library {}", self.path.display());
        let library = Callee::new(printable_line(&text).into_owned(), true);
        let mark = library.enter();
        let offers = native::load(copy.file(), symbol)
            .map_err(|error| self.refused(refusal(error, copy.file(), &self.path)))?;
        drop(mark);
        Ok(Library {
            crate_name: symbol.replacen(SYMBOL_PREFIX, "", 1),
            version: offers.first().map_or("", Offer::crate_version).to_owned(),
            offers,
        })
    }
}

/// The refusal, with the name of the user's file instead of that of the copy.
fn refusal(error: NativeError, copy: &Path, path: &Path) -> Refusal {
    match error {
        NativeError::Open(error) => error.into(),
        NativeError::Loader(reason) => {
            let (copy, path) = (copy.to_string_lossy(), path.to_string_lossy());
            let reason = reason
                .replace(&format!("{copy}: "), "")
                .replace(&*copy, &path);
            let cannot_map = reason.contains("failed to map") || reason.contains("not permitted");
            let hint = cannot_map.then_some(NOEXEC_HINT);
            Refusal::Loader { reason, hint }
        }
    }
}

fn libraries_in(folder: &Path) -> Result<Vec<PathBuf>, LoadError> {
    let entries = fs::read_dir(folder).map_err(|source| folder_error(folder, source))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(|source| folder_error(folder, source))?.path();
        if is_library_name(&path) && !path.is_dir() {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn is_library_name(path: &Path) -> bool {
    let extension = path.extension().and_then(OsStr::to_str);
    extension.is_some_and(|extension| EXTENSIONS.contains(&extension))
}

fn folder_error(folder: &Path, source: io::Error) -> LoadError {
    let path = folder.to_owned();
    match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => LoadError::NoFolder { path },
        _ => LoadError::Unreadable { path, source },
    }
}

fn too_large(path: PathBuf) -> LoadError {
    let refusal = Refusal::TooLarge { limit: MOST_BYTES };
    LoadError::Refused { path, refusal }
}
