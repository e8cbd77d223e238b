//! The moves before and after a path: one axis at a time, over places where nothing of the part is.
//!
//! A path that begins with a lead-in is at rest there. Its program has an approach before it: Z goes up
//! to the plane of the approach, then X and C go to the path's first point, and then Z goes down to it
//! at a feed of its own. After a lead-out, Z goes up to that plane again: the retreat. The plane is
//! [`ProgramFormat::approach_height`] above the highest place of the path, and a path with leads rests
//! above the highest place of the part.
//!
//! A path without leads begins and ends in motion. Its program has neither: the header and the footer
//! of its recipe bring the axes to speed and take them away.

use turnpath_core::toolpath::Section;

use crate::digit_segments::DigitSegments;
use crate::digits::{Digits, said_place};
use crate::program_format::ProgramFormat;

/// Index of an axis among C, X and Z.
pub(crate) const C: usize = 0;
pub(crate) const X: usize = 1;
pub(crate) const Z: usize = 2;

/// A statement before or after a path. Positions are in the program's last digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Travel {
    /// Numbers are positions from here on, and the axes come to rest after each move.
    Begin,
    /// One axis at the machine's own speed.
    Rapid {
        /// Its index among C, X and Z.
        axis: usize,
        /// Where it goes.
        to: i64,
    },
    /// Z at the feed of the approach.
    Feed {
        /// Where it goes.
        to: i64,
        /// How far that is, always positive.
        way: i64,
    },
    /// The program waits for the operator.
    Stop,
}

/// Which of the two motions a move is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// At the machine's own speed.
    Rapid,
    /// At the speed that the program says.
    Fed,
}

/// What a program says of the speed of such a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Speed {
    /// mm/min.
    Feed(f64),
    /// Its time in whole milliseconds.
    Milliseconds(f64),
}

/// The modes of a controller that a reader of such moves keeps.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TravelModes {
    /// The words of modes that the program has said.
    pub said: Vec<&'static str>,
    /// How the axes move.
    pub motion: Option<Motion>,
    /// How fast they move, unless the move is a rapid one.
    pub speed: Option<Speed>,
    /// Whether the last move would be blended with the path, because nothing has ended it.
    pub blends: bool,
}

impl TravelModes {
    /// Takes a word of a mode.
    pub fn say(&mut self, word: &'static str) {
        self.said.push(word);
    }

    /// Checks that all of these words were said before a move.
    ///
    /// # Errors
    /// The first of them that is missing.
    pub fn need(&self, words: &[&str]) -> Result<(), String> {
        let missing = words.iter().find(|word| !self.said.contains(*word));
        missing.map_or(Ok(()), |word| Err(format!("a move before `{word}`")))
    }
}

/// A speed as it stands in a program: a positive decimal number.
pub(crate) fn speed_of(what: &str, text: &str) -> Result<f64, String> {
    let is_plain = text
        .bytes()
        .all(|byte| byte.is_ascii_digit() || byte == b'.');
    let speed = text
        .parse()
        .ok()
        .filter(|speed: &f64| is_plain && *speed > 0.0);
    speed.ok_or_else(|| format!("{what} is no positive number"))
}

/// The positions that one line of such moves gives to C, X and Z, in 10⁻¹² mm or deg.
pub type Places = [Option<i128>; 3];

/// From where to where the lines of a program go, in last digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    first: Digits,
    highest: i64,
    /// Whether the path begins with a lead-in and ends with a lead-out.
    leads: [bool; 2],
}

impl Extent {
    /// That of one point.
    pub(crate) fn of(point: &Digits, section: Section) -> Self {
        Self {
            first: *point,
            highest: point.position[Z],
            leads: [section == Section::LeadIn, section == Section::LeadOut],
        }
    }

    /// That of the ends of segments.
    pub(crate) fn of_segments(segments: &DigitSegments<'_>, section: Section) -> Option<Self> {
        let first = Self::of(&segments.ends().at(0)?, section);
        Some(Self {
            highest: segments.highest()?,
            ..first
        })
    }

    /// That of these lines and those that follow.
    pub(crate) fn and(self, next: Self) -> Self {
        Self {
            first: self.first,
            highest: self.highest.max(next.highest),
            leads: [self.leads[0], next.leads[1]],
        }
    }

    /// The plane over which X and C go.
    pub(crate) fn plane(&self, format: &ProgramFormat) -> i64 {
        self.highest.saturating_add(format.approach_digits())
    }

    /// The moves to the path's first point; none where the path begins in motion.
    pub(crate) fn approach(&self, format: &ProgramFormat) -> Vec<Travel> {
        if !self.leads[0] {
            return Vec::new();
        }
        let plane = self.plane(format);
        let [c, x, z] = said_place(format, &self.first);
        vec![
            Travel::Begin,
            Travel::Rapid { axis: Z, to: plane },
            Travel::Rapid { axis: X, to: x },
            Travel::Rapid { axis: C, to: c },
            Travel::Feed {
                to: z,
                way: plane - z,
            },
        ]
    }

    /// The moves from the path's last point; none where the path ends in motion.
    pub(crate) fn retreat(&self, format: &ProgramFormat) -> Vec<Travel> {
        if !self.leads[1] {
            return Vec::new();
        }
        let to = self.plane(format);
        vec![Travel::Begin, Travel::Rapid { axis: Z, to }]
    }
}
