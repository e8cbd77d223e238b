//! A loop over depths: the program reads as its path, and no other loop is taken for it.

use super::travel::with_leads;
use super::*;
use crate::{Depths, POSTS, ProgramFormat};

/// The posts that have such a loop.
fn with_loops() -> impl Iterator<Item = Layout> {
    let posts = POSTS
        .iter()
        .filter(|post| post.dialect.depth_loop().is_some());
    posts.map(plain)
}

fn deep(layout: &Layout, count: i64, step: i64) -> Layout {
    let depths = Some(Depths { count, step });
    let format = ProgramFormat {
        depths,
        ..layout.format
    };
    Layout { format, ..*layout }
}

fn text(layout: &Layout) -> String {
    let points = with_leads();
    assembled(layout, &lines_in_sections(layout, &points, &[], 2..4))
}

#[test]
fn a_loop_stands_around_approach_path_and_retreat() {
    let nanotech = plain(crate::post_named("nanotech-g93").unwrap());
    let text = text(&deep(&nanotech, 3, 2000));
    let lines: Vec<&str> = text.lines().collect();
    let begin = [
        "OPEN PROG 1 CLEAR",
        "; -- depths --",
        "; 3 depths of 0.002 mm; the first is 0.004 mm above the path, the last is the path",
        "#100 = 3",
        "#103 = 0.002",
        "#5 = 0",
        "#8 = 0.006",
        "WHILE[#5 LT #100] DO 2",
        "#8 = #8 - #103",
        "G52 X0 Y0 Z[#8]",
        "; -- approach --",
        "G90 G94",
        // 5 mm above the first depth, which is 0.004 mm above the path.
        "G0 Z6.504",
        "G0 X2.46",
        "G0 C0",
        "G1 Z1.5 F60",
        "; -- lead-in --",
    ];
    assert_eq!(lines[..begin.len()], begin);
    let end = [
        "; -- retreat --",
        "G90 G94",
        "G0 Z6.504",
        "; -- end of depths --",
        "#5 = #5 + 1",
        "END 2",
    ];
    assert_eq!(lines[lines.len() - end.len() - 2..lines.len() - 2], end);
}

#[test]
fn a_program_with_a_loop_reads_as_its_path() {
    for layout in with_loops() {
        let once = read_sections(&layout, text(&layout).as_bytes());
        for (count, step) in [(2, 1), (3, 2000), (1000, 7)] {
            let deep = deep(&layout, count, step);
            assert_eq!(read_sections(&deep, text(&deep).as_bytes()), once);
        }
    }
}

#[test]
fn a_loop_that_the_recipe_does_not_say_is_refused() {
    for layout in with_loops() {
        let (two, three) = (deep(&layout, 2, 2000), deep(&layout, 3, 2000));
        let finer = deep(&layout, 3, 2001);
        for (writer, reader) in [
            (layout, three),
            (three, layout),
            (three, two),
            (two, three),
            (three, finer),
        ] {
            let said = read(&reader, text(&writer).as_bytes()).unwrap_err();
            assert!(said.contains("by the recipe it is played"), "{said}");
        }
    }
}

/// The other posts know no such loop.
#[test]
fn a_loop_of_another_controller_is_refused() {
    for post in POSTS
        .iter()
        .filter(|post| post.dialect.depth_loop().is_none())
    {
        let layout = plain(post);
        let text = text(&layout);
        let mark = format!("{} -- approach --", post.comment);
        let other = text.replace(&mark, &format!("{} -- depths --\n{mark}", post.comment));
        let said = read(&layout, other.as_bytes()).unwrap_err();
        assert!(said.contains("line 2: turnpath knows no loop"), "{said}");
    }
}

#[test]
fn damaged_loops_are_refused_with_their_line() {
    let nanotech = plain(crate::post_named("nanotech-g93").unwrap());
    let deep = deep(&nanotech, 3, 2000);
    let good = text(&deep);
    let at = |line: &str| good.lines().position(|found| found == line).unwrap() + 1;
    let end_mark = good
        .lines()
        .position(|line| line.contains("end of path"))
        .unwrap()
        + 1;
    for (old, new, line, says) in [
        (
            "#103 = 0.002",
            "#103 = 0,002",
            at("#103 = 0.002"),
            "has no number",
        ),
        (
            "WHILE[#5 LT #100] DO 2",
            "WHILE[#5 LE #100] DO 2",
            at("WHILE[#5 LT #100] DO 2"),
            "is not a line",
        ),
        (
            "G52 X0 Y0 Z[#8]",
            "G52 X0 Y0 Z[#8] G0 Z-5",
            at("G52 X0 Y0 Z[#8]"),
            "is not a line",
        ),
        (
            "G52 X0 Y0 Z[#8]",
            "G0 Z-5",
            at("G52 X0 Y0 Z[#8]"),
            "is not a line",
        ),
        ("END 2", "END 1", at("END 2"), "does not end the loop"),
        (
            "#103 = 0.002",
            "#103 = 0.003",
            end_mark,
            "Z's zero is shifted behind the loop",
        ),
        (
            "#100 = 3",
            "#100 = 4",
            end_mark,
            "Z's zero is shifted behind the loop",
        ),
        ("#8 = 0.006\n", "\n", end_mark, "#8 has no value"),
        ("END 2\n", "\n", end_mark, "has no `WHILE`, or no `END`"),
        (
            "; -- end of depths --\n",
            "\n",
            at("#5 = #5 + 1"),
            "is not a word",
        ),
        (
            "; -- depths --\n",
            "\n",
            at("; -- end of depths --"),
            "that has not begun",
        ),
        (
            "G0 X2.46",
            "; -- end of depths --\nG0 X2.46",
            at("G0 X2.46"),
            "is out of order",
        ),
        // 5 mm above the path is not 5 mm above the first depth.
        (
            "G0 Z6.504\nG0 X2.46",
            "G0 Z6.403\nG0 X2.46",
            at("G0 X2.46"),
            "the plane is at Z = 6.5040 mm",
        ),
        (
            "G0 Z6.504\n; -- end of depths",
            "G0 Z6.403\n; -- end of depths",
            at("; -- end of depths --") - 1,
            "a rapid move goes to Z = 6.403 mm",
        ),
    ] {
        assert!(good.contains(old), "{old}");
        let said = read(&deep, good.replacen(old, new, 1).as_bytes()).unwrap_err();
        let line = format!("line {line}: ");
        assert!(
            said.contains(&line) && said.contains(says),
            "{new}: {line}{said}"
        );
    }
}

#[test]
fn a_dry_run_stays_above_the_first_depth() {
    for layout in with_loops() {
        let deep = deep(&layout, 3, 2_000_000);
        let points = with_leads();
        let extent = lines_in_sections(&deep, &points, &[], 2..4).extent.unwrap();
        let text = deep.dry_run(&extent, 2.5, (&[], &[]), ("", "")).unwrap();
        let text = String::from_utf8(text).unwrap();
        // 5 mm above the first depth, which is 4 mm above the path.
        assert!(
            text.contains("G0 Z10.5\n") && !text.contains("WHILE"),
            "{text}"
        );
    }
}
