//! Opening a file that is one: a pipe may never give its first byte.

use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Opens a file for reading.
///
/// # Errors
/// When it cannot be opened, or is a pipe or a device.
pub fn open(path: &Path) -> io::Result<File> {
    let kind = fs::metadata(path)?.file_type();
    if kind.is_file() || kind.is_dir() {
        // A folder cannot be read, and the system says so.
        return File::open(path);
    }
    let what = "it is a pipe or a device; write what it gives into a file first";
    Err(io::Error::new(io::ErrorKind::InvalidInput, what))
}
