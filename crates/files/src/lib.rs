//! Files that are whole or not there.
//!
//! A [`Draft`] is a file under a temporary name: it gets its own when it is whole, and is removed if
//! it is given up or if the process ends. A [`ResultFolder`] gives several files their names
//! together: whenever the process ends, the folder has the result before or the new one, or the next
//! writer completes the new one. [`end_writing`] and [`remove_drafts`] are for a process that ends
//! early.
//!
//! ```
//! use std::io::Write;
//! use turnpath_files::{FolderError, ResultFolder};
//! # let folder = tempfile::tempdir().unwrap();
//! # let folder = folder.path();
//!
//! let result = ResultFolder::open(folder)?;
//! let mut draft = result.draft(&folder.join("table.csv"))?;
//! draft.write_all(b"1,2\n").unwrap();
//! let table = draft.finish()?;
//! let mut index = result.draft(&folder.join("index.json"))?;
//! index.write_all(b"{\"files\": []}").unwrap();
//! assert!(!folder.join("table.csv").exists());
//! result.commit(vec![table], index.finish()?)?;
//! assert!(folder.join("table.csv").exists());
//! # Ok::<(), FolderError>(())
//! ```

mod bounded;
mod contents;
mod draft;
mod file_error;
mod following_reader;
mod gate;
mod hashed_file;
mod operation;
mod read_back;
mod registry;
mod result_folder;
mod scratch;
mod stale_drafts;
mod temporary;

pub use bounded::{read_bounded, read_bounded_text};
pub use contents::Contents;
pub use draft::{Draft, WholeFile};
pub use file_error::FileError;
pub use gate::{begin_draft, end_writing, wait_if_ending};
pub use operation::{Operation, watch_operations};
pub use registry::{DraftKind, Registration, remove_drafts};
pub use result_folder::{FolderError, ListedFile, ResultFolder};
pub use scratch::{Scratch, ScratchReader};
pub use stale_drafts::remove_stale_drafts;
