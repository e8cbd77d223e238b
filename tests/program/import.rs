//! `turnpath import`: recipes of lens designs, and what is refused.
//!
//! `tests/reference/lens` has the files, the heights of their surfaces by other programs, and the
//! script that makes both.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

mod lines;

use std::fs;
use std::path::PathBuf;

use serde_json::Value;

use crate::support::bench::{Answer, Bench};
use crate::support::recipe::changed;
use crate::support::repository;

/// Largest difference of a height from another program's, mm.
const HEIGHT: f64 = 1e-13;

fn lens(file: &str) -> PathBuf {
    repository().join("tests/reference/lens/files").join(file)
}

fn cases() -> Vec<Value> {
    let file = repository().join("tests/reference/lens/lens.json");
    let all: Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    all["cases"].as_array().unwrap().clone()
}

/// The recipe of a case in `recipe.toml`.
fn imported(case: &Value) -> Bench {
    let bench = Bench::empty();
    let file = lens(case["file"].as_str().unwrap());
    let words = case["words"].as_array().unwrap();
    let words = words.iter().map(|word| word.as_str().unwrap());
    let ends = ["import", file.to_str().unwrap(), "-o", "recipe.toml"];
    let said = bench.call(ends.into_iter().chain(words)).ends(0);
    assert_eq!(said.stdout, "");
    bench
}

#[test]
fn the_surfaces_of_all_designs_have_the_heights_that_other_programs_read() {
    let all = cases();
    assert_eq!(all.len(), 14);
    for case in &all {
        let bench = imported(case);
        let name = case["file"].as_str().unwrap();
        let count = case["grid"].as_u64().unwrap();
        let level = match case["decentred"].as_bool().unwrap() {
            true => " --set part.pose.level=false",
            false => "",
        };
        let line = format!("sag recipe.toml --grid {count} -o -{level}");
        let said = bench.line(&line).ends(0).stdout;
        let rows: Vec<Vec<f64>> = said
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|one| one.parse().unwrap()).collect())
            .collect();
        let half = case["half"].as_f64().unwrap();
        assert!((rows[0][0] + half).abs() < 1e-12, "{name}: {:?}", rows[0]);
        for heights in case["heights"].as_array().unwrap() {
            let wanted = heights["z"].as_array().unwrap();
            assert_eq!(rows.len(), wanted.len());
            for (row, wanted) in rows.iter().zip(wanted) {
                let (found, wanted) = (row[2], wanted.as_f64().unwrap());
                assert!(
                    (found - wanted).abs() < HEIGHT,
                    "{name} at {}, {}: {found}, and {wanted} by {}",
                    row[0],
                    row[1],
                    heights["by"]
                );
            }
        }
    }
}

/// A mirror behind a lens: surface 1 and 2 are the lens, 3 is the mirror.
const DESIGN: &str = "VERS 191106 2 1\nMODE SEQ\nNAME Test\nUNIT MM X W X CM MR CPMM\n\
SURF 0\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0\n  DISZ INFINITY\n\
SURF 1\n  TYPE STANDARD\n  COMM front\n  CURV 0.02 0 0 0 0\n  DISZ 4\n  GLAS N-BK7 0 0 1.5 64\n  DIAM 6 1 0 0 1\n\
SURF 2\n  TYPE EVENASPH\n  CURV -0.01 0 0 0 0\n  PARM 2 1E-6\n  DISZ 50\n  DIAM 6 1 0 0 1\n\
SURF 3\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0\n  DISZ -50\n  GLAS MIRROR 0 0\n  DIAM 5 0 0 0 1\n\
SURF 4\n  TYPE STANDARD\n  CURV 0.0 0 0 0 0\n  DISZ 0\nTOL TOFF 0 0\nMNUM 1 1\n";

/// The design with one passage changed, and the answer to its import.
fn import(from: &str, to: &str, words: &str) -> Answer {
    let bench = Bench::empty();
    bench.write("lens.zmx", changed(DESIGN, from, to));
    bench.line(&format!("import lens.zmx {words}"))
}

