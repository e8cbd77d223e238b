//! Lines `x y z` of points on a regular grid, `.xyz`.
//!
//! Blanks, commas or semicolons stand between the numbers. Lines that begin with `#` or `!` are
//! comments. The lines may come in any order. A point that is missing, or whose z is `NaN`, is a
//! hole. The file does not say its units.

use std::collections::HashSet;

use crate::conventions::Conventions;
use crate::error::{MapError, MapProblem};
use crate::map::{Map, Size};
use crate::text::{lines, no_number, number, shown, text};

const COMMENTS: &[char] = &['#', '!'];

/// How far a point may lie off its place in the grid, in pitches: coordinates are rounded. A larger
/// share would take an uneven grid for an even one.
const LARGEST_SHIFT: f64 = 0.01;

/// Coordinates that are nearer than this share of the largest gap are one column, rounded.
const SAME: f64 = 0.02;

/// Most places of a grid for each point of the file: a grid with more of them is none. A disc in its
/// square needs 1.27.
const MOST_PLACES: usize = 4;

/// Most columns (rows) of a grid for each one that has a point.
const MOST_EMPTY: usize = 2;

/// A point, in the file's units.
struct Point {
    x: f64,
    y: f64,
    z: f64,
}

/// The columns or the rows of a grid, in the file's unit.
struct Axis {
    first: f64,
    pitch: f64,
    count: usize,
}

/// Reads a map.
pub fn read(bytes: &[u8], conventions: &Conventions) -> Result<Map, MapError> {
    let text = text(bytes)?;
    let (xy, unit) = (conventions.xy_unit(None)?, conventions.z_unit(None)?);
    let points = points(text)?;
    let columns = axis("x", points.iter().map(|point| point.x))?;
    let rows = axis("y", points.iter().map(|point| point.y))?;
    let size = Size::new(columns.count, rows.count).map_err(MapError::of_file)?;
    if size.points() / MOST_PLACES > points.len() {
        let (nx, ny, found) = (columns.count, rows.count, points.len());
        let what = format!("{nx} × {ny} places for {found} points");
        return Err(MapError::of_file(MapProblem::Uneven(what.into())));
    }
    let at = |number: usize, problem| {
        // Only an error needs the line of a point.
        let line = lines(text, COMMENTS)
            .nth(number)
            .map_or(1, |(line, _)| line);
        MapError::at_line(line, problem)
    };
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
                *height = point.z * unit;
            }
            _ => return Err(at(number, MapProblem::Twice)),
        }
    }
    let pitch = conventions.pitch([Some(columns.pitch * xy), Some(rows.pitch * xy)])?;
    let mut map = Map::around_origin(size, pitch, heights);
    map.shift(columns.middle() * xy, rows.middle() * xy);
    Ok(map)
}

fn points(text: &str) -> Result<Vec<Point>, MapError> {
    let mut points = Vec::new();
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
            Ok(z) if !z.is_infinite() => z,
            _ => return Err(no_number(line, &shown(z), "number")),
        };
        let (x, y) = (number(line, x)?, number(line, y)?);
        points.push(Point { x, y, z });
    }
    Ok(points)
}

/// The columns (rows) to which all points belong.
fn axis(name: &'static str, values: impl Iterator<Item = f64>) -> Result<Axis, MapError> {
    let uneven = |what: String| {
        let what = format!("along {name} {what}");
        MapError::of_file(MapProblem::Uneven(what.into()))
    };
    // Zero has two signs, and they are one place.
    let mut all: Vec<f64> = {
        let mut known = HashSet::new();
        values
            .map(|value| value + 0.0)
            .filter(|value| known.insert(value.to_bits()))
            .collect()
    };
    all.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (all.first().copied(), all.last().copied()) else {
        return Err(MapError::of_file(MapProblem::NoPoints));
    };
    let gaps = || {
        all.iter()
            .skip(1)
            .zip(&all)
            .map(|(after, before)| after - before)
    };
    let largest = gaps().fold(0.0, f64::max);
    let least = gaps()
        .filter(|gap| *gap > SAME * largest)
        .fold(f64::INFINITY, f64::min);
    let places = ((last - first) / least).round();
    if places.is_nan() || places < 1.0 {
        return Err(uneven("all points have the same place".to_owned()));
    }
    // Whole columns may be holes, but not most of them.
    if places + 1.0 > (MOST_EMPTY * all.len()) as f64 {
        return Err(uneven(format!(
            "the distances differ: {least} and {largest}"
        )));
    }
    let axis = Axis {
        first,
        pitch: (last - first) / places,
        count: places as usize + 1,
    };
    match all.iter().find(|value| axis.place(**value).is_none()) {
        None => Ok(axis),
        Some(value) => {
            let pitch = axis.pitch;
            Err(uneven(format!(
                "{value} lies off its place by more than 1 % of the pitch {pitch}"
            )))
        }
    }
}

impl Axis {
    /// The number of the column (row) to which a coordinate belongs.
    fn place(&self, value: f64) -> Option<usize> {
        let place = (value - self.first) / self.pitch;
        let whole = place.round();
        let near = (place - whole).abs() <= LARGEST_SHIFT;
        (near && whole >= 0.0 && whole < self.count as f64).then_some(whole as usize)
    }

    fn middle(&self) -> f64 {
        self.first + 0.5 * self.pitch * (self.count - 1) as f64
    }
}
