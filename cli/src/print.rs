//! Printing an answer.

use std::io;

use serde::Serialize;
use turnpath::report::to_json;

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

/// Writes a report in the form that was asked for; `text` is the one for a person.
pub fn print_report<T: Serialize>(
    format: Format,
    report: &T,
    text: impl FnOnce(&T) -> String,
) -> Result<(), Failure> {
    print(&match format {
        Format::Json => to_json(report),
        Format::Human => text(report),
    })
}