/// The messages of an import that is refused.
#[track_caller]
fn refused(from: &str, to: &str, words: &str) -> Vec<String> {
    let said = import(from, to, words).ends(2);
    assert_eq!(said.stdout, "");
    let lines = said.stderr.lines().filter(|line| !line.is_empty());
    lines.map(str::to_owned).collect()
}

#[test]
fn the_recipe_runs_as_it_stands() {
    let case = cases().remove(5);
    assert_eq!(case["file"], "toroid.zmx");
    let bench = imported(&case);
    bench.line("check recipe.toml").ends(0);
    let coarse = "--set tolerance.residual=2um --set tolerance.interpolation=1um";
    bench
        .line(&format!("run recipe.toml -o out {coarse}"))
        .ends(0);
}

#[test]
fn a_file_that_is_there_is_replaced_only_when_asked() {
    let bench = Bench::empty();
    bench.write("lens.zmx", DESIGN);
    bench.write("a.toml", "mine");
    let said = bench.line("import lens.zmx --surface 2 -o a.toml").ends(2);
    assert!(said.stderr.contains("a.toml is there already"), "{said}");
    assert!(said.stderr.contains("--force"), "{said}");
    assert_eq!(bench.read("a.toml"), "mine");
    bench
        .line("import lens.zmx --surface 2 -o a.toml --force")
        .ends(0);
    let printed = bench.line("import lens.zmx --surface 2").ends(0).stdout;
    let to_dash = bench
        .line("import lens.zmx --surface 2 -o -")
        .ends(0)
        .stdout;
    assert_eq!((&printed, &to_dash), (&bench.read("a.toml"), &printed));
    assert_eq!(bench.files(), ["a.toml", "lens.zmx"]);
}

#[test]
fn several_surfaces_are_listed_and_a_number_chooses_one() {
    let said = import("Test", "Test", "").ends(2).stderr;
    let listed = "surface 1 (line 9): STANDARD, \"front\"\n       surface 2 (line 16): EVENASPH";
    assert!(said.contains("several surfaces have a shape"), "{said}");
    assert!(said.contains(listed), "{said}");
    let said = refused("Test", "Test", "--surface 5");
    assert_eq!(
        said,
        ["error: lens.zmx: the file has no surface 5: its surfaces are 0 to 4"]
    );
    let plane = import("Test", "Test", "--surface 3").ends(0).stdout;
    assert!(plane.contains("use = \"even-asphere\"\n\n"), "{plane}");
    assert!(
        plane.contains("as the design program found it from its rays"),
        "{plane}"
    );
}

/// The side decides the sign, and nothing else does.
#[test]
fn the_front_of_a_lens_is_cut_from_before_and_its_back_from_behind() {
    let radius = |words: &str| {
        let said = import("Test", "Test", words).ends(0).stdout;
        let line = said.lines().find(|line| line.starts_with("radius"));
        line.unwrap().to_owned()
    };
    // Both sides of a biconvex lens are domes.
    assert_eq!(radius("--surface 1"), "radius = \"-50 mm\"");
    assert_eq!(radius("--surface 2"), "radius = \"-100 mm\"");
    // Their moulds are hollow.
    assert_eq!(
        radius("--surface 1 --tool-side plus-z"),
        "radius = \"50 mm\""
    );
    assert_eq!(
        radius("--surface 2 --tool-side minus-z"),
        "radius = \"100 mm\""
    );
}

#[test]
fn a_side_that_the_design_leaves_open_is_asked_for() {
    let air = "CURV 0.02 0 0 0 0\n  DISZ 4";
    let cases = [
        ("  GLAS N-BK7 0 0 1.5 64\n", "", "1", "air on both sides"),
        (
            "PARM 2 1E-6\n",
            "PARM 2 1E-6\n  GLAS SF6\n",
            "2",
            "glass on both sides",
        ),
        (
            air,
            "CURV 0.02 0 0 0 0\n  DISZ -4",
            "2",
            "leaves open which way the light goes",
        ),
    ];
    for (from, to, surface, why) in cases {
        let said = refused(from, to, &format!("--surface {surface}"));
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(
            said[0].contains(why) && said[0].contains("--tool-side"),
            "{said:?}"
        );
        import(from, to, &format!("--surface {surface} --tool-side plus-z")).ends(0);
    }
}

