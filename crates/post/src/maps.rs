//! Writers of maps: `.gsf` (Gwyddion Simple Field) and `.xyz` with lengths in metres, the default unit
//! of Gwyddion, and `.DAT` (Zemax grid sag) with lengths in mm.

use std::fmt::Write as _;
use std::io::Write as _;
use turnpath_files::{Draft, FileError};

/// Metres in a millimetre.
const M_PER_MM: f64 = 1e-3;
/// The first line of a simple field.
const MAGIC: &str = "Gwyddion Simple Field 1.0";
/// The data begin at a multiple of this number of bytes.
const ALIGNMENT: usize = 4;
/// The flag of Zemax for lengths in mm.
const ZEMAX_MM: u32 = 0;

/// The points of a map on a regular grid: x to the right, y up, in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridPoints {
    /// Points along x.
    pub columns: usize,
    /// Points along y.
    pub rows: usize,
    /// Distances of neighbouring points along x and along y.
    pub pitch: [f64; 2],
    /// The middle of the points.
    pub middle: [f64; 2],
}

impl GridPoints {
    /// The sides of the field whose cells have the points in their middles.
    fn sides(&self) -> [f64; 2] {
        let [dx, dy] = self.pitch;
        [dx * self.columns as f64, dy * self.rows as f64]
    }
}

/// A map as Gwyddion Simple Field: a text header, then 32-bit floats, row by row from the top, each
/// row from the left. A cell without a value is NaN.
#[derive(Debug)]
pub struct GsfWriter {
    draft: Draft,
}

impl GsfWriter {
    /// Begins a map of `count` × `count` cells over a square of side 2 · `half` mm around the axis.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(draft: Draft, title: &str, count: usize, half: f64) -> Result<Self, FileError> {
        let field = Field {
            cells: [count, count],
            sides: [2.0 * half; 2],
            corner: [-half; 2],
        };
        Self::begin_field(draft, title, &field)
    }

    /// Begins a map of the values at points.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn at_points(draft: Draft, title: &str, points: &GridPoints) -> Result<Self, FileError> {
        let ([x, y], [width, height]) = (points.middle, points.sides());
        let field = Field {
            cells: [points.columns, points.rows],
            sides: [width, height],
            // y of the file points down.
            corner: [x - 0.5 * width, -y - 0.5 * height],
        };
        Self::begin_field(draft, title, &field)
    }

    fn begin_field(mut draft: Draft, title: &str, field: &Field) -> Result<Self, FileError> {
        let title: String = title
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let [columns, rows] = field.cells;
        let [width, height] = field.sides.map(|side| side * M_PER_MM);
        let [left, top] = field.corner.map(|corner| corner * M_PER_MM);
        let header = format!(
            "{MAGIC}\nXRes = {columns}\nYRes = {rows}\nXReal = {width:e}\nYReal = {height:e}\n\
             XOffset = {left:e}\nYOffset = {top:e}\nTitle = {title}\nXYUnits = m\n\
             ZUnits = m\n"
        );
        let padding = ALIGNMENT - header.len() % ALIGNMENT;
        let mut bytes = header.into_bytes();
        bytes.extend(std::iter::repeat_n(0, padding));
        put(&mut draft, &bytes)?;
        Ok(Self { draft })
    }

    /// Writes the next row: heights in mm, which are rounded to 32 bits once.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn row(&mut self, values: impl Iterator<Item = f64>) -> Result<(), FileError> {
        let metres = values.map(|value| (value * M_PER_MM) as f32);
        let bytes: Vec<u8> = metres.flat_map(f32::to_le_bytes).collect();
        put(&mut self.draft, &bytes)
    }

    /// The complete file, still without its name.
    pub fn whole(self) -> Draft {
        self.draft
    }
}

/// The field of a Gwyddion file, in mm: y points down.
struct Field {
    cells: [usize; 2],
    sides: [f64; 2],
    /// The upper left corner.
    corner: [f64; 2],
}

