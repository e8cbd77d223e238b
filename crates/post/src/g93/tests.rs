//! The programs of straight lines as text: how they look, how many lines they have, what of them is
//! refused.

use std::path::Path;

use turnpath_core::toolpath::{
    ControlPoint, PathBlock, Section, SectionBlock, Segment, SegmentShape,
};
use turnpath_core::{DEG, Params};

use super::{LINUXCNC_G93, NANOTECH_G93};
use crate::program_tests::{path_of, plain, program, read};
use crate::{Chords, Layout, Post, ProgramError, ProgramFormat};

fn path() -> Vec<ControlPoint> {
    let steps: Vec<[f64; 6]> = (1..=2)
        .map(|k| [0.003, 9.0, 2.5 - 0.001 * f64::from(k), 1.0, -0.2, 5.0])
        .collect();
    path_of(&steps)
}

fn good() -> String {
    program(&plain(&LINUXCNC_G93), &path())
}

/// A post with chords for this tolerance, however short.
fn within(post: &'static Post, tolerance: f64) -> Layout {
    let format = post.format(&Params::new(), 0.0, tolerance);
    let chords = format.chords.map(|chords| Chords {
        shortest: 1,
        ..chords
    });
    let format = ProgramFormat { chords, ..format };
    Layout { post, format }
}

#[test]
fn the_program_looks_like_this() {
    let text = good();
    let path: Vec<&str> = text.lines().collect();
    let expected = [
        "OPEN PROG 1 CLEAR",
        "; -- cutting --",
        "G8 G21 G40 G64 G90 G93",
        "G1 C0 X2.5 Z0 F60",
        "C9 X2.499 Z1 F20000",
        "C18 X2.498 Z1 F20000",
        "; -- end of path: 3 points --",
        "CLOSE",
    ];
    assert_eq!(path, expected);

    let mut layout = plain(&NANOTECH_G93);
    layout.format.chords = layout.format.chords.map(|chords| Chords {
        feed: crate::FeedMeaning::Seconds,
        ..chords
    });
    let steps: Vec<[f64; 6]> = vec![[0.300_000_000_4, 170.0, 2.499_000_4, 1.0, -0.2, 5.0]; 3];
    let text = program(&layout, &path_of(&steps));
    let path: Vec<&str> = text.lines().skip(2).take(5).collect();
    let expected = [
        "G90 G93",
        "G1 C0 X2.5 Z0 F1",
        "C170 X2.499 Z1 F0.3",
        "C340 X2.499 Z1 F0.300000001",
        "C150 X2.499 Z1 F0.3",
    ];
    assert_eq!(path, expected);
    let read = read(&layout, text.as_bytes()).unwrap();
    assert!((read[3].c - 510.0 * DEG).abs() < 1e-12);
    assert!((read[3].t - 0.900_000_001).abs() < 1e-12);
}

#[test]
fn velocities_that_are_read_are_the_rates_of_the_lines_behind() {
    let points = read(&plain(&LINUXCNC_G93), good().as_bytes()).unwrap();
    let rates = |from: &ControlPoint, to: &ControlPoint| (to.z - from.z) / (to.t - from.t);
    assert_eq!(points[0].vz, rates(&points[0], &points[1]));
    assert_eq!(points[1].vz, rates(&points[1], &points[2]));
    assert_eq!(points[2].vz, points[1].vz);
}

#[test]
fn lines_stay_within_their_share_of_the_tolerance_and_use_it() {
    const BOTH: [&Post; 2] = [&LINUXCNC_G93, &NANOTECH_G93];
    for post in BOTH {
        let tolerance = 1e-4;
        let layout = within(post, tolerance);
        let points = path();
        let played = read(&layout, program(&layout, &points).as_bytes()).unwrap();
        let lines = played.len() as f64 / 2.0;
        assert!((40.0..600.0).contains(&lines), "{lines}");
        let mut largest = 0.0f64;
        for pair in played.windows(2) {
            let line = Segment::straight(&pair[0], &pair[1]);
            for k in 0..=20 {
                let s = f64::from(k) / 20.0;
                let at = line.start + s * line.duration;
                let (from, to) = if at <= points[1].t {
                    (&points[0], &points[1])
                } else {
                    (&points[1], &points[2])
                };
                let cubic = Segment::between(from, to);
                let on = cubic.z.value((at - from.t) / cubic.duration);
                largest = largest.max((line.z.value(s) - on).abs());
            }
        }
        assert!(largest <= 0.5 * tolerance, "{largest:e}");
        assert!(largest > 0.2 * tolerance, "{largest:e}");
    }
}

