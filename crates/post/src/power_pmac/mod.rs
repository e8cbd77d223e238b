//! Motion programs for Power PMAC in position-velocity-time mode.
//!
//! The lines of a path are those of Turbo PMAC. The controller has doubles throughout, so a C that
//! is not wrapped stays exact over any number of revolutions, and times are not counted in 1/4096 ms:
//! the program writes them in steps of a nanosecond.
//!
//! What is not known from a manual: whether the controller has a longest segment. Segments of more
//! than 1000 s are divided.

use turnpath_core::toolpath::SegmentShape;

use crate::pmac::{Clock, PVT_KEYS, PmacDialect, Pvt};
use crate::post::Post;
use crate::program_format::FeedMeaning;

/// Times in steps of a nanosecond.
const CLOCK: Clock = Clock {
    steps_per_ms: 1_000_000,
    decimals: 6,
};

/// Programs for Power PMAC.
pub(crate) const POWER_PMAC_PVT: Post = Post {
    name: "power-pmac-pvt",
    table: "output.power-pmac-pvt",
    extension: "ppmc",
    summary: "the layout of the programs of the post `power-pmac-pvt`",
    comment: "//",
    keys: PVT_KEYS,
    header: "\
// {name}
// recipe {recipe}, SHA-256 {sha256}
// changed by --set: {changes}
// turnpath {turnpath}, post power-pmac-pvt: {points} points, {revolutions} revolutions, {time_s} s
// X, Z in mm, Z of the {z_reference}; C in deg, {c_range}; velocities per {velocity_unit}: Coord[x].FeedTime = {ix90}
// X: {axis_x}
// Z: {axis_z}
// C: {axis_c}
// the path begins and ends {ends}
// verified on this text: {verified}
close
open prog 1
",
    footer: "close\n",
    shape: SegmentShape::Cubic,
    feed: FeedMeaning::PerMinute,
    steps_per_s: 1_000_000_000,
    longest: 1_000_000_000_000,
    mantissa_bits: None,
    c_is_even: false,
    delivered_decimals: None,
    dialect: &Pvt {
        clock: CLOCK,
        dialect: PmacDialect::Power,
    },
};
