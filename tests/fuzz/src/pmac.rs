//! Motion programs for Turbo PMAC, in all layouts.

use turnpath_post::{PmacFormat, PmacReader};

use super::points::{assert_blocks_agree, one_by_one};

const FILE: &str = "part.pmc";

/// Words of such programs.
pub const WORDS: &[&str] = &[
    "; -- lead-in --\n",
    "; -- cutting --\n",
    "; -- lead-out --\n",
    "; -- end of path: 1 points --\n",
    "ABS\n",
    "INC\n",
    "ABS(C,X)\n",
    "INC(Z)\n",
    "PVT1000\n",
    "PVT0.000244140625\n",
    "PVT4095.9999",
    "TM3 ",
    "C0:3000 X2.5:-0.2 Z1.5:0\n",
    "C",
    "X",
    "Z",
    ":",
    "-",
    "+",
    ".",
    "999999999999999.9999999999995",
    "1000000000000000",
    "N10 ",
    "//",
    ";",
    "(",
    ")",
    ",",
    "\n",
    "\r\n",
    "\u{b5}",
];

/// Reads a program in each layout that changes what its numbers mean.
pub fn read(bytes: &[u8]) {
    for layout in 0..8_u8 {
        let bit = |which: u8| layout & (1 << which) != 0;
        let format = PmacFormat {
            per_minute: bit(0),
            c_reversed: bit(1),
            c_wrapped: bit(2),
            z_above: if bit(0) { 1.5 } else { 0.0 },
            ..PmacFormat::default()
        };
        let new = || PmacReader::from_reader(bytes, FILE, format);
        let (points, error) = one_by_one(&mut new());
        assert_blocks_agree(|| Some(new()), &points, error.as_ref());
        for pair in points.windows(2) {
            let [(before, _), (after, _)] = pair else {
                continue;
            };
            assert!(before.t < after.t, "times grow");
        }
    }
}
