//! Where the loader finds the bytes that were checked.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};

use turnpath_files::{DraftKind, Registration, begin_draft};

/// A copy of the bytes in a file that no other user can read or change. It goes when this is dropped.
pub(crate) struct PrivateCopy {
    file: PathBuf,
    // Dropped in this order: whenever a signal comes, somebody removes file and folder.
    /// A library that ends the process while it is loaded leaves neither.
    _draft: Registration,
    _folder: Arc<PrivateFolder>,
}

/// The folder of all copies. It goes with the last of them.
struct PrivateFolder {
    path: PathBuf,
    // Dropped in this order, as above.
    _folder: tempfile::TempDir,
    _draft: Registration,
}

impl PrivateCopy {
    /// Writes these bytes into a file of their own.
    pub(crate) fn of(bytes: &[u8]) -> io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let folder = PrivateFolder::present()?;
        // Windows reads a name without an extension as one that ends in .dll.
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("plugin-{number}{}", std::env::consts::DLL_SUFFIX);
        let file = folder.path.join(name);
        let copy = Self {
            _draft: Registration::new(DraftKind::File, &file),
            _folder: folder,
            file,
        };
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        options.open(&copy.file)?.write_all(bytes)?;
        Ok(copy)
    }

    /// The copy, to be read. It can be read even after its name is gone.
    pub(crate) fn open(&self) -> io::Result<File> {
        File::open(&self.file)
    }

    /// Where the bytes are.
    pub(crate) fn file(&self) -> &Path {
        &self.file
    }
}

impl Drop for PrivateCopy {
    fn drop(&mut self) {
        // Windows keeps the file of a loaded library; its folder for temporary files belongs to the user
        // alone. Elsewhere the folder removes what this does not.
        let _ = fs::remove_file(&self.file);
    }
}

impl PrivateFolder {
    /// That of the other copies, or a new one.
    fn present() -> io::Result<Arc<Self>> {
        static PRESENT: Mutex<Weak<PrivateFolder>> = Mutex::new(Weak::new());
        let mut present = PRESENT.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(folder) = present.upgrade() {
            return Ok(folder);
        }
        let folder = Arc::new(Self::new()?);
        *present = Arc::downgrade(&folder);
        Ok(folder)
    }

    fn new() -> io::Result<Self> {
        let (mut folder, draft) = begin_draft(|| {
            let folder = tempfile::Builder::new().prefix("turnpath-").tempdir()?;
            let registration = Registration::new(DraftKind::Folder, folder.path());
            Ok::<_, io::Error>((folder, registration))
        })?;
        folder.disable_cleanup(cfg!(windows));
        Ok(Self {
            path: fs::canonicalize(folder.path())?,
            _folder: folder,
            _draft: draft,
        })
    }
}
