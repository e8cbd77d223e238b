//! The programs of `siemens-840d-poly` as text: how they look, what they play, and what of them is
//! refused.

use std::path::Path;

use turnpath_core::DEG;
use turnpath_core::toolpath::{PathBlock, Section, SectionBlock, Segment};

use super::SIEMENS_840D_POLY;
use crate::program_tests::{path_of, plain, program, read};

fn good() -> String {
    let steps: Vec<[f64; 6]> = (1..=2)
        .map(|k| [0.003, 9.0, 2.5 - 0.001 * f64::from(k), 1.0, -0.2, 5.0])
        .collect();
    let mut points = path_of(&steps);
    points[0].vc = 3000.0 * DEG;
    program(&plain(&SIEMENS_840D_POLY), &points)
}

#[test]
fn the_program_looks_like_this() {
    let path: Vec<String> = good().lines().map(str::to_owned).collect();
    // Z from 0 to 1 with -1/3 and 5 mm/s in 3 ms: a2 = 3 + 0.002 - 0.015, a3 = 0.014 - 2.
    let expected = [
        "OPEN PROG 1 CLEAR",
        "; -- cutting --",
        "G71 G90 G93 G64 FGROUP()",
        "G1 C0 X2.5 Z-0 F60",
        "FGROUP(C) UPATH",
        "POLY PO[C]=(9) PO[X]=(2.499,-0.0024,0.0014) PO[Z]=(1,2.9869999998,-1.9859999999) F20000",
        "PO[C]=(18) PO[X]=(2.498,-0.0012,0.0008) PO[Z]=(1,-0.045,0.03) F20000",
        "; -- end of path: 3 points --",
        "CLOSE",
    ];
    let expected = expected.map(|line| line.replace("Z-0 ", "Z0 "));
    assert_eq!(path, expected);
}

/// A path that an independent script has played from the definition of the manual; the program and
/// what was played are in tests/reference/programs. The points are those of the cubics: where C is, X
/// and Z are the same, whether C is even in time within a block or not.
#[test]
fn an_independent_evaluation_of_the_polynomials_plays_the_same_path() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/reference/programs");
    let text = std::fs::read(folder.join("saddle.mpf")).unwrap();
    let points = read(&plain(&SIEMENS_840D_POLY), &text).unwrap();
    let played = std::fs::read_to_string(folder.join("siemens_840d.csv")).unwrap();
    let mut rows = played.lines().skip(1);
    let mut seen = 0;
    for pair in points.windows(2) {
        let segment = Segment::between(&pair[0], &pair[1]);
        for k in 0..4 {
            let s = f64::from(k) / 4.0;
            let row = rows.next().unwrap();
            let row: Vec<f64> = row.split(',').map(|value| value.parse().unwrap()).collect();
            let [t, c, x, z] = row[..] else {
                panic!("{row:?}")
            };
            // Where C has its speed of the whole block, it is there at this time, and X and Z with it.
            let c_at = |s: f64| segment.c.value(s);
            let share = (c_at(s) - c_at(0.0)) / (c_at(1.0) - c_at(0.0));
            assert!((segment.start + share * segment.duration - t).abs() < 1e-9);
            for (own, other) in [
                (segment.c.value(s) / DEG, c),
                (segment.x.value(s), x),
                (segment.z.value(s), z),
            ] {
                assert!((own - other).abs() < 1e-9, "{own} {other} at {t}");
            }
            seen += 1;
        }
    }
    assert!(rows.next().is_none() && seen > 100);
}

fn refusal(line: usize, new: &str) -> String {
    let text = good();
    let mut lines: Vec<&str> = text.lines().collect();
    lines[line - 1] = new;
    read(&plain(&SIEMENS_840D_POLY), lines.join("\n").as_bytes()).unwrap_err()
}

