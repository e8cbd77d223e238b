//! A path comes back from its program whatever the settings.

use proptest::prelude::*;
use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock};

use super::*;
use crate::{POSTS, ProgramFormat};

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

/// The time of the first point as a program carries it; a reader counts from there.
fn carried_start(layout: &Layout, points: &[ControlPoint]) -> f64 {
    let steps_per_s = layout.format.steps_per_s as f64;
    (points[0].t * steps_per_s).round() / steps_per_s
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
            carried.extend(layout.carried(&stretch).unwrap().points.points());
        }
        prop_assert_eq!(carried.len(), read.len());
        for (k, (carried, read)) in carried.iter().zip(&read).enumerate() {
            let next = points.get(k.max(1)).map_or(f64::INFINITY, |point| point.t);
            let duration = next - points[k.max(1) - 1].t;
            let of_coefficients = coefficient_rounding(&layout, duration);
            // A reader counts in 10⁻¹², also where the controller holds binary numbers.
            let of_steps = if layout.format.mantissa_bits.is_some() { 0.6e-12 } else { 0.0 };
            let mut pairs = vec![
                (carried.t - carried_start(&layout, &points), read.t),
                (carried.c - left_out, read.c),
                (carried.x, read.x),
                (carried.z, read.z),
            ];
            let velocities = [
                (carried.vc, read.vc),
                (carried.vx, read.vx),
                (carried.vz, read.vz),
            ];
            if layout.format.chords.is_none() {
                pairs.extend(velocities);
            }
            for (one, other) in pairs {
                prop_assert!((one - other).abs() <= 1e-14 * (1.0 + other.abs()) + of_coefficients + of_steps, "{} {}", one, other);
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

    /// Points on steps of time go through vector registers, unless one of those beside them lies between two steps.
    #[test]
    fn lines_of_points_on_steps_do_not_depend_on_the_way_of_their_digits(
        layout in layout(),
        steps in prop::collection::vec(step(), 2..40),
    ) {
        let steps_per_s = layout.format.steps_per_s as f64;
        let mut points = path_of(&steps);
        for point in &mut points {
            point.t = (point.t * steps_per_s).round() / steps_per_s;
        }
        if let Some(last) = points.last_mut() {
            last.t += 0.3 / steps_per_s;
        }
        let on_steps = lines(&layout, &points[..points.len() - 1], &[]);
        let beside = lines(&layout, &points, &[]);
        prop_assert!(beside.text.starts_with(&on_steps.text));
    }

    /// Behind a point that is written, those on steps of time go together where each of them ends one line.
    #[test]
    fn lines_of_segments_together_are_those_of_each_alone(
        layout in layout(),
        decimals in 3..12u32,
        steps in prop::collection::vec(step(), 2..70),
        shortest in 1..2000i64,
        c_limit in 0..4_000i64,
    ) {
        let format = ProgramFormat {
            velocity_decimals: decimals,
            shortest: layout.format.shortest.max(shortest),
            // As many degrees are within the reach of about half of these paths.
            c_limit: Some(c_limit * 10i64.pow(layout.format.position_decimals)),
            ..layout.format
        };
        let layout = Layout { format, ..layout };
        let steps_per_s = format.steps_per_s as f64;
        let mut points = path_of(&steps);
        for point in &mut points {
            point.t = (point.t * steps_per_s).round() / steps_per_s;
        }
        let of = |before: usize, points: &[ControlPoint]| {
            let (before, rest) = points.split_at(before);
            let mut block = PathBlock::default();
            rest.iter().for_each(|point| block.push(*point));
            let section = Section::Cutting;
            layout.lines(&SectionBlock { section, opens_section: false, before, points: &block })
        };
        let text = |lines: Lines| String::from_utf8(lines.text).unwrap();
        match (of(0, &points), of(1, &points)) {
            (Ok(alone), Ok(together)) => {
                prop_assert_eq!((together.points + 1, together.extent.is_some()), (alone.points, true));
                let (alone, together) = (text(alone), text(together));
                prop_assert!(alone.ends_with(&together), "{} {}", alone, together);
            }
            (alone, together) => {
                let message = |lines: Result<Lines, _>| lines.map(text).map_err(|error: crate::ProgramError| error.to_string());
                prop_assert_eq!(message(together), message(alone));
            }
        }
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
        // What the text says, apart from what the controller holds of it.
        let positions = plain(&POSTS[post]);
        let format = ProgramFormat { mantissa_bits: None, ..positions.format };
        let positions = Layout { format, ..positions };
        let format = ProgramFormat { incremental: true, ..format };
        let distances = Layout { format, ..positions };
        prop_assert_eq!(
            read(&positions, program(&positions, &points).as_bytes()),
            read(&distances, program(&distances, &points).as_bytes())
        );
    }

    #[test]
    fn no_text_makes_a_reader_panic(
        post in 0..POSTS.len(),
        text in "((;|//) -- cutting --\n)?(G21G90G93G1)?([-ABSINCPVTXZcxzFGN0-9.:;(),\\[\\]MovePvt \n]|\\PC){0,80}",
    ) {
        let _ = read(&plain(&POSTS[post]), text.as_bytes());
    }

    /// Words of each dialect in any order, with numbers of any size.
    #[test]
    fn no_words_of_its_dialect_make_a_reader_panic(
        post in 0..POSTS.len(),
        words in prop::collection::vec((0..40usize, "-?[0-9]{0,16}(\\.[0-9]{0,14})?"), 1..60),
    ) {
        let post = &POSTS[post];
        let first = program(&plain(post), &path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]]));
        let (path, _) = first.split_once(" -- end of path").unwrap();
        let (path, _) = path.rsplit_once('\n').unwrap();
        let mut text = format!("{path}\n");
        let all = words_of(post.name);
        for (word, number) in words {
            text += &all[word % all.len()].replace('#', &number);
        }
        text += &format!("\n{} -- end of path: 2 points --\n", post.comment);
        let _ = read(&plain(post), text.as_bytes());
    }
}

