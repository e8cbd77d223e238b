//! The place of a surface in a sum: the keys that every surface takes.

use turnpath_core::kind::{Angle, Length, Number};
use turnpath_core::{Param, ParamInfo, Placement};

use crate::read::Section;

use super::strategy::USE;

const SCALE: Param<Number> = Param::number(
    "scale",
    "factor on the height; -1 takes the surface away from the sum",
)
.nonzero()
.default(1.0);
const DECENTRE_X: Param<Length> =
    Param::length("decentre_x", "where the surface's own origin lies, along x").default(0.0);
const DECENTRE_Y: Param<Length> =
    Param::length("decentre_y", "where the surface's own origin lies, along y").default(0.0);
const CLOCKING: Param<Angle> = Param::angle(
    "clocking",
    "how far the surface is turned about its own origin, from x to y",
)
.default(0.0);
const PISTON: Param<Length> =
    Param::length("piston", "height that is added after the scale").default(0.0);

/// The host's keys in the table of a surface.
pub(super) const KEYS: &[ParamInfo] = &[
    USE.info(),
    SCALE.info(),
    DECENTRE_X.info(),
    DECENTRE_Y.info(),
    CLOCKING.info(),
    PISTON.info(),
];

/// Reads the place of a surface in the sum.
pub(crate) fn placement(section: &mut Section<'_>) -> Option<Placement> {
    let of_place = KEYS.iter().filter(|key| key.name != USE.name());
    let params = section.values(of_place);
    Some(Placement {
        scale: params.find(SCALE)?,
        decentre_x: params.find(DECENTRE_X)?,
        decentre_y: params.find(DECENTRE_Y)?,
        clocking: params.find(CLOCKING)?,
        piston: params.find(PISTON)?,
    })
}
