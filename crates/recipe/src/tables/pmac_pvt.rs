//! `[output.pmac-pvt]`: the layout of the programs of that post.

use crate::diagnostic::Diagnostic;
use crate::read::Section;
use crate::span::Spanned;

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

/// Decimals of positions if the recipe gives none: the last one is 0.1 nm.
const POSITION_DECIMALS: u32 = 7;
/// Most decimals: with more, a position does not fit into 64 bits.
const MOST_DECIMALS: u32 = 12;

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

/// Reads `[output.pmac-pvt]`.
pub(crate) fn pmac_pvt(section: &mut Section<'_>) -> PmacPvt {
    section.report_unknown_keys(KEYS);
    section.report_unless_table();
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
    let number = section.number(key)?;
    let count = (0..=MOST_DECIMALS).find(|count| f64::from(*count) == number.value);
    if count.is_none() {
        let title = format!("`{key}` must be a whole number from 0 to {MOST_DECIMALS}");
        section.report(Diagnostic::new(number.span, title).with_label("not such a number"));
    }
    count
}

fn c_reversed(section: &mut Section<'_>) -> bool {
    let Some(number) = section.number("c_sign") else {
        return false;
    };
    if number.value.abs() != 1.0 {
        let diagnostic = Diagnostic::new(number.span, "`c_sign` must be 1 or -1")
            .with_label("neither 1 nor -1")
            .with_help("the path's C grows; -1 makes the program's C decrease");
        section.report(diagnostic);
    }
    number.value < 0.0
}
