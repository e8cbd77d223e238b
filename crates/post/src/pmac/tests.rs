//! A program reads back as the path that the controller plays, and damage is refused with its line.

use proptest::prelude::*;
use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Cubic, PathBlock, Section, SectionBlock, Segment};
use turnpath_files::Draft;

use super::format::{QUANTA_PER_S, TURN_DEG};
use super::{PmacFormat, PmacReader, PmacWriter};
use crate::ReadPath;

/// A path from random steps: time in s, angle in deg, the rest in the units used inside.
fn path_of(steps: &[[f64; 6]]) -> Vec<ControlPoint> {
    let mut point = ControlPoint {
        vc: 50.0,
        x: 2.5,
        vz: -1.0 / 3.0,
        ..ControlPoint::default()
    };
    let mut points = vec![point];
    for [dt, dc, x, z, vx, vz] in steps {
        point = ControlPoint {
            t: point.t + dt,
            c: point.c + dc * DEG,
            x: *x,
            z: *z,
            vc: dc * DEG / dt,
            vx: *vx,
            vz: *vz,
        };
        points.push(point);
    }
    points
}

fn step() -> impl Strategy<Value = [f64; 6]> {
    (
        1e-4..0.5f64,
        0.01..170.0f64,
        -300.0..300.0f64,
        -20.0..20.0f64,
        -9.0..9.0f64,
        -200.0..200.0f64,
    )
        .prop_map(|(dt, dc, x, z, vx, vz)| [dt, dc, x, z, vx, vz])
}

/// The program's lines, made of blocks that end at `ends`.
fn lines(format: &PmacFormat, points: &[ControlPoint], ends: &[usize]) -> Vec<u8> {
    lines_in_sections(format, points, ends, 0..points.len())
}

/// The same for a path whose cutting section is `cut`, with leads around it.
fn lines_in_sections(
    format: &PmacFormat,
    points: &[ControlPoint],
    cuts: &[usize],
    cut: std::ops::Range<usize>,
) -> Vec<u8> {
    let ends = [cut.start, cut.end, points.len()];
    let mut cuts: Vec<usize> = cuts.iter().copied().chain(ends).collect();
    cuts.sort_unstable();
    let mut text = Vec::new();
    let mut begin = 0;
    for end in cuts {
        if end <= begin {
            continue;
        }
        let (section, opens_section) = match begin {
            _ if begin >= cut.end => (Section::LeadOut, begin == cut.end),
            _ if begin >= cut.start => (Section::Cutting, begin == cut.start),
            _ => (Section::LeadIn, begin == 0),
        };
        let mut block = PathBlock::default();
        points[begin..end]
            .iter()
            .for_each(|point| block.push(*point));
        let stretch = SectionBlock {
            section,
            opens_section,
            before: &points[begin.saturating_sub(2)..begin],
            points: &block,
        };
        text.extend(PmacWriter::lines(format, &stretch).unwrap());
        begin = end;
    }
    text
}

fn program(format: &PmacFormat, points: &[ControlPoint]) -> String {
    assembled(points.len(), &lines(format, points, &[]))
}

fn assembled(points: usize, lines: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("path.pmc");
    let mut writer = PmacWriter::begin(Draft::begin(&path).unwrap()).unwrap();
    writer.append(points, lines).unwrap();
    let draft = writer.assemble("OPEN PROG 1 CLEAR\n", "CLOSE\n").unwrap();
    draft.complete().unwrap();
    std::fs::read_to_string(path).unwrap()
}

fn read(format: &PmacFormat, text: &[u8]) -> Result<Vec<ControlPoint>, String> {
    Ok(read_sections(format, text)?.0)
}

fn read_sections(
    format: &PmacFormat,
    text: &[u8],
) -> Result<(Vec<ControlPoint>, Vec<Section>), String> {
    let mut reader = PmacReader::from_reader(text, "p", *format);
    let (mut points, mut sections) = (Vec::new(), Vec::new());
    while let Some((point, section)) = reader.next_point().map_err(|error| error.to_string())? {
        points.push(point);
        sections.push(section);
    }
    Ok((points, sections))
}

