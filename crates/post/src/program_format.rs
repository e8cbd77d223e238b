//! The numbers of a program: what its writer and its reader must agree on.

use turnpath_core::toolpath::{Section, SegmentShape};

use crate::part_name::PartNumbers;

/// What velocities that are off at both ends move the middle of a cubic by, as a part of what such a velocity goes in
/// its time.
const MOVED_BY_VELOCITIES: f64 = 0.25;

/// Degrees of a revolution.
pub(crate) const TURN_DEG: i64 = 360;
/// The beginning of the line after the path, in its comment.
pub(crate) const END_MARK: &str = "-- end of path";

/// The mark before the approach.
pub(crate) const APPROACH_MARK: &str = "-- approach --";
/// The mark before the retreat.
pub(crate) const RETREAT_MARK: &str = "-- retreat --";

/// The mark before the lines that begin a loop over depths.
pub(crate) const DEPTHS_MARK: &str = "-- depths --";
/// The mark before the lines that end it.
pub(crate) const END_OF_DEPTHS_MARK: &str = "-- end of depths --";

/// The mark before the calls of parts.
pub(crate) fn parts_mark(parts: u32) -> String {
    format!("-- {parts} parts --")
}

/// The parts that such a mark says.
pub(crate) fn says_parts(mark: &str) -> Option<u32> {
    let rest = mark.strip_prefix("-- ")?;
    rest.strip_suffix(" parts --")?.parse().ok()
}

/// The mark before the lines of a part.
pub(crate) fn part_mark(number: u32) -> String {
    format!("-- part {number} --")
}

/// The mark behind the lines of a part.
pub(crate) fn end_of_part_mark(number: u32) -> String {
    format!("-- end of part {number} --")
}

/// The mark before the moves of a dry run.
pub(crate) const DRY_RUN_MARK: &str = "-- dry run --";
/// The mark after them.
pub(crate) const END_OF_DRY_RUN_MARK: &str = "-- end of dry run --";
/// What the F of a straight line says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedMeaning {
    /// One over its minutes.
    PerMinute,
    /// Its seconds.
    Seconds,
}

/// Most steps by which a place of a lead is lifted, so that the line to it is not too slow.
pub(crate) const LIFTS: u32 = 2;

/// The slowest motion that a controller plays in the time that F says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slowest {
    /// The lowest rate of X and Z together, mm/min, and of C where they stand still, deg/min. Zero:
    /// any.
    pub rate: f64,
    /// Largest way of X and of Z that the controller takes for none, in last digits.
    pub still: i64,
    /// On leads, positions of C, X and Z are multiples of these, in last digits. So each axis stands
    /// still or is not too slow.
    pub lead_steps: [i64; 3],
    /// The longest line of a lead, in steps of time.
    pub longest_in_lead: i64,
}

impl Slowest {
    /// What positions of C, X and Z are multiples of, in last digits.
    pub(crate) fn steps(&self, in_lead: bool) -> [i64; 3] {
        match in_lead {
            true => self.lead_steps,
            // X and Z stand still, or move by more than counts as none.
            false => [1, self.still + 1, self.still + 1],
        }
    }
}

/// How chords stand for cubics, where a controller goes straight from point to point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chords {
    /// The part of the tolerance of interpolation that is theirs; the path's cubics get the rest.
    pub share: f64,
    /// Largest distance of a chord from its cubic along z, mm.
    pub deviation: f64,
    /// What F says.
    pub feed: FeedMeaning,
    /// The shortest line that the controller plays in its time, in steps.
    pub shortest: i64,
    /// The slowest motion; `None` where every line takes its time.
    pub slowest: Option<Slowest>,
}

/// A path that a loop of the controller plays several times, each time deeper. The last time it is played
/// where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Depths {
    /// How often.
    pub count: i64,
    /// How much deeper each time, in last digits of positions.
    pub step: i64,
}

impl Depths {
    /// How far above the path it is played first, in last digits.
    pub fn rise(&self) -> i64 {
        (self.count - 1).saturating_mul(self.step)
    }
}

/// An axis that a controller moves for its time alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeAxis {
    /// Its name.
    pub name: char,
    /// How fast it goes, µm/s.
    pub speed_um_per_s: i64,
    /// The farthest place from zero, µm.
    pub limit_um: i64,
}

