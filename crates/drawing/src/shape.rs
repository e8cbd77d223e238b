//! What a drawing consists of: outlines and pictures, in mm from the upper left corner, y downwards.

/// A place, mm.
pub type Place = [f64; 2];

/// Red, green and blue.
pub type Colour = [u8; 3];

/// A step of an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    Move(Place),
    Line(Place),
    /// A quadratic curve by its control point and its end.
    Curve(Place, Place),
    Close,
}

/// How an outline is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ink {
    /// What it encloses is filled.
    Fill,
    /// Its line is drawn.
    Line {
        /// mm.
        width: f64,
        /// Lengths of dashes and of gaps, mm; `None` for a whole line.
        dash: Option<f64>,
    },
}

/// Pixels with a transparency, row after row from above.
#[derive(Debug, Clone, PartialEq)]
pub struct Pixels {
    pub width: u32,
    pub height: u32,
    /// Red, green, blue and opacity; either opaque or nothing.
    pub bytes: Vec<u8>,
}

/// A rectangle, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Area {
    pub fn right(self) -> f64 {
        self.left + self.width
    }

    pub fn bottom(self) -> f64 {
        self.top + self.height
    }
}

/// A part of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    Outline {
        steps: Vec<Step>,
        ink: Ink,
        colour: Colour,
        /// What it says, for readers of screens: the text of letters, the value of a tick.
        label: Option<String>,
    },
    Picture {
        pixels: Pixels,
        area: Area,
    },
    /// Shapes that belong together, under a name that the drawing has once.
    Group {
        name: String,
        shapes: Vec<Shape>,
    },
}

impl Shape {
    /// A line from place to place.
    pub fn line(places: &[Place], width: f64, colour: Colour) -> Self {
        let step = |(at, place): (usize, &Place)| match at {
            0 => Step::Move(*place),
            _ => Step::Line(*place),
        };
        Self::Outline {
            steps: places.iter().enumerate().map(step).collect(),
            ink: Ink::Line { width, dash: None },
            colour,
            label: None,
        }
    }

    /// The same shape, which says something.
    pub fn labelled(self, text: &str) -> Self {
        match self {
            Self::Outline {
                steps, ink, colour, ..
            } => Self::Outline {
                steps,
                ink,
                colour,
                label: Some(text.to_owned()),
            },
            other => other,
        }
    }
}
