//! Libraries: the checks of a file's bytes before the system's loader gets them.

use turnpath_host::{Refusal, entry_symbol};

/// Words of such files: the beginnings of ELF headers, program headers and dynamic entries.
pub const WORDS: &[&str] = &[
    "\u{7f}ELF\u{2}\u{1}\u{1}\0",
    "\0\0\0\0\0\0\0\0",
    "\u{1}\0\0\0",
    "\u{2}\0\0\0",
    "\u{7}\0\0\0",
    "\0\u{10}\0\0\0\0\0\0",
    "!<arch>\n",
    "MZ",
];

/// Checks a library. A refusal names what is wrong.
pub fn read(bytes: &[u8]) {
    match entry_symbol(bytes, "libplugin") {
        Ok(symbol) => assert!(!symbol.is_empty()),
        Err(refusal) => {
            let said = Refusal::to_string(&refusal);
            assert!(!said.is_empty());
        }
    }
}
