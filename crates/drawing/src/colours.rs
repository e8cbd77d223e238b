//! Colours of a drawing: those of the page of a result.

use crate::shape::{Colour, Pixels};

/// Lines, frames and letters.
pub const BLACK: Colour = [0, 0, 0];
/// A curve.
pub const BLUE: Colour = [0x2e, 0x86, 0xd1];
/// A limit.
pub const LIMIT: Colour = [0xb3, 0x4d, 0x86];

/// Cividis, at even steps, as plotly has it: even in lightness, and the same to colour-blind people.
const CIVIDIS: [Colour; 18] = [
    [0, 32, 76],
    [0, 42, 102],
    [0, 52, 110],
    [39, 63, 108],
    [60, 74, 107],
    [76, 85, 107],
    [91, 95, 109],
    [104, 106, 112],
    [117, 117, 117],
    [131, 129, 120],
    [146, 140, 120],
    [161, 152, 118],
    [176, 165, 114],
    [192, 177, 109],
    [209, 191, 102],
    [225, 204, 92],
    [243, 219, 79],
    [255, 233, 69],
];
/// Rows of the picture of a scale.
const ROWS: u32 = 256;

/// A scale of colours between two values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourScale {
    pub from: f64,
    pub to: f64,
}

impl ColourScale {
    /// The colour of a value; values beyond the scale have that of its end.
    pub fn colour(self, value: f64) -> Colour {
        let share = ((value - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        let place = share * (CIVIDIS.len() - 1) as f64;
        let below = place.floor();
        let at = |index: usize| CIVIDIS.get(index).copied().unwrap_or(BLACK);
        let (low, high) = (
            at(below as usize),
            at((below as usize + 1).min(CIVIDIS.len() - 1)),
        );
        std::array::from_fn(|i| {
            let (low, high) = (f64::from(low[i]), f64::from(high[i]));
            (low + (place - below) * (high - low)).round() as u8
        })
    }

    /// The pixels of a grid of values, row after row from above; what is no number has none.
    pub fn pixels(self, values: &[f64], columns: usize) -> Pixels {
        let pixel = |value: &f64| match value.is_nan() {
            true => [0; 4],
            false => {
                let [r, g, b] = self.colour(*value);
                [r, g, b, 255]
            }
        };
        Pixels {
            width: columns as u32,
            height: (values.len() / columns.max(1)) as u32,
            bytes: values.iter().flat_map(pixel).collect(),
        }
    }

    /// The scale itself, a column of pixels with its end above.
    pub fn bar(self) -> Pixels {
        let share = |row: u32| 1.0 - (f64::from(row) + 0.5) / f64::from(ROWS);
        let values = (0..ROWS).map(|row| self.from + share(row) * (self.to - self.from));
        self.pixels(&values.collect::<Vec<_>>(), 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_middle_have_the_colours_of_cividis() {
        let scale = ColourScale {
            from: -10.0,
            to: 10.0,
        };
        let colours = [-99.0, -10.0, 10.0, 99.0].map(|value| scale.colour(value));
        assert_eq!(colours, [CIVIDIS[0], CIVIDIS[0], CIVIDIS[17], CIVIDIS[17]]);
        // Half of the way between the two in the middle.
        assert_eq!(scale.colour(0.0), [124, 123, 119]);
    }

    #[test]
    fn lightness_grows_with_the_value() {
        let scale = ColourScale { from: 0.0, to: 1.0 };
        // The weights of Rec. 709.
        let light = |[r, g, b]: Colour| {
            0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
        };
        let lights = (0..=100).map(|i| light(scale.colour(f64::from(i) / 100.0)));
        let lights: Vec<f64> = lights.collect();
        assert!(lights.windows(2).all(|pair| pair[1] > pair[0] - 1e-9));
    }

    #[test]
    fn what_is_no_number_is_transparent() {
        let scale = ColourScale { from: 0.0, to: 1.0 };
        let pixels = scale.pixels(&[f64::NAN, 1.0], 1);
        assert_eq!((pixels.width, pixels.height), (1, 2));
        assert_eq!(pixels.bytes, [0, 0, 0, 0, 255, 233, 69, 255]);
    }
}
