//! Files of a tool path: writers of data files and motion programs, and the readers that check
//! them.
//!
//! A writer takes a [`Draft`](turnpath_files::Draft), which gets its own name when it is whole. Data
//! files and programs can be written to memory instead, and read from memory.
//! A reader shares no code with the writer of its format.

mod maps;
mod ordinary_file;
mod path_reader;
mod pmac;
mod read_csv;
mod read_error;
mod row;
mod short_lines;
#[cfg(test)]
mod tests;
mod turn;
mod write_csv;

pub use maps::{GsfWriter, XyzWriter};
pub use path_reader::{ReadCount, ReadPath};
pub use pmac::{
    Command, ENTRY_MS, FOOTER as PMAC_FOOTER, HEADER as PMAC_HEADER, PLACEHOLDERS, PmacError,
    PmacFileBody, PmacFormat, PmacReader, PmacWriter, QUANTA_PER_S as PMAC_TIME_STEPS, Template,
    TemplateError, commands, leaves_program_open,
};
pub use read_csv::PathReader;
pub use read_error::ReadError;
pub use row::HEADER;
pub use write_csv::PathWriter;