/// The words of a dialect; `#` stands for a number.
fn words_of(post: &str) -> &'static [&'static str] {
    match post {
        "siemens-840d-poly" => &[
            " PO[C]=(#)",
            " PO[X]=(#,#)",
            " PO[Z]=(#,#,#)",
            " PO[C]=(#,#,#)",
            " F#\n",
            " F0.06\n",
            " F60000000000\n",
            " POLY",
            " G1",
            " X#",
            "\n",
            "N#",
            " UPATH",
            " G71",
        ],
        "beckhoff-poly" => &[
            " W#",
            " C[POLY A0=#]",
            " X[POLY A0=# A1=# A2=#]",
            " Z[POLY A0=# A1=# A2=# A3=#]",
            " C[POLY L=# A0=#",
            " A4=#]",
            " F#",
            "\n",
            " G94 G1 F600",
            " G0 W#\n",
            "#FGROUP [W]\n",
            " G#",
            "N#",
            " (",
            ") ",
        ],
        "automation1-pvt" => &[
            "MovePvt([C, X, Z], [#, #, #], [#, #, #], #)\n",
            "MovePvt([C], [#], [#], 1000)\n",
            "MovePvt([X",
            "])\n",
            ", #",
            "SetupTaskTargetMode(TargetMode.Incremental)\n",
            "SetupTaskTargetMode(TargetMode.Absolute)\n",
        ],
        "beckhoff-g93" | "nanotech-g93" | "linuxcnc-g93" => &[
            " C#",
            " X#",
            " Z#",
            " F#",
            " P#",
            "\n",
            " G1",
            " G4",
            " G#",
            " N#",
            " (",
            ") ",
            " G4 P0.5\n",
            " C# F60\n",
        ],
        _ => &[
            " C#",
            " X#:#",
            " Z#",
            "\n",
            " PVT#",
            "\nPVT0.25\n",
            " INC",
            " ABS",
            " INC(C)",
            " TM#",
            " N#",
            ":#",
            " ABS(",
        ],
    }
}

