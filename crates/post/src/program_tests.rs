//! A program of every post reads back as the path that the controller plays.

use proptest::prelude::*;
use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock, Segment};
use turnpath_core::{DEG, Params};
use turnpath_files::Draft;

use crate::{Layout, Lines, POSTS, Post, ProgramFormat, ProgramWriter, ReadPath};

/// A path from random steps: time in s, angle in deg, the rest in the units used inside.
pub(crate) fn path_of(steps: &[[f64; 6]]) -> Vec<ControlPoint> {
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
pub(crate) fn lines(layout: &Layout, points: &[ControlPoint], ends: &[usize]) -> Lines {
    lines_in_sections(layout, points, ends, 0..points.len())
}

/// The same for a path whose cutting section is `cut`, with leads around it.
fn lines_in_sections(
    layout: &Layout,
    points: &[ControlPoint],
    cuts: &[usize],
    cut: std::ops::Range<usize>,
) -> Lines {
    let ends = [cut.start, cut.end, points.len()];
    let mut cuts: Vec<usize> = cuts.iter().copied().chain(ends).collect();
    cuts.sort_unstable();
    let mut all = Lines::default();
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
        let lines = layout.lines(&stretch).unwrap();
        all.text.extend(lines.text);
        all.points += lines.points;
        begin = end;
    }
    all
}

pub(crate) fn program(layout: &Layout, points: &[ControlPoint]) -> String {
    assembled(layout, &lines(layout, points, &[]))
}

pub(crate) fn assembled(layout: &Layout, lines: &Lines) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("path.pmc");
    let mut writer =
        ProgramWriter::begin(Draft::begin(&path).unwrap(), layout.post.comment).unwrap();
    writer.append(lines).unwrap();
    let draft = writer.assemble("OPEN PROG 1 CLEAR\n", "CLOSE\n").unwrap();
    draft.complete().unwrap();
    std::fs::read_to_string(path).unwrap()
}

/// The time of the first point as a program carries it; a reader counts from there.
fn carried_start(layout: &Layout, points: &[ControlPoint]) -> f64 {
    let steps_per_s = layout.format.steps_per_s as f64;
    (points[0].t * steps_per_s).round() / steps_per_s
}

pub(crate) fn read(layout: &Layout, text: &[u8]) -> Result<Vec<ControlPoint>, String> {
    Ok(read_sections(layout, text)?.0)
}

