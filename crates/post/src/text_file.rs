//! The text of a program into its file, and out of it again.
//!
//! A file that is compressed is written and read as a stream, so memory does not grow with the text. It
//! has a sum of its contents, so that a damaged one is refused and not read as another text.

use std::io::{self, Read, Write};
#[cfg(feature = "zst")]
use std::io::{BufRead, BufReader};
use std::path::Path;

use crate::compression::Compression;

#[cfg(feature = "zst")]
use zstd::stream::{read::Decoder, write::Encoder};

/// The level of the compression: the fastest. The third makes files of programs larger by up to a tenth. The
/// ninth takes some fifteen times as long and saves 4 %.
#[cfg(feature = "zst")]
const LEVEL: i32 = 1;
/// Most bytes that a reader holds of the text behind it, as a power of two: 128 MiB, what `zstd` itself reads
/// unless it is asked for more. A file that asks for more is refused.
#[cfg(feature = "zst")]
const WINDOW_LOG: u32 = 27;

/// The first bytes of a frame of Zstandard (RFC 8878, 3.1.1).
#[cfg(feature = "zst")]
const MAGIC: [u8; 4] = [0x28, 0xB5, 0x2F, 0xFD];
/// Those of a frame without a text; the first of them is any of sixteen.
#[cfg(feature = "zst")]
const SKIPPABLE: [u8; 4] = [0x50, 0x2A, 0x4D, 0x18];
/// The bit of the byte behind them that says that a sum of the contents ends the frame.
#[cfg(feature = "zst")]
const HAS_SUM: u8 = 1 << 2;
/// These bytes together.
#[cfg(feature = "zst")]
const HEADER_BYTES: u64 = 5;

/// A file of text that is read, or bytes in place of one.
pub type OpenFile = Box<dyn Read + Send + Sync>;

/// A file of text that is written.
pub(crate) enum TextFile<W: Write> {
    /// The file is the text.
    Plain(W),
    /// The text is compressed. The box keeps the two kinds alike in size.
    #[cfg(feature = "zst")]
    Zst(Box<Encoder<'static, W>>),
}

impl<W: Write> TextFile<W> {
    /// Begins to write text into `file`.
    pub(crate) fn begin(compression: Compression, file: W) -> io::Result<Self> {
        match compression {
            Compression::None => Ok(Self::Plain(file)),
            #[cfg(feature = "zst")]
            Compression::Zst => {
                let mut encoder = Encoder::new(file, LEVEL)?;
                encoder.include_checksum(true)?;
                Ok(Self::Zst(Box::new(encoder)))
            }
            #[cfg(not(feature = "zst"))]
            Compression::Zst => Err(left_out()),
        }
    }

    /// The file with all of the text in it.
    pub(crate) fn whole(self) -> io::Result<W> {
        match self {
            Self::Plain(file) => Ok(file),
            #[cfg(feature = "zst")]
            Self::Zst(encoder) => encoder.finish(),
        }
    }
}

impl<W: Write> Write for TextFile<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Plain(file) => file.write(bytes),
            #[cfg(feature = "zst")]
            Self::Zst(encoder) => encoder.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Plain(file) => file.flush(),
            #[cfg(feature = "zst")]
            Self::Zst(encoder) => encoder.flush(),
        }
    }
}

/// The bytes of the file of this name, which has this text.
///
/// # Errors
/// When this build writes no files that are compressed so.
pub(crate) fn file_bytes(file: &str, text: Vec<u8>) -> io::Result<Vec<u8>> {
    match Compression::of_file(Path::new(file)) {
        Compression::None => Ok(text),
        compression => {
            let mut bytes = TextFile::begin(compression, Vec::new())?;
            bytes.write_all(&text)?;
            bytes.whole()
        }
    }
}

/// The text in a file.
pub(crate) fn open(
    compression: Compression,
    file: impl Read + Send + Sync + 'static,
) -> io::Result<OpenFile> {
    match compression {
        Compression::None => Ok(Box::new(file)),
        #[cfg(feature = "zst")]
        Compression::Zst => Ok(Box::new(OneFrame::new(file)?)),
        #[cfg(not(feature = "zst"))]
        Compression::Zst => Err(left_out()),
    }
}

/// The text of a file of one frame, which has a sum of its contents.
#[cfg(feature = "zst")]
struct OneFrame<R: Read> {
    decoder: Decoder<'static, BufReader<StartAndRest<R>>>,
}

/// The first bytes of a file, which were read already, and the rest of it.
#[cfg(feature = "zst")]
type StartAndRest<R> = io::Chain<io::Cursor<Vec<u8>>, R>;

#[cfg(feature = "zst")]
impl<R: Read> OneFrame<R> {
    fn new(mut file: R) -> io::Result<Self> {
        let mut begin = Vec::new();
        (&mut file).take(HEADER_BYTES).read_to_end(&mut begin)?;
        let has_sum = match begin.split_first_chunk() {
            Some((magic, rest)) if *magic == MAGIC => rest
                .first()
                .is_some_and(|descriptor| descriptor & HAS_SUM > 0),
            // A frame without a text, which other frames may follow.
            Some((magic, _)) => magic.get(1..) != SKIPPABLE.get(1..),
            None => true,
        };
        if !has_sum {
            return Err(damaged(
                "this file has no sum of its contents, so that damage would not show: `zstd --check` writes one",
            ));
        }
        let mut decoder = Decoder::new(io::Cursor::new(begin).chain(file))?.single_frame();
        decoder.window_log_max(WINDOW_LOG)?;
        Ok(Self { decoder })
    }
}

#[cfg(feature = "zst")]
impl<R: Read> Read for OneFrame<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.decoder.read(buffer)?;
        let is_end = read == 0 && !buffer.is_empty();
        match is_end && !self.decoder.get_mut().fill_buf()?.is_empty() {
            true => Err(damaged("something stands behind the text of this file")),
            false => Ok(read),
        }
    }
}

#[cfg(feature = "zst")]
fn damaged(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

/// A build may have been made without a compression.
#[cfg(not(feature = "zst"))]
fn left_out() -> io::Error {
    let what = "this build of turnpath reads and writes no .zst: decompress the file first";
    io::Error::new(io::ErrorKind::Unsupported, what)
}
