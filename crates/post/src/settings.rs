//! The settings of posts: keys that dialects may have in their tables, and the format that they give.

use turnpath_core::kind::{Choice, Count, Number, Text, Time};
use turnpath_core::{Param, Params};

use crate::post::Post;
use crate::program_format::ProgramFormat;

/// Decimals of positions if the recipe gives none: the last one is 0.1 nm.
const DECIMALS: u64 = 7;
/// Most decimals: with more, a position does not fit into 64 bits.
const MOST_DECIMALS: u64 = 12;

/// How far above the highest place of the path X and C move before it if the recipe does not say, mm:
/// more than the rest of a mount stands above a part, and a second's way of a slow Z.
pub const APPROACH_HEIGHT: f64 = 5.0;
/// How fast Z goes down to the path if the recipe does not say, mm/min: a person sees a millimetre in
/// a second, and can stop it.
pub const APPROACH_FEED: f64 = 60.0;

const PER_MINUTE: &str = "min";
const WRAPPED: &str = "0-360";
const INCREMENTAL: &str = "incremental";

pub(crate) const POSITION_DECIMALS: Param<Count> =
    Param::count("position_decimals", "decimals of positions, mm and deg")
        .default(DECIMALS)
        .max(MOST_DECIMALS);
pub(crate) const VELOCITY_DECIMALS: Param<Option<Count>> = Param::count(
    "velocity_decimals",
    "decimals of velocities; left out: as for positions, one less per minute",
)
.max(MOST_DECIMALS)
.example("7")
.optional();
pub(crate) const VELOCITY_PER: Param<Choice> = Param::choice(
    "velocity_per",
    &["s", PER_MINUTE],
    "velocities per second or per minute",
)
.default("s");
pub(crate) const ROTARY: &str = "rotary";
/// Where the lines of a program go.
pub(crate) const BUFFER: Param<Choice> = Param::choice(
    "buffer",
    &["program", ROTARY],
    "a motion program in the controller, or its rotary buffer, for programs that do not fit",
)
.default("program");
/// The sign of C.
pub const C_SIGN: Param<Number> = Param::number(
    "c_sign",
    "1, or -1: the program's C runs against the path's",
)
.default(1.0);
pub(crate) const C_WRAP: Param<Choice> = Param::choice(
    "c_wrap",
    &["unwrapped", WRAPPED],
    "C unwrapped, or within 0 to 360 deg",
)
.default("unwrapped");
pub(crate) const POSITIONING: Param<Choice> = Param::choice(
    "positioning",
    &["absolute", INCREMENTAL],
    "positions, or distances from point to point",
)
.default("absolute");
pub(crate) const SHORTEST_SEGMENT: Param<Option<Time>> = Param::time(
    "shortest_segment",
    "the shortest segment that your controller plays, or the time in which it reads one; left out: a \
     step of its time",
)
.positive()
.example("0.5 ms")
.optional();
/// The template of the header.
pub const HEADER: Param<Option<Text>> = Param::text(
    "header",
    "template of what stands before the lines; left out: the post's own",
)
.optional();
/// The template of the footer.
pub const FOOTER: Param<Option<Text>> = Param::text(
    "footer",
    "template of what stands after the lines; left out: the post's own",
)
.optional();

impl Post {
    /// Whether its programs have velocities, whose decimals are a setting.
    pub fn writes_velocities(&self) -> bool {
        let mut keys = self.keys.iter();
        keys.any(|info| info.name == VELOCITY_DECIMALS.info().name)
    }

    /// The format that the keys of its table give. A key that it does not have, or that has no value,
    /// counts as absolute positions, C unwrapped and growing, 7 decimals, velocities per second.
    /// `z_above` is Z of the path − Z of the program, mm.
    pub fn format(&self, settings: &Params, z_above: f64) -> ProgramFormat {
        let per_minute = settings.find(VELOCITY_PER) == Some(PER_MINUTE);
        let position_decimals = decimals(settings.find(POSITION_DECIMALS).unwrap_or(DECIMALS));
        let to_match = position_decimals.saturating_sub(u32::from(per_minute));
        let velocity_decimals = settings.find(VELOCITY_DECIMALS).flatten();
        ProgramFormat {
            steps_per_s: self.steps_per_s,
            shortest: settings.find(SHORTEST_SEGMENT).flatten().map_or(1, |time| {
                ((time * self.steps_per_s as f64).ceil() as i64).max(1)
            }),
            longest: self.longest,
            position_decimals,
            velocity_decimals: velocity_decimals.map_or(to_match, decimals),
            per_minute,
            c_reversed: settings.find(C_SIGN).is_some_and(|sign| sign < 0.0),
            c_wrapped: settings.find(C_WRAP) == Some(WRAPPED),
            incremental: settings.find(POSITIONING) == Some(INCREMENTAL),
            mantissa_bits: self.mantissa_bits,
            z_above,
            approach_height: APPROACH_HEIGHT,
            approach_feed: APPROACH_FEED,
        }
    }
}

fn decimals(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