/// The mirror behind the lens, with a break of coordinates before it.
fn mirror_behind(broken: &str) -> Answer {
    let design = DESIGN.replace("SURF 4\n", "SURF 5\n");
    let to = format!("SURF 3\n  TYPE COORDBRK\n{broken}SURF 4\n");
    let bench = Bench::empty();
    bench.write("lens.zmx", changed(&design, "SURF 3\n", &to));
    bench.line("import lens.zmx --surface 4")
}

#[test]
fn axes_that_look_the_other_way_leave_the_side_open() {
    // A fold, and a turn about the axis itself.
    for broken in [
        "  PARM 3 45\n",
        "  PARM 5 180\n  DISZ 0\n",
        "  PARM 3 180\n  DISZ -30\n",
    ] {
        // The half turn is told by the distance behind it.
        let status = if broken.contains("DISZ -30") { 2 } else { 0 };
        mirror_behind(broken).ends(status);
    }
    for broken in ["  PARM 3 180\n  DISZ 0\n", "  PARM 3 60\n  PARM 4 -60\n"] {
        let said = mirror_behind(broken).ends(2);
        assert!(
            said.stderr.contains("leaves open which way the light goes"),
            "{said}"
        );
    }
}

/// The last term of the list that design programs print: their manuals give it as this polynomial.
#[test]
fn the_37th_fringe_term_is_that_of_the_twelfth_power() {
    let terms: String = (3..39)
        .map(|number| format!("  XDAT {number} 0.0 0 0\n"))
        .collect();
    let shape = format!("  XDAT 1 37 0 0\n  XDAT 2 6.0 0 0\n{terms}  XDAT 39 0.001 0 0\n");
    let bench = Bench::empty();
    let flat = "TYPE EVENASPH\n  CURV -0.01 0 0 0 0\n  PARM 2 1E-6\n";
    let to = format!("TYPE FZERNSAG\n  CURV 0.0 0 0 0 0\n{shape}");
    bench.write("lens.zmx", changed(DESIGN, flat, &to));
    let side = "--surface 2 --tool-side plus-z";
    bench
        .line(&format!("import lens.zmx -o recipe.toml {side}"))
        .ends(0);
    let said = bench.line("sag recipe.toml --grid 13 -o -").ends(0).stdout;
    for line in said.lines().skip(1) {
        let row: Vec<f64> = line
            .split(',')
            .map(|number| number.parse().unwrap())
            .collect();
        let square = (row[0] * row[0] + row[1] * row[1]) / 36.0;
        let powers = [1.0, -42.0, 420.0, -1680.0, 3150.0, -2772.0, 924.0];
        let wanted = powers
            .iter()
            .rev()
            .fold(0.0, |sum, factor| sum * square + factor);
        if square <= 1.0 {
            assert!((row[2] - 0.001 * wanted).abs() < HEIGHT, "{line}: {wanted}");
        }
    }
}

#[test]
fn all_lines_that_could_change_the_surface_are_named_at_once() {
    let text = changed(
        DESIGN,
        "PARM 2 1E-6\n",
        "PARM 2 1E-6 2 1 0\n  PARM 9 0.5\n  SDEC 1\n",
    );
    let text = changed(&text, "TOL TOFF 0 0\nMNUM 1 1\n", "MNUM 3 1\nCRVT 2 0.1\n");
    let bench = Bench::empty();
    bench.write("lens.zmx", text);
    let said = bench.line("import lens.zmx --surface 2").ends(2);
    insta::assert_snapshot!(bench.shown(&said));
}

