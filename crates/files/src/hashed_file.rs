//! Bytes and their sums: a fast one as a file is written, and the SHA-256 as it reads back.

use std::fmt;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::thread;

use sha2::{Digest, Sha256};
use twox_hash::xxhash3_128;

use crate::operation::{Operation, announce, perform, uninterrupted};

/// Bytes of a file that are read at once.
const BUFFER: usize = 1 << 16;

/// How many bytes a file has, and their hash.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contents {
    /// The number of bytes.
    pub bytes: u64,
    /// Their SHA-256, in lower-case hexadecimal.
    pub sha256: String,
}

impl Contents {
    /// Those of a file, which is read piece by piece.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn of_file(path: &Path) -> io::Result<Self> {
        let mut sum = Sum::default();
        for_each_piece(path, |piece| sum.add(piece))?;
        Ok(sum.contents())
    }
}

/// What a file has so far.
#[derive(Debug, Default)]
struct Sum {
    hasher: Sha256,
    bytes: u64,
}

impl Sum {
    fn add(&mut self, piece: &[u8]) {
        self.hasher.update(piece);
        self.bytes += piece.len() as u64;
    }

    fn contents(self) -> Contents {
        let hash = self.hasher.finalize();
        Contents {
            bytes: self.bytes,
            sha256: hash.iter().map(|byte| format!("{byte:02x}")).collect(),
        }
    }
}

/// Reads a file to its end.
fn for_each_piece(path: &Path, mut take: impl FnMut(&[u8])) -> io::Result<()> {
    let mut file = perform(Operation::Read, path, || File::open(path))?;
    let mut buffer = vec![0; BUFFER];
    loop {
        match file.read(&mut buffer) {
            Ok(0) => return Ok(()),
            Ok(read) => take(buffer.get(..read).unwrap_or_default()),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// A file that is compared with what was written when it is finished. For that a fast sum is enough: nobody
/// chooses the bytes that a disk damages. It has 128 bits, and takes a tenth of the time of SHA-256.
pub struct HashedFile {
    file: File,
    path: PathBuf,
    written: xxhash3_128::Hasher,
}

impl HashedFile {
    /// An empty file.
    pub fn new(file: File, path: PathBuf) -> Self {
        Self {
            file,
            path,
            written: xxhash3_128::Hasher::new(),
        }
    }

    /// Brings the file to the disk, and compares what it has with what was written. The file is read while the
    /// disk takes it, since the system answers the reading from its memory either way.
    pub fn finish(self) -> io::Result<Contents> {
        let Self {
            file,
            path,
            written,
        } = self;
        // Operations are announced by one thread, in one order.
        perform(Operation::Sync, &path, || Ok(()))?;
        let sync = || uninterrupted(|| file.sync_all());
        let found = thread::scope(|scope| {
            let Ok(syncing) = thread::Builder::new().spawn_scoped(scope, sync) else {
                sync()?;
                return read_back(&path);
            };
            let found = read_back(&path);
            let synced = syncing.join();
            synced.unwrap_or_else(|_| Err(io::Error::other("it was not brought to the disk")))?;
            found
        });
        let (contents, sum) = found?;
        match written.finish_128() == sum {
            true => Ok(contents),
            false => Err(io::Error::other("it does not read back as it was written")),
        }
    }
}

/// What a file has, and its fast sum.
fn read_back(path: &Path) -> io::Result<(Contents, u128)> {
    let (mut sum, mut found) = (Sum::default(), xxhash3_128::Hasher::new());
    for_each_piece(path, |piece| {
        sum.add(piece);
        found.write(piece);
    })?;
    Ok((sum.contents(), found.finish_128()))
}

impl fmt::Debug for HashedFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HashedFile")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

impl Write for HashedFile {
    /// An interrupted call is the caller's to repeat, as everywhere in `std`.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        announce(Operation::Write, &self.path)?;
        let written = self.file.write(bytes)?;
        self.written.write(bytes.get(..written).unwrap_or_default());
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FIPS 180-2, appendices B.1 and B.3.
    #[test]
    fn the_standards_examples_have_these_hashes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        for (bytes, sha256) in [
            (
                b"abc".to_vec(),
                "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
            ),
            (
                vec![b'a'; 1_000_000],
                "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0",
            ),
        ] {
            let mut file = HashedFile::new(File::create(&path).unwrap(), path.clone());
            file.write_all(&bytes).unwrap();
            let contents = file.finish().unwrap();
            assert_eq!(contents.sha256, sha256);
            assert_eq!(contents.bytes, bytes.len() as u64);
        }
    }

    #[test]
    fn a_file_that_another_changes_meanwhile_is_not_finished() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let mut file = HashedFile::new(File::create(&path).unwrap(), path.clone());
        file.write_all(b"written").unwrap();
        std::fs::write(&path, "changed").unwrap();
        let error = file.finish().unwrap_err();
        assert!(error.to_string().contains("read back"), "{error}");
    }
}
