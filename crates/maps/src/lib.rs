//! Readers of height maps: files of heights on a regular grid, measured or designed.
//!
//! Each format has a file of its own, which turns bytes into a [`Map`]. All lengths of a map are in
//! mm, x points to the right, y up, and z to the observer. What a file does not say, such as the
//! unit of an `.xyz`, comes from [`Conventions`]. What does not fit a format is a [`MapError`] with
//! the place in the file.
//!
//! ```
//! use turnpath_maps::{Conventions, read};
//! let mut text = "6 6 0.5 0.5 0 0 0\n".to_owned();
//! text.push_str(&"0.001 0 0 0\n".repeat(36));
//! let map = read("flat.DAT", text.as_bytes(), &Conventions::default())?;
//! assert_eq!((map.columns(), map.rows(), map.pitch_x()), (6, 6, 0.5));
//! assert_eq!((map.x(0), map.y(0), map.height(0, 0)), (-1.25, -1.25, 0.001));
//! # Ok::<(), turnpath_maps::MapError>(())
//! ```

mod axis;
mod cells;
mod code_v;
mod conventions;
mod detection;
mod error;
mod format;
mod gsf;
mod limits;
mod map;
mod metropro;
mod text;
mod xyz;
mod zemax;

pub use conventions::{Conventions, Origin, length_unit};
pub use detection::format_of;
pub use error::{MapError, MapProblem, Place};
pub use format::Format;
pub use limits::{LARGEST_LENGTH, LEAST_PITCH, LEAST_POINTS, MOST_POINTS};
pub use map::Map;

/// Reads a map. The name of the file tells the format where neither the conventions nor the bytes
/// do.
///
/// # Errors
/// When the bytes are no map of that format, when the conventions leave out what the file does not
/// say, or when the map is too small or too large.
pub fn read(name: &str, bytes: &[u8], conventions: &Conventions) -> Result<Map, MapError> {
    let format = match conventions.format {
        Some(format) => format,
        None => format_of(name, bytes).ok_or_else(|| MapError::of_file(MapProblem::NoFormat))?,
    };
    let read = match format {
        Format::Zemax => zemax::read,
        Format::CodeV => code_v::read,
        Format::Xyz => xyz::read,
        Format::Gsf => gsf::read,
        Format::MetroPro => metropro::read,
    };
    let mut map = read(bytes, conventions)?;
    if map.valid() == 0 {
        return Err(MapError::of_file(MapProblem::NoPoints));
    }
    if conventions.origin == Origin::Middle {
        map.centre();
    }
    Ok(map)
}
