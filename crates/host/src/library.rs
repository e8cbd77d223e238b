//! One library: read once, checked, and loaded from exactly the bytes that were hashed.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use sha2::{Digest, Sha256};
use turnpath_plugin::Offer;
use turnpath_plugin::loading::SYMBOL_PREFIX;

use crate::native::{self, NativeError};
use crate::{LoadError, Refusal, image};

/// No plugin is larger, debug information included; it bounds the memory that a file can claim.
const MOST_BYTES: u64 = 1 << 30;
/// What may help when the loader cannot map a file that is whole.
const NOEXEC_HINT: &str = "the folder for temporary files may be mounted without permission to \
                           execute; set TMPDIR to another";

/// A library's file, read.
pub struct Image {
    /// Its absolute path.
    pub path: PathBuf,
    /// SHA-256 of `bytes`.
    pub sha256: String,
    bytes: Vec<u8>,
}

/// A library, loaded.
#[derive(Debug, Clone)]
pub struct Library {
    /// The crate that exports the plugin.
    pub crate_name: String,
    /// That crate's version.
    pub version: String,
    /// Its strategies.
    pub offers: Vec<Offer>,
}

/// Reads a library, once: what is hashed, checked and loaded are these bytes.
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
    // A device or a pipe would not end, or not even open.
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
    let sha256 = hexadecimal(&Sha256::digest(&bytes));
    Ok(Image {
        path,
        sha256,
        bytes,
    })
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Image {
    /// Checks and loads the library. The same bytes are loaded once in a program.
    pub fn load(&self) -> Result<Library, LoadError> {
        static LOADED: Mutex<Option<HashMap<(String, String), Library>>> = Mutex::new(None);
        let symbol = image::entry_symbol(&self.bytes, &self.stem())
            .map_err(|refusal| self.refused(refusal))?;
        // A panic while the lock is held leaves nothing half done: what is in the map is loaded.
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
        let offers = native::load(&copy.file, symbol)
            .map_err(|error| self.refused(refusal(error, &copy.file, &self.path)))?;
        Ok(Library {
            crate_name: symbol.replacen(SYMBOL_PREFIX, "", 1),
            version: offers.first().map_or("", Offer::crate_version).to_owned(),
            offers,
        })
    }
}

/// Says it with the name of the user's file, not with that of the copy.
fn refusal(error: NativeError, copy: &Path, path: &Path) -> Refusal {
    match error {
        NativeError::Open(error) => error.into(),
        NativeError::Loader(reason) => {
            let (copy, path) = (copy.to_string_lossy(), path.to_string_lossy());
            let reason = reason
                .replace(&format!("{copy}: "), "")
                .replace(&*copy, &path);
            let unmapped = reason.contains("failed to map") || reason.contains("not permitted");
            let hint = unmapped.then_some(NOEXEC_HINT);
            Refusal::Loader { reason, hint }
        }
    }
}

/// The bytes in a file that no other user can read or change, for as long as the loader needs it.
struct PrivateCopy {
    file: PathBuf,
    /// Removes itself, with the file, when dropped.
    _folder: tempfile::TempDir,
}

impl PrivateCopy {
    fn of(bytes: &[u8]) -> io::Result<Self> {
        let mut folder = tempfile::Builder::new().prefix("turnpath-").tempdir()?;
        // Windows keeps a loaded library's file; its folder for temporary files is the user's own.
        folder.disable_cleanup(cfg!(windows));
        // Windows takes a name without an ending for one that ends in .dll.
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
