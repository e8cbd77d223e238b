//! A file is read back by another thread, behind the one that writes it.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, JoinHandle};

use crate::read_back::ReadBack;

/// The thread that reads a file back, as far as it is written.
pub struct FollowingReader {
    /// Where the file ends so far; `None` once it gets no more bytes.
    ends: Option<Sender<u64>>,
    reading: Option<JoinHandle<Reading>>,
}

/// How far the file was read.
type Reading = io::Result<(File, ReadBack)>;

impl FollowingReader {
    /// Begins to read a file from its start.
    ///
    /// # Errors
    /// When the file cannot be opened, or the system has no thread.
    pub fn begin(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let (ends, later_ends) = mpsc::channel();
        let reading = thread::Builder::new().spawn(move || follow(file, &later_ends))?;
        Ok(Self {
            ends: Some(ends),
            reading: Some(reading),
        })
    }

    /// Says where the file ends now.
    pub fn go_to(&self, end: u64) {
        if let Some(ends) = &self.ends {
            // A reader that has failed says so in the end.
            let _ = ends.send(end);
        }
    }

    /// Reads the rest of the file, also what nobody said.
    ///
    /// # Errors
    /// When the file could not be read somewhere.
    pub fn finish(mut self) -> io::Result<ReadBack> {
        let (mut file, mut found) = self.end()?;
        found.add_all(&mut file)?;
        Ok(found)
    }

    fn end(&mut self) -> Reading {
        self.ends = None;
        let reading = self.reading.take().map(JoinHandle::join);
        let reading = reading.and_then(Result::ok);
        reading.unwrap_or_else(|| Err(io::Error::other("it was not read back")))
    }
}

/// A file that is given up is closed before it is removed.
impl Drop for FollowingReader {
    fn drop(&mut self) {
        let _ = self.end();
    }
}

fn follow(file: File, ends: &Receiver<u64>) -> Reading {
    let mut found = ReadBack::default();
    for end in ends {
        let new = end.saturating_sub(found.bytes());
        found.add_all((&file).take(new))?;
    }
    Ok((file, found))
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn a_file_that_grows_is_read_as_one_that_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let mut file = File::create(&path).unwrap();
        let reader = FollowingReader::begin(&path).unwrap();
        let mut end = 0;
        for piece in 0..200u32 {
            let bytes = vec![piece as u8; 1 + 997 * piece as usize];
            file.write_all(&bytes).unwrap();
            end += bytes.len() as u64;
            reader.go_to(end);
        }
        file.write_all(b"nobody says that these follow").unwrap();
        let whole = ReadBack::of_file(&path).unwrap();
        assert_eq!(reader.finish().unwrap().contents(), whole.contents());
    }
}
