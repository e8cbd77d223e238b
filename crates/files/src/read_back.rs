//! What a file has as it reads back.

use std::fmt;
use std::io::{self, Read};
use std::path::Path;

use twox_hash::xxhash3_128;

use crate::contents::{Contents, Sum, for_each_piece, open};

/// What was read of a file so far: its SHA-256, and a fast sum, with which it is compared with what was
/// written.
#[derive(Default)]
pub struct ReadBack {
    sum: Sum,
    fast: xxhash3_128::Hasher,
}

impl ReadBack {
    /// A file as a whole.
    pub fn of_file(path: &Path) -> io::Result<Self> {
        let mut found = Self::default();
        found.add_all(open(path)?)?;
        Ok(found)
    }

    /// Adds what can be read.
    pub fn add_all(&mut self, file: impl Read) -> io::Result<()> {
        for_each_piece(file, |piece| {
            self.sum.add(piece);
            self.fast.write(piece);
        })
    }

    /// The number of bytes so far.
    pub fn bytes(&self) -> u64 {
        self.sum.bytes()
    }

    /// What was read, and its fast sum.
    pub fn contents(self) -> (Contents, u128) {
        (self.sum.contents(), self.fast.finish_128())
    }
}

impl fmt::Debug for ReadBack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ReadBack")
            .field("bytes", &self.bytes())
            .finish_non_exhaustive()
    }
}
