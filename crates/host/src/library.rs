//! One library. It is read once; the bytes that were hashed are checked and loaded.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use turnpath_core::printable_line;
use turnpath_files::{DraftKind, Registration, begin_draft};
use turnpath_plugin::Offer;
use turnpath_plugin::calls::Callee;
use turnpath_plugin::loading::SYMBOL_PREFIX;

use crate::hash::sha256_hex;
use crate::native::{self, NativeError};
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
    sha256: String,
    bytes: Vec<u8>,
}

impl fmt::Debug for LibraryFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("LibraryFile");
        shown
            .field("path", &self.path)
            .field("sha256", &self.sha256);
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
        let mut bytes = Vec::new();
        let reader = File::open(&path).map_err(unreadable)?;
        // The file may have grown.
        reader
            .take(MOST_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(unreadable)?;
        if bytes.len() as u64 > MOST_BYTES {
            return Err(too_large(path));
        }
        let sha256 = sha256_hex(&bytes);
        Ok(Self {
            path,
            sha256,
            bytes,
        })
    }

    /// Reads the libraries that lie directly in a folder, in the order of their names: the files
    /// `*.so`, `*.dylib` and `*.dll`.
    ///
    /// # Errors
    /// When the folder or one of the libraries cannot be read.
    pub fn read_folder(folder: impl AsRef<Path>) -> Result<Vec<Self>, LoadError> {
        libraries_in(folder.as_ref())?
            .iter()
            .map(Self::read)
            .collect()
    }

    /// The absolute path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// SHA-256 of the bytes, in lower-case hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Checks and loads the library. The same bytes are loaded only once in a program.
    ///
    /// # Errors
    /// When the library is not a plugin for this program, or cannot be loaded.
    pub(crate) fn load(&self) -> Result<Library, LoadError> {
        static LOADED: Mutex<Option<HashMap<(String, String), Library>>> = Mutex::new(None);
        let symbol = image::entry_symbol(&self.bytes, &self.stem())
            .map_err(|refusal| self.refused(refusal))?;
        // A panic while the lock is held leaves a valid map: each library in it is loaded.
        let mut loaded = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
        let loaded = loaded.get_or_insert_default();
        let key = (self.sha256.clone(), symbol);
        if let Some(library) = loaded.get(&key) {
            return Ok(library.clone());
        }
        let library = self.load_anew(&key.1)?;
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
        let copy = PrivateCopy::of(&self.bytes).map_err(|source| LoadError::NoCopy {
            path: self.path.clone(),
            folder: std::env::temp_dir(),
            source,
        })?;
        let text = format!("the library {}", self.path.display());
        let library = Callee::new(printable_line(&text).into_owned(), true);
        let mark = library.enter();
        let offers = native::load(&copy.file, symbol)
            .map_err(|error| self.refused(refusal(error, &copy.file, &self.path)))?;
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

/// A copy of the bytes in a file that no other user can read or change. It exists as long as the
/// loader needs it.
struct PrivateCopy {
    file: PathBuf,
    // Dropped in this order: whenever a signal comes, somebody removes folder and file.
    /// The folder removes itself and the file when it is dropped.
    _folder: tempfile::TempDir,
    /// A library that ends the process while it is loaded leaves neither file nor folder.
    _drafts: [Registration; 2],
}

impl PrivateCopy {
    fn of(bytes: &[u8]) -> io::Result<Self> {
        let (mut folder, of_folder) = begin_draft(|| {
            let folder = tempfile::Builder::new().prefix("turnpath-").tempdir()?;
            let registration = Registration::new(DraftKind::Folder, folder.path());
            Ok::<_, io::Error>((folder, registration))
        })?;
        // Windows keeps the file of a loaded library; its folder for temporary files belongs to the
        // user alone.
        folder.disable_cleanup(cfg!(windows));
        // Windows reads a name without an extension as one that ends in .dll.
        let name = format!("plugin{}", std::env::consts::DLL_SUFFIX);
        let file = fs::canonicalize(folder.path())?.join(name);
        let drafts = [of_folder, Registration::new(DraftKind::File, &file)];
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        options.open(&file)?.write_all(bytes)?;
        Ok(Self {
            file,
            _folder: folder,
            _drafts: drafts,
        })
    }
}
