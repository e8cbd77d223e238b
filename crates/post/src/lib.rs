//! Data files of a tool path: writers, and the readers that check them.
//!
//! A file is written beside its final name ([`Draft`]) and takes that name when it is complete.

mod draft;
mod read_csv;
mod row;
#[cfg(test)]
mod tests;
mod write_csv;

pub use draft::{Draft, FileError};
pub use read_csv::{PathReader, ReadError};
pub use row::HEADER;
pub use write_csv::PathWriter;
