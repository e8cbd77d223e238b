//! `[path]`: the direction of the feed, the overrun beyond the part, and the leads.

use turnpath_core::kind::{Choice, ChoiceOr, Flag, Length, WordOrNumber};
use turnpath_core::{Direction, Overrun, Param};

use crate::read::Section;
use crate::table_info::TableInfo;

/// Height of the path's rest above the part if the recipe does not give it, mm.
const REST: f64 = 1.0;
/// The largest height, mm: no lathe for optics has a longer travel of Z.
const REACH: f64 = 1e3;

const OUTWARD: &str = "outward";
const NONE: &str = "none";

const DIRECTION: Param<Choice> = Param::choice(
    "direction",
    &["inward", OUTWARD],
    "which way the tool feeds",
)
.default("inward");
const OVERRUN: Param<ChoiceOr<Length>> = Param::choice_or_length(
    "overrun",
    &["contact", NONE],
    "how far the path runs beyond the part",
)
.default_word("contact")
.min(0.0)
.example("0.5 mm");
const LEAD: Param<Flag> =
    Param::flag("lead", "whether the path runs from rest to rest").default(true);
const CLEARANCE: Param<Length> = Param::length(
    "clearance",
    "height above the highest place of the part at which the path rests",
)
.positive()
.max(REACH)
.default(REST)
.example("1 mm");

pub(super) const PATH: TableInfo = TableInfo {
    name: "path",
    summary: "the direction of the feed, the overrun beyond the part, and the leads",
    required: false,
    keys: &[
        DIRECTION.info(),
        OVERRUN.info(),
        LEAD.info(),
        CLEARANCE.info(),
    ],
};

/// `[path]`.
pub(crate) struct PathTable {
    pub(crate) direction: Direction,
    pub(crate) overrun: Overrun,
    pub(crate) lead: bool,
    pub(crate) clearance: f64,
}

/// Reads `[path]`; `None` if a value is wrong.
pub(crate) fn path(section: &mut Section<'_>) -> Option<PathTable> {
    let params = section.bind(&PATH);
    Some(PathTable {
        direction: match params.find(DIRECTION)? {
            OUTWARD => Direction::Outward,
            _ => Direction::Inward,
        },
        overrun: match params.find(OVERRUN)? {
            WordOrNumber::Word(NONE) => Overrun::None,
            WordOrNumber::Word(_) => Overrun::Contact,
            WordOrNumber::Number(length) => Overrun::Length(length),
        },
        lead: params.find(LEAD)?,
        clearance: params.find(CLEARANCE)?,
    })
}
