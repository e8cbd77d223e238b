//! The programs of `beckhoff-poly` as text: how they look, what they play, and what of them is refused.

use std::path::Path;

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock, Segment};
use turnpath_core::{DEG, ParamValue, Params};

use super::BECKHOFF_POLY;
use crate::program_tests::{path_of, plain, program, read};
use crate::{Layout, Post};

fn good() -> String {
    let steps: Vec<[f64; 6]> = (1..=2)
        .map(|k| [0.003, 9.0, 2.5 - 0.001 * f64::from(k), 1.0, -0.2, 5.0])
        .collect();
    let mut points = path_of(&steps);
    points[0].vc = 3000.0 * DEG;
    program(&plain(&BECKHOFF_POLY), &points)
}

#[test]
fn the_program_looks_like_this() {
    let path: Vec<String> = good().lines().map(str::to_owned).collect();
    // Z from 0 to 1 with -1/3 and 5 mm/s in 3 ms: a2 = 3 + 0.002 - 0.015, a3 = 0.014 - 2.
    let expected = [
        "OPEN PROG 1 CLEAR",
        "; -- cutting --",
        "G40 G52 G71 G90 G93 G359",
        "G1 C0 X2.5 Z0 F1",
        "G0 W0",
        "#FGROUP [W]",
        "G94 G1 W0.03 C[POLY A0=0 A1=9] X[POLY A0=2.5 A2=-0.0024 A3=0.0014] \
         Z[POLY A0=0 A1=-0.0009999999 A2=2.9869999998 A3=-1.9859999999] F600",
        "W0.06 C[POLY A0=9 A1=9] X[POLY A0=2.499 A1=-0.0006 A2=-0.0012 A3=0.0008] \
         Z[POLY A0=1 A1=0.015 A2=-0.045 A3=0.03]",
        "#FGROUP",
        "; -- end of path: 3 points --",
        "CLOSE",
    ];
    assert_eq!(path, expected);
}

#[test]
fn another_axis_of_time_goes_as_fast_as_its_recipe_says() {
    let mut settings = Params::new();
    settings.set("time_axis", ParamValue::Text("U".to_owned()));
    settings.set("time_axis_speed", ParamValue::Number(0.001));
    let format = BECKHOFF_POLY.format(&settings, 0.0, f64::INFINITY);
    let post = &BECKHOFF_POLY;
    let slow = Layout { post, format };
    let points = path_of(&[[0.003_000_001, 9.0, 2.5, 1.0, -0.2, 5.0]; 3]);
    let text = program(&slow, &points);
    for says in ["G0 U0\n#FGROUP [U]\n", "G1 U0.000003000001 C[", " F0.06\n"] {
        assert!(text.contains(says), "{text}");
    }
    let of_w = plain(&BECKHOFF_POLY);
    let expected = read(&of_w, program(&of_w, &points).as_bytes());
    assert_eq!(read(&slow, text.as_bytes()), expected);
}

/// A polynomial ends where the next one begins, to the last of its decimals: the sums are of whole numbers.
#[test]
fn the_sum_of_the_coefficients_is_the_next_beginning_exactly() {
    let steps: Vec<[f64; 6]> = (1..=200)
        .map(|k| {
            let k = f64::from(k);
            let (time, turn) = (0.002 + 1e-7 * (k % 7.0), 8.0 + 0.1 * (k % 3.0));
            let (z, vz) = (1.0 / (k + 0.3), (k % 11.0) / 7.0);
            [time, turn, 2.5 - 0.003 * k, z, -1.5, vz]
        })
        .collect();
    let text = program(&plain(&BECKHOFF_POLY), &path_of(&steps));
    let mut ends: [Option<i128>; 3] = [None; 3];
    for line in text.lines().filter(|line| line.contains("[POLY")) {
        for (k, axis) in ["C", "X", "Z"].into_iter().enumerate() {
            let (_, rest) = line.split_once(&format!(" {axis}[POLY ")).unwrap();
            let (inside, _) = rest.split_once(']').unwrap();
            let units = |word: &str| -> i128 {
                let (_, number) = word.split_once('=').unwrap();
                let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
                format!("{whole}{fraction:0<12}").parse().unwrap()
            };
            let begin = units(inside.split_whitespace().next().unwrap());
            assert!(ends[k].is_none_or(|end| end == begin), "{line}");
            ends[k] = Some(inside.split_whitespace().map(units).sum());
        }
    }
    assert!(ends.iter().all(Option::is_some));
}