#[test]
fn a_path_of_straight_lines_is_carried_as_it_is() {
    let points = path();
    let mut block = PathBlock {
        shape: SegmentShape::Linear,
        ..PathBlock::default()
    };
    points.iter().for_each(|point| block.push(*point));
    let stretch = SectionBlock {
        section: Section::Cutting,
        opens_section: true,
        before: &[],
        points: &block,
    };
    let lines = within(&LINUXCNC_G93, 1e-9).lines(&stretch).unwrap();
    assert_eq!(lines.points, points.len());
}

/// A flat part at 60 rpm with this feed, mm/rev, in the layout of a lowest rate, mm/min.
fn flat(feed: f64, lowest: f64) -> Result<usize, ProgramError> {
    flat_lines(feed, lowest).map(|(points, _)| points)
}

fn flat_lines(feed: f64, lowest: f64) -> Result<(usize, String), ProgramError> {
    let params = Params::new().with("lowest_rate", lowest / 60.0);
    let format = LINUXCNC_G93.format(&params, 0.0, 1e-4);
    let layout = Layout {
        post: &LINUXCNC_G93,
        format,
    };
    let mut block = PathBlock::default();
    for k in 0..100 {
        let turns = f64::from(k) / 40.0;
        block.push(ControlPoint {
            t: turns,
            c: 360.0 * DEG * turns,
            x: 2.5 - feed * turns,
            z: 0.0,
            vc: 360.0 * DEG,
            vx: -feed,
            vz: 0.0,
        });
    }
    let stretch = SectionBlock {
        section: Section::Cutting,
        opens_section: true,
        before: &[],
        points: &block,
    };
    let lines = layout.lines(&stretch)?;
    let text = String::from_utf8(lines.text).unwrap();
    Ok((lines.points, text))
}

#[test]
fn a_flat_part_at_60_rpm_and_1_um_a_turn_is_refused_with_its_place() {
    let error = flat(1e-3, 0.1).unwrap_err();
    let said = error.to_string();
    assert!(
        said.contains(
            "X and Z move at 0.06000 mm/min in the line that ends at 0.025000 s, C = 9.000"
        ),
        "{said}"
    );
    assert!(
        error
            .help(LINUXCNC_G93.keys)
            .contains("lowest_rate = \"0 mm/min\"")
    );
    assert_eq!(flat(1.7e-3, 0.1), Ok(100));
    // LinuxCNC from 2.9.0 on.
    assert_eq!(flat(1e-3, 0.0), Ok(100));
}

/// A way of 10^-7 mm is none to LinuxCNC's interpreter.
#[test]
fn x_and_z_stand_still_or_move_by_more_than_counts_as_none() {
    // 0.075 nm a line.
    let (points, text) = flat_lines(3e-6, 0.0).unwrap();
    let places: Vec<&str> = text
        .lines()
        .filter_map(|line| line.split(' ').find(|word| word.starts_with('X')))
        .collect();
    assert_eq!(places.len(), points);
    let digits = |place: &str| -> i64 {
        let value: f64 = place[1..].parse().unwrap();
        (value * 1e7).round() as i64
    };
    let ways: Vec<i64> = places
        .windows(2)
        .map(|pair| digits(pair[1]) - digits(pair[0]))
        .collect();
    assert!(ways.iter().all(|way| [0, -2].contains(way)), "{ways:?}");
    assert!(ways.contains(&-2) && ways.contains(&0));
}

#[test]
fn a_line_that_is_shorter_than_the_servo_period_is_refused_with_its_place() {
    let points = path();
    let mut block = PathBlock::default();
    points.iter().for_each(|point| block.push(*point));
    let stretch = SectionBlock {
        section: Section::Cutting,
        opens_section: true,
        before: &[],
        points: &block,
    };
    let refused = |period: f64| {
        let params = Params::new().with("servo_period", period);
        let post = &LINUXCNC_G93;
        let format = post.format(&params, 0.0, f64::INFINITY);
        Layout { post, format }.lines(&stretch).err()
    };
    // The lines take 3 ms.
    assert_eq!(refused(2.94e-3), None);
    let said = refused(2.95e-3).unwrap().to_string();
    assert!(
        said.contains("ends at 0.003000 s, C = 9.000 deg takes 3.000 ms"),
        "{said}"
    );
    assert!(said.contains("less than 3.009 ms"), "{said}");
}

