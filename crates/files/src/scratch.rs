//! A file without a name, for what waits until it is put into another.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use crate::operation::{Operation, announce, perform};

/// Size of the buffer, bytes.
const BUFFER: usize = 1 << 18;

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
    pub fn into_reader(self) -> io::Result<File> {
        let file = self.file.into_inner();
        let NamelessFile { mut file, folder } = file.map_err(io::IntoInnerError::into_error)?;
        perform(Operation::Read, &folder, || file.rewind())?;
        Ok(file)
    }
}

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