/// The controller keeps time where C stands still: it moves its axis of time.
#[test]
fn a_segment_in_which_nothing_moves_is_written() {
    let layout = plain(&BECKHOFF_POLY);
    let mut points = path_of(&[[0.003, 0.0, 2.5, 0.0, 0.0, 0.0]]);
    points[0].vc = 0.0;
    points[0].vz = 0.0;
    let mut block = PathBlock::default();
    points.iter().for_each(|point| block.push(*point));
    let lines = layout.lines(&SectionBlock {
        section: Section::LeadIn,
        opens_section: true,
        before: &[],
        points: &block,
    });
    let text = String::from_utf8(lines.unwrap().text).unwrap();
    let says = "G94 G1 W0.03 C[POLY A0=0] X[POLY A0=2.5] Z[POLY A0=0] F600\n";
    assert!(text.ends_with(says), "{text}");
}

/// A path that an independent script has played from the definition of the manual; the program and what was
/// played are in tests/reference/programs.
#[test]
fn an_independent_evaluation_of_the_polynomials_plays_the_same_path() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/reference/programs");
    let text = std::fs::read(folder.join("cutting-speed.ncp")).unwrap();
    let points = read(&plain(&BECKHOFF_POLY), &text).unwrap();
    let played = std::fs::read_to_string(folder.join("beckhoff_poly.csv")).unwrap();
    let mut rows = played.lines().skip(1);
    let mut rates = Vec::new();
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
        }
        rates.push(segment.c.slope(0.5) / segment.duration);
    }
    assert!(rows.next().is_none() && rates.len() > 100);
    // C changes its speed: in the leads from rest, and in the cut with the spindle.
    let fastest = rates.iter().copied().fold(0.0, f64::max);
    let steady = rates.iter().filter(|rate| **rate > 0.99 * fastest).count();
    assert!(steady < rates.len() / 2, "{steady} of {}", rates.len());
}

fn refusal(line: usize, new: &str) -> String {
    let text = good();
    let mut lines: Vec<&str> = text.lines().collect();
    lines[line - 1] = new;
    read(&plain(&BECKHOFF_POLY), lines.join("\n").as_bytes()).unwrap_err()
}

/// A second block of the program with other words in place of some.
fn second_with(old: &str, new: &str) -> String {
    let text = good();
    let line = text.lines().nth(7).unwrap();
    assert!(line.contains(old), "{line}");
    line.replace(old, new)
}

#[test]
fn lines_before_the_first_polynomial_are_needed() {
    for (line, new, says) in [
        (3, "G71 G90 G95", "line 3: `G95` is not a word"),
        (3, "G90 G93", "line 4: a move before `G71`"),
        (3, "G71 G93", "line 4: a move before `G90`"),
        (3, "G40 G52 G71 G90 G93", "line 4: a move before `G359`"),
        (
            3,
            "G40 G52 G71 G90 G359",
            "line 4: the line to the first point is not one of",
        ),
        (
            4,
            "G1 C0 X2.5 Z0",
            "line 4: the line to the first point is not one of",
        ),
        (
            4,
            "C0 X2.5 Z0 F1",
            "line 4: the line to the first point is not one of",
        ),
        (
            4,
            "G1 C0 X2.5 F1",
            "line 4: the first point does not give Z",
        ),
        (4, "G1 C0 X2.5 Z0 X2 F1", "line 4: X appears twice"),
        (4, "G1 W0 C0 X2.5 Z0 F1", "line 4: this block is neither"),
        (4, "", "line 7: a polynomial before the first point"),
        (5, "", "line 7: no `G0 W` before the first polynomial"),
        (
            5,
            "G0 W7",
            "line 7: W does not go on by the time of a segment",
        ),
        (
            5,
            "G0 W999999999999999",
            "line 5: this is far from the beginning",
        ),
        (6, "", "line 7: a polynomial before `#FGROUP [W]`"),
        (6, "#FGROUP", "line 7: a polynomial before `#FGROUP [W]`"),
        (
            6,
            "#FGROUP [X,W]",
            "line 6: F refers to X,W, and not to W alone",
        ),
        (6, "#FGROUP W", "line 6: `#FGROUP` is not a word"),
        (
            7,
            "G1 W0.03 C[POLY A0=0] F600",
            "line 7: a polynomial before `G94` and `G1`",
        ),
        (
            7,
            "G94 W0.03 C[POLY A0=0] F600",
            "line 7: a polynomial before `G94` and `G1`",
        ),
        (
            7,
            "G94 G1 W0.03 C[POLY A0=0]",
            "line 7: a polynomial before F",
        ),
        (
            7,
            "G94 G1 W0.03 C[POLY A0=0] F60",
            "line 7: F is not 600 mm/min",
        ),
    ] {
        let message = refusal(line, new);
        assert!(message.contains(says), "{new}: {message}");
    }
}

