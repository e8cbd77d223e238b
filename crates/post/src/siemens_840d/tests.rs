//! The programs of `siemens-840d-poly` as text: how they look, what they play, and what of them is
//! refused.

use std::path::Path;

use turnpath_core::DEG;
use turnpath_core::toolpath::Segment;

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
        "G90 G93 G64 FGROUP(C) UPATH",
        "G1 C0 X2.5 Z-0 F60",
        "POLY PO[C]=(9) PO[X]=(2.499,-0.0024,0.0014) PO[Z]=(1,2.9869999998,-1.9859999999) F20000",
        "PO[C]=(18) PO[X]=(2.498,-0.0012,0.0008) PO[Z]=(1,-0.045,0.03) F20000",
        "; -- end of path: 3 points --",
        "CLOSE",
    ];
    let expected = expected.map(|line| line.replace("Z-0 ", "Z0 "));
    assert_eq!(path, expected);
}

/// A path that an independent script has played from the definition of the manual; the program and
/// what was played are in tests/reference/programs.
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
            assert!((segment.start + s * segment.duration - t).abs() < 1e-9);
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
        (3, "G90 G94 FGROUP(C) UPATH", "line 3: `G94` is not a word"),
        (3, "G90 G93 UPATH", "line 4: a move before `G90`"),
        (
            4,
            "G1 C0 X2.5 F60",
            "line 4: the first point does not give Z",
        ),
        (4, "", "line 5: a polynomial before the first point"),
        (5, "PO[C]=(9) F20000", "line 5: this block is neither"),
        (5, "POLY PO[C]=(9)", "line 5: a move without F"),
        (5, "POLY PO[C]=(9) F0", "line 5: F0 is no segment"),
        (
            5,
            "POLY PO[C]=(9,1,1,1) F20000",
            "line 5: the polynomial of C is no cubic",
        ),
        (
            5,
            "POLY PO[Y]=(9) F20000",
            "line 5: `PO[Y]=(9)` is not a word",
        ),
        (
            5,
            "POLY PO[C]=(9) PO[C]=(9) F20000",
            "line 5: C appears twice",
        ),
        (
            5,
            "POLY PO[C]=(9 F20000",
            "line 5: `PO[C]=(9` is not a word",
        ),
        (5, "POLY PO[C]=(9e1) F20000", "line 5: C has no number"),
        (6, "G1 C18 X2 Z1 F20000", "line 6: `G1` ends the path"),
        (6, "G90 UPATH G1", "line 6: `G1` ends the path"),
        (4, "G1 C0 X2.5 Z0 X2 F60", "line 4: X appears twice"),
        (5, "POLY PO[C]=(9) F20000 F60", "line 5: F appears twice"),
        (5, "N POLY PO[C]=(9) F20000", "line 5: `N` is not a word"),
        (
            5,
            "N10POLY PO[C]=(9) F20000",
            "line 5: `N10POLY` is not a word",
        ),
        (
            5,
            "N+1 POLY PO[C]=(9) F20000",
            "line 5: `N+1` is not a word",
        ),
        (
            6,
            "PO[C]=(18) PO[X]=(2.498,-0.0012,0.0008) PO[Z]=(1,-0.0451,0.03) F20000",
            "line 6: the polynomial of Z does not begin with the velocity",
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
        .replace("G90 ", "N10 g90 ")
        .replace("POLY PO[C]", "n20 poly po[c]")
        .replace("PO[C]=(18)", "  N030 PO[c]=(18)");
    assert_eq!(
        read(&layout, numbered.as_bytes()),
        read(&layout, good().as_bytes())
    );
}

/// The velocities of such a program do not fit into the numbers of the reader.
#[test]
fn coefficients_of_any_size_are_refused_with_their_line() {
    let huge = "999999999999999";
    let poly = format!("POLY PO[X]=(0.48,{huge},{huge}) F60000000000");
    let lines = [
        "; -- lead-in --",
        "G90 G93 G64 FGROUP(C) UPATH",
        "G1 C0 X2.5 Z0 F60",
        &poly,
        "PO[X]=(0.48) F0.06",
        "; -- end of path: 3 points --",
    ];
    let message = read(&plain(&SIEMENS_840D_POLY), lines.join("\n").as_bytes()).unwrap_err();
    let says = "line 5: the velocity of X has too many digits";
    assert!(message.contains(says), "{message}");
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
