//! A file with a fast sum of what is written, and the SHA-256 of what reads back.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::PathBuf;
use std::thread;

use twox_hash::xxhash3_128;

use crate::contents::Contents;
use crate::following_reader::FollowingReader;
use crate::operation::{Operation, announce, perform, uninterrupted};
use crate::read_back::ReadBack;

/// What is said of a file that has other bytes.
const OTHER: &str = "it does not read back as it was written";

/// A file that is compared with what was written when it is finished. For that a fast sum is enough: nobody
/// chooses the bytes that a disk damages. It has 128 bits, and takes a tenth of the time of SHA-256.
pub struct HashedFile {
    file: File,
    path: PathBuf,
    written: xxhash3_128::Hasher,
    bytes: u64,
    /// Who reads the file while it is written.
    reader: Option<FollowingReader>,
}

impl HashedFile {
    /// An empty file.
    pub fn new(file: File, path: PathBuf) -> Self {
        Self {
            file,
            path,
            written: xxhash3_128::Hasher::new(),
            bytes: 0,
            reader: None,
        }
    }

    /// From now on another thread reads the file back while it is written, so that there is little left to
    /// read in the end. Where the file cannot be opened, or there is no thread, it is read in the end.
    pub fn read_while_written(&mut self) {
        self.reader = FollowingReader::begin(&self.path).ok();
        if let Some(reader) = &self.reader {
            reader.go_to(self.bytes);
        }
    }

    /// Brings the file to the disk, and compares what it has with what was written. The file, or the rest of it,
    /// is read while the disk takes it, since the system answers the reading from its memory either way.
    pub fn finish(self) -> io::Result<Contents> {
        let Self {
            file,
            path,
            written,
            bytes: _,
            reader,
        } = self;
        // Operations are announced by one thread, in one order.
        perform(Operation::Sync, &path, || Ok(()))?;
        let sync = || uninterrupted(|| file.sync_all());
        let read_back = || match reader {
            Some(reader) => {
                // Who reads by the file and not by its name does not see that another one has cut it short.
                let length = perform(Operation::Read, &path, || Ok(fs::metadata(&path)?.len()))?;
                reader
                    .finish()
                    .and_then(|found| match found.bytes() == length {
                        true => Ok(found),
                        false => Err(io::Error::other(OTHER)),
                    })
            }
            None => ReadBack::of_file(&path),
        };
        let found = thread::scope(|scope| {
            let Ok(syncing) = thread::Builder::new().spawn_scoped(scope, sync) else {
                sync()?;
                return read_back();
            };
            let found = read_back();
            let synced = syncing.join();
            synced.unwrap_or_else(|_| Err(io::Error::other("it was not brought to the disk")))?;
            found
        });
        let (contents, sum) = found?.contents();
        match written.finish_128() == sum {
            true => Ok(contents),
            false => Err(io::Error::other(OTHER)),
        }
    }
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
        self.bytes += written as u64;
        if let Some(reader) = &self.reader {
            reader.go_to(self.bytes);
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

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
        for other in ["changed", "writte", "written!"] {
            let mut file = HashedFile::new(File::create(&path).unwrap(), path.clone());
            file.write_all(b"written").unwrap();
            std::fs::write(&path, other).unwrap();
            let error = file.finish().unwrap_err();
            assert!(error.to_string().contains("read back"), "{error}");
        }
    }

    #[test]
    fn a_file_that_is_read_while_it_is_written_has_the_same_contents() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let finished = |begin_at: usize, add: &[u8]| {
            let mut file = HashedFile::new(File::create(&path).unwrap(), path.clone());
            for piece in 0..100 {
                if piece == begin_at {
                    file.read_while_written();
                }
                file.write_all(&vec![b'a' + (piece % 26) as u8; 10_007])
                    .unwrap();
            }
            let mut other = File::options().append(true).open(&path).unwrap();
            other.write_all(add).unwrap();
            file.finish()
        };
        let alone = finished(usize::MAX, b"").unwrap();
        assert_eq!(alone, Contents::of_file(&path).unwrap());
        for begin_at in [0, 50, 99] {
            assert_eq!(finished(begin_at, b"").unwrap(), alone);
            let error = finished(begin_at, b"of another").unwrap_err();
            assert!(error.to_string().contains("read back"), "{error}");
        }
    }

    /// Whatever was read before.
    #[test]
    fn a_file_that_another_cuts_short_or_removes_is_not_finished() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let spoils: [fn(&Path); 2] = [
            |path| {
                File::options()
                    .write(true)
                    .open(path)
                    .unwrap()
                    .set_len(3)
                    .unwrap()
            },
            |path| fs::remove_file(path).unwrap(),
        ];
        for spoil in spoils {
            let mut file = HashedFile::new(File::create(&path).unwrap(), path.clone());
            file.read_while_written();
            file.write_all(&vec![b'a'; 1_000_000]).unwrap();
            // The reader has most of it by now.
            std::thread::sleep(std::time::Duration::from_millis(20));
            spoil(&path);
            assert!(file.finish().is_err());
        }
    }
}
