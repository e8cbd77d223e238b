//! What X, Z and C of a program mean, in a line each: a wrong sign costs a part.

use serde::{Deserialize, Serialize};

use crate::run::Direction;

/// What the axes of a program mean.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AxisNotes {
    /// Where X grows, and which way the tool feeds.
    pub x: String,
    /// Where Z grows, where it is zero, and of which point it is.
    pub z: String,
    /// What C = 0 means, and which way the part turns.
    pub c: String,
}

impl AxisNotes {
    /// The notes for a feed direction, for Z of the tool's tip or of the nose centre, and for a C that
    /// runs as the path's does or against it.
    pub fn new(direction: Direction, z_is_of_tip: bool, c_is_reversed: bool) -> Self {
        let way = match direction {
            Direction::Inward => "inward, from the rim to the axis",
            Direction::Outward => "outward, from the axis to the rim",
        };
        let point = if z_is_of_tip {
            "tool tip"
        } else {
            "nose centre"
        };
        let turn = if c_is_reversed {
            "anticlockwise"
        } else {
            "clockwise"
        };
        Self {
            x: format!("+ away from the spindle axis, the tool stands at +X; {way}"),
            z: format!("+ away from the part, 0 at height 0 of the surface; of the {point}"),
            c: format!(
                "0 with the part's x axis under the tool; + turns the part {turn}, seen from the tool"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At C = 90 deg the part's y axis, which points up, has come to the tool on the right.
    #[test]
    fn the_part_turns_clockwise_unless_the_sign_of_c_is_changed() {
        let notes = |reversed| AxisNotes::new(Direction::Inward, true, reversed).c;
        assert!(notes(false).contains("turns the part clockwise"));
        assert!(notes(true).contains("turns the part anticlockwise"));
    }
}