/// A map as Zemax grid sag: the line `nx ny delx dely unitflag xdec ydec`, then for each point a line
/// `z dz/dx dz/dy d2z/dxdy nodata`, from the upper left point to the right, rows downwards. Slopes
/// are 0, which tells the program to find them from the heights.
#[derive(Debug)]
pub struct ZemaxWriter {
    draft: Draft,
    text: String,
}

impl ZemaxWriter {
    /// Begins a map of the values at points.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(mut draft: Draft, points: &GridPoints) -> Result<Self, FileError> {
        let GridPoints { columns, rows, .. } = points;
        let ([dx, dy], [x, y]) = (points.pitch, points.middle);
        let header = format!("{columns} {rows} {dx} {dy} {ZEMAX_MM} {x} {y}\n");
        put(&mut draft, header.as_bytes())?;
        let text = String::new();
        Ok(Self { draft, text })
    }

    /// Writes the next row: heights in mm; NaN where there is none.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn row(&mut self, values: impl Iterator<Item = f64>) -> Result<(), FileError> {
        self.text.clear();
        for value in values {
            // Writing to a string cannot fail.
            let _ = match value.is_finite() {
                true => writeln!(self.text, "{value:e} 0 0 0 0"),
                false => writeln!(self.text, "0 0 0 0 1"),
            };
        }
        put(&mut self.draft, self.text.as_bytes())
    }

    /// The complete file, still without its name.
    pub fn whole(self) -> Draft {
        self.draft
    }
}

/// A map as text: lines `x y z`.
#[derive(Debug)]
pub struct XyzWriter {
    draft: Draft,
    line: String,
}

impl XyzWriter {
    /// A map without a point.
    pub fn new(draft: Draft) -> Self {
        let line = String::new();
        Self { draft, line }
    }

    /// Writes the next point and its value, mm.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn point(&mut self, x: f64, y: f64, value: f32) -> Result<(), FileError> {
        let [x, y, z] = [x, y, f64::from(value)].map(|mm| mm * M_PER_MM);
        self.line.clear();
        // Writing to a string cannot fail.
        let _ = writeln!(self.line, "{x:.9e} {y:.9e} {z:.6e}");
        put(&mut self.draft, self.line.as_bytes())
    }

    /// The complete file, still without its name.
    pub fn whole(self) -> Draft {
        self.draft
    }
}

fn put(draft: &mut Draft, bytes: &[u8]) -> Result<(), FileError> {
    draft.write_all(bytes).map_err(|error| FileError {
        path: draft.path().to_owned(),
        error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_title(title: &str) -> Vec<u8> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.gsf");
        let mut writer = GsfWriter::begin(Draft::begin(&path).unwrap(), title, 2, 2.5).unwrap();
        writer.row([0.5, f64::NAN].into_iter()).unwrap();
        writer.row([0.0, -2e-4].into_iter()).unwrap();
        writer.whole().complete().unwrap();
        std::fs::read(&path).unwrap()
    }

    /// The format requires one to four NULs after the header, so that the data begin at a multiple of
    /// four.
    #[test]
    fn data_begin_at_a_multiple_of_four_whatever_the_title() {
        for title in ["", "a", "ab", "abc", "abcd", "Spiegel, 5 mm: Ø"] {
            let bytes = of_title(title);
            let text = bytes.iter().position(|byte| *byte == 0).unwrap();
            let nuls = bytes.len() - 16 - text;
            assert!((1..=4).contains(&nuls), "{nuls}");
            assert_eq!((text + nuls) % 4, 0);
            let data = &bytes[bytes.len() - 16..];
            assert_eq!(data[..4], 5e-4f32.to_le_bytes());
            assert!(f32::from_le_bytes([data[4], data[5], data[6], data[7]]).is_nan());
        }
    }

    #[test]
    fn a_title_of_two_lines_stays_on_its_line() {
        let bytes = of_title("one\nXRes = 7\0");
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.contains("Title = one XRes = 7 \n"), "{text}");
    }

    #[test]
    fn an_xyz_file_has_metres() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.xyz");
        let mut writer = XyzWriter::new(Draft::begin(&path).unwrap());
        writer.point(2.5, -1.0, 1e-4).unwrap();
        writer.whole().complete().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text, "2.500000000e-3 -1.000000000e-3 1.000000e-7\n");
    }
}
