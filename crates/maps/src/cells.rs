//! The heights of a binary file: from a place on, up to the file's end.

use crate::error::{MapError, MapProblem};
use crate::map::Size;

/// The bytes of each height, `BYTES` of them, from the byte `start` to the end of the file. A file
/// that ends before the last height, or goes on behind it, is refused.
pub fn cells<const BYTES: usize>(
    bytes: &[u8],
    start: usize,
    size: Size,
) -> Result<&[[u8; BYTES]], MapError> {
    let (cells, rest) = bytes.get(start..).unwrap_or_default().as_chunks::<BYTES>();
    let (found, wanted) = (cells.len(), size.points());
    if found < wanted {
        let problem = MapProblem::TooShort { found, wanted };
        return Err(MapError::at_byte(bytes.len(), problem));
    }
    if found > wanted || !rest.is_empty() {
        let at = start + wanted * BYTES;
        return Err(MapError::at_byte(at, MapProblem::TooLong { wanted }));
    }
    Ok(cells)
}
