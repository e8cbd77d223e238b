//! Programs of several files: the parts play what one file plays, and a part that is missing, damaged
//! or out of order is refused with its place.

use super::travel::with_leads;
use super::*;
use crate::{Amount, POSTS, PartLimits, PartsError, TextSize};

type Files = Vec<(String, Vec<u8>)>;

const FRAME: [&str; 2] = ["OPEN PROG 1 CLEAR\n", "CLOSE\n"];
/// The main program's file name.
fn main_of(layout: &Layout) -> String {
    format!("My Part.{}", layout.post.extension)
}

pub(super) fn limits(part: Amount, memory: Option<Amount>) -> PartLimits {
    PartLimits { part, memory }
}

/// A path with leads around a cut of some segments, in many blocks.
fn lines_of(layout: &Layout) -> Lines {
    let ends = with_leads();
    let (first, last) = (ends[0], ends[4]);
    let mut points = vec![first];
    for k in 1..60 {
        let part = f64::from(k) / 60.0;
        points.push(ControlPoint {
            t: first.t + part * (last.t - first.t),
            c: first.c + part * (last.c - first.c),
            x: first.x + part * (last.x - first.x),
            z: 0.01 * f64::from(k % 7),
            vz: 0.1 * f64::from(k % 5),
            vc: 3.0,
            ..ControlPoint::default()
        });
    }
    points.push(last);
    lines_in_sections(layout, &points, &[15, 16, 40], 5..55)
}

fn files(layout: &Layout, most: Amount) -> Result<Files, PartsError> {
    let mut writer = ProgramWriter::in_memory(*layout);
    writer.append(&lines_of(layout)).unwrap();
    writer
        .close()
        .assemble_parts(FRAME, (&main_of(layout), limits(most, None)))
}

fn whole(layout: &Layout) -> Vec<u8> {
    assembled(layout, &lines_of(layout)).into_bytes()
}

fn read_all(layout: &Layout, files: Files) -> Result<Vec<(ControlPoint, Section)>, String> {
    let mut reader = layout.read_files(files).unwrap();
    let mut points = Vec::new();
    while let Some(point) = reader.next_point().map_err(|error| error.to_string())? {
        points.push(point);
    }
    Ok(points)
}

/// The posts that may have parts.
fn layouts() -> Vec<Layout> {
    let has = |post: &&Post| post.keys.iter().any(|info| info.name == "split");
    POSTS.iter().filter(has).map(plain).collect()
}

/// The file of a part. Sinumerik takes no `-` in a name.
fn part_of(layout: &Layout, number: u32) -> String {
    let stem = match layout.post.name {
        "siemens-840d-poly" => format!("my_part_part_{number}"),
        _ => format!("my_part-part-{number}"),
    };
    format!("{stem}.{}", layout.post.extension)
}

/// The lines between the marks of a part.
fn body(text: &[u8]) -> String {
    let text = String::from_utf8(text.to_vec()).unwrap();
    let is_mark = |line: &&str| line.contains("-- part") || line.contains("-- end of part");
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let begin = lines.iter().position(&is_mark).unwrap();
    let end = lines.iter().rposition(is_mark).unwrap();
    lines[begin + 1..end].concat()
}

#[test]
fn parts_of_any_size_play_what_one_file_plays_and_have_its_lines() {
    assert!(layouts().len() >= POSTS.len() - 1);
    for layout in layouts() {
        let one = whole(&layout);
        let expected = read_all(&layout, vec![(main_of(&layout), one.clone())]).unwrap();
        assert!(expected.len() > 60);
        for most in ["12 blocks", "30 blocks", "700 B", "1.5 kB", "1 MB"] {
            let most: Amount = most.parse().unwrap();
            let files = files(&layout, most).unwrap();
            let name = layout.post.name;
            assert_eq!(
                read_all(&layout, files.clone()).unwrap(),
                expected,
                "{name} {most}"
            );
            let parts = &files[1..];
            assert_eq!(
                parts.len() > 1,
                most != Amount::Bytes(1_000_000),
                "{name} {most}"
            );
            for (k, (file, text)) in parts.iter().enumerate() {
                assert_eq!(file, &part_of(&layout, k as u32 + 1));
                assert!(most.holds(TextSize::of(text)), "{name} {most}");
            }
            let bodies: String = parts.iter().map(|(_, text)| body(text)).collect();
            let one = String::from_utf8(one.clone()).unwrap();
            assert!(one.contains(&bodies), "{name} {most}");
        }
    }
}