#[test]
fn a_lead_from_rest_moves_in_steps_that_are_not_too_slow_and_waits_between_them() {
    let layout = within(&LINUXCNC_G93, 1e-4);
    // Nothing, then C from rest, then Z from rest.
    let mut points = Vec::new();
    for k in 0..=100 {
        let s = f64::from(k) / 100.0;
        let ramp = |s: f64| s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        let rate = |s: f64| 30.0 * s * s * (1.0 - s) * (1.0 - s);
        let (turning, falling) = ((s.min(0.5) - 0.05).max(0.0), (2.0 * s - 1.0).max(0.0));
        points.push(ControlPoint {
            t: s,
            c: 200.0 * turning * turning * (turning + 3.0 * (s - 0.5).max(0.0)),
            x: 2.5,
            z: 1e-2 * (1.0 - ramp(falling)),
            vc: 600.0 * turning * turning,
            vx: 0.0,
            vz: -2e-2 * rate(falling),
        });
    }
    let mut lead = PathBlock::default();
    points.iter().for_each(|point| lead.push(*point));
    let stretch = SectionBlock {
        section: Section::LeadIn,
        opens_section: true,
        before: &[],
        points: &lead,
    };
    let lines = layout.lines(&stretch).unwrap();
    let text = String::from_utf8(lines.text).unwrap();
    assert!(text.contains("\nG4 P0.00"), "{text}");
    let text = format!("{text}; -- end of path: {} points --\n", lines.points);
    // The reader proves every line by the interpreter's rule.
    let read = read(&layout, text.as_bytes()).unwrap();
    let last = read.last().unwrap();
    assert!((last.t - 1.0).abs() < 1e-9);
    let one = 10u64.pow(layout.format.position_decimals) as f64;
    let steps = layout.format.chords.unwrap().slowest.unwrap().lead_steps[1] as f64 / one;
    assert!(steps < 1e-5 && (last.z - points[100].z).abs() <= 0.5 * steps);
}

#[test]
fn a_segment_of_too_many_lines_is_refused() {
    let layout = within(&LINUXCNC_G93, 1e-18);
    let points = path();
    let mut block = PathBlock::default();
    points.iter().for_each(|point| block.push(*point));
    let stretch = SectionBlock {
        section: Section::Cutting,
        opens_section: true,
        before: &[],
        points: &block,
    };
    let refused = layout.lines(&stretch).unwrap_err();
    assert!(
        matches!(refused, ProgramError::ManyChords { .. }),
        "{refused}"
    );
}

fn refusal(layout: &Layout, line: usize, new: &str) -> String {
    let text = good();
    let mut lines: Vec<&str> = text.lines().collect();
    lines[line - 1] = new;
    read(layout, lines.join("\n").as_bytes()).unwrap_err()
}

