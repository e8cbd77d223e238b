//! Motion programs of all posts, in all layouts.

use turnpath_core::Params;
use turnpath_post::{Layout, POSTS, ProgramFormat};

use super::points::{assert_blocks_agree, one_by_one};

const FILE: &str = "part.program";

/// Words of such programs.
pub const WORDS: &[&str] = &[
    "; -- lead-in --\n",
    "; -- cutting --\n",
    "; -- approach --\n",
    "; -- retreat --\n",
    "ABS\nRAPID\nZ6.5\nX2.5\nC0\nLINEAR TM5000\nZ1.5\nDWELL0\n",
    "G90 G94 G710 G60 FGROUP()\nG0 Z6.5\nG0 X2.5\nG0 C0\nG1 Z1.5 F60\n",
    "MoveRapid([Z], [6.5])\n",
    "MoveLinear([Z], [1.5], 1)\n",
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
    "// -- cutting --\n",
    "// -- end of path: 1 points --\n",
    "SetupTaskDistanceUnits(DistanceUnits.Primary)\n",
    "SetupTaskTimeUnits(TimeUnits.Seconds)\n",
    "SetupTaskTargetMode(TargetMode.Absolute)\n",
    "SetupTaskTargetMode(TargetMode.Incremental)\n",
    "MovePvt([C, X, Z], [9, 2.5, 1.5], [3000, -0.2, 0], 0.003)\n",
    "[",
    "]",
    "G90 G93 G64 FGROUP(C) UPATH\n",
    "G1 C0 X2.5 Z1.5 F60\n",
    "POLY PO[C]=(9) PO[X]=(2.4,0.001) PO[Z]=(1.6,0.001,-0.001) F20000\n",
    "PO[Z]=(",
    "POLY PO[X]=(1,999999999999999,999999999999999) F60\n",
    "F60000000000\n",
    "F0.06\n",
    "g1 ",
    "G71 ",
    "MovePvt([C], [999999999999999], [-999999999999999], 1000)\n",
    "SetupTaskDistanceUnits(DistanceUnits.Primary)\n",
    "F20000",
    "POLY ",
    "G8 G21 G40 G64 G90 G93\n",
    "G1 C0 X2.5 Z0 F60\n",
    "C9 X2.499 Z1 F20000\n",
    "G4 P0.003\n",
    "G40 G52 G71 G90 G93 G359\n",
    "G90 G94 G40 G52 G71 G360\nG0 Z6.5\n",
    "G40 G52 G71 G90 G93 G359\nG1 C0 X2.5 Z1.5 F1\nG0 W0\n#FGROUP [W]\n",
    "G94 G1 W0.03 C[POLY A0=0 A1=9] X[POLY A0=2.5] Z[POLY A0=1.5 A2=0.1 A3=-0.1] F600\n",
    "W10000.06 Z[POLY A0=1 A1=999999999999999 A2=-999999999999999]\n",
    "; -- depths --\n#100 = 3\n#103 = 0.002\n#5 = 0\n#8 = 0.006\nWHILE[#5 LT #100] DO 2\n",
    "#8 = #8 - #103\nG52 X0 Y0 Z[#8]\n",
    "#5 = #5 + 1\nEND 2\n",
    "; -- end of depths --\n",
    "#FGROUP\n",
    " L=2",
    "[POLY A0=",
    "W",
    "( -- cutting -- )\n",
    "F0.003",
    " F",
];

/// Reads a program as one of each post, in each layout that changes what its numbers mean.
pub fn read(bytes: &[u8]) {
    for post in POSTS {
        for layout in 0..8_u8 {
            let bit = |which: u8| layout & (1 << which) != 0;
            let z_above = if bit(0) { 1.5 } else { 0.0 };
            let format = ProgramFormat {
                per_minute: bit(0),
                c_reversed: bit(1),
                c_wrapped: bit(2),
                ..post.format(&Params::new(), z_above, 1e-4)
            };
            read_one(&Layout { post, format }, bytes);
        }
    }
}

fn read_one(layout: &Layout, bytes: &[u8]) {
    let new = || layout.read(bytes, FILE);
    let (points, error) = one_by_one(&mut new());
    assert_blocks_agree(|| Some(new()), &points, error.as_ref());
    for pair in points.windows(2) {
        let [(before, _), (after, _)] = pair else {
            continue;
        };
        assert!(before.t < after.t, "times grow");
    }
}
