//! A file is read back by another thread, behind the one that writes it.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, JoinHandle};

use crate::read_back::ReadBack;

/// The thread that reads a file back, as far as it is written.
pub struct FollowingReader {
    /// Tells the thread how long the file is.
    lengths: Option<Sender<u64>>,
    is_given_up: Arc<AtomicBool>,
    thread: Option<JoinHandle<Reading>>,
}

/// The file and what was read of it, or why it cannot be read.
type Reading = io::Result<(File, ReadBack)>;

impl FollowingReader {
    /// Begins to read a file from its start.
    ///
    /// # Errors
    /// When the file cannot be opened, or the system has no thread.
    pub fn begin(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let (sender, lengths) = mpsc::channel();
        let is_given_up = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&is_given_up);
        let thread = thread::Builder::new().spawn(move || follow(file, &lengths, &seen))?;
        Ok(Self {
            lengths: Some(sender),
            is_given_up,
            thread: Some(thread),
        })
    }

    /// Says how long the file is now.
    pub fn go_to(&self, length: u64) {
        if let Some(lengths) = &self.lengths {
            // A reader that has failed says so in the end.
            let _ = lengths.send(length);
        }
    }

    /// Reads the rest of the file, also what nobody said.
    ///
    /// # Errors
    /// When the file could not be read somewhere.
    pub fn finish(mut self) -> io::Result<ReadBack> {
        let reading = self.join();
        let reading = reading.unwrap_or_else(|| Err(io::Error::other("it was not read back")));
        let (mut file, mut found) = reading?;
        found.add_all(&mut file)?;
        Ok(found)
    }

    /// Waits for the thread; `None` if it has ended by a panic, or was waited for before.
    fn join(&mut self) -> Option<Reading> {
        self.lengths = None;
        let thread = self.thread.take()?;
        thread.join().ok()
    }
}

/// A file that is given up is closed before it is removed, and not read to its end.
impl Drop for FollowingReader {
    fn drop(&mut self) {
        self.is_given_up.store(true, Ordering::Relaxed);
        let _ = self.join();
    }
}

fn follow(file: File, lengths: &Receiver<u64>, is_given_up: &AtomicBool) -> Reading {
    let mut found = ReadBack::default();
    for length in lengths {
        if is_given_up.load(Ordering::Relaxed) {
            break;
        }
        let new = length.saturating_sub(found.bytes());
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
        let mut length = 0;
        for piece in 0..200u32 {
            let bytes = vec![piece as u8; 1 + 997 * piece as usize];
            file.write_all(&bytes).unwrap();
            length += bytes.len() as u64;
            reader.go_to(length);
        }
        file.write_all(b"nobody says that these follow").unwrap();
        let whole = ReadBack::of_file(&path).unwrap();
        assert_eq!(reader.finish().unwrap().contents(), whole.contents());
    }

    #[test]
    fn a_file_that_cannot_be_opened_has_no_reader() {
        let folder = tempfile::tempdir().unwrap();
        assert!(FollowingReader::begin(&folder.path().join("none")).is_err());
    }
}
