//! The layout of a program. Its writer and its reader must agree on it.

use turnpath_core::toolpath::Section;

/// Steps of time in a millisecond, with I42 = 0.
pub(super) const QUANTA_PER_MS: u32 = 4096;
/// Steps of time in a second.
pub const QUANTA_PER_S: f64 = 4_096_000.0;
/// Longest segment in steps: 24 bits, 4095.9998 ms.
pub(super) const LONGEST: i64 = (1 << 24) - 1;
/// Time of the move to the first control point, ms. It is not a part of the path.
pub const ENTRY_MS: u32 = 1000;
/// Degrees of a revolution.
pub(super) const TURN_DEG: i64 = 360;
/// The beginning of the line after the path.
pub(super) const END_MARK: &str = "-- end of path";

/// The settings of a program. The defaults are absolute positions, C unwrapped and growing, 7
/// decimals, velocities per second, Z of the nose centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PmacFormat {
    /// Decimals of positions, in mm and deg.
    pub position_decimals: u32,
    /// Decimals of velocities. If velocities have as many decimals as positions, or one less where
    /// they are per minute, their rounding costs less than a position's last digit over any segment
    /// that the controller accepts: the rounding at both ends moves the middle of the segment by a
    /// quarter of the rounding error times the segment's duration in seconds.
    pub velocity_decimals: u32,
    /// Velocities per minute (Ix90 = 60000) instead of per second (Ix90 = 1000).
    pub per_minute: bool,
    /// The program's C runs against the path's.
    pub c_reversed: bool,
    /// Absolute C within 0 to 360 deg.
    pub c_wrapped: bool,
    /// Distances from point to point (`INC`) instead of positions (`ABS`).
    pub incremental: bool,
    /// Z of the path − Z of the program, mm: the nose radius where the program's Z is the tip's.
    pub z_above: f64,
}

impl Default for PmacFormat {
    fn default() -> Self {
        Self {
            position_decimals: 7,
            velocity_decimals: 7,
            per_minute: false,
            c_reversed: false,
            c_wrapped: false,
            incremental: false,
            z_above: 0.0,
        }
    }
}

impl PmacFormat {
    /// The value that Ix90 must have: the milliseconds that velocities refer to.
    pub fn ix90(&self) -> u32 {
        if self.per_minute { 60_000 } else { 1000 }
    }

    /// The seconds that velocities refer to.
    pub(super) fn velocity_time(&self) -> f64 {
        if self.per_minute { 60.0 } else { 1.0 }
    }

    /// 1, or −1 if the program's C runs against the path's.
    pub(super) fn c_sign(&self) -> f64 {
        if self.c_reversed { -1.0 } else { 1.0 }
    }
}

/// The line before a section, without its semicolon.
pub(super) fn mark(section: Section) -> &'static str {
    match section {
        Section::LeadIn => "-- lead-in --",
        Section::Cutting => "-- cutting --",
        Section::LeadOut => "-- lead-out --",
    }
}
