//! One library. It is read once; the bytes that were hashed are checked and loaded.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use turnpath_core::printable_line;
use turnpath_plugin::Offer;
use turnpath_plugin::calls::Callee;
use turnpath_plugin::loading::SYMBOL_PREFIX;

use crate::hash::sha256_hex;
use crate::native::{self, NativeError};
use crate::{LoadError, Refusal, image};

/// Largest plugin with its debug information. It limits the memory that a file can take.
const MOST_BYTES: u64 = 1 << 30;
/// Help for a complete file that the loader cannot map.
const NOEXEC_HINT: &str = "the folder for temporary files may be mounted without permission to \
                           execute; set TMPDIR to another";

/// The bytes of a library's file.
pub struct Image {
    /// The absolute path of the file.
    pub path: PathBuf,
    /// SHA-256 of `bytes`.
    pub sha256: String,
    bytes: Vec<u8>,
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

/// Reads a library. These bytes are hashed, checked and loaded; the file is not read again.
///
/// # Errors
/// When there is no such file, or it cannot be read or is too large.
pub fn read(file: &Path) -> Result<Image, LoadError> {
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
    if !fs::metadata(&path).map_err(unreadable)?.is_file() {
        return Err(LoadError::NoFile { path });
    }
    let mut bytes = Vec::new();
    let reader = File::open(&path).map_err(unreadable)?;
    reader
        .take(MOST_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    if bytes.len() as u64 > MOST_BYTES {
        let refusal = Refusal::TooLarge { limit: MOST_BYTES };
        return Err(LoadError::Refused { path, refusal });
    }
    let sha256 = sha256_hex(&bytes);
    Ok(Image {
        path,
        sha256,
        bytes,
    })
}

impl Image {
    /// Checks and loads the library. The same bytes are loaded only once in a program.
    ///
    /// # Errors
    /// When the library is not a plugin for this program, or cannot be loaded.
    pub fn load(&self) -> Result<Library, LoadError> {
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

/// A copy of the bytes in a file that no other user can read or change. It exists as long as the
/// loader needs it.
struct PrivateCopy {
    file: PathBuf,
    /// The folder removes itself and the file when it is dropped.
    _folder: tempfile::TempDir,
}

impl PrivateCopy {
    fn of(bytes: &[u8]) -> io::Result<Self> {
        let mut folder = tempfile::Builder::new().prefix("turnpath-").tempdir()?;
        // Windows keeps the file of a loaded library; its folder for temporary files belongs to the
        // user alone.
        folder.disable_cleanup(cfg!(windows));
        // Windows reads a name without an extension as one that ends in .dll.
        let name = format!("plugin{}", std::env::consts::DLL_SUFFIX);
        let file = fs::canonicalize(folder.path())?.join(name);
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        options.open(&file)?.write_all(bytes)?;
        Ok(Self {
            file,
            _folder: folder,
        })
    }
}
