//! The posts of motion programs: their names, and how a recipe lays out what they write.

use turnpath_post::PmacFormat;
use turnpath_recipe::{Recipe, ZReference};

/// The post's name in recipes.
pub const PMAC_PVT: &str = "pmac-pvt";
/// What the names of its files end with.
pub const PMAC_EXTENSION: &str = "pmc";

/// How a recipe lays out PMAC programs. A path that is not compensated is that of the contact, so
/// its Z is the tip's already.
pub fn pmac_format(recipe: &Recipe, compensates_nose: bool) -> PmacFormat {
    let settings = &recipe.pmac_pvt;
    let tip = recipe.output.z_reference == ZReference::Tip && compensates_nose;
    PmacFormat {
        position_decimals: settings.position_decimals,
        velocity_decimals: settings.velocity_decimals,
        per_minute: settings.per_minute,
        c_reversed: settings.c_reversed,
        c_wrapped: settings.c_wrapped,
        incremental: settings.incremental,
        z_above: if tip { recipe.tool.nose_radius } else { 0.0 },
    }
}
