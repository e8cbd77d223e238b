//! The moves before and after a path: written for every post, and refused where they could collide.

use turnpath_core::toolpath::Section;

use super::*;
use crate::{POSTS, ProgramFormat};

/// A path from rest to rest 1.5 mm above the cut, whose middle is the cut.
pub(super) fn with_leads() -> Vec<ControlPoint> {
    let at = |k: u32, z: f64, vz: f64| ControlPoint {
        t: 0.5 * f64::from(k),
        c: f64::from(k) * 90.0 * DEG,
        x: 2.5 - 0.01 * f64::from(k),
        z,
        vz,
        ..ControlPoint::default()
    };
    vec![
        at(4, 1.5, 0.0),
        at(5, 1.0, -1.0),
        at(6, 0.25, 0.0),
        at(7, 0.0, 0.0),
        at(8, 1.5, 0.0),
    ]
}

fn text(layout: &Layout) -> String {
    let points = with_leads();
    assembled(layout, &lines_in_sections(layout, &points, &[], 2..4))
}

fn good(post: &str) -> String {
    text(&plain(crate::post_named(post).unwrap()))
}

/// The lines between two others.
fn between<'a>(text: &'a str, begin: &str, end: &str) -> Vec<&'a str> {
    let lines = text.lines().skip_while(|line| *line != begin).skip(1);
    lines.take_while(|line| !line.starts_with(end)).collect()
}

#[test]
fn z_goes_up_before_x_and_c_move_and_down_at_a_feed_of_its_own() {
    let pmac = good("pmac-pvt");
    assert_eq!(
        between(&pmac, "; -- approach --", "; -- lead-in"),
        [
            "ABS",
            "RAPID",
            "Z6.5",
            "X2.46",
            "C360",
            "LINEAR TM5000",
            "Z1.5",
            "DWELL0"
        ]
    );
    assert_eq!(
        between(&pmac, "; -- retreat --", "; -- end"),
        ["ABS", "RAPID", "Z6.5"]
    );
    let siemens = good("siemens-840d-poly");
    assert_eq!(
        between(&siemens, "; -- approach --", "; -- lead-in"),
        [
            "G90 G94 G710 G60 FGROUP()",
            "G0 Z6.5",
            "G0 X2.46",
            "G0 C360",
            "G1 Z1.5 F60"
        ]
    );
    let nanotech = good("nanotech-g93");
    assert_eq!(
        between(&nanotech, "; -- approach --", "; -- lead-in"),
        ["G90 G94", "G0 Z6.5", "G0 X2.46", "G0 C0", "G1 Z1.5 F60"]
    );
    assert_eq!(
        between(&nanotech, "; -- lead-in --", "; -- cutting")[..2],
        ["G90 G93", "G1 C0 X2.46 Z1.5 F60"]
    );
    let beckhoff = good("beckhoff-g93");
    assert_eq!(
        between(&beckhoff, "; -- approach --", "; -- lead-in"),
        [
            "G90 G94 G40 G52 G71 G360",
            "G0 Z6.5",
            "G0 X2.46",
            "G0 C360",
            "G1 Z1.5 F60"
        ]
    );
    assert_eq!(
        between(&beckhoff, "; -- lead-in --", "; -- cutting")[..2],
        ["G40 G52 G71 G90 G93 G359", "G1 C360 X2.46 Z1.5 F1"]
    );
    let linuxcnc = good("linuxcnc-g93");
    assert_eq!(
        between(&linuxcnc, "; -- approach --", "; -- lead-in"),
        [
            "G90 G94 G8 G21 G40 G61",
            "G0 Z6.5",
            "G0 X2.46",
            "G0 C360",
            "G1 Z1.5 F60"
        ]
    );
    assert_eq!(
        between(&linuxcnc, "; -- lead-in --", "; -- cutting")[..2],
        ["G8 G21 G40 G64 G90 G93", "G1 C360 X2.46 Z1.5 F60"]
    );
    assert_eq!(
        between(&linuxcnc, "; -- retreat --", "; -- end"),
        ["G90 G94 G8 G21 G40 G61", "G0 Z6.5"]
    );
    let aerotech = good("automation1-pvt");
    assert_eq!(
        between(&aerotech, "// -- approach --", "// -- lead-in"),
        [
            "SetupTaskDistanceUnits(DistanceUnits.Primary)",
            "SetupTaskTimeUnits(TimeUnits.Seconds)",
            "SetupTaskTargetMode(TargetMode.Absolute)",
            "SetupTaskWaitMode(WaitMode.MotionDone)",
            "MoveRapid([Z], [6.5])",
            "MoveRapid([X], [2.46])",
            "MoveRapid([C], [360])",
            "MoveLinear([Z], [1.5], 1)",
        ]
    );
}