#[test]
fn a_part_that_is_missing_damaged_or_out_of_order_is_refused_with_its_place() {
    for layout in layouts() {
        let files = files(&layout, Amount::Blocks(25)).unwrap();
        assert!(files.len() > 3);
        let name = layout.post.name;
        let refused = |change: &dyn Fn(&mut Files)| {
            let mut files = files.clone();
            change(&mut files);
            read_all(&layout, files).unwrap_err()
        };
        let missing = refused(&|files| drop(files.remove(2)));
        assert!(missing.contains(&part_of(&layout, 2)), "{name}: {missing}");
        let cut = refused(&|files| {
            let text = &mut files[2].1;
            let lines = String::from_utf8(text.clone()).unwrap();
            let half: Vec<&str> = lines.split_inclusive('\n').take(20).collect();
            *text = half.concat().into_bytes();
        });
        let says = "line 20: part 2 ends without its mark";
        assert!(cut.contains(says), "{name}: {cut}");
        let swapped = refused(&|files| {
            let [one, two] = [files[1].1.clone(), files[2].1.clone()];
            (files[1].1, files[2].1) = (two, one);
        });
        assert!(
            swapped.contains("is out of order in part 1")
                || swapped.contains("outside the marks of part 1"),
            "{name}: {swapped}"
        );
        let lost = refused(&|files| {
            let main = String::from_utf8(files[0].1.clone()).unwrap();
            let kept = main.split_inclusive('\n').filter(|line| !is_call(line, 3));
            files[0].1 = kept.collect::<String>().into_bytes();
        });
        assert!(
            lost.contains("parts, and calls")
                || lost.contains("out of order")
                || lost.contains("outside the marks of part 3"),
            "{name}: {lost}"
        );
    }
}

#[test]
fn a_part_alone_is_told_as_a_part() {
    for layout in layouts() {
        let files = files(&layout, Amount::Blocks(25)).unwrap();
        for (number, part) in (1..).zip(&files[1..]) {
            let said = read_all(&layout, vec![part.clone()]).unwrap_err();
            let wanted = format!("this file is part {number} of a program: read the main program");
            // The first line of a part may need what the part before has said.
            assert!(said.contains(&wanted), "{}: {said}", layout.post.name);
        }
        // Whoever writes such a comment into a header, the number of a workpiece, say, makes no part of it.
        let comment = format!("{} -- Part 12 --\n", layout.post.comment);
        for files in [files, vec![(main_of(&layout), whole(&layout))]] {
            let mut named = files.clone();
            named[0].1.splice(0..0, comment.bytes());
            let read = read_all(&layout, named).unwrap();
            assert_eq!(read, read_all(&layout, files).unwrap());
        }
    }
}

