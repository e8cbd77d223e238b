//! The settings of posts: keys that dialects may have in their tables, and the format that they give.

use turnpath_core::kind::{Angle, Choice, Count, Length, Number, Text, Time, Velocity};
use turnpath_core::toolpath::SegmentShape;
use turnpath_core::{DEG, Param, ParamDefault, Params};

use crate::part_name::PartNumbers;
use crate::post::Post;
use crate::program_format::{Chords, Depths, FeedMeaning, ProgramFormat, Slowest, TimeAxis};

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
const SECONDS: &str = "s";

/// The part of their share that chords are placed for. The rest is for slopes that change within a
/// segment.
const CHORD_AIM: f64 = 0.95;
/// The least part of their share that chords are placed for, where digits take more of it.
const LEAST_CHORD_AIM: f64 = 0.25;
/// The longest line of a lead where a controller plays no slow line, s. A longer one makes the steps
/// coarser in which the leads move, a shorter one makes more lines: at 0.1 mm/min it is 7 nm.
const LONGEST_IN_LEAD: f64 = 4e-3;
/// Largest way of X and of Z, mm, that a controller with a lowest rate takes for none.
const STILL: f64 = 1e-7;
/// The shortest line of LinuxCNC in periods of its servo thread (TP_MIN_SEGMENT_CYCLES in
/// src/emc/tp/tp_types.h).
const SHORTEST_PERIODS: f64 = 1.02;
/// Most depths of a loop: with more, a person has mistaken the key.
const MOST_DEPTHS: u64 = 1000;
/// The largest step of depths, mm: far more than a diamond cuts at once.
const LARGEST_STEP: f64 = 10.0;
/// Seconds of a minute.
const MINUTE: f64 = 60.0;
/// The slowest axis of time, mm/s: its speed is in whole µm/s.
const SLOWEST_TIME_AXIS: f64 = 1e-3;
/// The fastest one, mm/s: far beyond any machine's, and its way still fits into the numbers of a reader.
const FASTEST_TIME_AXIS: f64 = 1e5;

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
/// Positions of a controller that reads millionths of a millimetre.
pub(crate) const SIX_DECIMALS: Param<Count> = POSITION_DECIMALS.default(6);
/// C of a controller that reads angles of one revolution.
pub(crate) const C_WITHIN_TURN: Param<Choice> = C_WRAP.default(WRAPPED);
/// The chords' share of the tolerance of interpolation.
pub const CHORD_SHARE: Param<Number> = Param::number(
    "chord_share",
    "what the straight lines may take of `tolerance.interpolation`; the path gets the rest. Less \
     gives more lines and fewer control points",
)
.default(0.5)
.positive()
.below(1.0);
pub(crate) const LOWEST_RATE: Param<Velocity> = Param::velocity(
    "lowest_rate",
    "slowest motion that the controller plays in its time: 0.1 mm/min up to LinuxCNC 2.8, and none, \
     \"0 mm/min\", from 2.9.0 on",
)
.default(0.1 / MINUTE)
.min(0.0);
pub(crate) const SERVO_PERIOD: Param<Time> = Param::time(
    "servo_period",
    "`SERVO_PERIOD` of the machine: LinuxCNC plays no line in less than 1.02 of it",
)
.default(1e-3)
.positive();
pub(crate) const FEED_MEANING: Param<Choice> = Param::choice(
    "f_means",
    &["1/min", SECONDS],
    "what F says of a line under `G93`: one over its minutes, or its seconds. See a program that your \
     machine has run",
);
pub(crate) const TIME_AXIS: Param<Choice> = Param::choice(
    "time_axis",
    &["W", "V", "U", "Q", "B", "A", "Y"],
    "the simulated linear axis of the channel whose position is the time",
)
.default("W");
pub(crate) const TIME_AXIS_SPEED: Param<Velocity> = Param::velocity(
    "time_axis_speed",
    "how fast that axis goes, to whole um/s. Faster needs fewer digits of it, and a longer way",
)
.default(10.0)
.min(SLOWEST_TIME_AXIS)
.max(FASTEST_TIME_AXIS);
pub(crate) const TIME_AXIS_LIMIT: Param<Length> = Param::length(
    "time_axis_limit",
    "how far that axis may be from zero; the default is what the maker documents for increments of 0.1 um",
)
.default(214_000.0)
.positive();
pub(crate) const SHORTEST_SEGMENT: Param<Option<Time>> = Param::time(
    "shortest_segment",
    "the shortest segment that your controller plays, or the time in which it reads one; left out: a \
     step of its time",
)
.positive()
.example("0.5 ms")
.optional();
/// The most segments that the controller reads in a second.
pub const SEGMENTS_PER_SECOND: Param<Option<Number>> = Param::number(
    "segments_per_second",
    "the most segments that your controller reads in a second; left out: any number",
)
.positive()
.example("2000")
.optional();
/// The most that the controller holds of one file.
pub const MEMORY: Param<Option<Text>> = Param::text(
    "memory",
    "the largest file that your controller takes, \"100 MB\" or \"200000 blocks\"; left out: any size",
)
.optional();
/// The size of the parts of a long program.
pub const SPLIT: Param<Option<Text>> = Param::text(
    "split",
    "the size of the parts that a longer program calls, \"100 MB\" or \"200000 blocks\"; left out: \
     one file",
)
.optional();
pub(crate) const C_LIMIT: Param<Option<Angle>> = Param::angle(
    "c_limit",
    "how far C of your machine may be from zero, to both sides; left out: any angle",
)
.positive()
.example("360000 deg")
.optional();
/// That of TwinCAT CNC: 1190 turns, which its maker documents for increments of 0.0001 deg.
pub(crate) const TWINCAT_C_LIMIT: Param<Angle> = Param::angle(
    "c_limit",
    "how far C of your machine may be from zero, to both sides; the default is the 1190 turns that the maker \
     documents for increments of 0.0001 deg",
)
.default(1190.0 * 360.0 * DEG)
.positive();
/// How often a loop of the controller plays the path.
pub const DEPTHS: Param<Option<Count>> = Param::count(
    "depths",
    "how often a loop of the controller plays the finishing path, each time `depth_step` deeper; left out: \
     once",
)
.min(1)
.max(MOST_DEPTHS)
.example("3")
.optional();
/// How much deeper each time.
pub const DEPTH_STEP: Param<Option<Length>> = Param::length(
    "depth_step",
    "how much deeper the path lies each time; the last time it is where it is",
)
.positive()
.max(LARGEST_STEP)
.example("2 um")
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

    /// The format that the keys of its table give. A key that it does not have counts as absolute
    /// positions, C unwrapped and growing, 7 decimals, velocities per second; a key that has no value
    /// counts as its default. `z_above` is Z of the path − Z of the program, mm; `tolerance` is that of
    /// interpolation, mm, of which chords have a share.
    pub fn format(&self, settings: &Params, z_above: f64, tolerance: f64) -> ProgramFormat {
        let per_minute = settings.find(VELOCITY_PER) == Some(PER_MINUTE);
        let position_decimals = settings.find(POSITION_DECIMALS);
        let own_decimals = self.default_number(POSITION_DECIMALS.name());
        let position_decimals = position_decimals.or(own_decimals.map(|own| own as u64));
        let position_decimals = decimals(position_decimals.unwrap_or(DECIMALS));
        let to_match = position_decimals.saturating_sub(u32::from(per_minute));
        let velocity_decimals = settings.find(VELOCITY_DECIMALS).flatten();
        let wrap = settings.find(C_WRAP);
        let wrap = wrap.or(self.default_text(C_WRAP.name()));
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
            c_wrapped: wrap == Some(WRAPPED),
            incremental: settings.find(POSITIONING) == Some(INCREMENTAL),
            mantissa_bits: self.mantissa_bits,
            z_above,
            c_limit: settings
                .find(C_LIMIT)
                .flatten()
                .or(self.default_number(C_LIMIT.name()))
                .map(|limit| (limit / DEG * 10u64.pow(position_decimals) as f64).floor() as i64),
            depths: depths(settings, position_decimals),
            time_axis: self.time_axis(settings),
            part_numbers: PartNumbers::ALONE.with_names(self.dialect.part_names()),
            approach_height: APPROACH_HEIGHT,
            approach_feed: APPROACH_FEED,
            chords: (self.shape == SegmentShape::Linear)
                .then(|| self.chords(settings, position_decimals, tolerance)),
        }
    }

    /// The axis of time, if its table has the keys of one.
    fn time_axis(&self, settings: &Params) -> Option<TimeAxis> {
        let own_name = self.default_text(TIME_AXIS.name())?;
        let own_speed = self.default_number(TIME_AXIS_SPEED.name())?;
        let name = settings.find(TIME_AXIS).unwrap_or(own_name);
        let speed = settings.find(TIME_AXIS_SPEED).unwrap_or(own_speed);
        let own_limit = self.default_number(TIME_AXIS_LIMIT.name())?;
        let limit = settings.find(TIME_AXIS_LIMIT).unwrap_or(own_limit);
        Some(TimeAxis {
            limit_um: (1e3 * limit).floor() as i64,
            name: name.chars().next()?,
            speed_um_per_s: (1e3 * speed).round() as i64,
        })
    }

    fn chords(&self, settings: &Params, decimals: u32, tolerance: f64) -> Chords {
        let own = || self.default_number(CHORD_SHARE.name());
        let part = settings.find(CHORD_SHARE).or_else(own).unwrap_or(0.0);
        let share = part * tolerance;
        let one = 10u64.pow(decimals) as f64;
        let seconds = settings.find(FEED_MEANING).map(|means| means == SECONDS);
        let lowest = self.default_number(LOWEST_RATE.name());
        let rate = lowest.map(|own| settings.find(LOWEST_RATE).unwrap_or(own));
        let slowest = rate.map(|rate| self.slowest(rate * MINUTE, decimals));
        // Positions are rounded to multiples of this.
        let rounded_to = slowest.map_or(1, |slowest| slowest.still + 1) as f64 / one;
        Chords {
            share: part,
            deviation: (CHORD_AIM * share - rounded_to).max(LEAST_CHORD_AIM * share),
            feed: match seconds {
                Some(true) => FeedMeaning::Seconds,
                Some(false) => FeedMeaning::PerMinute,
                None => self.feed,
            },
            shortest: self.shortest(settings),
            slowest,
        }
    }

    /// The shortest line, in steps.
    fn shortest(&self, settings: &Params) -> i64 {
        let own = self.default_number(SERVO_PERIOD.name());
        let period = own.map(|own| settings.find(SERVO_PERIOD).unwrap_or(own));
        let shortest = period.map(|period| SHORTEST_PERIODS * period * self.steps_per_s as f64);
        shortest.map_or(1, |steps| (steps.round() as i64).max(1))
    }

    /// The slowest motion at so many mm or deg in a minute.
    fn slowest(&self, rate: f64, decimals: u32) -> Slowest {
        let one = 10u64.pow(decimals) as f64;
        let of_rate = (rate / MINUTE * LONGEST_IN_LEAD * one).ceil();
        let still = (STILL * one * (1.0 + 1e-9)).floor() as i64;
        let linear = (of_rate as i64).max(still + 1);
        Slowest {
            rate,
            still,
            lead_steps: [(of_rate as i64).max(1), linear, linear],
            longest_in_lead: (LONGEST_IN_LEAD * self.steps_per_s as f64) as i64,
        }
    }

    /// The default of a key; `None` if there is none.
    fn default_of(&self, name: &str) -> Option<ParamDefault> {
        let key = self.keys.iter().find(|key| key.name == name)?;
        Some(key.default)
    }

    fn default_number(&self, name: &str) -> Option<f64> {
        match self.default_of(name) {
            Some(ParamDefault::Number(number)) => Some(number),
            _ => None,
        }
    }

    fn default_text(&self, name: &str) -> Option<&'static str> {
        match self.default_of(name) {
            Some(ParamDefault::Text(text)) => Some(text),
            _ => None,
        }
    }
}

/// The loop over depths, if there is more than one.
fn depths(settings: &Params, position_decimals: u32) -> Option<Depths> {
    let count = settings.find(DEPTHS).flatten().filter(|count| *count > 1)?;
    let step = settings.find(DEPTH_STEP).flatten()?;
    let step = (step * 10u64.pow(position_decimals) as f64).round() as i64;
    Some(Depths {
        count: i64::try_from(count).ok()?,
        step: step.max(1),
    })
}

fn decimals(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
