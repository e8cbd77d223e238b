//! One library. Its file is read once; what was read is checked, copied, hashed and loaded.

use std::ffi::OsStr;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::native;
use crate::private_copy::PrivateCopy;
use crate::{LoadError, Refusal, SourceHash, image};

/// Largest library. A plugin with all its debug information has a tenth of that; the limit is on the
/// memory that a file can take.
const MOST_BYTES: u64 = 1 << 28;
/// How many libraries of one folder have copies that stay open, so that they can be hashed later.
/// Libraries of larger folders are hashed as they are read: systems allow a program some hundreds of
/// open files.
const MOST_OPEN: usize = 64;
/// The extensions of libraries. A plugin folder may hold other files too.
const EXTENSIONS: [&str; 3] = ["so", "dylib", "dll"];

/// A library's file, as it was when it was read. The file is not read again: a private copy of its
/// bytes is loaded. The copy is hashed too, unless the bytes were hashed as they were read.
pub struct LibraryFile {
    path: PathBuf,
    checked: Result<CheckedCopy, Refusal>,
    hash: SourceHash,
}

/// A private copy of bytes that passed the checks.
pub(crate) struct CheckedCopy {
    /// The symbol of the entry.
    pub symbol: String,
    /// Where the loader finds the bytes.
    pub copy: PrivateCopy,
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
    /// Loads the library, as a [`Catalogue`](crate::Catalogue) of another process will. Nothing comes
    /// of a library that the loader or the boundary refuses, or whose symbol is not that of an entry.
    pub fn try_load(&self) {
        if let Ok(entry) = native::load(&self.file, &self.symbol)
            && let Ok(None) = entry.offers_if_not_newer()
        {
            let _ = entry.offers_of_newer();
        }
    }
}

impl fmt::Debug for LibraryFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("LibraryFile");
        shown.field("path", &self.path).field("hash", &self.hash);
        shown.finish_non_exhaustive()
    }
}

impl LibraryFile {
    /// Reads a library, checks it, and copies what passes.
    ///
    /// # Errors
    /// When there is no such file, or it cannot be read or copied, or is too large.
    pub fn read(file: impl AsRef<Path>) -> Result<Self, LoadError> {
        Self::read_with(&mut Vec::new(), file.as_ref(), false)
    }

    /// Reads the libraries that lie directly in a folder, in the order of their names: the files
    /// `*.so`, `*.dylib` and `*.dll`.
    ///
    /// # Errors
    /// When the folder or one of the libraries cannot be read, or what passes cannot be copied.
    pub fn read_folder(folder: impl AsRef<Path>) -> Result<Vec<Self>, LoadError> {
        let files = libraries_in(folder.as_ref())?;
        let hash_now = files.len() > MOST_OPEN;
        let share = files.len().div_ceil(rayon::current_num_threads()).max(1);
        let read = files.par_chunks(share).flat_map_iter(|files| {
            let mut buffer = Vec::new();
            let read = |file: &PathBuf| Self::read_with(&mut buffer, file, hash_now);
            files.iter().map(read).collect::<Vec<_>>()
        });
        let read: Vec<_> = read.collect();
        read.into_iter().collect()
    }

    /// Reads a library through a buffer. Fresh memory for each library would take longer than the
    /// reading.
    fn read_with(buffer: &mut Vec<u8>, file: &Path, hash_now: bool) -> Result<Self, LoadError> {
        let path = read_bytes(buffer, file)?;
        let symbol = match image::entry_symbol(buffer, &stem(&path)) {
            Ok(symbol) => symbol,
            Err(refusal) => {
                return Ok(Self {
                    path,
                    checked: Err(refusal),
                    // There is no copy that could be hashed later.
                    hash: SourceHash::of(buffer),
                });
            }
        };
        let hashable = |copy: &PrivateCopy| match hash_now {
            true => Ok(SourceHash::of(buffer)),
            false => SourceHash::of_copy(path.clone(), copy.open()?),
        };
        let copy = PrivateCopy::of(buffer);
        let with_hash = copy.and_then(|copy| Ok((hashable(&copy)?, copy)));
        let (hash, copy) = with_hash.map_err(|source| LoadError::NoCopy {
            path: path.clone(),
            folder: std::env::temp_dir(),
            source,
        })?;
        Ok(Self {
            path,
            checked: Ok(CheckedCopy { symbol, copy }),
            hash,
        })
    }

    /// The absolute path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// SHA-256 of the bytes, in lower-case hexadecimal.
    ///
    /// # Errors
    /// When the copy of the bytes cannot be read.
    pub fn sha256(&self) -> Result<&str, LoadError> {
        Ok(self.hash.hex()?)
    }

    /// The hash, which may still have to be calculated.
    pub(crate) fn hash(&self) -> &SourceHash {
        &self.hash
    }

    /// What the loader will get, so that another process can try it; `None` if the library is refused
    /// before.
    pub fn loadable(&self) -> Option<Loadable> {
        let CheckedCopy { symbol, copy } = self.checked.as_ref().ok()?;
        Some(Loadable {
            file: copy.file().to_owned(),
            symbol: symbol.clone(),
        })
    }

    /// The copy that the loader gets, if the library passed the checks.
    ///
    /// # Errors
    /// When it did not.
    pub(crate) fn checked(&self) -> Result<&CheckedCopy, LoadError> {
        let checked = self.checked.as_ref();
        checked.map_err(|refusal| self.refused(refusal.clone()))
    }

    /// The error of a library that is refused.
    pub(crate) fn refused(&self, refusal: Refusal) -> LoadError {
        let path = self.path.clone();
        LoadError::Refused { path, refusal }
    }
}

/// Puts the bytes of a library's file into a buffer, and gives the file's absolute path.
fn read_bytes(buffer: &mut Vec<u8>, file: &Path) -> Result<PathBuf, LoadError> {
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
    buffer.clear();
    // One byte more, so that the end is found without more room.
    buffer.reserve(metadata.len() as usize + 1);
    let reader = File::open(&path).map_err(unreadable)?;
    // The file may have grown.
    let mut reader = reader.take(MOST_BYTES + 1);
    reader.read_to_end(buffer).map_err(unreadable)?;
    if buffer.len() as u64 > MOST_BYTES {
        return Err(too_large(path));
    }
    Ok(path)
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
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
        io::ErrorKind::NotADirectory if path.is_file() => LoadError::FileForFolder { path },
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => LoadError::NoFolder { path },
        _ => LoadError::Unreadable { path, source },
    }
}

fn too_large(path: PathBuf) -> LoadError {
    let refusal = Refusal::TooLarge { limit: MOST_BYTES };
    LoadError::Refused { path, refusal }
}
