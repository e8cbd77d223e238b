//! Reads a PNG.

use std::io::Cursor;

/// Millimetres of a metre.
const METRE: f64 = 1000.0;
/// Border lines are drawn over the edges of a bar, mm.
const BORDER: f64 = 0.15;

/// The pixels of a PNG.
pub struct Sheet {
    pub width: u32,
    pub height: u32,
    /// 0 where the file does not say it.
    pub per_metre: u32,
    /// Red, green, blue and opacity.
    bytes: Vec<u8>,
}

/// How far two colours lie apart.
pub fn difference(one: [u8; 3], other: [u8; 3]) -> u32 {
    let channels = one.into_iter().zip(other);
    channels
        .map(|(one, other)| u32::from(one.abs_diff(other)))
        .sum()
}

impl Sheet {
    pub fn read(file: &[u8]) -> Self {
        let mut reader = png::Decoder::new(Cursor::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        let info = reader.info();
        Self {
            width: info.width,
            height: info.height,
            per_metre: info.pixel_dims.map_or(0, |dims| dims.xppu),
            bytes,
        }
    }

    pub fn pixel(&self, column: u32, row: u32) -> [u8; 3] {
        let at = 4 * (row * self.width + column) as usize;
        [self.bytes[at], self.bytes[at + 1], self.bytes[at + 2]]
    }

    fn per_mm(&self) -> f64 {
        f64::from(self.per_metre) / METRE
    }

    /// The colour at a place of the sheet, mm.
    pub fn colour(&self, x: f64, y: f64) -> [u8; 3] {
        self.pixel((x * self.per_mm()) as u32, (y * self.per_mm()) as u32)
    }

    /// Where between two ends of a column, mm, a colour comes nearest.
    pub fn place_of(&self, colour: [u8; 3], column: f64, [top, bottom]: [f64; 2]) -> f64 {
        let row = |mm: f64| (mm * self.per_mm()) as u32;
        let rows = row(top + BORDER)..row(bottom - BORDER);
        let column = (column * self.per_mm()) as u32;
        let nearest = rows
            .min_by_key(|row| difference(self.pixel(column, *row), colour))
            .unwrap();
        (f64::from(nearest) + 0.5) / self.per_mm()
    }

    /// The share of pixels that are not white.
    pub fn ink(&self) -> f64 {
        let pixels = self.bytes.chunks_exact(4);
        let drawn = pixels
            .clone()
            .filter(|pixel| pixel[..3] != [255; 3])
            .count();
        drawn as f64 / pixels.len() as f64
    }

    /// The pixels around the sheet.
    pub fn edges(&self) -> Vec<[u8; 3]> {
        let (last_row, last_column) = (self.height - 1, self.width - 1);
        let rows = (0..self.width).flat_map(|column| [(column, 0), (column, last_row)]);
        let columns = (0..self.height).flat_map(|row| [(0, row), (last_column, row)]);
        rows.chain(columns)
            .map(|(column, row)| self.pixel(column, row))
            .collect()
    }
}
