//! Messages on standard error, which may take nothing.

use std::io::{self, Write};

/// Writes a remark to standard error, which may take nothing.
pub fn note(text: &str) {
    say(&format!("note: {text}"));
}

/// Writes a line to standard error. Where that takes nothing, nobody can be told.
pub fn say(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}