/// The shortest path on which a point that waited for the line behind it had the section of that line.
#[test]
fn a_single_cutting_point_after_a_single_point_of_the_lead_keeps_its_section() {
    for post in POSTS {
        let layout = plain(post);
        let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 4]);
        for cut in [1..2, 1..5, 2..3, 0..1] {
            let text = assembled(
                &layout,
                &lines_in_sections(&layout, &points, &[], cut.clone()),
            );
            let (_, sections) = read_sections(&layout, text.as_bytes()).unwrap();
            let expected = (0..5).map(|k| match k {
                _ if k < cut.start => Section::LeadIn,
                _ if k < cut.end => Section::Cutting,
                _ => Section::LeadOut,
            });
            assert_eq!(sections, expected.collect::<Vec<_>>(), "{}", post.name);
        }
    }
}

/// What stands before a mark on its line is code that no reader of the path reads.
#[test]
fn code_before_a_mark_is_refused_and_an_end_mark_has_one_form() {
    for post in POSTS {
        let layout = plain(post);
        let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 4]);
        let (comment, good) = (post.comment, program(&layout, &points));
        let spoiled = |from: &str, to: &str| {
            let (from, to) = (format!("{comment} {from}"), to.replace(';', comment));
            assert!(good.contains(&from));
            read(&layout, good.replace(&from, &to).as_bytes())
        };
        let end = "-- end of path: 5 points --";
        for mark in [end, "-- cutting --"] {
            let said = spoiled(mark, &format!("C3600:0 X0:0 Z-50:0 ; {mark}")).unwrap_err();
            assert!(said.contains("code stands before a mark"), "{said}");
            assert!(spoiled(mark, &format!("  ; {mark}")).is_ok());
        }
        for wrong in [
            "5 0",
            "0 5",
            "05 points 5",
            "5, points",
            "5.0 points",
            "",
            "points",
        ] {
            let said = spoiled(end, &format!("; -- end of path: {wrong} --")).unwrap_err();
            assert!(
                said.contains("must give the number of points"),
                "{wrong}: {said}"
            );
        }
        for right in ["-- end of path: 5 points", "-- End of Path : 5 points--"] {
            assert!(spoiled(end, &format!("; {right}")).is_ok(), "{right}");
        }
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
        let half_digit = 0.5001 / 10u64.pow(layout.format.position_decimals) as f64;
        for point in &read[2..] {
            let expected = played(&points[1], &points[2], point.t);
            assert!(
                (expected.x - point.x).abs() < half_digit,
                "{expected:?} {point:?}"
            );
            assert!((expected.z - point.z).abs() < half_digit);
            assert!((expected.c - point.c).abs() < half_digit * DEG);
            if layout.format.chords.is_none() {
                assert!((expected.vz - point.vz).abs() < half_digit);
            }
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
        let mut writer = ProgramWriter::in_memory(layout);
        writer.append(&lines).unwrap();
        let around = ["OPEN PROG 1 CLEAR\n", "CLOSE\n"];
        let memory = writer.close().assemble(around, "path").unwrap();
        assert_eq!(String::from_utf8(memory).unwrap(), file);
    }
}

#[test]
fn a_segment_that_is_shorter_than_the_recipe_says_is_refused_with_its_place() {
    for post in POSTS {
        let steps = [
            [0.003, 9.0, 2.5, 1.0, -0.2, 5.0],
            [0.001, 3.0, 2.5, 1.0, -0.2, 5.0],
        ];
        let points = path_of(&steps);
        let mut block = PathBlock::default();
        points.iter().for_each(|point| block.push(*point));
        let stretch = SectionBlock {
            section: Section::Cutting,
            opens_section: true,
            before: &[],
            points: &block,
        };
        let lines = |shortest: i64| {
            let plain = plain(post);
            let format = ProgramFormat {
                shortest,
                ..plain.format
            };
            Layout { format, ..plain }.lines(&stretch)
        };
        let step = post.steps_per_s / 1000;
        assert!(lines(step).is_ok(), "{}", post.name);
        let said = lines(2 * step).unwrap_err().to_string();
        assert!(
            said.contains("ends at 0.004000 s, C = 12.000 deg takes 1.0000 ms"),
            "{said}"
        );
    }
}