#[test]
fn damaged_lines_are_refused_with_their_number() {
    let format = LINUXCNC_G93.format(&Params::new(), 0.0, 1.0);
    let layout = Layout {
        post: &LINUXCNC_G93,
        format: ProgramFormat { ..format },
    };
    for (line, new, says) in [
        (3, "G20 G90 G93", "line 3: `G20` is not a word"),
        (3, "G21 G90 G94", "line 3: `G94` is not a word"),
        (3, "G8 G21 G40 G64 G90", "line 4: a move before `G93`"),
        (3, "G8 G21 G40 G90 G93", "line 4: a move before `G64`"),
        (4, "C0 X2.5 Z0 F60", "line 4: a move before `G1`"),
        (
            4,
            "G1 C0 X2.5 F60",
            "line 4: the first point does not give Z",
        ),
        (5, "C9 X2.499 Z1", "line 5: a move without F"),
        (5, "C9 X2.499 Z1 F0", "line 5: F is no positive number"),
        (5, "C9 X2.499 Z1 F1e3", "line 5: `E3` is not a word"),
        (5, "C9 X2.499 Z1 F1e-3", "line 5: `E-3` is not a word"),
        (5, "C9 X2.499 Z1 F0.01", "line 5: F0.01 is no time"),
        (5, "C9 X2.499 X2.4 Z1 F20000", "line 5: X appears twice"),
        (5, "C9 Y1 F20000", "line 5: `Y1` is not a word"),
        (5, "C9 X2.499 (Z1 F20000", "line 5: a `(` without"),
        (
            5,
            "C9 X2.5 Z0.00001 F1",
            "line 5: LinuxCNC plays this line in 6e-3 s",
        ),
        (
            5,
            "C9 X2.5 Z0.0000001 F20000",
            "line 5: X and Z move by no more than 1e-7",
        ),
        (5, "C0 X2.5 Z0 F20000", "line 5: no axis moves"),
        (5, "C-9 X2.499 Z1 F20000", "line 5: C turns by"),
        (5, "G4", "line 5: `G4` without P"),
        (5, "G4 P1 X2", "line 5: an axis moves in a line with `G4`"),
        (5, "P1", "line 5: P without `G4`"),
    ] {
        let message = refusal(&layout, line, new);
        assert!(message.contains(says), "{new}: {message}");
    }
    let nanotech = plain(&NANOTECH_G93);
    let message = refusal(&nanotech, 5, "G4 P1");
    assert!(message.contains("line 3: `G8` is not a word"), "{message}");
}

/// What LinuxCNC's own interpreter makes of a program; program and output are in
/// tests/reference/programs.
#[test]
fn linuxcncs_own_interpreter_reads_the_same_positions_and_times() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/reference/programs");
    let text = std::fs::read(folder.join("saddle.ngc")).unwrap();
    let points = read(&within(&LINUXCNC_G93, 1e-3), &text).unwrap();
    let played = std::fs::read_to_string(folder.join("linuxcnc.csv")).unwrap();
    let rows: Vec<Vec<f64>> = played
        .lines()
        .skip(1)
        .map(|row| row.split(',').map(|value| value.parse().unwrap()).collect())
        .collect();
    assert_eq!(points.len(), rows.len());
    assert!(points.len() > 500);
    for (point, row) in points.iter().zip(&rows) {
        assert!((point.t - row[0]).abs() < 1e-6, "{point:?} {row:?}");
        assert!((point.c / DEG - row[1]).abs() < 1e-7, "{point:?} {row:?}");
        assert!((point.x - row[2]).abs() < 1e-9, "{point:?} {row:?}");
        assert!((point.z - row[3]).abs() < 1e-9, "{point:?} {row:?}");
    }
}

/// X rests between the steps of leads, and Z is at rest where the cut begins and ends: the finer steps of
/// the cut would leave ways of some 0.1 nm in lines that are too slow.
#[test]
fn a_lead_at_rest_meets_the_cut_in_lines_that_are_not_too_slow() {
    let layout = within(&LINUXCNC_G93, 1e-4);
    let at = |k: u32, z: f64| ControlPoint {
        t: 0.01 * f64::from(k),
        c: f64::from(k) * DEG,
        x: 0.05,
        z,
        vc: 100.0 * DEG,
        ..ControlPoint::default()
    };
    let path = [
        at(0, 1e-3),
        at(1, 0.0),
        at(2, 0.0),
        at(3, 0.0),
        at(4, 2e-4),
        at(5, 0.0),
        at(6, 0.0),
        at(7, 1e-3),
    ];
    let mut text = Vec::new();
    let mut count = 0;
    for (section, points) in [
        (Section::LeadIn, 0..3),
        (Section::Cutting, 3..6),
        (Section::LeadOut, 6..8),
    ] {
        let mut block = PathBlock::default();
        path[points.clone()]
            .iter()
            .for_each(|point| block.push(*point));
        let stretch = SectionBlock {
            section,
            opens_section: true,
            before: &path[points.start.saturating_sub(2)..points.start],
            points: &block,
        };
        let lines = layout.lines(&stretch).unwrap();
        text.extend(lines.text);
        count += lines.points;
    }
    let text = String::from_utf8(text).unwrap();
    let text = format!("{text}; -- end of path: {count} points --\n");
    // The reader proves every line by the interpreter's rule.
    let found = read(&layout, text.as_bytes()).unwrap();
    for point in &path[3..6] {
        let same = |one: &&ControlPoint| (one.t - point.t).abs() < 1e-9;
        let carried = found.iter().find(same).unwrap();
        assert!((carried.x - point.x).abs() < 1e-9 && (carried.z - point.z).abs() < 1e-9);
    }
    // The tool is lifted and never lowered.
    assert!(found.iter().all(|point| point.z >= 0.0), "{text}");
    let moved = found.iter().filter(|point| point.x != 0.05);
    assert!(moved.count() > 2, "{text}");
}