/// How a program writes times, positions and velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgramFormat {
    /// Steps of time in a second: every segment takes a whole number of them.
    pub steps_per_s: i64,
    /// Shortest segment, in steps. A shorter one is refused.
    pub shortest: i64,
    /// Longest segment, in steps. A longer one is divided.
    pub longest: i64,
    /// Decimals of positions, in mm and deg.
    pub position_decimals: u32,
    /// Decimals of velocities. If velocities have as many decimals as positions, or one less where
    /// they are per minute, their rounding costs less than a position's last digit over any segment
    /// of some seconds: the rounding at both ends moves the middle of the segment by a quarter of the
    /// rounding error times the segment's duration in seconds.
    pub velocity_decimals: u32,
    /// Velocities per minute instead of per second.
    pub per_minute: bool,
    /// The program's C runs against the path's.
    pub c_reversed: bool,
    /// Absolute C within 0 to 360 deg.
    pub c_wrapped: bool,
    /// Distances from point to point instead of positions.
    pub incremental: bool,
    /// Bits of the size of a number that the controller holds, where it holds less than a double. It
    /// rounds absolute positions to them; distances are small, and their rounding counts for nothing.
    pub mantissa_bits: Option<u32>,
    /// Z of the path − Z of the program, mm: the nose radius where the program's Z is the tip's.
    pub z_above: f64,
    /// Chords in place of cubics: the program has no velocities. `None` where it plays cubics.
    pub chords: Option<Chords>,
    /// The loop over depths, where the program has one.
    pub depths: Option<Depths>,
    /// The axis of time, where the controller has one.
    pub time_axis: Option<TimeAxis>,
    /// The largest C of the program, to both sides, in last digits, where its axis has an end.
    pub c_limit: Option<i64>,
    /// The numbers of the path's parts, where the controller calls programs by numbers.
    pub part_numbers: PartNumbers,
    /// How far above the highest place of the path X and C move before it, mm.
    pub approach_height: f64,
    /// How fast Z goes down to the path's first point, mm/min.
    pub approach_feed: f64,
}

impl ProgramFormat {
    /// What the controller plays between two points of the program.
    pub fn shape(&self) -> SegmentShape {
        match self.chords {
            Some(_) => SegmentShape::Linear,
            None => SegmentShape::Cubic,
        }
    }

    /// What positions of C, X and Z are multiples of, in last digits.
    pub(crate) fn position_steps(&self, in_lead: bool) -> [i64; 3] {
        let slowest = self.chords.and_then(|chords| chords.slowest);
        slowest.map_or([1; 3], |slowest| slowest.steps(in_lead))
    }

    /// By how much positions of C, X and Z may lie beside those of the path, in last digits: half of what they are
    /// multiples of. A place of a lead may also have been lifted.
    pub fn position_rounding(&self, in_lead: bool) -> [f64; 3] {
        let slowest = self.chords.and_then(|chords| chords.slowest);
        let lifts = if in_lead && slowest.is_some() {
            LIFTS
        } else {
            0
        };
        let [c, x, z] = self.position_steps(in_lead).map(|step| step as f64);
        [0.5 * c, 0.5 * x, (0.5 + f64::from(lifts)) * z]
    }

    /// The part of an absolute position by which the controller's numbers move it, at most; `None` where they hold
    /// all digits of a double, or where the program says distances.
    pub fn held_part(&self) -> Option<f64> {
        let bits = self.mantissa_bits.filter(|_| !self.incremental)?;
        Some(1.0 / (1_u64 << bits.min(53)) as f64)
    }

    /// The milliseconds that velocities refer to, which Turbo PMAC has in Ix90.
    pub fn velocity_ms(&self) -> u32 {
        if self.per_minute { 60_000 } else { 1000 }
    }

    /// The seconds that velocities refer to.
    pub fn velocity_time(&self) -> f64 {
        if self.per_minute { 60.0 } else { 1.0 }
    }

    /// The height of the approach above the path in last digits, rounded up: that above the first of its
    /// depths.
    pub(crate) fn approach_digits(&self) -> i64 {
        let one = 10u64.pow(self.position_decimals) as f64;
        let height = (self.approach_height * one).ceil() as i64;
        height.saturating_add(self.rise())
    }

    /// How far above the path it is played first, in last digits.
    pub(crate) fn rise(&self) -> i64 {
        self.depths.map_or(0, |depths| depths.rise())
    }

    /// The most by which the controller's numbers move a position of this size, in its unit; `None` where
    /// they hold all digits of a double, or where the program says distances.
    pub fn held_rounding(&self, position: f64) -> Option<f64> {
        let part = self.held_part()?;
        let mut size = 1.0;
        while size <= position.abs() {
            size *= 2.0;
        }
        Some(0.5 * part * size)
    }

    /// The last digit of positions, mm or deg.
    pub fn position_digit(&self) -> f64 {
        1.0 / 10_u64.pow(self.position_decimals) as f64
    }

    /// The last digit of velocities, mm/s or deg/s.
    pub fn velocity_digit(&self) -> f64 {
        1.0 / 10_u64.pow(self.velocity_decimals) as f64 / self.velocity_time()
    }

    /// The most by which the digits of the program move X in the cut, mm, where no segment takes longer than this time,
    /// s. What the controller's numbers add is not counted: see [`Self::held_rounding`].
    pub fn moves_x_by(&self, longest_time: f64) -> f64 {
        let [_, x, _] = self.position_rounding(false);
        let of_positions = x * self.position_digit();
        let of_velocities = match self.shape() {
            SegmentShape::Cubic => MOVED_BY_VELOCITIES * 0.5 * self.velocity_digit() * longest_time,
            SegmentShape::Linear => 0.0,
        };
        of_positions + of_velocities
    }

    /// 1, or −1 if the program's C runs against the path's.
    pub fn c_sign(&self) -> f64 {
        if self.c_reversed { -1.0 } else { 1.0 }
    }
}

/// The comment before a section.
pub(crate) fn mark(section: Section) -> &'static str {
    match section {
        Section::LeadIn => "-- lead-in --",
        Section::Cutting => "-- cutting --",
        Section::LeadOut => "-- lead-out --",
    }
}
