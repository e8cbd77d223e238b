//! Small files that others may have put there: read up to a limit, and never waited for.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// The bytes of a file of at most `most` bytes. What is no file is not opened, since a pipe may never
/// have a writer; and no more than the limit is read, however large the file is.
///
/// # Errors
/// When there is no such file, when it cannot be read, when it is a folder, a pipe or a device, or
/// when it is larger.
pub fn read_bounded(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let found = fs::metadata(path)?;
    let refused = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
    if !found.is_file() {
        return Err(refused("it is a folder, a pipe or a device".to_owned()));
    }
    let too_large = || refused(format!("it is larger than {most} bytes"));
    if found.len() > most {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    // The file may have grown.
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(too_large()),
        false => Ok(bytes),
    }
}

/// The text of a file, read like the bytes of [`read_bounded`].
///
/// # Errors
/// The same, and when the bytes are no UTF-8.
pub fn read_bounded_text(path: &Path, most: u64) -> io::Result<String> {
    let no_text = |_| io::Error::new(io::ErrorKind::InvalidData, "it is no text");
    String::from_utf8(read_bounded(path, most)?).map_err(no_text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_up_to_the_limit_is_read_and_one_beyond_it_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "abcd").unwrap();
        assert_eq!(read_bounded(&path, 4).unwrap(), b"abcd");
        assert_eq!(read_bounded_text(&path, 4).unwrap(), "abcd");
        let error = read_bounded(&path, 3).unwrap_err();
        assert_eq!(error.to_string(), "it is larger than 3 bytes");
        fs::write(&path, [0xFF]).unwrap();
        assert!(read_bounded_text(&path, 4).is_err());
        assert!(read_bounded(folder.path(), 4).is_err());
    }
}