/// A line with the key of another surface's type cannot change this one.
#[test]
fn other_surfaces_may_be_of_any_type() {
    import(
        "SURF 3\n  TYPE STANDARD",
        "SURF 3\n  TYPE US_HOLO.DLL\n  WXYZ 5",
        "--surface 2",
    )
    .ends(0);
    let said = refused("TYPE EVENASPH", "TYPE GRID_SAG", "--surface 2");
    assert!(
        said[0].contains("line 17: surfaces of type `GRID_SAG` cannot be read"),
        "{said:?}"
    );
}

#[test]
fn what_is_not_beyond_doubt_is_refused_with_its_line() {
    let cases = [
        ("MODE SEQ", "MODE NSC", "line 2: the mode is `NSC`"),
        (
            "UNIT MM",
            "UNIT FURLONG",
            "line 4: the unit `FURLONG` is unknown",
        ),
        (
            "UNIT MM X W X CM MR CPMM\n",
            "",
            "the file does not say its unit",
        ),
        (
            "CURV -0.01 0",
            "CURV -0.01 2",
            "line 18: `CURV` follows from a solve",
        ),
        ("CURV -0.01", "CURV NaN", "line 18: `NaN` is no number"),
        (
            "CURV -0.01",
            "CURV 1e-320",
            "line 18: `1e-320 0 0 0 0` is no curvature",
        ),
        (
            "PARM 2 1E-6",
            "PARM 2 1E200",
            "line 19: `1E200` is no number",
        ),
        (
            "PARM 2 1E-6",
            "PARM 2 1E-6\n  PARM 2 0",
            "line 20: `PARM 2` stands there a second time",
        ),
        (
            "PARM 2 1E-6",
            "PPAR 2 1",
            "line 19: `PPAR` follows from a solve or a pickup",
        ),
        (
            "PARM 2 1E-6",
            "XDAT 1 9",
            "line 19: XDAT 1 of a surface of type `EVENASPH` is 9",
        ),
        (
            "DISZ 50\n  DIAM 6 1 0 0 1",
            "DISZ 50\n  SQAP 5 5",
            "line 21: `SQAP` is an aperture",
        ),
        (
            "DISZ 50\n  DIAM 6 1 0 0 1",
            "DISZ 50",
            "line 16: surface 2 has no aperture",
        ),
        (
            "DISZ 50\n  DIAM 6",
            "DISZ 50\n  DIAM -6",
            "line 21: `-6 1 0 0 1` is no radius above 0",
        ),
        (
            "DISZ 50",
            "DISZ 50\n  CLAP 5 3",
            "line 21: the aperture's inner radius 5 is not below",
        ),
        (
            "DISZ 50",
            "DISZ 50\n  IGNR 1",
            "line 21: the design ignores this surface",
        ),
        (
            "SURF 0\n",
            "UNIT IN X W X CM MR CPMM\nSURF 0\n",
            "line 5: `UNIT` stands there a second time",
        ),
        (
            "  CURV -0.01 0 0 0 0\n",
            "",
            "line 16: surface 2 has no line `CURV`",
        ),
        (
            "SURF 4",
            "SURF 5",
            "line 28: surface 4 follows here, and the line says `5`",
        ),
    ];
    for (from, to, wanted) in cases {
        let said = refused(from, to, "--surface 2");
        assert!(said[0].contains(wanted), "{wanted}: {said:?}");
        assert!(said[0].starts_with("error: lens.zmx"), "{said:?}");
    }
    let given = import(
        "DISZ 50\n  DIAM 6 1 0 0 1",
        "DISZ 50\n  SQAP 5 5",
        "--surface 2 --aperture 9mm",
    );
    let given = given.ends(0);
    assert!(given.stdout.contains("aperture = \"9 mm\""), "{given}");
    assert!(
        given
            .stderr
            .contains("line 21: SQAP 5 5 is not in the recipe"),
        "{given}"
    );
}

