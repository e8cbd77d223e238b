//! Lines `x y z` of points on a regular grid, `.xyz`.
//!
//! Blanks, commas or semicolons stand between the numbers. Lines that begin with `#` or `!` are
//! comments. The lines may come in any order. A point that is missing, or whose z is `NaN`, is a
//! hole. The file does not say its units.

use crate::axis::{Axis, UnevenAxis};
use crate::conventions::Conventions;
use crate::error::{MapError, MapProblem, Place};
use crate::map::{Map, Size};
use crate::text::{length, lines, no_number, number, whole_text};

const COMMENTS: &[char] = &['#', '!'];

/// Most places of a grid for each point of the file: a grid with more of them is none. A disc in its
/// square needs 1.27.
const MOST_PLACES: usize = 4;

/// A point.
struct Point {
    /// In the file's unit.
    x: f64,
    /// In the file's unit.
    y: f64,
    /// mm; NaN in a hole.
    z: f64,
}

/// The points of a file, and how finely their coordinates are written.
#[derive(Default)]
struct Points {
    points: Vec<Point>,
    /// The power of ten of the last digit, along x and along y.
    last_digits: [i32; 2],
}

/// Reads a map.
pub fn read(bytes: &[u8], conventions: &Conventions) -> Result<Map, MapError> {
    let text = whole_text(bytes)?;
    let (xy, unit) = (conventions.xy_unit(None)?, conventions.z_unit(None)?);
    let at = |number: usize, problem| {
        // Only an error needs the line of a point.
        let line = lines(text, COMMENTS)
            .nth(number)
            .map_or(1, |(line, _)| line);
        MapError::at_line(line, problem)
    };
    let Points {
        points,
        last_digits,
    } = points(text, xy, unit)?;
    let last = points.len().saturating_sub(1);
    let uneven = |name: &str, of: fn(&Point) -> f64, error: UnevenAxis| {
        let value = error.value;
        let number = points.iter().position(|point| of(point) == value);
        let what = format!("along {name} {}", error.what);
        at(number.unwrap_or(last), MapProblem::Uneven(what.into()))
    };
    let along = |name: &str, of: fn(&Point) -> f64, last_digit: i32| {
        let axis = Axis::of(points.iter().map(of), last_digit);
        axis.map_err(|error| uneven(name, of, error))
    };
    if points.is_empty() {
        return Err(MapError::of_file(MapProblem::NoPoints));
    }
    let columns = along("x", |point| point.x, last_digits[0])?;
    let rows = along("y", |point| point.y, last_digits[1])?;
    let size = Size::new(columns.count, rows.count).map_err(|problem| at(last, problem))?;
    if size.points() / MOST_PLACES > points.len() {
        let (nx, ny, found) = (columns.count, rows.count, points.len());
        let what = format!("{nx} × {ny} places for {found} points");
        return Err(at(last, MapProblem::Uneven(what.into())));
    }
    let mut heights = vec![f64::NAN; size.points()];
    let mut seen = vec![false; size.points()];
    for (number, point) in points.iter().enumerate() {
        let place = (columns.place(point.x), rows.place(point.y));
        let (Some(column), Some(row)) = place else {
            let what = "this point lies between its columns or rows";
            return Err(at(number, MapProblem::Uneven(what.into())));
        };
        let index = row * size.columns + column;
        match (seen.get_mut(index), heights.get_mut(index)) {
            (Some(seen), Some(height)) if !*seen => {
                *seen = true;
                *height = point.z;
            }
            _ => return Err(at(number, MapProblem::Twice)),
        }
    }
    let pitch = conventions.pitch([Some(columns.pitch * xy), Some(rows.pitch * xy)]);
    let pitch = pitch.map_err(|error| error.placed(Place::Line(1)))?;
    let mut map = Map::around_origin(size, pitch, heights);
    map.shift(columns.middle() * xy, rows.middle() * xy);
    Ok(map)
}

fn points(text: &str, xy: f64, unit: f64) -> Result<Points, MapError> {
    let mut points = Points::default();
    let is_between = |c: char| c.is_ascii_whitespace() || c == ',' || c == ';';
    for (line, text) in lines(text, COMMENTS) {
        let mut words = text.split(is_between).filter(|word| !word.is_empty());
        let mut three = [""; 3];
        for (place, word) in three.iter_mut().zip(words.by_ref()) {
            *place = word;
        }
        let [x, y, z] = three;
        if z.is_empty() || words.next().is_some() {
            let found = text
                .split(is_between)
                .filter(|word| !word.is_empty())
                .count();
            let wanted = "3: x y z";
            return Err(MapError::at_line(
                line,
                MapProblem::Columns { found, wanted },
            ));
        }
        let z = match z.parse::<f64>() {
            Ok(z) if z.is_nan() => z,
            Ok(z) if z.is_finite() => length(line, z * unit)?,
            _ => return Err(no_number(line, z, "number, nor `NaN` for a hole")),
        };
        for (last_digit, word) in points.last_digits.iter_mut().zip([x, y]) {
            *last_digit = (*last_digit).min(power_of_last_digit(word));
        }
        let (x, y) = (number(line, x)?, number(line, y)?);
        length(line, x * xy)?;
        length(line, y * xy)?;
        points.points.push(Point { x, y, z });
    }
    Ok(points)
}

/// The power of ten of a number's last digit: −3 of `1.250`.
fn power_of_last_digit(word: &str) -> i32 {
    let (digits, exponent) = word.split_once(['e', 'E']).unwrap_or((word, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    exponent.saturating_sub(i32::try_from(decimals).unwrap_or(i32::MAX))
}
