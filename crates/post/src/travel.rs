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

/// The modes of a controller that a reader of such moves keeps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TravelModes {
    /// Whether the program has said that numbers are positions.
    pub absolute: bool,
    /// Whether it has said that they are mm, on a controller that also reads inches.
    pub metric: bool,
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
