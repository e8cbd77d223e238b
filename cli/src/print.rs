//! Printing an answer.

use std::io::{self, Write};

use serde::Serialize;
use turnpath::report::to_json;
use turnpath_core::printable;

use crate::args::Format;
use crate::crash::answer_to;
use crate::failure::Failure;

/// Writes a text to standard output. A reader that has gone, such as `head`, is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    match answer_to(text.as_bytes()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure::Output(error)),
        Ok(()) => Ok(()),
    }
}

/// Standard output as a writer, for more text than should be held at once.
pub struct Output;

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        answer_to(bytes)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes a report in the form that was asked for; `text` is the one for a person.
pub fn print_report<T: Serialize>(
    format: Format,
    report: &T,
    text: impl FnOnce(&T) -> String,
) -> Result<(), Failure> {
    print(&match format {
        Format::Json => to_json(report),
        Format::Human => printable(&text(report)).into_owned(),
    })
}
