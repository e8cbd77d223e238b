//! The programs of `automation1-pvt` as text: how they look, and what of them is refused.

use super::AUTOMATION1_PVT;
use crate::program_tests::{path_of, plain, program, read};

fn good() -> String {
    let steps: Vec<[f64; 6]> = (1..=2)
        .map(|k| [0.003, 9.0, 2.5 - 0.001 * f64::from(k), 1.0, -0.2, 5.0])
        .collect();
    program(&plain(&AUTOMATION1_PVT), &path_of(&steps))
}

#[test]
fn the_program_looks_like_this() {
    let path: Vec<String> = good().lines().map(str::to_owned).collect();
    let expected = [
        "OPEN PROG 1 CLEAR",
        "// -- cutting --",
        "SetupTaskDistanceUnits(DistanceUnits.Primary)",
        "SetupTaskTimeUnits(TimeUnits.Seconds)",
        "SetupTaskTargetMode(TargetMode.Absolute)",
        "MovePvt([C, X, Z], [0, 2.5, 0], [2864.7889757, 0, -0.3333333], 1)",
        "MovePvt([C, X, Z], [9, 2.499, 1], [3000, -0.2, 5], 0.003)",
        "MovePvt([C, X, Z], [18, 2.498, 1], [3000, -0.2, 5], 0.003)",
        "// -- end of path: 3 points --",
        "CLOSE",
    ];
    assert_eq!(path, expected);
}

fn refusal(line: usize, new: &str) -> String {
    let text = good();
    let mut lines: Vec<&str> = text.lines().collect();
    lines[line - 1] = new;
    read(&plain(&AUTOMATION1_PVT), lines.join("\n").as_bytes()).unwrap_err()
}

#[test]
fn damaged_lines_are_refused_with_their_number() {
    for (line, new, says) in [
        (3, "", "line 6: a move before `SetupTaskDistanceUnits"),
        (
            3,
            "SetupTaskDistanceUnits(DistanceUnits.Secondary)",
            "line 3: `SetupTaskDistance",
        ),
        (4, "", "line 6: a move before `SetupTaskTimeUnits"),
        (5, "", "line 6: a move before `SetupTaskTargetMode"),
        (
            5,
            "SetupTaskTargetMode(TargetMode.Incremental)",
            "line 6: the first point must be a position",
        ),
        (
            4,
            "SetupTaskTimeUnits(TimeUnits.Minutes)",
            "line 4: `SetupTask",
        ),
        (
            6,
            "MovePvt([C, X], [0, 1], [0, 1], 1)",
            "line 6: the first point does not give Z",
        ),
        (
            7,
            "MovePvt([C, X, Z], [9, 2, 1], [1, 2], 0.1)",
            "line 7: `MovePvt` needs",
        ),
        (
            7,
            "MovePvt([C, C], [9, 2], [1, 2], 0.1)",
            "line 7: C appears twice",
        ),
        (
            7,
            "MovePvt([C, Y], [9, 2], [1, 2], 0.1)",
            "line 7: `Y` is not an axis",
        ),
        (
            7,
            "MovePvt([C], [1e3], [1], 0.1)",
            "line 7: the position of C has no number",
        ),
        (
            7,
            "MovePvt([C], [9], [], 0.1)",
            "line 7: the velocity of C has no number",
        ),
        (
            7,
            "MovePvt([C], [9], [1] 0.1)",
            "line 7: a comma is missing",
        ),
        (
            7,
            "MovePvt([C], [9], [1], 0)",
            "line 7: a segment cannot take 0 s",
        ),
        (
            7,
            "MovePvt([C], [9], [1], -1)",
            "line 7: a segment cannot take -1 s",
        ),
        (7, "MoveLinear([C], [9])", "line 7: `MoveLinear"),
        (7, "MovePvt(C, 9, 1, 0.1)", "line 7: `MovePvt` takes axes"),
    ] {
        let message = refusal(line, new);
        assert!(message.contains(says), "{new}: {message}");
    }
}

#[test]
fn an_axis_that_a_call_does_not_name_stays_and_others_may_come_in_any_order() {
    let layout = plain(&AUTOMATION1_PVT);
    let edited = good().replace(
        "MovePvt([C, X, Z], [18, 2.498, 1], [3000, -0.2, 5], 0.003)",
        "  MovePvt( [X,C], [2.498,18.0], [-.2,3000] , 0.003 ) // by hand",
    );
    let (good, edited) = (
        read(&layout, good().as_bytes()).unwrap(),
        read(&layout, edited.as_bytes()).unwrap(),
    );
    assert_eq!((good[2].x, good[2].c), (edited[2].x, edited[2].c));
    assert_eq!((edited[2].z, edited[2].vz), (1.0, 0.0));
}

#[test]
fn a_recipes_calls_that_may_move_something_are_told() {
    let commands = AUTOMATION1_PVT
        .dialect
        .commands("// {name}\nprogram\nHome([X])\nend\n");
    let told: Vec<(usize, bool)> = commands
        .iter()
        .map(|one| (one.line, one.harmless))
        .collect();
    assert_eq!(told, [(2, true), (3, false), (4, true)]);
}
