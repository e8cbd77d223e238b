//! A file without a name, for what waits until it is put into another.

use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

use twox_hash::xxhash3_128;

use crate::operation::{Operation, announce, perform};

/// Size of the buffer, bytes.
const BUFFER: usize = 1 << 18;
/// Bytes that are moved before their room is given back: many calls of the system cost more than the room.
const GIVEN_BACK: u64 = 1 << 26;

/// A file without a name: it goes with the process that made it, however that ends.
#[derive(Debug)]
pub struct Scratch {
    file: BufWriter<NamelessFile>,
}

#[derive(Debug)]
struct NamelessFile {
    file: File,
    /// For those who watch.
    folder: PathBuf,
}

impl Scratch {
    /// An empty file on the file system of this folder.
    ///
    /// # Errors
    /// When the folder takes no file.
    pub fn in_folder(folder: &Path) -> io::Result<Self> {
        let file = perform(Operation::Create, folder, || tempfile::tempfile_in(folder))?;
        let folder = folder.to_owned();
        let file = NamelessFile { file, folder };
        Ok(Self {
            file: BufWriter::with_capacity(BUFFER, file),
        })
    }

    /// All that was written, from its beginning.
    ///
    /// # Errors
    /// When the file cannot be written or read.
    pub fn into_reader(self) -> io::Result<ScratchReader> {
        let file = self.file.into_inner();
        let NamelessFile { mut file, folder } = file.map_err(io::IntoInnerError::into_error)?;
        perform(Operation::Read, &folder, || file.rewind())?;
        let sum = xxhash3_128::Hasher::new();
        Ok(ScratchReader { file, sum })
    }
}

/// Reads what was written to a scratch file. It keeps a sum of 128 bits, so that two readings can be compared.
pub struct ScratchReader {
    file: File,
    /// Of what was read since the beginning.
    sum: xxhash3_128::Hasher,
}

impl ScratchReader {
    /// Goes back to the beginning.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn rewind(&mut self) -> io::Result<()> {
        self.sum = xxhash3_128::Hasher::new();
        self.file.rewind()
    }

    /// Reads to the end. Gives the sum of the whole reading since the beginning.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn sum_to_end(&mut self) -> io::Result<u128> {
        io::copy(self, &mut io::sink())?;
        Ok(self.sum.finish_128())
    }

    /// Moves all of it, from the beginning, and gives the sum of what was moved. What has been moved takes no
    /// room any more, where the system can give it back.
    ///
    /// # Errors
    /// When the file cannot be read, or the other one cannot be written.
    pub fn move_to(mut self, to: &mut impl Write) -> io::Result<u128> {
        self.rewind()?;
        let mut buffer = vec![0; BUFFER];
        let (mut moved, mut given_back) = (0, 0);
        loop {
            let read = match self.read(&mut buffer) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                read => read?,
            };
            if read == 0 {
                return Ok(self.sum.finish_128());
            }
            to.write_all(buffer.get(..read).unwrap_or_default())?;
            moved += read as u64;
            if moved - given_back >= GIVEN_BACK {
                give_back(&self.file, given_back, moved - given_back);
                given_back = moved;
            }
        }
    }
}

impl Read for ScratchReader {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(bytes)?;
        self.sum.write(bytes.get(..read).unwrap_or_default());
        Ok(read)
    }
}

impl fmt::Debug for ScratchReader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("ScratchReader");
        shown.field("file", &self.file).finish_non_exhaustive()
    }
}

/// Gives the room of bytes that nobody will read back to the file system and to its cache.
#[cfg(target_os = "linux")]
fn give_back(file: &File, from: u64, bytes: u64) {
    use rustix::fs::{FallocateFlags, fallocate};
    // Not every file system can; the room then goes with the file.
    let hole = FallocateFlags::PUNCH_HOLE | FallocateFlags::KEEP_SIZE;
    let _ = fallocate(file, hole, from, bytes);
}

/// Elsewhere the room goes with the file.
#[cfg(not(target_os = "linux"))]
fn give_back(_: &File, _: u64, _: u64) {}

impl Write for Scratch {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Write for NamelessFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        announce(Operation::Write, &self.folder)?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reader(bytes: &[u8]) -> ScratchReader {
        let folder = tempfile::tempdir().unwrap();
        let mut scratch = Scratch::in_folder(folder.path()).unwrap();
        scratch.write_all(bytes).unwrap();
        scratch.into_reader().unwrap()
    }

    #[test]
    fn what_is_moved_has_the_bytes_and_the_sum_of_what_was_read() {
        // Three pieces whose room is given back, and the beginning of a fourth.
        let bytes: Vec<u8> = (0..3 * GIVEN_BACK + 12_345)
            .map(|k| (k % 251) as u8)
            .collect();
        let mut reader = reader(&bytes);
        let sum = reader.sum_to_end().unwrap();
        let mut moved = Vec::new();
        assert_eq!(reader.move_to(&mut moved).unwrap(), sum);
        assert!(moved == bytes);
    }

    #[test]
    fn the_sum_is_that_of_the_whole_reading_however_far_it_went() {
        let mut reader = reader(b"a path of a program");
        let sum = reader.sum_to_end().unwrap();
        reader.rewind().unwrap();
        reader.read_exact(&mut [0; 7]).unwrap();
        assert_eq!(reader.sum_to_end().unwrap(), sum);
        let other = self::reader(b"a path of A program").sum_to_end().unwrap();
        assert_ne!(other, sum);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn what_changes_between_two_readings_has_another_sum() {
        use std::os::fd::AsRawFd;
        let mut reader = reader(b"a path of a program");
        let sum = reader.sum_to_end().unwrap();
        let name = format!("/proc/self/fd/{}", reader.file.as_raw_fd());
        let mut file = File::options().write(true).open(name).unwrap();
        file.write_all(b"A").unwrap();
        assert_ne!(reader.move_to(&mut Vec::new()).unwrap(), sum);
    }
}