/// The point of the played path at a time near a control point: on the cubic that ends there.
fn played(before: &ControlPoint, point: &ControlPoint, time: f64) -> ControlPoint {
    let segment = Segment::between(before, point);
    let (s, h) = ((time - before.t) / segment.duration, segment.duration);
    ControlPoint {
        t: time,
        c: segment.c.value(s),
        x: segment.x.value(s),
        z: segment.z.value(s),
        vc: segment.c.slope(s) / h,
        vx: segment.x.slope(s) / h,
        vz: segment.z.slope(s) / h,
    }
}

/// Half a unit of the last digit, and the rounding error of a double of this size.
fn half_unit(decimals: u32, size: f64) -> f64 {
    0.5 / 10u64.pow(decimals) as f64 * (1.0 + 1e-6) + 1e-12 * size.abs()
}

fn assert_same(format: &PmacFormat, points: &[ControlPoint], read: &[ControlPoint]) {
    assert_eq!(points.len(), read.len());
    // The writer and this test compute a cubic's slope in different orders, from times and positions
    // after many turns. The rounding error of the difference of two positions, divided by the time
    // between them, is far smaller than a digit.
    let velocity = |speed: f64, position: f64, duration: f64, instant: f64| {
        let per = if format.per_minute { 60.0 } else { 1.0 };
        let rounding = 1e-12 * (position.abs() + 600.0) / duration;
        let of_instant = 12.0 * 600.0 / (duration * duration) * f64::EPSILON * instant;
        half_unit(format.velocity_decimals, speed * per) / per + rounding + of_instant
    };
    let position = |size: f64| half_unit(format.position_decimals, size);
    for (k, (written, read)) in points.iter().zip(read).enumerate() {
        assert!(
            (read.t - written.t).abs() <= 0.5001 / QUANTA_PER_S,
            "{written:?} {read:?}"
        );
        let expected = match k {
            0 => *written,
            _ => played(&points[k - 1], written, read.t),
        };
        let duration = match k {
            0 => f64::INFINITY,
            _ => written.t - points[k - 1].t,
        };
        for (expected, read, bound) in [
            (expected.c / DEG, read.c / DEG, position(expected.c / DEG)),
            (expected.x, read.x, position(expected.x)),
            (expected.z, read.z, position(expected.z)),
            (
                expected.vc / DEG,
                read.vc / DEG,
                velocity(expected.vc / DEG, expected.c / DEG, duration, written.t),
            ),
            (
                expected.vx,
                read.vx,
                velocity(expected.vx, expected.x, duration, written.t),
            ),
            (
                expected.vz,
                read.vz,
                velocity(expected.vz, expected.z, duration, written.t),
            ),
        ] {
            assert!(
                (expected - read).abs() <= bound,
                "point {k}: {expected} {read} {bound}"
            );
        }
    }
}

fn format() -> impl Strategy<Value = PmacFormat> {
    let flags = any::<[bool; 4]>();
    (3..9u32, 3..9u32, flags, 0.0..2.0f64).prop_map(|(position, velocity, flags, z_above)| {
        let [per_minute, c_reversed, c_wrapped, incremental] = flags;
        PmacFormat {
            position_decimals: position,
            velocity_decimals: velocity,
            per_minute,
            c_reversed,
            c_wrapped,
            incremental,
            z_above,
        }
    })
}