#[test]
fn a_path_with_leads_has_an_approach_and_a_retreat_in_every_layout_and_comes_back() {
    for post in POSTS {
        for flags in 0..8 {
            let plain = plain(post);
            let has = |key: &str| post.keys.iter().any(|info| info.name == key);
            let format = ProgramFormat {
                c_reversed: flags & 1 > 0 && has("c_sign"),
                c_wrapped: flags & 2 > 0 && has("c_wrap"),
                incremental: flags & 4 > 0 && has("positioning"),
                z_above: 0.75,
                approach_height: 12.3456,
                ..plain.format
            };
            let layout = Layout { format, ..plain };
            let text = text(&layout);
            assert!(text.contains("-- approach --") && text.contains("-- retreat --"));
            assert!(
                text.contains("Z13.0956") || text.contains("[13.0956]"),
                "{text}"
            );
            let read = read(&layout, text.as_bytes()).unwrap();
            assert_eq!(read.len(), with_leads().len());
        }
    }
}

#[test]
fn a_path_in_motion_has_neither() {
    for post in POSTS {
        let text = program(&plain(post), &with_leads());
        assert!(
            !text.contains("approach") && !text.contains("retreat"),
            "{text}"
        );
    }
}

#[test]
fn moves_that_could_collide_are_refused_with_their_line() {
    let pmac = || good("pmac-pvt");
    let siemens = || good("siemens-840d-poly");
    let linuxcnc = || good("linuxcnc-g93");
    let aerotech = || good("automation1-pvt");
    for (text, from, to, says) in [
        (
            pmac(),
            "Z6.5\nX2.46\n",
            "Z6.5\nZ2\nX2.46\nZ6.5\n",
            "line 7: C or X moves at Z = 2 mm; by `approach_height` of the recipe the plane is at Z = 6.5000 mm",
        ),
        (
            pmac(),
            "RAPID\nZ6.5\nX2.46\n",
            "RAPID\nZ1.4\nX2.46\n",
            "line 9: Z goes by a feed: only Z does, on its way down",
        ),
        (
            pmac(),
            "Z6.5\nX2.46\n",
            "X2.46\nZ6.5\n",
            "line 5: X moves before Z has gone up",
        ),
        (
            pmac(),
            "Z6.5\nX2.46\n",
            "Z6.5 X2.46\n",
            "line 5: more than one axis moves",
        ),
        (
            pmac(),
            "C360\nLINEAR",
            "C36\nLINEAR",
            "the approach does not end at the path's first C",
        ),
        (
            pmac(),
            "TM5000\nZ1.5\n",
            "TM4900\nZ1.6\n",
            "does not end at the path's first Z",
        ),
        (
            pmac(),
            "ABS\nRAPID\nZ6.5\nX",
            "RAPID\nZ6.5\nX",
            "line 4: a move before `ABS`",
        ),
        (
            pmac(),
            "RAPID\nZ6.5\n; -- end",
            "RAPID\nZ1.2\n; -- end",
            "line 25: a rapid move goes to Z = 1.2 mm; by `approach_height`",
        ),
        (
            pmac(),
            "RAPID\nZ6.5\n; -- end",
            "RAPID\nX3\n; -- end",
            "X moves before Z has gone up",
        ),
        (
            pmac(),
            "X2.46\n",
            "X2.46 HOME1\n",
            "`HOME1` is not a word of an approach",
        ),
        (
            siemens(),
            "G0 Z6.5\nG0 X2.46",
            "G0 Z6.5\nG0 Z2\nG0 X2.46\nZ6.5",
            "line 6: C or X moves at Z = 2 mm",
        ),
        (
            siemens(),
            "G0 C360",
            "G0 C361",
            "does not end at the path's first C",
        ),
        (siemens(), "G90 G94", "G94", "a move before `G90`"),
        (
            siemens(),
            "G0 C360",
            "G0 C360 M3",
            "`M3` is not a word of an approach",
        ),
        (
            linuxcnc(),
            "G94 G8 G21 ",
            "G94 G8 ",
            "line 4: a move before `G21`",
        ),
        (
            linuxcnc(),
            "G0 Z6.5\nG0 X2.46",
            "G0 Z6.5\nG0 Z2\nG0 X2.46\nZ6.5",
            "line 6: C or X moves at Z = 2 mm",
        ),
        (
            linuxcnc(),
            "G8 G21 G40 G64 G90 G93",
            "G8 G21 G40 G64 G90",
            "a move before `G93`",
        ),
        (
            aerotech(),
            "MoveRapid([C]",
            "MoveRapid([Z], [2])\nMoveRapid([C]",
            "moves at Z = 2 mm",
        ),
        (
            aerotech(),
            "MoveRapid([X]",
            "MoveAbsolute([X]",
            "is not a call of an approach",
        ),
        (
            aerotech(),
            "MoveRapid([X]",
            "MoveRapid([X, Z]",
            "`X, Z` is not one axis",
        ),
        (
            aerotech(),
            "MoveRapid([Z], [6.5])",
            "MoveRapid([Z], -[-6.5])",
            "is not a call of an approach",
        ),
        (
            aerotech(),
            "MoveRapid([Z], [6.5])",
            "MoveRapid([Z] [6.5])",
            "is not a call of an approach",
        ),
    ] {
        assert!(text.contains(from), "{from}: {text}");
        let spoiled = text.replacen(from, to, 1);
        let name = ["; ", "// "].map(|comment| text.contains(&format!("{comment}-- approach")));
        let post = POSTS.iter().find(|post| match (name, post.name) {
            ([_, true], name) => name == "automation1-pvt",
            _ if text.contains("RAPID") => post.name == "pmac-pvt",
            _ if text.contains("G61") => post.name == "linuxcnc-g93",
            (_, name) => name == "siemens-840d-poly",
        });
        let said = read(&plain(post.unwrap()), spoiled.as_bytes()).unwrap_err();
        assert!(said.contains(says), "{to}: {said}");
    }
}

