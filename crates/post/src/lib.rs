//! Files of a tool path: writers of data files and motion programs, and the readers that check
//! them.
//!
//! A file is written beside its final name ([`Draft`]) and takes that name when it is complete.
//! A reader shares no code with the writer of its format.

mod draft;
mod maps;
mod path_reader;
mod pmac;
mod read_csv;
mod row;
mod short_lines;
#[cfg(test)]
mod tests;
mod write_csv;

pub use draft::{Draft, FileError};
pub use maps::{GsfWriter, XyzWriter};
pub use path_reader::{Counted, ReadPath};
pub use pmac::{
    ENTRY_MS, FOOTER as PMAC_FOOTER, HEADER as PMAC_HEADER, PLACEHOLDERS, PmacError, PmacFormat,
    PmacReader, PmacWriter, QUANTA_PER_S as PMAC_TIME_STEPS, Template, TemplateError,
};
pub use read_csv::{PathReader, ReadError};
pub use row::HEADER;
pub use write_csv::PathWriter;