proptest! {
    #[test]
    fn a_path_comes_back_to_half_a_digit_whatever_the_settings(
        format in format(),
        steps in prop::collection::vec(step(), 1..60),
    ) {
        let points = path_of(&steps);
        let text = program(&format, &points);
        assert_same(&format, &points, &read(&format, text.as_bytes()).unwrap());
    }

    #[test]
    fn lines_do_not_depend_on_where_blocks_end(
        format in format(),
        steps in prop::collection::vec(step(), 1..40),
        cuts in prop::collection::btree_set(1..40usize, 0..12),
    ) {
        let points = path_of(&steps);
        let cuts: Vec<usize> = cuts.into_iter().filter(|cut| *cut < points.len()).collect();
        prop_assert_eq!(lines(&format, &points, &cuts), lines(&format, &points, &[]));
    }

    #[test]
    fn leads_come_back_in_their_sections_whatever_the_settings(
        format in format(),
        steps in prop::collection::vec(step(), 2..40),
        (start, end) in (0..20usize, 1..20usize),
        cuts in prop::collection::btree_set(1..40usize, 0..6),
    ) {
        let points = path_of(&steps);
        let start = start.min(points.len() - 1);
        let cut = start..(start + end).min(points.len());
        let cuts: Vec<usize> = cuts.into_iter().filter(|cut| *cut < points.len()).collect();
        let lines = lines_in_sections(&format, &points, &cuts, cut.clone());
        prop_assert_eq!(&lines, &lines_in_sections(&format, &points, &[], cut.clone()));
        let text = assembled(points.len(), &lines);
        let (read, sections) = read_sections(&format, text.as_bytes()).unwrap();
        assert_same(&format, &points, &read);
        for (k, section) in sections.into_iter().enumerate() {
            let expected = match k {
                _ if k < cut.start => Section::LeadIn,
                _ if k < cut.end => Section::Cutting,
                _ => Section::LeadOut,
            };
            prop_assert_eq!(section, expected);
        }
    }

    #[test]
    fn distances_give_the_same_points_as_positions(steps in prop::collection::vec(step(), 1..60)) {
        let points = path_of(&steps);
        let positions = PmacFormat::default();
        let distances = PmacFormat { incremental: true, ..positions };
        prop_assert_eq!(
            read(&positions, program(&positions, &points).as_bytes()),
            read(&distances, program(&distances, &points).as_bytes())
        );
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in "(; -- cutting --\n)?([-ABSINCPVTXZcxz0-9.:;() \n]|\\PC){0,80}") {
        let _ = read(&PmacFormat::default(), text.as_bytes());
    }
}

#[test]
fn time_does_not_drift_over_a_hundred_thousand_segments() {
    // 1/3 ms and a little is never a whole number of quanta.
    let points: Vec<ControlPoint> = (0..=100_000u32)
        .map(|k| ControlPoint {
            t: f64::from(k) * (1e-3 / 3.0 + 1e-9),
            c: f64::from(k) * 0.01,
            vc: 30.0,
            ..ControlPoint::default()
        })
        .collect();
    for incremental in [false, true] {
        let format = PmacFormat {
            incremental,
            ..PmacFormat::default()
        };
        let text = program(&format, &points);
        let sum: f64 = summed_ms(&text);
        let (first, last) = (points[0], points[points.len() - 1]);
        assert!((sum / 1e3 - (last.t - first.t)).abs() <= 0.5001 / QUANTA_PER_S);
        let read = read(&format, text.as_bytes()).unwrap();
        for (written, read) in points.iter().zip(&read) {
            assert!((written.t - read.t).abs() <= 0.5001 / QUANTA_PER_S);
            let rate = last.c / last.t;
            assert!((read.c - rate * read.t).abs() < 1e-8);
        }
    }
}

/// The sum of the segment times without the entry's, from the text alone, without the reader.
fn summed_ms(text: &str) -> f64 {
    let (mut sum, mut time, mut entered) = (0.0, 0.0, false);
    for line in text.lines() {
        if let Some(ms) = line.strip_prefix("PVT") {
            time = ms.parse().unwrap();
        } else if line.starts_with('C') && line != "CLOSE" {
            sum += if entered { time } else { 0.0 };
            entered = true;
        }
    }
    sum
}

fn good() -> String {
    let steps: Vec<[f64; 6]> = (1..=4)
        .map(|k| [0.003, 9.0, 2.5 - 0.001 * f64::from(k), 1.0, -0.2, 5.0])
        .collect();
    program(&PmacFormat::default(), &path_of(&steps))
}

#[test]
fn the_program_looks_like_this() {
    let text = "\
OPEN PROG 1 CLEAR
; -- cutting --
ABS
PVT1000
C0:2864.7889757 X2.5:0 Z0:-0.3333333
PVT3
C9:3000 X2.499:-0.2 Z1:5
C18:3000 X2.498:-0.2 Z1:5
C27:3000 X2.497:-0.2 Z1:5
C36:3000 X2.496:-0.2 Z1:5
; -- end of path: 5 points --
CLOSE
";
    assert_eq!(good(), text);
}

