//! Zemax grid sag, `.DAT`.
//!
//! The first line is `nx ny delx dely unitflag xdec ydec`. Then each point has a line
//! `z dz/dx dz/dy d2z/dxdy nodata`, of which `nodata` may be left out. The first point is the upper
//! left one (least x, largest y); points go to the right, rows go down. The unit is that of z and of
//! the distances. The middle of the grid lies at (xdec, ydec). Lines that begin with `!` are
//! comments.
//!
//! A point with `nodata` 1 is a hole, whatever its z. The slopes in the file are not used: a spline
//! of degree 5 through the heights has better ones.

use crate::conventions::Conventions;
use crate::error::{MapError, MapProblem, Place};
use crate::map::{Map, Size, turn_rows};
use crate::text::{count, length, lines, no_number, number, shown, whole_text, words};

/// Least bytes of a point: a digit and the end of its line.
const LEAST_BYTES: usize = 2;

/// The first line.
struct Header {
    size: Size,
    /// In the file's unit.
    pitch: [f64; 2],
    /// mm.
    unit: f64,
    /// Where the middle lies, in the file's unit.
    middle: [f64; 2],
}

/// Reads a map.
pub fn read(bytes: &[u8], conventions: &Conventions) -> Result<Map, MapError> {
    let mut lines = lines(whole_text(bytes)?, &['!']);
    let Some((line, first)) = lines.next() else {
        return Err(MapError::header(1, "the file is empty"));
    };
    let header = header(line, first)?;
    let (points, wanted) = (bytes.len() / LEAST_BYTES, header.size.points());
    if points < wanted {
        let found = lines.count();
        return Err(MapError::at_line(
            line,
            MapProblem::TooShort { found, wanted },
        ));
    }
    let (xy, z) = (
        conventions.xy_unit(Some(header.unit))?,
        conventions.z_unit(Some(header.unit))?,
    );
    let pitch = conventions.pitch(header.pitch.map(|pitch| Some(pitch * xy)));
    let pitch = pitch.map_err(|error| error.placed(Place::Line(line)))?;
    let [middle_x, middle_y] = header.middle.map(|middle| length(line, middle * xy));
    let (middle_x, middle_y) = (middle_x?, middle_y?);
    let mut heights = Vec::with_capacity(wanted);
    let mut last = line;
    for (line, text) in lines {
        last = line;
        if heights.len() == wanted {
            return Err(MapError::at_line(line, MapProblem::TooLong { wanted }));
        }
        heights.push(match height(line, text)? {
            Some(height) => length(line, height * z)?,
            None => f64::NAN,
        });
    }
    if heights.len() < wanted {
        let found = heights.len();
        let problem = MapProblem::TooShort { found, wanted };
        return Err(MapError::at_line(last, problem));
    }
    turn_rows(header.size.columns, &mut heights);
    let mut map = Map::around_origin(header.size, pitch, heights);
    map.shift(middle_x, middle_y);
    Ok(map)
}

fn header(line: usize, text: &str) -> Result<Header, MapError> {
    let all: Vec<&str> = words(text).collect();
    let (nx, ny, distances, flag, middle) = match all.as_slice() {
        [nx, ny, dx, dy, flag] => (nx, ny, [dx, dy], flag, [0.0; 2]),
        [nx, ny, dx, dy, flag, x, y] => {
            let middle = [number(line, x)?, number(line, y)?];
            (nx, ny, [dx, dy], flag, middle)
        }
        other => {
            let (found, wanted) = (other.len(), "7: nx ny delx dely unitflag xdec ydec");
            return Err(MapError::at_line(
                line,
                MapProblem::Columns { found, wanted },
            ));
        }
    };
    let [dx, dy] = distances;
    let size = Size::new(count(line, nx)?, count(line, ny)?);
    Ok(Header {
        size: size.map_err(|problem| MapError::at_line(line, problem))?,
        // Zemax takes absolute values of the distances.
        pitch: [number(line, dx)?.abs(), number(line, dy)?.abs()],
        unit: unit(line, flag)?,
        middle,
    })
}

fn unit(line: usize, flag: &str) -> Result<f64, MapError> {
    Ok(match flag {
        "0" => 1.0,
        "1" => 10.0,
        "2" => 25.4,
        "3" => 1e3,
        other => {
            let flag = shown(other);
            return Err(MapError::at_line(line, MapProblem::UnitFlag { flag }));
        }
    })
}

/// The height of a point; `None` in a hole.
fn height(line: usize, text: &str) -> Result<Option<f64>, MapError> {
    let mut words = words(text);
    let first = words.next().unwrap_or_default();
    let height = match first.parse::<f64>() {
        Ok(height) if height.is_nan() => {
            return Err(no_number(
                line,
                first,
                "height; a hole has a number and `nodata` 1",
            ));
        }
        _ => number(line, first)?,
    };
    for word in words.by_ref().take(3) {
        // Most are zero: programs that estimate them write so.
        if word != "0" {
            number(line, word)?;
        }
    }
    let flag = words.next();
    if words.next().is_some() {
        let (found, wanted) = (text.split_ascii_whitespace().count(), "4 or 5");
        return Err(MapError::at_line(
            line,
            MapProblem::Columns { found, wanted },
        ));
    }
    match flag {
        None | Some("0") => Ok(Some(height)),
        Some("1") => Ok(None),
        Some(word) => Err(no_number(line, word, "flag `nodata`: 0 or 1")),
    }
}
