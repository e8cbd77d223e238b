//! SHA-256 as lower-case hexadecimal.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

/// Bytes of a file that are read at once.
const BUFFER: usize = 1 << 16;

/// The SHA-256 of some bytes, in lower-case hexadecimal.
///
/// ```
/// let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
/// assert_eq!(turnpath_host::sha256_hex(b""), empty);
/// ```
pub fn sha256_hex(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// The SHA-256 of a file, in lower-case hexadecimal. The file is read piece by piece, so a large
/// file takes no more memory than a small one.
///
/// # Errors
/// When the file cannot be opened or read.
pub fn sha256_hex_of_file(path: impl AsRef<Path>) -> io::Result<String> {
    sha256_hex_of_reader(File::open(path)?)
}

/// The SHA-256 of what a reader has left, which is read piece by piece.
pub(crate) fn sha256_hex_of_reader(mut reader: impl Read) -> io::Result<String> {
    let mut hasher = Sha256::new();
    let mut buffer = vec![0; BUFFER];
    loop {
        match reader.read(&mut buffer) {
            Ok(0) => return Ok(hex(&hasher.finalize())),
            Ok(read) => hasher.update(buffer.get(..read).unwrap_or_default()),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FIPS 180-2, appendices B.1 and B.3.
    #[test]
    fn the_standards_examples_have_these_hashes() {
        assert_eq!(
            sha256_hex(b"abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
        assert_eq!(
            sha256_hex(&vec![b'a'; 1_000_000]),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"
        );
    }

    #[test]
    fn a_file_has_the_hash_of_its_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        for bytes in [vec![], b"abc".to_vec(), vec![b'a'; 1_000_000]] {
            std::fs::write(&path, &bytes).unwrap();
            assert_eq!(sha256_hex_of_file(&path).unwrap(), sha256_hex(&bytes));
        }
        assert!(sha256_hex_of_file(folder.path().join("none")).is_err());
    }
}
