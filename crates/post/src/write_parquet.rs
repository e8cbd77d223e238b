//! Writes `toolpath.parquet`: the columns of `toolpath.csv`, with their units in the metadata.
//!
//! Doubles are split into streams of bytes and compressed by zstd. Rows are gathered into groups, and a
//! group is written when it is full. Memory does not grow with the path.

use std::io;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, ZstdLevel};
use parquet::data_type::{DoubleType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use parquet::schema::types::ColumnPath;
use turnpath_files::{Draft, FileError};

use crate::columns::{Columns, WriteColumns};
use crate::row::{HEADER, UNITS};

/// Rows of a group: larger groups compress no better, and this one takes 7 MB of memory.
const GROUP: usize = 1 << 17;

/// Writes the file.
pub(crate) struct ParquetWriter {
    writer: SerializedFileWriter<Draft>,
    path: std::path::PathBuf,
    /// Rows that wait for their group to be full.
    waiting: Columns,
}

impl ParquetWriter {
    /// Begins the file that the draft will be.
    pub(crate) fn begin(draft: Draft) -> Result<Self, FileError> {
        let path = draft.path().to_owned();
        let begin = || -> Result<SerializedFileWriter<Draft>, ParquetError> {
            let schema = Arc::new(parse_message_type(&schema())?);
            SerializedFileWriter::new(draft, schema, properties()?)
        };
        match begin() {
            Ok(writer) => Ok(Self {
                writer,
                path,
                waiting: Columns::default(),
            }),
            Err(error) => Err(FileError::of(&path)(of_parquet(error))),
        }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let rows = std::mem::take(&mut self.waiting);
        if rows.sections.is_empty() {
            return Ok(());
        }
        let mut group = self.writer.next_row_group()?;
        write_columns(&mut group, &rows)?;
        group.close()?;
        Ok(())
    }
}

impl WriteColumns for ParquetWriter {
    fn append(&mut self, columns: &Columns) -> io::Result<()> {
        for (waiting, column) in self.waiting.numbers.iter_mut().zip(&columns.numbers) {
            waiting.extend_from_slice(column);
        }
        self.waiting.sections.extend_from_slice(&columns.sections);
        match self.waiting.sections.len() >= GROUP {
            true => self.write_group().map_err(of_parquet),
            false => Ok(()),
        }
    }

    fn whole(mut self: Box<Self>) -> Result<Draft, FileError> {
        let path = self.path.clone();
        let written = self.write_group().and_then(|()| self.writer.into_inner());
        written.map_err(|error| FileError::of(&path)(of_parquet(error)))
    }
}

fn write_columns(
    group: &mut SerializedRowGroupWriter<'_, Draft>,
    rows: &Columns,
) -> Result<(), ParquetError> {
    for column in &rows.numbers {
        if let Some(mut writer) = group.next_column()? {
            writer
                .typed::<DoubleType>()
                .write_batch(column, None, None)?;
            writer.close()?;
        }
    }
    if let Some(mut writer) = group.next_column()? {
        let sections: Vec<i32> = rows.sections.iter().map(|s| i32::from(*s)).collect();
        writer
            .typed::<Int32Type>()
            .write_batch(&sections, None, None)?;
        writer.close()?;
    }
    Ok(())
}

fn schema() -> String {
    let columns = HEADER.map(|name| match name {
        "section" => format!("REQUIRED INT32 {name} (INTEGER(8,false));"),
        _ => format!("REQUIRED DOUBLE {name};"),
    });
    format!("message toolpath {{ {} }}", columns.join(" "))
}

fn properties() -> Result<WriterPropertiesPtr, ParquetError> {
    let units = HEADER.into_iter().zip(UNITS);
    let units = units.map(|(name, unit)| KeyValue::new(format!("unit of {name}"), unit.to_owned()));
    let properties = WriterProperties::builder()
        .set_created_by("turnpath".to_owned())
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        .set_dictionary_enabled(false)
        .set_encoding(Encoding::BYTE_STREAM_SPLIT)
        .set_column_encoding(ColumnPath::from("section"), Encoding::DELTA_BINARY_PACKED)
        .set_key_value_metadata(Some(units.collect()));
    Ok(Arc::new(properties.build()))
}

fn of_parquet(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(error) => match error.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(error) => io::Error::other(error),
        },
        error => io::Error::other(error),
    }
}