#[test]
fn damaged_polynomials_are_refused_with_their_line() {
    for (old, new, says) in [
        (
            "A0=2.499 ",
            "A0=2.4991 ",
            "the polynomial of X does not begin where the one before ends",
        ),
        ("A0=2.499 ", "", "the polynomial of X has no A0"),
        (
            "A1=0.015",
            "A1=0.016",
            "the polynomial of Z does not begin with the velocity",
        ),
        ("A3=0.03", "A4=0.03", "the polynomial of Z is no cubic"),
        ("A3=0.03", "A5=0.03", "the polynomial of Z is no cubic"),
        ("A3=0.03", "A6=0.03", "`A6=0.03` is not a word"),
        ("A3=0.03", "A3=", "A3 has no number"),
        ("A3=0.03", "A3=1e3", "A3 has no number"),
        ("A3=0.03", "A3", "`A3` is not a word"),
        (
            "A3=0.03",
            "A2=0.03",
            "A2 appears twice in the polynomial of Z",
        ),
        (
            "Z[POLY A0=1",
            "Z[POLY L=0 A0=1",
            "L of the polynomial of Z must be greater than zero",
        ),
        (
            "Z[POLY A0=1",
            "Z[POLY L=-1 A0=1",
            "L of the polynomial of Z must be greater than zero",
        ),
        ("Z[POLY A0=1", "Z[POLY L=2 A0=1", "ends at another L than 1"),
        ("Z[POLY", "Z[A0=1 POLY", "Z[…] does not begin with POLY"),
        ("Z[POLY", "Z[OSC", "Z[…] does not begin with POLY"),
        ("Z[POLY", "X[POLY", "X appears twice"),
        ("Z[POLY", "Y[POLY", "is not a word"),
        ("Z[POLY A0=1", "Z1 Z[POLY A0=1", "this block is neither"),
        (" Z[POLY", " Z[[POLY", "Z[…] does not begin with POLY"),
        ("A3=0.03]", "A3=0.03", "is not a word"),
        ("A3=0.03]", "A3=0.03]]", "A3 has no number"),
        ("W0.06 ", "", "polynomials without a way of W"),
        ("W0.06 ", "W0.03 ", "W does not go on"),
        ("W0.06 ", "W0.02 ", "W does not go on"),
        (
            "W0.06 ",
            "W999999999999999 ",
            "W goes farther than in any path",
        ),
        ("W0.06 ", "W20000.1 ", "W does not go on"),
        ("W0.06 ", "W0.07 ", "does not begin with the velocity"),
        ("W0.06 ", "G93 W0.06 ", "a polynomial before `G94` and `G1`"),
        ("W0.06 ", "G0 W0.06 ", "a polynomial before `G94` and `G1`"),
        ("W0.06 ", "G2 W0.06 ", "`G2` is not a word"),
        ("W0.06 ", "F60 W0.06 ", "F is not 600 mm/min"),
        ("W0.06 ", "W0.06 (", "a `(` without its partner"),
        ("W0.06 ", "W0.06) ", "a `)` without its partner"),
    ] {
        let message = refusal(8, &second_with(old, new));
        let says = format!("line 8: {says}");
        let (place, says) = says.split_at(8);
        assert!(
            message.contains(place) && message.contains(says),
            "{new}: {message}"
        );
    }
    let message = refusal(8, "G1 C18 X2 Z1 F2");
    assert!(
        message.contains("line 8: a straight line within the path"),
        "{message}"
    );
    let message = refusal(8, "G0 W0.06");
    assert!(message.contains("line 8: `G0` ends the path"), "{message}");
}