/// The numbers of the lines of the approach and of the retreat.
fn lines_around(text: &str) -> Vec<usize> {
    let mut inside = false;
    let lines = text.lines().enumerate().filter(|(_, line)| {
        if line.contains("-- ") {
            inside = line.contains("-- approach") || line.contains("-- retreat");
            return false;
        }
        inside
    });
    lines.map(|(number, _)| number).collect()
}

#[test]
fn no_word_of_an_approach_or_a_retreat_may_be_missing() {
    for post in POSTS {
        let layout = plain(post);
        let text = text(&layout);
        let lines: Vec<&str> = text.lines().collect();
        let around = lines_around(&text);
        assert!(around.len() >= 7, "{text}");
        for number in around {
            let words: Vec<&str> = lines[number].split_whitespace().collect();
            // A motion goes on until another one is said.
            let goes_on = lines[number - 1].starts_with("G0 ");
            for missing in usize::from(goes_on && words[0] == "G0")..words.len() {
                let mut kept = words.clone();
                kept.remove(missing);
                let line = kept.join(" ");
                let mut spoiled = lines.clone();
                spoiled[number] = &line;
                let said = read(&layout, spoiled.join("\n").as_bytes());
                let (name, was) = (post.name, lines[number]);
                assert!(said.is_err(), "{name}: `{line}` for `{was}` is read");
            }
        }
    }
}

