//! What the axes of a recipe's programs mean.

use turnpath_core::Direction;
use turnpath_recipe::{Recipe, ZReference};
use turnpath_report::{self as report, AxisNotes};

/// Which way the tool feeds.
pub fn feed_direction(recipe: &Recipe) -> report::Direction {
    match recipe.direction {
        Direction::Inward => report::Direction::Inward,
        Direction::Outward => report::Direction::Outward,
    }
}

/// The notes for a program whose C runs as the path's does, or against it.
pub fn axis_notes(recipe: &Recipe, c_is_reversed: bool) -> AxisNotes {
    let z_is_of_tip = recipe.output.z_reference == ZReference::Tip;
    AxisNotes::new(feed_direction(recipe), z_is_of_tip, c_is_reversed)
}