/// A controller runs all lines of a part, those outside the marks too.
#[test]
fn code_outside_the_marks_of_a_part_is_refused_and_so_is_a_line_that_is_missing() {
    for layout in layouts() {
        let files = files(&layout, Amount::Blocks(25)).unwrap();
        let name = layout.post.name;
        let text = String::from_utf8(files[2].1.clone()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let begin = lines
            .iter()
            .position(|line| line.contains("-- part 2"))
            .unwrap();
        let end = lines
            .iter()
            .position(|line| line.contains("-- end of part 2"))
            .unwrap();
        let refused = |lines: &[&str]| {
            let mut files = files.clone();
            files[2].1 = lines.join("\n").into_bytes();
            let said = read_all(&layout, files);
            said.expect_err(&format!("{name}: {lines:#?}"))
        };
        let outside = (0..begin).chain(end + 1..lines.len());
        let is_code = |line: &&str| !line.starts_with(layout.post.comment);
        for number in outside.clone().filter(|number| is_code(&lines[*number])) {
            let mut fewer = lines.clone();
            let missing = fewer.remove(number);
            let said = refused(&fewer);
            assert!(
                said.contains("part 2 lacks its line") || said.contains("outside the marks"),
                "{name} without {missing}: {said}"
            );
        }
        let others = [
            "G0 Z-5",
            "MoveRapid([Z], [-5])",
            "Z-5",
            "M30",
            "M17",
            "M2",
            "RET",
            "CLOSE",
            "/*",
            "%",
            "OPEN PROG 101 CLEAR",
            "open prog 101",
            "o<my_part-part-1> sub",
            "N10 M17",
            "O1234",
        ];
        for other in others {
            for number in [0, begin, end + 1, lines.len()] {
                let mut more = lines.clone();
                more.insert(number, other);
                let said = refused(&more);
                let place = format!("{}, line ", part_of(&layout, 2));
                assert!(said.contains(&place), "{name}, {other} at {number}: {said}");
            }
            for number in outside.clone().filter(|number| is_code(&lines[*number])) {
                if lines[number]
                    .replace(' ', "")
                    .eq_ignore_ascii_case(&other.replace(' ', ""))
                {
                    continue;
                }
                let mut changed = lines.clone();
                changed[number] = other;
                refused(&changed);
            }
        }
    }
}

/// What counts is the file that is written, by either unit, and the main program too.
#[test]
fn a_file_that_is_larger_than_the_memory_is_refused_by_its_name() {
    for layout in layouts() {
        for part in ["25 blocks", "1.5 kB"] {
            let part: Amount = part.parse().unwrap();
            let sizes: Vec<(String, TextSize)> = files(&layout, part)
                .unwrap()
                .into_iter()
                .map(|(file, text)| (file, TextSize::of(&text)))
                .collect();
            let bytes = sizes.iter().map(|(_, size)| size.bytes).max().unwrap();
            let blocks = sizes.iter().map(|(_, size)| size.blocks).max().unwrap();
            let written = |memory: Amount| {
                let mut writer = ProgramWriter::in_memory(layout);
                writer.append(&lines_of(&layout)).unwrap();
                let limits = limits(part, Some(memory));
                let path = writer.close();
                path.assemble_parts(FRAME, (&main_of(&layout), limits))
            };
            for memory in [Amount::Bytes(bytes), Amount::Blocks(blocks)] {
                assert!(written(memory).is_ok());
            }
            for memory in [Amount::Bytes(bytes - 1), Amount::Blocks(blocks - 1)] {
                let said = written(memory).unwrap_err().to_string();
                let first = sizes.iter().skip(1).chain(&sizes[..1]);
                let large = first
                    .clone()
                    .find(|(_, size)| !memory.holds(*size))
                    .unwrap();
                assert!(said.contains(&large.0), "{}: {said}", layout.post.name);
            }
        }
    }
}

/// Whether a line calls the part of this number.
fn is_call(line: &str, number: u32) -> bool {
    let by_number = format!("call{}", 100 + number);
    let joined: String = line.to_ascii_lowercase().split_whitespace().collect();
    let names = [format!("-part-{number}"), format!("_part_{number}")];
    let is_named = names.iter().any(|name| line.contains(name));
    joined == by_number || (is_named && !line.contains("--"))
}

#[test]
fn a_line_of_a_part_is_named_by_its_own_file_and_number() {
    for layout in layouts() {
        let mut files = files(&layout, Amount::Blocks(25)).unwrap();
        let text = String::from_utf8(files[2].1.clone()).unwrap();
        let damaged: Vec<String> = text
            .lines()
            .zip(1..)
            .map(|(line, number)| {
                if number == 12 {
                    "C#".to_owned()
                } else {
                    line.to_owned()
                }
            })
            .collect();
        files[2].1 = damaged.join("\n").into_bytes();
        let said = read_all(&layout, files).unwrap_err();
        let place = format!("{}, line 12: ", part_of(&layout, 2));
        assert!(said.contains(&place), "{}: {said}", layout.post.name);
    }
}

#[test]
fn a_call_leads_to_no_other_folder_and_a_program_in_memory_has_no_parts() {
    let layout = plain(crate::post_named("beckhoff-g93").unwrap());
    let mut files = files(&layout, Amount::Blocks(25)).unwrap();
    let main = String::from_utf8(files[0].1.clone()).unwrap();
    files[0].1 = main
        .replace("L my_part-part-1", "L ../my_part-part-1")
        .into_bytes();
    let said = read_all(&layout, files).unwrap_err();
    assert!(
        said.contains("not beside its main program") || said.contains("cannot read"),
        "{said}"
    );
    let said = read(&layout, main.as_bytes()).unwrap_err();
    assert!(said.contains("cannot read"), "{said}");
}

#[test]
fn more_parts_than_controllers_can_name_are_refused() {
    let layout = plain(crate::post_named("pmac-pvt").unwrap());
    let points: Vec<[f64; 6]> = (1..=2000)
        .map(|k| [0.003, 9.0, 2.5, f64::from(k % 3), 0.0, 0.0])
        .collect();
    let mut writer = ProgramWriter::in_memory(layout);
    writer
        .append(&lines(&layout, &path_of(&points), &[]))
        .unwrap();
    let refused = writer
        .close()
        .assemble_parts(FRAME, (&main_of(&layout), limits(Amount::Bytes(1), None)));
    assert!(
        refused
            .unwrap_err()
            .to_string()
            .contains("more than 899 parts")
    );
}
