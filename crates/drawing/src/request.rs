//! Which figure is drawn, how large, and why it may be refused.

use std::ops::RangeInclusive;

/// Sides of a drawing, mm: from the least side of any figure to a poster.
const SIDES: RangeInclusive<f64> = 40.0..=1200.0;
/// Dots an inch: from a screen to a film.
const DOTS: RangeInclusive<u32> = 50..=2400;
/// Pixels of a PNG at the most: 400 MB of memory.
const MOST_PIXELS: f64 = 1e8;
/// Millimetres of an inch.
const INCH: f64 = 25.4;

/// What is drawn of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Figure {
    /// Machined − wanted along z, as a map.
    Map,
    /// Places of the tool, coloured by |played − true|.
    Spiral,
    /// Feed, control points and speed of the spindle against the radius.
    Feed,
    /// Velocity, acceleration and jerk of X and Z against the radius, with the machine's limits.
    Axes,
    /// The amplitude of each harmonic of the error around a turn.
    Spectrum,
}

impl Figure {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Map,
        Self::Spiral,
        Self::Feed,
        Self::Axes,
        Self::Spectrum,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Spiral => "spiral",
            Self::Feed => "feed",
            Self::Axes => "axes",
            Self::Spectrum => "spectrum",
        }
    }

    /// The figure of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|figure| figure.name() == name)
    }

    /// The size that it has unless another one is asked for: a column of a journal, or for the axes
    /// the width of a page.
    pub fn size(self) -> Size {
        let (width, height) = match self {
            Self::Map | Self::Spiral => (85.0, 72.0),
            Self::Feed => (85.0, 95.0),
            Self::Axes => (170.0, 105.0),
            Self::Spectrum => (85.0, 60.0),
        };
        Size { width, height }
    }

    /// The least size at which its titles and numbers stand beside each other, and its frames are high
    /// and wide enough to read.
    pub fn least(self) -> Size {
        let (width, height) = match self {
            Self::Map | Self::Spiral | Self::Spectrum => (45.0, 40.0),
            Self::Feed => (45.0, 45.0),
            Self::Axes => (60.0, 45.0),
        };
        Size { width, height }
    }

    /// Whether it can be drawn at this size.
    ///
    /// # Errors
    /// When a side is below that of its least size.
    pub fn allows(self, size: Size) -> Result<(), DrawingError> {
        let least = self.least();
        match size.width >= least.width && size.height >= least.height {
            true => Ok(()),
            false => Err(DrawingError::Small { figure: self, size }),
        }
    }
}

/// The sides of a drawing, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Size {
    /// A drawing of this width and height, mm.
    ///
    /// # Errors
    /// When a side is too short for any figure, or longer than any paper.
    pub fn new(width: f64, height: f64) -> Result<Self, DrawingError> {
        match SIDES.contains(&width) && SIDES.contains(&height) {
            true => Ok(Self { width, height }),
            false => Err(DrawingError::Size { width, height }),
        }
    }

    /// The pixels of a PNG of this size, along its width and along its height.
    ///
    /// # Errors
    /// When they are too many.
    pub fn pixels(self, dots: Dots) -> Result<[u32; 2], DrawingError> {
        let pixels = |side: f64| (side * dots.per_mm()).round() as u32;
        let (width, height) = (pixels(self.width), pixels(self.height));
        match f64::from(width) * f64::from(height) > MOST_PIXELS {
            true => Err(DrawingError::Pixels { width, height }),
            false => Ok([width, height]),
        }
    }
}

/// Dots an inch of a PNG.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dots(u32);

impl Dots {
    /// So many an inch.
    ///
    /// # Errors
    /// When they are too few to read, or more than any printer has.
    pub fn per_inch(dots: u32) -> Result<Self, DrawingError> {
        match DOTS.contains(&dots) {
            true => Ok(Self(dots)),
            false => Err(DrawingError::Dots { dots }),
        }
    }

    pub(crate) fn per_mm(self) -> f64 {
        f64::from(self.0) / INCH
    }
}

/// Why a drawing cannot be made as it is asked for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawingError {
    /// A side is too short or too long.
    #[error(
        "a drawing of {width} mm x {height} mm: each side has {} mm to {} mm",
        SIDES.start(),
        SIDES.end()
    )]
    Size {
        /// mm.
        width: f64,
        /// mm.
        height: f64,
    },
    /// A figure has no room for its titles and numbers.
    #[error(
        "the figure `{}` at {} mm x {} mm: it needs {} mm x {} mm at the least",
        figure.name(), size.width, size.height, figure.least().width, figure.least().height
    )]
    Small {
        /// What is to be drawn.
        figure: Figure,
        /// Its size.
        size: Size,
    },
    /// A PNG has too few or too many dots.
    #[error("{dots} dots an inch: a PNG has {} to {}", DOTS.start(), DOTS.end())]
    Dots {
        /// Dots an inch.
        dots: u32,
    },
    /// A PNG has too many pixels.
    #[error("a PNG of {width} x {height} pixels is too large: ask for fewer dots an inch")]
    Pixels {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_figure_has_a_name_and_a_size_that_can_be_asked_for() {
        for figure in Figure::ALL {
            assert_eq!(Figure::named(figure.name()), Some(figure));
            let Size { width, height } = figure.size();
            assert_eq!(Size::new(width, height), Ok(figure.size()));
        }
        assert_eq!(Figure::named("Map"), None);
    }

    #[test]
    fn a_figure_is_refused_below_its_least_size_with_that_size() {
        for figure in Figure::ALL {
            let Size { width, height } = figure.least();
            assert_eq!(Size::new(width, height), Ok(figure.least()));
            assert_eq!(figure.allows(figure.least()), Ok(()));
            assert_eq!(figure.allows(figure.size()), Ok(()));
            for (width, height) in [(width - 1.0, height), (width, height - 1.0)] {
                assert!(
                    figure.allows(Size { width, height }).is_err(),
                    "{}",
                    figure.name()
                );
            }
        }
        let refused = Figure::Axes.allows(Size::new(40.0, 50.0).unwrap());
        let message = "the figure `axes` at 40 mm x 50 mm: it needs 60 mm x 45 mm at the least";
        assert_eq!(refused.unwrap_err().to_string(), message);
    }

    #[test]
    fn no_size_is_smaller_than_its_titles_or_larger_than_paper() {
        for (width, height) in [(20.0, 60.0), (85.0, 1e9), (f64::NAN, 60.0), (-85.0, 60.0)] {
            assert!(Size::new(width, height).is_err());
        }
        let poster = Size::new(1200.0, 900.0).unwrap();
        assert!(poster.pixels(Dots::per_inch(2400).unwrap()).is_err());
        assert!(Dots::per_inch(0).is_err() && Dots::per_inch(1_000_000).is_err());
    }
}