fn replaced(line: usize, new: &str) -> String {
    let text = good();
    let mut lines: Vec<&str> = text.lines().collect();
    lines[line - 1] = new;
    lines.join("\n")
}

fn refusal(text: &str) -> String {
    read(&PmacFormat::default(), text.as_bytes()).unwrap_err()
}

#[test]
fn damaged_lines_are_refused_with_their_number() {
    for (new, says) in [
        (
            "C18:3000 X2.498:NaN Z1:5",
            "line 8: the velocity of X has no number",
        ),
        (
            "C18:3000 XNaN:-0.2 Z1:5",
            "line 8: `XNaN:-0.2` is not a word",
        ),
        ("C18:3000 X2.498:-0.2 Q1:5", "line 8: `Q1:5` is not a word"),
        (
            "C18:3000 X2.4.98:-0.2 Z1:5",
            "line 8: `.98:-0.2` is not a word",
        ),
        (
            "C18:3000 X2.498: Z1:5",
            "line 8: the velocity of X has no number",
        ),
        ("C18:3000 X2.498:-0.2 Z1:5 Z1:5", "line 8: Z appears twice"),
        (
            "C18:3000 X2.498:-0.2 PVT3 Z1:5",
            "line 8: a mode follows a move",
        ),
        ("C5:3000 X2.498:-0.2 Z1:5", "line 8: C turns by -4"),
        ("C1800:3000 X2.498:-0.2 Z1:5", "line 8: C turns by 1791"),
        ("PVT0", "line 8: a segment cannot take 0 ms"),
        ("PVT5000", "line 8: a segment cannot take 5000 ms"),
        ("LINEAR", "line 8: `LINEAR` is not a word"),
        (
            "; -- lead-in --",
            "line 8: `; -- lead-in --` is out of order",
        ),
        (
            "",
            "line 11: the path has 4 points, but its end mark says 5",
        ),
        ("\u{fc}", "line 8: `\u{fc}` is not a word"),
    ] {
        let message = refusal(&replaced(8, new));
        assert!(message.contains(says), "{new}: {message}");
    }
}

#[test]
fn the_first_point_must_have_positions_of_all_axes_and_a_time() {
    for (line, new, says) in [
        (3, "INC", "line 5: the first point must be a position"),
        (4, "", "line 5: a move without a `PVT` time"),
        (5, "C0:1 X2.5:0", "line 5: the first point does not give Z"),
    ] {
        let message = refusal(&replaced(line, new));
        assert!(message.contains(says), "{new}: {message}");
    }
}

#[test]
fn an_incomplete_program_is_refused() {
    let text = good();
    let cut = text.split("; -- end").next().unwrap();
    let message = refusal(cut);
    assert!(
        message.contains("line 10: the program ends without"),
        "{message}"
    );
    let message = refusal(&cut[..cut.len() - 8]);
    assert!(message.contains("line 10:"), "{message}");
    let message = refusal("OPEN PROG 1 CLEAR\nX1:2\nCLOSE\n");
    assert!(message.contains("line 3: there is no path"), "{message}");
    let message = refusal("");
    assert!(message.contains("line 1: there is no path"), "{message}");
    let message = refusal(&"X".repeat(100_000));
    assert!(message.contains("line 1: this line is longer"), "{message}");
}

#[test]
fn reasonable_edits_by_hand_are_accepted() {
    let format = PmacFormat::default();
    let edited = "\
&1 I42=0 whatever the header says
;   -- CUTTING --
abs // all axes
  pvt 1000 z 0:-.3333333 x+2.5 C0:2864.7889757   ; another order
PVT3.0 C9:3000 X2.499:-0.2 Z1:5

INC(C)
N20 c9:3000 x 2.498 : -0.2 Z1.:5.0
TM3
C9:3000 X2.497:-0.2
ABS (C)
C36:3000 X2.496:-0.2 Z1:5\r
; -- END OF PATH: 5 points
whatever the footer says";
    let mut expected = read(&format, good().as_bytes()).unwrap();
    // Without a word, Z keeps its position and ends at rest.
    expected[3].vz = 0.0;
    assert_eq!(read(&format, edited.as_bytes()).unwrap(), expected);
}