#[test]
fn block_numbers_small_letters_comments_and_a_limit_of_one_are_read() {
    let layout = plain(&BECKHOFF_POLY);
    let other = good()
        .replace("G40 G52 ", "N10 g40 (no tool) G52 ")
        .replace("G0 W0", "n20 G00 w0 (the time)")
        .replace("#FGROUP [W]", "  #fgroup[w]")
        .replace("C[POLY A0=9", "c[poly L=1.0 a0=9.000")
        .replace("; -- cutting --", "( -- cutting -- )");
    assert_eq!(
        read(&layout, other.as_bytes()),
        read(&layout, good().as_bytes())
    );
}

/// The velocities of such a program are not those of a machine.
#[test]
fn coefficients_of_any_size_are_refused_with_their_line() {
    let huge = "A2=999999999999999 A3=-999999999999998]";
    let second = format!("Z[POLY A0=1 A1=0.015 {huge}");
    let old = "Z[POLY A0=1 A1=0.015 A2=-0.045 A3=0.03]\n";
    assert!(good().contains(old));
    let third = "W10000.06 C[POLY A0=18 A1=3000000] X[POLY A0=2.498 A1=-200] Z[POLY A0=2.015]\n";
    let text = good().replace(old, &format!("{second}\n{third}"));
    let message = read(&plain(&BECKHOFF_POLY), text.as_bytes()).unwrap_err();
    let says = "line 8: vZ = -3.33333333333332e17 mm/s is faster than any machine";
    assert!(message.contains(says), "{message}");
}

#[test]
fn words_of_a_recipe_that_may_move_something_are_told() {
    let commands = BECKHOFF_POLY
        .dialect
        .commands("; {name}\nG71 G90\n#FGROUP [X]\nG0 Z5\nM30\n");
    let told: Vec<(usize, bool)> = commands
        .iter()
        .map(|one| (one.line, one.harmless))
        .collect();
    assert_eq!(told, [(2, true), (3, false), (4, false), (5, true)]);
}

/// 1190 turns of C, and 214 m of the axis of time: what the maker documents for the increments on delivery.
#[test]
fn what_is_beyond_the_documented_numbers_is_refused_and_a_lab_may_say_others() {
    let refused = |post: &'static Post, table: Params, point: ControlPoint| {
        let format = post.format(&table, 0.0, f64::INFINITY);
        let layout = Layout { post, format };
        let before = ControlPoint {
            t: point.t - 0.1,
            c: point.c - 0.2,
            ..point
        };
        let mut block = PathBlock::default();
        block.push(point);
        let stretch = SectionBlock {
            section: Section::Cutting,
            opens_section: false,
            before: &[before],
            points: &block,
        };
        layout.lines(&stretch).err()
    };
    let at = |t: f64, turns: f64| ControlPoint {
        t,
        c: turns * 360.0 * DEG,
        vc: 2.0,
        x: 1.0,
        ..ControlPoint::default()
    };
    for post in [&BECKHOFF_POLY, crate::post_named("beckhoff-g93").unwrap()] {
        assert_eq!(refused(post, Params::new(), at(100.0, 1189.9)), None);
        let said = refused(post, Params::new(), at(100.0, 1190.1)).unwrap();
        assert!(said.to_string().contains("c_limit is 428400 deg"), "{said}");
        assert!(said.help(post.keys).contains("your own c_limit"));
    }
    // 10 mm/s: 214 m in 21400 s.
    assert_eq!(
        refused(&BECKHOFF_POLY, Params::new(), at(21399.9, 5.0)),
        None
    );
    let said = refused(&BECKHOFF_POLY, Params::new(), at(21400.1, 5.0)).unwrap();
    let says = "W, the axis of time, is at 214001.000 mm at 21400.100000 s, and time_axis_limit is 214000 mm";
    assert_eq!(said.to_string(), says);
}
