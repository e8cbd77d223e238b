//! `[output.pmac-pvt]`: how that post lays out its programs.

use crate::diagnostic::Diagnostic;
use crate::place::Located;
use crate::read::Section;

pub(super) const NAME: &str = "output.pmac-pvt";
pub(super) const KEYS: &[&str] = &[
    "position_decimals",
    "velocity_decimals",
    "velocity_per",
    "c_sign",
    "c_wrap",
    "positioning",
    "header",
    "footer",
];

/// Decimals of positions where none are given: 0.1 nm.
const POSITION_DECIMALS: u32 = 7;
/// Most decimals: beyond, a position has no room in 64 bits.
const MOST_DECIMALS: u32 = 12;

/// `[output.pmac-pvt]`, with what it leaves out filled in.
#[derive(Debug, Clone, PartialEq)]
pub struct PmacPvt {
    /// Decimals of positions, mm and deg.
    pub position_decimals: u32,
    /// Decimals of velocities; as many as of positions unless given, or one less per minute.
    pub velocity_decimals: u32,
    /// Velocities per minute instead of per second.
    pub per_minute: bool,
    /// The program's C runs against the path's: `c_sign = -1`.
    pub c_reversed: bool,
    /// C within 0 to 360 deg instead of unwrapped.
    pub c_wrapped: bool,
    /// Distances from point to point instead of places.
    pub incremental: bool,
    /// The program's header, a template; none: the post's own.
    pub header: Option<Located<String>>,
    /// Its footer, likewise.
    pub footer: Option<Located<String>>,
}

/// Reads `[output.pmac-pvt]`.
pub(crate) fn pmac_pvt(section: &mut Section<'_>) -> PmacPvt {
    section.only(KEYS);
    section.is_table();
    let is = |section: &mut Section<'_>, key: &str, words: [&'static str; 2]| {
        let word = section.word(key, &words);
        word.is_some_and(|word| word.value == words[1])
    };
    let per_minute = is(section, "velocity_per", ["s", "min"]);
    let position_decimals = decimals(section, "position_decimals").unwrap_or(POSITION_DECIMALS);
    let to_match = position_decimals.saturating_sub(u32::from(per_minute));
    PmacPvt {
        position_decimals,
        velocity_decimals: decimals(section, "velocity_decimals").unwrap_or(to_match),
        per_minute,
        c_reversed: c_reversed(section),
        c_wrapped: is(section, "c_wrap", ["unwrapped", "0-360"]),
        incremental: is(section, "positioning", ["absolute", "incremental"]),
        header: section.text("header"),
        footer: section.text("footer"),
    }
}

fn decimals(section: &mut Section<'_>, key: &str) -> Option<u32> {
    let written = section.number(key)?;
    let found = (0..=MOST_DECIMALS).find(|count| f64::from(*count) == written.value);
    if found.is_none() {
        let title = format!("`{key}` must be a whole number from 0 to {MOST_DECIMALS}");
        section.complain(Diagnostic::new(written.place, title).label("not such a number"));
    }
    found
}

fn c_reversed(section: &mut Section<'_>) -> bool {
    let Some(written) = section.number("c_sign") else {
        return false;
    };
    if written.value.abs() != 1.0 {
        let diagnostic = Diagnostic::new(written.place, "`c_sign` must be 1 or -1")
            .label("neither")
            .help("-1: the program's C runs against that of the path, which grows");
        section.complain(diagnostic);
    }
    written.value < 0.0
}
