//! Gwyddion Simple Field, `.gsf`.
//!
//! A text header of lines `key = value`, then one to four NULs, so that the data begin at a multiple
//! of four bytes, then little-endian 32-bit floats: rows from the top, each from the left. NaN is a
//! hole. XReal and YReal are the sides of the whole field, so that the distance of points is
//! XReal/XRes, and points lie in the middles of their cells. XOffset and YOffset are the upper left
//! corner of the field, with y pointing down. Gwyddion leaves an offset out that is zero: so where one
//! of the two is there, the other one is zero. Where both are left out, the middle of the field lies at
//! the origin.

use crate::cells::cells;
use crate::conventions::{Conventions, length_unit};
use crate::error::{MapError, MapProblem};
use crate::map::{Map, Size, check_length, check_pitch, turn_rows};
use crate::text::{count, length, number, shown};

const MAGIC: &str = "Gwyddion Simple Field 1.0\n";

/// The longest header that is read.
const LONGEST_HEADER: usize = 1 << 16;

/// Bytes of a height.
const BYTES: usize = 4;

/// Whether the file begins as the format does.
pub fn is(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC.as_bytes())
}

/// A value with its line.
type Entry<T> = (usize, T);

/// What the header says, in the file's units.
#[derive(Default)]
struct Header<'a> {
    columns: Option<Entry<usize>>,
    rows: Option<Entry<usize>>,
    sides: [Option<Entry<f64>>; 2],
    corner: [Option<Entry<f64>>; 2],
    xy_unit: Option<Entry<&'a str>>,
    z_unit: Option<Entry<&'a str>>,
}

/// Reads a map.
pub fn read(bytes: &[u8], conventions: &Conventions) -> Result<Map, MapError> {
    if !is(bytes) {
        let what = "the file does not begin with `Gwyddion Simple Field 1.0`";
        return Err(MapError::header(1, what));
    }
    let head = bytes.get(..LONGEST_HEADER).unwrap_or(bytes);
    let end = head.iter().position(|byte| *byte == 0);
    let end = end.ok_or_else(|| MapError::header(1, "no NUL ends the header"))?;
    let header = header(crate::text::text(head.get(..end).unwrap_or_default())?)?;
    let lacks = |key: &str| MapError::header(1, format!("the header has no {key}"));
    let (line, columns) = header.columns.ok_or_else(|| lacks("XRes"))?;
    let (_, rows) = header.rows.ok_or_else(|| lacks("YRes"))?;
    let size = Size::new(columns, rows).map_err(|problem| MapError::at_line(line, problem))?;
    let data = data(bytes, end, size)?;
    let xy_name = header.xy_unit;
    let given = [conventions.pitch_x, conventions.pitch_y];
    let has_lengths = header
        .sides
        .iter()
        .chain(&header.corner)
        .any(Option::is_some);
    let xy = match has_lengths {
        true => conventions.xy_unit(unit(xy_name, "xy_unit", conventions.xy_unit)?)?,
        // Where the header has no length, there is nothing that needs its unit.
        false => 1.0,
    };
    let z = conventions.z_unit(unit(header.z_unit, "z_unit", conventions.z_unit)?)?;
    let of_file = [(header.sides[0], columns), (header.sides[1], rows)];
    for ((side, count), given) in of_file.into_iter().zip(given) {
        if let (Some((line, side)), None) = (side, given) {
            let pitch = check_pitch(side * xy / count as f64);
            pitch.map_err(|problem| MapError::at_line(line, problem))?;
        }
    }
    let of_file = of_file.map(|(side, count)| side.map(|(_, side)| side * xy / count as f64));
    let pitch = conventions.pitch(of_file)?;
    let first = bytes.len() - data.len() * BYTES;
    let height = |(number, bytes): (usize, &[u8; BYTES])| {
        let at = first + number * BYTES;
        height(*bytes, z).map_err(|problem| MapError::at_byte(at, problem))
    };
    let heights: Result<Vec<f64>, MapError> = data.iter().enumerate().map(height).collect();
    let mut heights = heights?;
    turn_rows(columns, &mut heights);
    let mut map = Map::around_origin(size, pitch, heights);
    // A pitch that is given changes the size of the field, and the corner no longer means anything.
    if header.corner.iter().any(Option::is_some) && given == [None, None] {
        let offset = |entry: Option<Entry<f64>>| match entry {
            Some((line, offset)) => length(line, offset * xy),
            None => Ok(0.0),
        };
        let [left, top] = header.corner.map(offset);
        let half = [
            pitch[0] * columns as f64 / 2.0,
            pitch[1] * rows as f64 / 2.0,
        ];
        map.shift(left? + half[0], -(top? + half[1]));
    }
    Ok(map)
}

fn height(bytes: [u8; BYTES], unit: f64) -> Result<f64, MapProblem> {
    let height = f64::from(f32::from_le_bytes(bytes));
    // Some programs write an infinity where they have no height.
    match height.is_finite() {
        true => check_length(height * unit),
        false => Ok(f64::NAN),
    }
}

fn header(text: &str) -> Result<Header<'_>, MapError> {
    let mut header = Header::default();
    for (number_of_line, line) in (1..).zip(text.lines()).skip(1) {
        if line.trim().is_empty() {
            continue;
        }
        let Some((key, value)) = line.split_once('=') else {
            let what = format!("`{}` is no `key = value`", shown(line));
            return Err(MapError::header(number_of_line, what));
        };
        let value = value.trim();
        let length = || number(number_of_line, value).map(|length| Some((number_of_line, length)));
        let whole = || count(number_of_line, value).map(|count| Some((number_of_line, count)));
        match key.trim() {
            "XRes" => header.columns = whole()?,
            "YRes" => header.rows = whole()?,
            "XReal" => header.sides[0] = length()?,
            "YReal" => header.sides[1] = length()?,
            "XOffset" => header.corner[0] = length()?,
            "YOffset" => header.corner[1] = length()?,
            "XYUnits" => header.xy_unit = Some((number_of_line, value)),
            "ZUnits" => header.z_unit = Some((number_of_line, value)),
            // The title, and what programs add.
            _ => {}
        }
    }
    Ok(header)
}

/// A unit of the header; `None` if there is none, or if another one is given.
fn unit(
    named: Option<Entry<&str>>,
    param: &'static str,
    given: Option<f64>,
) -> Result<Option<f64>, MapError> {
    match (named, given) {
        (None | Some((_, "")), _) | (_, Some(_)) => Ok(None),
        (Some((line, name)), None) => match length_unit(name) {
            Some(unit) => Ok(Some(unit)),
            None => {
                let name = shown(name);
                let problem = MapProblem::UnitName { name, param };
                Err(MapError::at_line(line, problem))
            }
        },
    }
}

/// The heights' bytes after a header that ends at a NUL.
fn data(bytes: &[u8], end: usize, size: Size) -> Result<&[[u8; BYTES]], MapError> {
    let start = (end / BYTES + 1) * BYTES;
    let padding = bytes.get(end..start.min(bytes.len())).unwrap_or_default();
    if let Some(at) = padding.iter().position(|byte| *byte != 0) {
        let what = "the header ends with one to four NULs, up to a multiple of four bytes";
        return Err(MapError::at_byte(end + at, MapProblem::Header(what.into())));
    }
    cells(bytes, start, size)
}