#[test]
fn a_move_at_another_speed_than_the_recipes_is_refused() {
    let g_code = [
        ("G1 Z1.5 F60", "G0 Z1.5", "a rapid move goes to Z = 1.5 mm"),
        (
            "G1 Z1.5 F60",
            "G0 Z1.5 F60",
            "a rapid move goes to Z = 1.5 mm",
        ),
        ("G1 Z1.5 F60", "G1 Z1.5 F600000", "at 600000 mm/min"),
        (
            "G1 Z1.5 F60",
            "G1 Z1.5 F59.9",
            "`approach_feed` of the recipe is 60",
        ),
        ("G1 Z1.5 F60", "G1 Z1.5 F0", "F is no positive number"),
        (
            "G1 Z1.5 F60",
            "G1 G0 Z1.5 F60",
            "`G0` is the second word of its group",
        ),
        ("G0 X2.46", "G1 X2.46 F60", "X goes by a feed"),
    ];
    let pmac = [
        ("TM5000", "TM5", "at 5 mm in 5 ms"),
        ("TM5000", "TM4999", "at 5 mm in 4999 ms"),
        ("TM5000", "TM5002", "at 5 mm in 5002 ms"),
        (
            "LINEAR TM5000",
            "RAPID TM5000",
            "a rapid move goes to Z = 1.5 mm",
        ),
        ("DWELL0\n", "", "does not come to rest"),
        ("RAPID\nZ6.5", "LINEAR TM5\nZ6.5", "Z goes by a feed"),
    ];
    let aerotech = [
        ("[1.5], 1)", "[1.5])", "`MoveLinear` has no speed"),
        ("[1.5], 1)", "[1.5], 10)", "at 600 mm/min"),
        (
            "MoveLinear([Z], [1.5], 1)",
            "MoveRapid([Z], [1.5])",
            "a rapid move goes to",
        ),
        (
            "MoveRapid([X], [2.46])",
            "MoveRapid([X], [2.46], 1)",
            "`MoveRapid` has a speed",
        ),
        (
            "MoveRapid([X], [2.46])",
            "MoveLinear([X], [2.46], 1)",
            "X goes by a feed",
        ),
    ];
    for post in POSTS {
        let cases: &[(&str, &str, &str)] = match post.name {
            "automation1-pvt" => &aerotech,
            "pmac-pvt" | "power-pmac-pvt" => &pmac,
            _ => &g_code,
        };
        let (layout, text) = (plain(post), good(post.name));
        for (from, to, says) in cases {
            let at = text.find(from).unwrap_or_else(|| panic!("{from}: {text}"));
            let line = text[..at].matches('\n').count() + 1;
            let spoiled = text.replacen(from, to, 1);
            let said = read(&layout, spoiled.as_bytes()).unwrap_err();
            assert!(said.contains(says), "{}: {to}: {said}", post.name);
            // What comes to rest too late shows at the first point.
            let near = (line..line + 4).any(|line| said.contains(&format!("line {line}: ")));
            assert!(near, "{}: {to}: {said}", post.name);
        }
    }
}

/// A plane that clears the path, but not by the recipe's height.
#[test]
fn a_plane_below_the_recipes_height_is_refused() {
    for post in POSTS {
        let (layout, text) = (plain(post), good(post.name));
        for (from, to) in [("Z6.5", "Z6.4"), ("[6.5]", "[6.4]")] {
            if !text.contains(from) {
                continue;
            }
            let lower = text.replace(from, to).replace("TM5000", "TM4900");
            let said = read(&layout, lower.as_bytes()).unwrap_err();
            assert!(
                said.contains(
                    "6.4 mm; by `approach_height` of the recipe the plane is at Z = 6.5000 mm"
                ),
                "{}: {said}",
                post.name
            );
        }
        let higher = text.replace("Z6.5", "Z7").replace("[6.5]", "[7]");
        let higher = higher.replace("TM5000", "TM5500");
        assert!(read(&layout, higher.as_bytes()).is_ok(), "{}", post.name);
    }
}

/// Lines that bring Z down to `z` by the feed of the recipe, and others that bring it up again.
fn down_and_up(post: &str, z: f64) -> String {
    let way = 6.5 - z;
    match post {
        "automation1-pvt" => format!("MoveLinear([Z], [{z}], 1)\nMoveRapid([Z], [6.5])\n"),
        "pmac-pvt" | "power-pmac-pvt" => {
            let ms = (1000.0 * way).ceil();
            format!("LINEAR TM{ms}\nZ{z}\nRAPID\nZ6.5\n")
        }
        _ => format!("G1 Z{z} F60\nG0 Z6.5\n"),
    }
}

/// The mark of a path is the place above the part at which it begins: no move of an approach goes lower, at
/// whatever speed, and on whatever way it comes back.
#[test]
fn an_approach_that_goes_through_the_part_is_refused_with_its_line() {
    for post in POSTS {
        let (layout, text) = (plain(post), good(post.name));
        let behind_up = ["G0 Z6.5\n", "RAPID\nZ6.5\n", "MoveRapid([Z], [6.5])\n"];
        let up = behind_up.into_iter().find(|up| text.contains(up)).unwrap();
        let behind = text.find(up).unwrap() + up.len();
        let (head, rest) = text.split_at(behind);
        for (z, is_refused) in [(-1000.0, true), (1.499, true), (1.5, false), (3.0, false)] {
            let plunge = format!("{head}{}{rest}", down_and_up(post.name, z));
            let read = read(&layout, plunge.as_bytes());
            assert_eq!(read.is_err(), is_refused, "{}: {z}: {read:?}", post.name);
            let Err(said) = read else {
                continue;
            };
            let down = format!("Z goes down to Z = {z} mm; the path begins at 1.5000 mm");
            assert!(said.contains(&down), "{}: {said}", post.name);
            let number = 1 + head.lines().count() + usize::from(post.name.contains("pmac"));
            let line = format!("line {number}: ");
            assert!(said.contains(&line), "{}: {line}{said}", post.name);
        }
    }
}