#[test]
fn damaged_lines_are_refused_with_their_number() {
    for (line, new, says) in [
        (3, "G71 G90 G94", "line 3: `G94` is not a word"),
        (3, "G90 G93", "line 4: a move before `G71`"),
        (3, "G71 G90", "line 4: a move before `G93`"),
        (3, "G71 G90 G93 FGROUP()", "line 4: a move before `G64`"),
        (3, "G71 G90 G93 G64", "line 4: a move before `FGROUP()`"),
        (5, "", "line 6: a polynomial before `FGROUP(C)` and `UPATH`"),
        (5, "FGROUP(C)", "line 6: a polynomial before `FGROUP(C)`"),
        (5, "FGROUP(C) UPATH FGROUP()", "line 6: a polynomial before"),
        (
            4,
            "G1 C0 X2.5 F60",
            "line 4: the first point does not give Z",
        ),
        (4, "", "line 6: a polynomial before the first point"),
        (6, "PO[C]=(9) F20000", "line 6: this block is neither"),
        (6, "POLY PO[C]=(9)", "line 6: a move without F"),
        (6, "POLY PO[C]=(9) F0", "line 6: F0 is no segment"),
        (
            6,
            "POLY PO[C]=(9,1,1,1) F20000",
            "line 6: the polynomial of C is no cubic",
        ),
        (
            6,
            "POLY PO[Y]=(9) F20000",
            "line 6: `PO[Y]=(9)` is not a word",
        ),
        (
            6,
            "POLY PO[C]=(9) PO[C]=(9) F20000",
            "line 6: C appears twice",
        ),
        (
            6,
            "POLY PO[C]=(9 F20000",
            "line 6: `PO[C]=(9` is not a word",
        ),
        (6, "POLY PO[C]=(9e1) F20000", "line 6: C has no number"),
        (
            7,
            "PO[X]=(2.498,-0.0012,0.0008) PO[Z]=(1,-0.045,0.03) F20000",
            "line 7: C stands still",
        ),
        (
            7,
            "PO[C]=(9) PO[X]=(2.498) F20000",
            "line 7: C stands still",
        ),
        (7, "G1 C18 X2 Z1 F20000", "line 7: `G1` ends the path"),
        (7, "G90 UPATH G1", "line 7: `G1` ends the path"),
        (4, "G1 C0 X2.5 Z0 X2 F60", "line 4: X appears twice"),
        (6, "POLY PO[C]=(9) F20000 F60", "line 6: F appears twice"),
        (6, "N POLY PO[C]=(9) F20000", "line 6: `N` is not a word"),
        (
            6,
            "N10POLY PO[C]=(9) F20000",
            "line 6: `N10POLY` is not a word",
        ),
        (
            6,
            "N+1 POLY PO[C]=(9) F20000",
            "line 6: `N+1` is not a word",
        ),
        (
            7,
            "PO[C]=(18) PO[X]=(2.498,-0.0012,0.0008) PO[Z]=(1,-0.0451,0.03) F20000",
            "line 7: the polynomial of Z does not begin with the velocity",
        ),
    ] {
        let message = refusal(line, new);
        assert!(message.contains(says), "{new}: {message}");
    }
}

#[test]
fn block_numbers_and_small_letters_are_read() {
    let layout = plain(&SIEMENS_840D_POLY);
    let numbered = good()
        .replace("G71 G90 ", "N10 g71 G90 ")
        .replace("POLY PO[C]", "n20 poly po[c]")
        .replace("PO[C]=(18)", "  N030 PO[c]=(18)");
    assert_eq!(
        read(&layout, numbered.as_bytes()),
        read(&layout, good().as_bytes())
    );
}

/// The controller takes the time of a block from C. A C that goes and comes back has a way.
#[test]
fn a_segment_in_which_c_stands_still_is_not_written() {
    let layout = plain(&SIEMENS_840D_POLY);
    let said = |c_deg: f64, vc_deg: f64| {
        let mut points = path_of(&[[0.003, c_deg, 2.499, 1.0, -0.2, 5.0]]);
        points[1].vc = vc_deg * DEG;
        points[0].vc = vc_deg * DEG;
        let mut block = PathBlock::default();
        points.iter().for_each(|point| block.push(*point));
        let lines = layout.lines(&SectionBlock {
            section: Section::LeadIn,
            opens_section: true,
            before: &[],
            points: &block,
        });
        lines.err().map(|error| error.to_string())
    };
    assert_eq!(said(9.0, 3000.0), None);
    assert_eq!(said(0.0, 3000.0), None);
    let refused = said(0.0, 0.0).unwrap();
    assert!(
        refused.starts_with("C stands still in the segment that ends at 0.003"),
        "{refused}"
    );
}

/// The velocities of such a program are not those of a machine.
#[test]
fn coefficients_of_any_size_are_refused_with_their_line() {
    let huge = "999999999999999";
    let poly = format!("POLY PO[C]=(0.48,{huge},{huge}) F60000000000");
    let lines = [
        "; -- lead-in --",
        "G71 G90 G93 G64 FGROUP()",
        "G1 C0 X2.5 Z0 F60",
        "FGROUP(C) UPATH",
        &poly,
        "PO[C]=(0.5) F0.06",
        "; -- end of path: 3 points --",
    ];
    let message = read(&plain(&SIEMENS_840D_POLY), lines.join("\n").as_bytes()).unwrap_err();
    let says = "rad/s is faster than any machine";
    assert!(
        message.contains("line 5: vC = ") && message.contains(says),
        "{message}"
    );
}

#[test]
fn words_of_a_recipe_that_may_move_something_are_told() {
    let commands = SIEMENS_840D_POLY
        .dialect
        .commands("; {name}\nG71 G90\nG0 Z5\nM30\n");
    let told: Vec<(usize, bool)> = commands
        .iter()
        .map(|one| (one.line, one.harmless))
        .collect();
    assert_eq!(told, [(2, true), (3, false), (4, true)]);
}

/// The number of a block hides no end of the program.
#[test]
fn an_end_behind_the_number_of_its_block_ends_the_program() {
    let dialect = crate::post_named("siemens-840d-poly").unwrap().dialect;
    for command in ["M30", "N10M30", "N10 M30", "n10m17", "N5 RET"] {
        assert!(dialect.ends_program(command), "{command}");
    }
    for command in ["N10 G90", "N30", "M0"] {
        assert!(!dialect.ends_program(command), "{command}");
    }
}