#[test]
fn zernike_terms_that_end_on_the_part_are_refused() {
    let file = fs::read_to_string(lens("zernike.zmx")).unwrap();
    let bench = Bench::empty();
    bench.write("a.zmx", changed(&file, "DIAM 18", "DIAM 21"));
    let said = bench.line("import a.zmx").ends(2).stderr;
    assert!(
        said.contains("the Zernike terms end at their normalization radius of 20 mm"),
        "{said}"
    );
    bench.write("a.zmx", changed(&file, "PARM 9 0", "PARM 9 0.1"));
    let said = bench.line("import a.zmx").ends(2).stderr;
    assert!(
        said.contains("PARM 9 of a surface of type `SZERNSAG` is 0.1"),
        "{said}"
    );
}

#[test]
fn rubbish_and_enormous_lines_are_refused_quickly() {
    let long = "x".repeat(10_000_000);
    let many = "2 ".repeat(5_000_000);
    let cases: [(Vec<u8>, &str); 7] = [
        (
            b"\x89PNG\r\n\x1a\n\0\0".to_vec(),
            "lens.zmx, line 3: this is not a text",
        ),
        (Vec::new(), "lens.zmx: the file has no surface"),
        (
            vec![0xff, 0xfe, 0x53],
            "lens.zmx, line 1: this is not a text",
        ),
        (
            changed(DESIGN, "NAME Test", &long).into(),
            "line 3: `xxxxxxxxxxxxxxxxxxxxxxxx…` is not known",
        ),
        (
            changed(DESIGN, "PARM 2 1E-6", &format!("PARM {many}")).into(),
            "line 19: `PARM` follows from a solve",
        ),
        (
            changed(DESIGN, "SURF 2", "SURF 1000000000").into(),
            "surface 2 follows here",
        ),
        (
            changed(
                DESIGN,
                "TYPE EVENASPH",
                "TYPE XPOLYNOM\n  XDAT 1 1000000000",
            )
            .into(),
            "line 18: `1000000000` is no count of terms",
        ),
    ];
    for (bytes, wanted) in cases {
        let bench = Bench::empty();
        bench.write("lens.zmx", &bytes);
        let said = bench.line("import lens.zmx --surface 2").ends(2);
        assert!(
            said.stderr.contains(wanted),
            "{wanted}: {:.300}",
            said.stderr
        );
        assert!(said.stderr.len() < 2000, "{}", said.stderr.len());
    }
    let said = Bench::empty().line("import nothing.zmx").ends(4);
    assert!(said.stderr.contains("cannot read nothing.zmx"), "{said}");
}

/// Names and comments come from outside: they neither end their comment nor act on a terminal.
#[test]
fn names_stay_in_their_lines() {
    let said = import(
        "COMM front",
        "COMM a\"b\u{c}format = 2\u{85}c",
        "--surface 1",
    )
    .ends(0);
    let bench = Bench::with(&said.stdout);
    bench.line("sag recipe.toml --grid 2 -o -").ends(0);
    assert!(said.stdout.contains("\\u{c}format"), "{said}");
}

/// What the part has beside its clear aperture is said, and only that.
#[test]
fn an_edge_beyond_the_aperture_is_a_note() {
    let note = |lines: &str, words: &str| {
        let to = format!("DISZ 50\n{lines}");
        let said = import("DISZ 50\n", &to, &format!("--surface 2 {words}"));
        said.ends(0).stderr
    };
    assert_eq!(note("  CLAP 1 6 0\n  MEMA 6 0 0 0 1\n", ""), "");
    assert_eq!(
        note("  CLAP 1 6 0\n  MEMA 6.5 0 0 0 1\n", ""),
        "note: line 22: MEMA 6.5 0 0 0 1 is not in the recipe\n"
    );
    assert_eq!(
        note("  CLAP 1 6 0\n  OBSC 0 2 0\n", "--aperture 8mm"),
        "note: line 21: CLAP 1 6 0 is not in the recipe\n\
         note: line 22: OBSC 0 2 0 is not in the recipe\n"
    );
}
