//! `[output.pmac-pvt]`: the layout of the programs of that post.

use turnpath_core::Param;
use turnpath_core::kind::{Choice, Count, Number, Text};

use crate::diagnostic::Diagnostic;
use crate::read::Section;
use crate::span::Spanned;
use crate::table_info::TableInfo;

/// Decimals of positions if the recipe gives none: the last one is 0.1 nm.
const DECIMALS: u64 = 7;
/// Most decimals: with more, a position does not fit into 64 bits.
const MOST_DECIMALS: u64 = 12;

const PER_MINUTE: &str = "min";
const WRAPPED: &str = "0-360";
const INCREMENTAL: &str = "incremental";

const POSITION_DECIMALS: Param<Count> =
    Param::count("position_decimals", "decimals of positions, mm and deg")
        .default(DECIMALS)
        .max(MOST_DECIMALS);
const VELOCITY_DECIMALS: Param<Option<Count>> = Param::count(
    "velocity_decimals",
    "decimals of velocities; left out: as for positions, one less per minute",
)
.max(MOST_DECIMALS)
.example("7")
.optional();
const VELOCITY_PER: Param<Choice> = Param::choice(
    "velocity_per",
    &["s", PER_MINUTE],
    "velocities per second or per minute",
)
.default("s");
const C_SIGN: Param<Number> = Param::number(
    "c_sign",
    "1, or -1: the program's C runs against the path's",
)
.default(1.0);
const C_WRAP: Param<Choice> = Param::choice(
    "c_wrap",
    &["unwrapped", WRAPPED],
    "C unwrapped, or within 0 to 360 deg",
)
.default("unwrapped");
const POSITIONING: Param<Choice> = Param::choice(
    "positioning",
    &["absolute", INCREMENTAL],
    "positions, or distances from point to point",
)
.default("absolute");
const HEADER: Param<Option<Text>> = Param::text(
    "header",
    "template of what stands before the lines; left out: the post's own",
)
.optional();
const FOOTER: Param<Option<Text>> = Param::text(
    "footer",
    "template of what stands after the lines; left out: the post's own",
)
.optional();

pub(super) const PMAC_PVT: TableInfo = TableInfo {
    name: "output.pmac-pvt",
    summary: "the layout of the programs of the post `pmac-pvt`",
    required: false,
    keys: &[
        POSITION_DECIMALS.info(),
        VELOCITY_DECIMALS.info(),
        VELOCITY_PER.info(),
        C_SIGN.info(),
        C_WRAP.info(),
        POSITIONING.info(),
        HEADER.info(),
        FOOTER.info(),
    ],
};

/// `[output.pmac-pvt]`, with defaults for the keys that it leaves out.
#[derive(Debug, Clone, PartialEq)]
pub struct PmacPvt {
    /// Decimals of positions, mm and deg.
    pub position_decimals: u32,
    /// Decimals of velocities. The default is as many as positions have, or one less if velocities
    /// are per minute.
    pub velocity_decimals: u32,
    /// Velocities per minute instead of per second.
    pub per_minute: bool,
    /// The program's C runs against the path's: `c_sign = -1`.
    pub c_reversed: bool,
    /// C within 0 to 360 deg instead of unwrapped.
    pub c_wrapped: bool,
    /// Distances from point to point instead of positions.
    pub incremental: bool,
    /// The template of the program's header; `None` for the post's own.
    pub header: Option<Spanned<String>>,
    /// The template of the program's footer; `None` for the post's own.
    pub footer: Option<Spanned<String>>,
}

/// Reads `[output.pmac-pvt]`; `None` if a value is wrong.
pub(crate) fn pmac_pvt(section: &mut Section<'_>) -> Option<PmacPvt> {
    // Templates keep their places, since the post reads them later.
    let params = section.bind_but(&PMAC_PVT, &[HEADER.name(), FOOTER.name()]);
    section.report_unless_table();
    let per_minute = params.find(VELOCITY_PER)? == PER_MINUTE;
    let position_decimals = decimals(params.find(POSITION_DECIMALS)?);
    let to_match = position_decimals.saturating_sub(u32::from(per_minute));
    Some(PmacPvt {
        position_decimals,
        velocity_decimals: params.find(VELOCITY_DECIMALS)?.map_or(to_match, decimals),
        per_minute,
        c_reversed: c_reversed(section, params.find(C_SIGN)?),
        c_wrapped: params.find(C_WRAP)? == WRAPPED,
        incremental: params.find(POSITIONING)? == INCREMENTAL,
        header: section.text(HEADER.name()),
        footer: section.text(FOOTER.name()),
    })
}

fn decimals(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

fn c_reversed(section: &mut Section<'_>, sign: f64) -> bool {
    if sign.abs() != 1.0 {
        let span = section.nearest_span(C_SIGN.name());
        let diagnostic = Diagnostic::new(span, "`c_sign` must be 1 or -1")
            .with_label("neither 1 nor -1")
            .with_help("the path's C grows; -1 makes the program's C decrease");
        section.report(diagnostic);
    }
    sign < 0.0
}