/// Z may go down in steps.
#[test]
fn an_approach_of_several_steps_is_read() {
    for post in POSTS {
        let (layout, text) = (plain(post), good(post.name));
        let last = [
            "G1 Z1.5 F60",
            "LINEAR TM5000\nZ1.5",
            "MoveLinear([Z], [1.5], 1)",
        ];
        let last = last.into_iter().find(|last| text.contains(last)).unwrap();
        let first = match post.name {
            "automation1-pvt" => "MoveLinear([Z], [4.5], 1)\nMoveLinear([Z], [1.5], 1)",
            "pmac-pvt" | "power-pmac-pvt" => "LINEAR TM2000\nZ4.5\nTM3000\nZ1.5",
            _ => "G1 Z4.5 F60\nZ1.5",
        };
        let steps = text.replacen(last, first, 1);
        let read = read(&layout, steps.as_bytes());
        assert!(read.is_ok(), "{}: {read:?}", post.name);
    }
}

/// A path with an approach begins where it ends. Without its moves the first line would bring all axes there at
/// once, from wherever they are.
#[test]
fn the_mark_of_an_approach_without_moves_is_refused() {
    for post in POSTS {
        let (layout, text) = (plain(post), good(post.name));
        let around = lines_around(&text);
        let of_approach = text.lines().position(|line| line.contains("-- lead-in"));
        let is_move = |number: usize| around.contains(&number) && Some(number) < of_approach;
        let kept = text
            .lines()
            .enumerate()
            .filter(|(number, _)| !is_move(*number));
        let bare: Vec<&str> = kept.map(|(_, line)| line).collect();
        let said = read(&layout, bare.join("\n").as_bytes()).unwrap_err();
        let says = "the approach does not end at the path's first C";
        assert!(said.contains(says), "{}: {said}", post.name);
    }
}

#[test]
fn an_approach_without_a_retreat_is_refused() {
    let text = good("pmac-pvt");
    let (path, rest) = text.split_once("; -- retreat").unwrap();
    let (_, end) = rest.split_once("; -- end").unwrap();
    let said = read(&plain(&POSTS[0]), format!("{path}; -- end{end}").as_bytes()).unwrap_err();
    assert!(said.contains("an approach and no retreat"), "{said}");
}

#[test]
fn a_retreat_without_an_approach_is_refused_where_the_path_has_a_lead_in() {
    let text = good("pmac-pvt");
    let (head, rest) = text.split_once("; -- approach --").unwrap();
    let (_, path) = rest.split_once("; -- lead-in").unwrap();
    let bare = format!("{head}; -- lead-in{path}");
    let said = read(&plain(&POSTS[0]), bare.as_bytes()).unwrap_err();
    assert!(said.contains("a retreat and no approach"), "{said}");
}

#[test]
fn marks_out_of_order_are_refused() {
    let text = good("pmac-pvt");
    let swapped = text.replace("-- retreat --", "-- approach --");
    let said = read(&plain(&POSTS[0]), swapped.as_bytes()).unwrap_err();
    assert!(said.contains("out of order"), "{said}");
    let early = text.replacen("; -- cutting --", "; -- retreat --\n; -- cutting --", 1);
    assert!(read(&plain(&POSTS[0]), early.as_bytes()).is_err());
}

/// A program of a version without an approach, or one by hand, is read as before.
#[test]
fn a_program_without_an_approach_is_read() {
    let text = good("pmac-pvt");
    let (head, rest) = text.split_once("; -- approach --").unwrap();
    let (_, path) = rest.split_once("; -- lead-in").unwrap();
    let (path, rest) = path.split_once("; -- retreat").unwrap();
    let (_, end) = rest.split_once("; -- end").unwrap();
    let bare = format!("{head}; -- lead-in{path}; -- end{end}");
    let layout = plain(&POSTS[0]);
    assert_eq!(
        read(&layout, bare.as_bytes()).unwrap(),
        read(&layout, text.as_bytes()).unwrap()
    );
}

#[test]
fn the_sections_of_a_path_stay_as_they_are() {
    let layout = plain(&POSTS[0]);
    let (_, sections) = read_sections(&layout, text(&layout).as_bytes()).unwrap();
    use Section::{Cutting, LeadIn, LeadOut};
    assert_eq!(sections, [LeadIn, LeadIn, Cutting, Cutting, LeadOut]);
}
