//! How many bytes there are, and their SHA-256.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::operation::{Operation, perform};

/// Bytes that are read at once.
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
        for_each_piece(open(path)?, |piece| sum.add(piece))?;
        Ok(sum.contents())
    }
}

/// What there is so far.
#[derive(Debug, Default)]
pub struct Sum {
    hasher: Sha256,
    bytes: u64,
}

impl Sum {
    /// Adds what follows.
    pub fn add(&mut self, piece: &[u8]) {
        self.hasher.update(piece);
        self.bytes += piece.len() as u64;
    }

    /// The number of bytes so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// What there is.
    pub fn contents(self) -> Contents {
        let hash = self.hasher.finalize();
        Contents {
            bytes: self.bytes,
            sha256: hash.iter().map(|byte| format!("{byte:02x}")).collect(),
        }
    }
}

/// Opens a file that is read back.
pub fn open(path: &Path) -> io::Result<File> {
    perform(Operation::Read, path, || File::open(path))
}

/// Reads to the end.
pub fn for_each_piece(mut file: impl Read, mut take: impl FnMut(&[u8])) -> io::Result<()> {
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