#[test]
fn a_program_by_hand_is_read() {
    let text = "(a header)\n%\n( -- cutting -- )\nn10 g90g93 g21 g8g40 (modes) g64 g1\n\
                N20 G01 c0x2.5z0 f60 ; begin\nN30 C9. (a third) X2.499 Z1 F20000.0\n\
                \nX2.498 F20000 C18.0\n; -- end of path: 3 points --\nM2\n";
    let own = read(&plain(&LINUXCNC_G93), good().as_bytes()).unwrap();
    let by_hand = read(&plain(&LINUXCNC_G93), text.as_bytes()).unwrap();
    assert_eq!(own, by_hand);
}

#[test]
fn words_of_a_recipe_that_may_move_something_are_told() {
    let header = "; {name}\nG21 G90\nG0 Z5\nM30\nT0202\n";
    let told = |post: &Post| -> Vec<(usize, bool)> {
        let commands = post.dialect.commands(header);
        commands
            .iter()
            .map(|one| (one.line, one.harmless))
            .collect()
    };
    assert_eq!(
        told(&LINUXCNC_G93),
        [(2, true), (3, false), (4, true), (5, false)]
    );
    assert_eq!(
        told(&NANOTECH_G93),
        [(2, false), (3, false), (4, true), (5, true)]
    );
}

#[test]
fn each_line_of_a_segment_counts_against_the_shortest_one() {
    let points = path();
    let mut block = PathBlock::default();
    points.iter().for_each(|point| block.push(*point));
    let stretch = SectionBlock {
        section: Section::Cutting,
        opens_section: true,
        before: &[],
        points: &block,
    };
    // The segments take 3 ms.
    let lines = |tolerance: f64| {
        let mut layout = within(&NANOTECH_G93, tolerance);
        layout.format.shortest = 3_000_000;
        layout.lines(&stretch)
    };
    assert_eq!(lines(f64::INFINITY).unwrap().points, 3);
    let error = lines(1e-5).unwrap_err();
    let is_line = matches!(error, ProgramError::ShorterThanSaid { ms, .. } if ms < 1.5);
    assert!(is_line, "{error}");
    let help = error.help(NANOTECH_G93.keys);
    assert!(help.contains("more tolerance of interpolation"), "{help}");
}

/// What lies between the last point of a lead-in and the first one of the cut belongs to the lead-in,
/// whether it is one line or many. Its lines are above the part, and no tolerance of the cut holds them.
#[test]
fn lines_from_a_lead_to_the_cut_belong_to_the_lead() {
    let layout = within(&NANOTECH_G93, 1e-4);
    let points = path();
    let mut text = Vec::new();
    for (k, section) in [
        (0, Section::LeadIn),
        (1, Section::Cutting),
        (2, Section::LeadOut),
    ] {
        let mut block = PathBlock::default();
        block.push(points[k]);
        let stretch = SectionBlock {
            section,
            opens_section: true,
            before: &points[..k],
            points: &block,
        };
        let carried = layout.carried(&stretch).unwrap();
        let lines = layout.lines(&stretch).unwrap();
        assert_eq!(carried.points.len(), lines.points);
        let expected = if k == 1 { lines.points - 1 } else { 0 };
        assert_eq!(carried.of_section_before, expected);
        assert!(k == 0 || lines.points > 5);
        text.extend(lines.text);
    }
    let text = String::from_utf8(text).unwrap();
    let cut = text
        .lines()
        .position(|line| line == "; -- cutting --")
        .unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert!(
        lines[cut + 1].starts_with("C9 X2.499 "),
        "{}",
        lines[cut + 1]
    );
    assert_eq!(lines[cut + 2], "; -- lead-out --");
}
