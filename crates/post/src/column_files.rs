//! The writers of column files that this build has.

use turnpath_files::{Draft, FileError};

use crate::columns::{ColumnFormat, WriteColumns};
#[cfg(feature = "npz")]
use crate::write_npz::NpzWriter;
#[cfg(feature = "parquet")]
use crate::write_parquet::ParquetWriter;

impl ColumnFormat {
    /// Begins the file that the draft will be; `None` in a build without this format.
    ///
    /// # Errors
    /// When the file cannot be written.
    #[cfg_attr(
        not(any(feature = "npz", feature = "parquet")),
        expect(unused_variables, reason = "no format takes the draft")
    )]
    pub fn begin(self, draft: Draft) -> Result<Option<Box<dyn WriteColumns>>, FileError> {
        Ok(match self {
            #[cfg(feature = "parquet")]
            Self::Parquet => Some(Box::new(ParquetWriter::begin(draft)?)),
            #[cfg(feature = "npz")]
            Self::Npz => Some(Box::new(NpzWriter::begin(draft)?)),
            #[cfg(not(all(feature = "npz", feature = "parquet")))]
            _ => None,
        })
    }
}