#[test]
fn what_a_program_cannot_carry_is_refused_with_its_place() {
    let refused = |format: PmacFormat, steps: &[[f64; 6]]| {
        let mut block = PathBlock::default();
        path_of(steps)
            .into_iter()
            .for_each(|point| block.push(point));
        let stretch = SectionBlock {
            section: Section::Cutting,
            opens_section: true,
            before: &[],
            points: &block,
        };
        PmacWriter::lines(&format, &stretch)
            .unwrap_err()
            .to_string()
    };
    let plain = PmacFormat::default();
    let long = refused(
        plain,
        &[
            [0.003, 9.0, 1.0, 1.0, 0.0, 0.0],
            [4.096, 9.0, 1.0, 1.0, 0.0, 0.0],
        ],
    );
    assert!(
        long.contains("ends at 4.099000 s, C = 18.000 deg takes 4096.0000 ms"),
        "{long}"
    );
    let short = refused(plain, &[[1e-7, 9.0, 1.0, 1.0, 0.0, 0.0]]);
    assert!(short.contains("less than 1/4096 ms"), "{short}");
    let wrapped = PmacFormat {
        c_wrapped: true,
        ..plain
    };
    let turned = refused(wrapped, &[[0.1, 180.0, 1.0, 1.0, 0.0, 0.0]]);
    assert!(turned.contains("half a revolution"), "{turned}");
    let fine = PmacFormat {
        position_decimals: 12,
        ..plain
    };
    let digits = refused(fine, &[[0.1, 9.0, 1e4, 1.0, 0.0, 0.0]]);
    assert!(
        digits.contains("X = 10000 at 0.100000 s has too many digits"),
        "{digits}"
    );
}

#[test]
fn wrapped_c_is_written_within_one_revolution_and_read_unwrapped() {
    let steps: Vec<[f64; 6]> = (0..100).map(|_| [0.003, 9.0, 1.0, 1.0, 0.0, 0.0]).collect();
    for c_reversed in [false, true] {
        let format = PmacFormat {
            c_wrapped: true,
            c_reversed,
            ..PmacFormat::default()
        };
        let text = program(&format, &path_of(&steps));
        for line in text
            .lines()
            .filter(|line| line.starts_with('C') && *line != "CLOSE")
        {
            let c: f64 = line[1..].split(':').next().unwrap().parse().unwrap();
            assert!((0.0..TURN_DEG as f64).contains(&c), "{line}");
        }
        let read = read(&format, text.as_bytes()).unwrap();
        assert!((read[100].c / DEG - 900.0).abs() < 1e-9);
    }
}

#[test]
fn the_default_velocity_digits_cost_less_than_a_position_digit() {
    let format = PmacFormat::default();
    let half = |decimals: u32| 0.5 / 10u64.pow(decimals) as f64;
    let velocity = half(format.velocity_decimals);
    // The worst case: both ends off by half a digit, one up, one down, over a second.
    let off = Cubic::hermite(0.0, velocity, 0.0, -velocity, 1.0);
    let largest = (0..=100)
        .map(|k| off.value(f64::from(k) / 100.0))
        .fold(0.0, f64::max);
    assert!(largest < 0.51 * half(format.position_decimals), "{largest}");
}

#[test]
fn a_program_in_memory_has_the_bytes_of_its_file() {
    let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 4]);
    let lines = lines(&PmacFormat::default(), &points, &[]);
    let file = assembled(points.len(), &lines);
    let mut writer = PmacWriter::in_memory();
    writer.append(points.len(), &lines).unwrap();
    let memory = writer.assemble_in_memory("OPEN PROG 1 CLEAR\n", "CLOSE\n");
    assert_eq!(String::from_utf8(memory).unwrap(), file);
}

#[test]
fn a_program_reads_the_same_from_a_file_and_from_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("path.pmc");
    std::fs::write(&path, good()).unwrap();
    let format = PmacFormat::default();
    let mut file = PmacReader::open(&path, format).unwrap();
    let good = good();
    let mut memory = PmacReader::from_reader(good.as_bytes(), "memory", format);
    loop {
        let (one, other) = (file.next_point().unwrap(), memory.next_point().unwrap());
        assert_eq!(one, other);
        if one.is_none() {
            break;
        }
    }
    assert_eq!(file.read_count().points(), 5);
}