fn read_sections(
    layout: &Layout,
    text: &[u8],
) -> Result<(Vec<ControlPoint>, Vec<Section>), String> {
    let mut reader = layout.read(text, "p");
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

/// By how much a velocity may differ beyond its digits where a post writes it as coefficients of twelve
/// decimals, over a segment of some seconds.
fn coefficient_rounding(layout: &Layout, duration: f64) -> f64 {
    let as_coefficients = layout.post.name.ends_with("-poly");
    if as_coefficients {
        1e-12 / duration
    } else {
        0.0
    }
}

fn assert_same(layout: &Layout, points: &[ControlPoint], read: &[ControlPoint]) {
    let format = &layout.format;
    let half_step = 0.5001 / format.steps_per_s as f64;
    assert_eq!(points.len(), read.len());
    // The writer and this test compute a cubic's slope in different orders, from times and positions
    // after many turns. The rounding error of the difference of two positions, divided by the time
    // between them, is far smaller than a digit.
    let velocity = |speed: f64, position: f64, duration: f64, instant: f64| {
        let per = if format.per_minute { 60.0 } else { 1.0 };
        let rounding = 1e-12 * (position.abs() + 600.0) / duration;
        let of_instant = 12.0 * 600.0 / (duration * duration) * f64::EPSILON * instant;
        let of_coefficients = coefficient_rounding(layout, duration);
        half_unit(format.velocity_decimals, speed * per) / per
            + rounding
            + of_instant
            + of_coefficients
    };
    let position = |size: f64| half_unit(format.position_decimals, size);
    for (k, (written, read)) in points.iter().zip(read).enumerate() {
        assert!(
            (read.t - written.t).abs() <= half_step,
            "{written:?} {read:?}"
        );
        let expected = match k {
            0 => *written,
            _ => played(&points[k - 1], written, read.t),
        };
        let duration = match k {
            // The first point has no segment before it; its velocity is that of the first one.
            0 if points.len() > 1 => points[1].t - written.t,
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

/// A post with its defaults.
pub(crate) fn plain(post: &'static Post) -> Layout {
    Layout {
        post,
        format: post.format(&Params::new(), 0.0),
    }
}

/// A post in some layout that its table can ask for.
fn layout() -> impl Strategy<Value = Layout> {
    let flags = any::<[bool; 4]>();
    (0..POSTS.len(), 3..9u32, 3..9u32, flags, 0.0..2.0f64).prop_map(
        |(post, position, velocity, flags, z_above)| {
            let plain = plain(&POSTS[post]);
            let has = |key: &str| plain.post.keys.iter().any(|info| info.name == key);
            let [per_minute, c_reversed, c_wrapped, incremental] = flags;
            let format = ProgramFormat {
                position_decimals: position,
                velocity_decimals: velocity,
                per_minute: per_minute && has("velocity_per"),
                c_reversed: c_reversed && has("c_sign"),
                c_wrapped: c_wrapped && has("c_wrap"),
                incremental: incremental && has("positioning"),
                z_above,
                ..plain.format
            };
            Layout { format, ..plain }
        },
    )
}

proptest! {
    #[test]
    fn a_path_comes_back_to_half_a_digit_whatever_the_settings(
        layout in layout(),
        steps in prop::collection::vec(step(), 1..60),
    ) {
        let points = path_of(&steps);
        let text = program(&layout, &points);
        assert_same(&layout, &points, &read(&layout, text.as_bytes()).unwrap());
    }

    /// What `verify` compares a program with: the points that a reader finds in it, to the rounding of
    /// doubles.
    #[test]
    fn what_a_program_carries_is_what_a_reader_finds_in_it(
        layout in layout(),
        steps in prop::collection::vec(step(), 1..60),
        cut in 0..60usize,
    ) {
        let points = path_of(&steps);
        let read = read(&layout, program(&layout, &points).as_bytes()).unwrap();
        let left_out = layout.turns_left_out(&points[0]).unwrap();
        let cut = cut.min(points.len());
        let mut carried = Vec::new();
        for (from, to) in [(0, cut), (cut, points.len())] {
            let mut block = PathBlock::default();
            points[from..to].iter().for_each(|point| block.push(*point));
            let stretch = SectionBlock {
                section: Section::Cutting,
                opens_section: from == 0,
                before: &points[from.saturating_sub(2)..from],
                points: &block,
            };
            carried.extend(layout.carried(&stretch).unwrap().points());
        }
        prop_assert_eq!(carried.len(), read.len());
        for (k, (carried, read)) in carried.iter().zip(&read).enumerate() {
            let next = points.get(k.max(1)).map_or(f64::INFINITY, |point| point.t);
            let duration = next - points[k.max(1) - 1].t;
            let of_coefficients = coefficient_rounding(&layout, duration);
            let pairs = [
                (carried.t - carried_start(&layout, &points), read.t),
                (carried.c - left_out, read.c),
                (carried.x, read.x),
                (carried.z, read.z),
                (carried.vc, read.vc),
                (carried.vx, read.vx),
                (carried.vz, read.vz),
            ];
            for (one, other) in pairs {
                prop_assert!((one - other).abs() <= 1e-14 * (1.0 + other.abs()) + of_coefficients, "{} {}", one, other);
            }
        }
    }

    #[test]
    fn lines_do_not_depend_on_where_blocks_end(
        layout in layout(),
        steps in prop::collection::vec(step(), 1..40),
        cuts in prop::collection::btree_set(1..40usize, 0..12),
    ) {
        let points = path_of(&steps);
        let cuts: Vec<usize> = cuts.into_iter().filter(|cut| *cut < points.len()).collect();
        prop_assert_eq!(lines(&layout, &points, &cuts), lines(&layout, &points, &[]));
    }

    #[test]
    fn leads_come_back_in_their_sections_whatever_the_settings(
        layout in layout(),
        steps in prop::collection::vec(step(), 2..40),
        (start, end) in (0..20usize, 1..20usize),
        cuts in prop::collection::btree_set(1..40usize, 0..6),
    ) {
        let points = path_of(&steps);
        let start = start.min(points.len() - 1);
        let cut = start..(start + end).min(points.len());
        let cuts: Vec<usize> = cuts.into_iter().filter(|cut| *cut < points.len()).collect();
        let lines = lines_in_sections(&layout, &points, &cuts, cut.clone());
        prop_assert_eq!(&lines, &lines_in_sections(&layout, &points, &[], cut.clone()));
        let text = assembled(&layout, &lines);
        let (read, sections) = read_sections(&layout, text.as_bytes()).unwrap();
        assert_same(&layout, &points, &read);
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
    fn distances_give_the_same_points_as_positions(
        post in 0..POSTS.len(),
        steps in prop::collection::vec(step(), 1..60),
    ) {
        let points = path_of(&steps);
        let positions = plain(&POSTS[post]);
        let format = ProgramFormat { incremental: true, ..positions.format };
        let distances = Layout { format, ..positions };
        prop_assert_eq!(
            read(&positions, program(&positions, &points).as_bytes()),
            read(&distances, program(&distances, &points).as_bytes())
        );
    }

    #[test]
    fn no_text_makes_a_reader_panic(
        post in 0..POSTS.len(),
        text in "((;|//) -- cutting --\n)?([-ABSINCPVTXZcxz0-9.:;(),\\[\\]MovePvt \n]|\\PC){0,80}",
    ) {
        let _ = read(&plain(&POSTS[post]), text.as_bytes());
    }
}

/// Numbers from a seed.
struct Numbers(u64);

impl Numbers {
    /// SplitMix64.
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Within 0 to 1.
    fn part(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number of any size up to `largest`, one in eight of them zero or the largest itself.
    fn of_any_size(&mut self, largest: f64) -> f64 {
        let sign = if self.next() & 1 == 0 { 1.0 } else { -1.0 };
        let size = match self.next() % 16 {
            0 => 0.0,
            1 => largest,
            _ => {
                let smaller = 10u64.pow((self.next() % 18) as u32) as f64;
                largest / smaller * self.part()
            }
        };
        sign * size
    }
}

/// Blocks of points on whole steps of time, so that nothing moves them: their numbers come back to
/// half a digit, whatever their size.
fn extreme_points_come_back(layout: &Layout, seed: u64, blocks: usize) {
    let steps_per_s = layout.format.steps_per_s;
    let half = |size: f64| 0.5e-7 + 2.0 * f64::EPSILON * size.abs();
    for block in 0..blocks as u64 {
        let mut numbers = Numbers(seed + block);
        let (mut steps, mut c) = (0i64, numbers.of_any_size(1e6));
        let points: Vec<ControlPoint> = (0..1000)
            .map(|_| {
                let point = ControlPoint {
                    t: steps as f64 / steps_per_s as f64,
                    c: c * DEG,
                    x: numbers.of_any_size(4e8),
                    z: numbers.of_any_size(4e8),
                    vc: numbers.of_any_size(4e8) * DEG,
                    vx: numbers.of_any_size(4e8),
                    vz: numbers.of_any_size(4e8),
                };
                let longest = layout.format.longest.min(10 * steps_per_s);
                steps += 1 + (numbers.part() * (longest - 1) as f64) as i64;
                c += 359.0 * numbers.part() + 1e-3;
                point
            })
            .collect();
        let read = read(layout, program(layout, &points).as_bytes()).unwrap();
        assert_eq!(read.len(), points.len());
        for (k, (one, other)) in points.iter().zip(&read).enumerate() {
            assert!((one.t - other.t).abs() <= 2.0 * f64::EPSILON * one.t);
            let duration = points[k.max(1)].t - points[k.max(1) - 1].t;
            let of_coefficients = coefficient_rounding(layout, duration);
            for (one, other, more) in [
                (one.c / DEG, other.c / DEG, 0.0),
                (one.x, other.x, 0.0),
                (one.z, other.z, 0.0),
                (one.vc / DEG, other.vc / DEG, of_coefficients),
                (one.vx, other.vx, of_coefficients),
                (one.vz, other.vz, of_coefficients),
            ] {
                assert!((one - other).abs() <= half(one) + more, "{one} {other}");
            }
        }
    }
}

#[test]
fn points_of_any_size_come_back_to_half_a_digit() {
    for post in POSTS {
        extreme_points_come_back(&plain(post), 1, 10);
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_million_points_of_any_size_come_back_to_half_a_digit() {
    for post in POSTS {
        extreme_points_come_back(&plain(post), 1_000_000, 1000);
    }
}

/// The time of a segment in seconds, from a line of text alone.
fn said_time(line: &str) -> Option<f64> {
    if let Some(ms) = line.strip_prefix("PVT") {
        return Some(ms.parse::<f64>().unwrap() / 1e3);
    }
    if let Some((_, feed)) = line.split_once(" F") {
        let feed: Option<f64> = feed.parse().ok();
        return feed.map(|feed| 60.0 / feed);
    }
    let call = line.strip_prefix("MovePvt(")?.strip_suffix(')')?;
    Some(call.rsplit(", ").next().unwrap().parse().unwrap())
}

/// The sum of the times in the text stays within half a step of the path's time, however many segments
/// it has. The sum is counted in steps, so that it has no rounding of its own.
fn times_do_not_drift(layout: &Layout, segments: u32) {
    let steps_per_s = layout.format.steps_per_s as f64;
    // 1/3 ms and a little is never a whole number of steps.
    let point = |k: u32| ControlPoint {
        t: f64::from(k) * (1e-3 / 3.0 + 1e-10 / 7.0),
        c: f64::from(k) * 0.01,
        vc: 30.0,
        ..ControlPoint::default()
    };
    let (mut sum, mut time, mut first) = (0i64, 0i64, true);
    let mut before: Vec<ControlPoint> = Vec::new();
    for begin in (0..=segments).step_by(10_000) {
        let mut block = PathBlock::default();
        (begin..(begin + 10_000).min(segments + 1)).for_each(|k| block.push(point(k)));
        let stretch = SectionBlock {
            section: Section::Cutting,
            opens_section: begin == 0,
            before: &before,
            points: &block,
        };
        let lines = String::from_utf8(layout.lines(&stretch).unwrap().text).unwrap();
        for line in lines.lines() {
            time = said_time(line).map_or(time, |s| (s * steps_per_s).round() as i64);
            let moves = ["C", "MovePvt", "G1 ", "POLY ", "PO["];
            let moves = moves.iter().any(|begin| line.starts_with(begin));
            // The first move is the way to the path.
            sum += if moves && !first { time } else { 0 };
            first &= !moves;
        }
        let last = block.get(block.len() - 1).unwrap();
        let off = sum as f64 / steps_per_s - last.t;
        assert!(
            off.abs() <= 0.5001 / steps_per_s + 1e-15 * last.t,
            "{}: {off}",
            layout.post.name
        );
        before = block.points().skip(block.len().saturating_sub(2)).collect();
    }
}

#[test]
fn times_do_not_drift_over_a_hundred_thousand_segments() {
    for post in POSTS {
        times_do_not_drift(&plain(post), 100_000);
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_times_do_not_drift_over_ten_million_segments() {
    for post in POSTS {
        times_do_not_drift(&plain(post), 10_000_000);
    }
}

#[test]
fn one_damaged_line_of_a_path_is_refused_with_its_number() {
    let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 40]);
    for post in POSTS {
        let layout = plain(post);
        let text = program(&layout, &points);
        let lines: Vec<&str> = text.lines().collect();
        let is_mark = |line: &str| line.contains("-- cutting") || line.contains("-- end of path");
        let begin = lines.iter().position(|line| is_mark(line)).unwrap() + 1;
        let end = lines.iter().rposition(|line| is_mark(line)).unwrap();
        let mut numbers = Numbers(7);
        for damaged in begin..end {
            let at = numbers.next() as usize % (lines[damaged].len() + 1);
            let (head, tail) = lines[damaged].split_at(at);
            let line = format!("{head}@{tail}");
            let mut spoiled = lines.clone();
            spoiled[damaged] = &line;
            let said = read(&layout, spoiled.join("\n").as_bytes()).unwrap_err();
            let place = format!("line {}: ", damaged + 1);
            assert!(said.contains(&place), "{line}: {said}");
        }
    }
}

#[test]
fn five_hundred_damaged_programs_of_each_post_are_read_or_refused_with_a_line() {
    let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 20]);
    for post in POSTS {
        let layout = plain(post);
        let good = program(&layout, &points).into_bytes();
        let (mut numbers, mut refused) = (Numbers(11), 0);
        for _ in 0..500 {
            let mut bytes = good.clone();
            for _ in 0..=numbers.next() % 4 {
                let at = numbers.next() as usize % bytes.len();
                let other = good[numbers.next() as usize % good.len()];
                match numbers.next() % 4 {
                    0 => bytes[at] = other,
                    1 => bytes.insert(at, other),
                    2 => bytes[at] = (numbers.next() % 256) as u8,
                    _ => {
                        bytes.remove(at);
                    }
                }
            }
            let lines = bytes.split(|byte| *byte == b'\n').count();
            if let Err(said) = read(&layout, &bytes) {
                let line = said.strip_prefix("p, line ").unwrap_or_default();
                let line: usize = line.split(':').next().unwrap().parse().unwrap();
                assert!((1..=lines).contains(&line), "{said}");
                refused += 1;
            }
        }
        assert!(refused > 200, "{}: only {refused} are refused", post.name);
    }
}

#[test]
fn a_segment_that_is_too_long_for_the_controller_is_divided_and_plays_the_same_cubic() {
    for post in POSTS {
        let layout = plain(post);
        let longest = layout.format.longest as f64 / layout.format.steps_per_s as f64;
        let long = 3.5 * longest;
        // A quarter of a turn: C grows evenly, and by less than a turn in each part.
        let rate = 90.0 / long;
        let points = path_of(&[
            [0.5, 0.5 * rate, 2.5, 1.0, -0.2, 5.0],
            [long, 90.0, 2.0, -1.0, 0.1, -1.0],
        ]);
        let read = read(&layout, program(&layout, &points).as_bytes()).unwrap();
        assert_eq!(read.len(), 6, "{}", post.name);
        for pair in read.windows(2) {
            assert!(pair[1].t - pair[0].t <= longest);
        }
        let half_digit = 0.5001e-7;
        for point in &read[2..] {
            let expected = played(&points[1], &points[2], point.t);
            assert!(
                (expected.x - point.x).abs() < half_digit,
                "{expected:?} {point:?}"
            );
            assert!((expected.z - point.z).abs() < half_digit);
            assert!((expected.c - point.c).abs() < half_digit * DEG);
            assert!((expected.vz - point.vz).abs() < half_digit);
        }
        assert_eq!(
            lines(&layout, &points, &[1, 2]),
            lines(&layout, &points, &[])
        );
    }
}

#[test]
fn a_program_in_memory_has_the_bytes_of_its_file() {
    for post in POSTS {
        let layout = plain(post);
        let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 4]);
        let lines = lines(&layout, &points, &[]);
        let file = assembled(&layout, &lines);
        let mut writer = ProgramWriter::in_memory(post.comment);
        writer.append(&lines).unwrap();
        let memory = writer.assemble_in_memory("OPEN PROG 1 CLEAR\n", "CLOSE\n");
        assert_eq!(String::from_utf8(memory).unwrap(), file);
    }
}
