//! Files of a tool path: writers of data files and motion programs, and the readers that check
//! them.
//!
//! A writer takes a [`Draft`](turnpath_files::Draft), which gets its own name when it is whole. Data
//! files and programs can be written to memory instead, and read from memory.
//! A reader shares no code with the writer of its format.

mod amount;
mod around_path;
mod automation1;
mod axes;
mod beckhoff;
mod beckhoff_poly;
mod carry;
mod chord;
mod column_files;
mod columns;
mod comment;
mod compression;
mod decimal;
mod depth_check;
mod digit_columns;
mod digit_segments;
mod digits;
mod dry_run;
mod eight_digits;
mod fixed_point;
mod forward_rates;
mod g93;
mod g_code;
mod layout;
mod line_room;
mod lines;
mod maps;
mod number_columns;
mod ordinary_file;
mod part_calls;
mod part_name;
mod parts;
mod path_mark;
mod path_reader;
mod pmac;
mod polynomial;
mod post;
mod posts;
mod power_pmac;
mod powers_of_ten;
mod program_error;
mod program_format;
mod program_reader;
#[cfg(test)]
mod program_tests;
mod program_writer;
mod read_csv;
mod read_error;
mod row;
mod settings;
mod short_lines;
mod siemens_840d;
mod template;
#[cfg(test)]
mod tests;
mod text_file;
mod trail;
mod travel;
mod travel_check;
mod turn;
mod whole_program;
mod write_csv;
#[cfg(feature = "npz")]
mod write_npz;
#[cfg(feature = "parquet")]
mod write_parquet;

pub use amount::{Amount, AmountError, TextSize};
pub use around_path::AroundPath;
pub use carry::CarriedPoints;
pub use columns::{ColumnFormat, Columns, WriteColumns};
pub use compression::{Compression, text_name};
pub use digit_segments::DigitSegments;
pub use digits::{DigitSegment, Digits};
pub use dry_run::{DryRunError, DryStop};
pub use layout::{Layout, Lines};
pub use maps::{GridPoints, GsfWriter, XyzWriter, ZemaxWriter};
pub use part_name::{PartLines, PartName, PartNames, PartNumbers};
pub use parts::{PartLimits, PartsError};
pub use path_reader::{ReadCount, ReadPath};
pub use post::{Command, DepthLoop, Dialect, Grammar, PlainLines, Post};
pub use posts::{POST_NAMES, POSTS, post_named, post_of_extension};
pub use program_error::ProgramError;
pub use program_format::{Chords, Depths, FeedMeaning, ProgramFormat, Slowest, TimeAxis};
pub use program_reader::ProgramReader;
pub use program_writer::{ProgramFileBody, ProgramPath, ProgramPathInMemory, ProgramWriter};
pub use read_csv::PathReader;
pub use read_error::ReadError;
pub use row::HEADER;
pub use settings::{
    APPROACH_FEED, APPROACH_HEIGHT, C_SIGN, DEPTH_STEP, DEPTHS, FOOTER as FOOTER_KEY,
    HEADER as HEADER_KEY, MEMORY, SEGMENTS_PER_SECOND, SPLIT,
};
pub use template::{PLACEHOLDERS, Template, TemplateError};
pub use text_file::OpenFile;
pub use travel::{Extent, Motion, Places, Speed, Travel, TravelModes};
pub use whole_program::WholeProgram;
pub use write_csv::PathWriter;
