//! Rows of a file against those of another path: on a plane of slope 0.1, where every worth has a closed
//! form.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;

use crate::common::{Plane, touch_on};
use turnpath_core::toolpath::{ControlPoint, Section, SegmentShape};
use turnpath_core::{Scalar, StrategyError};
use turnpath_verify::{
    Column, ComparisonFigures, HalfDigits, MOST_KEPT, PathRow, RowComparison, RowFault,
};

const SLOPE: f64 = 0.1;
const STEP: f64 = 0.05;
/// Time of a step, s.
const TIME: f64 = 0.01;

/// A spiral over the plane, with exact velocities.
fn path(count: usize) -> Vec<PathRow> {
    let (speed, feed) = (STEP / TIME, -1e-3 / TIME);
    let row = |k: usize| {
        let (t, c) = (TIME * k as f64, STEP * k as f64);
        let x = 2.0 - 1e-3 * k as f64;
        let (sin, cos) = Scalar::sin_cos(c);
        let point = ControlPoint {
            t,
            c,
            x,
            z: 1.0 + SLOPE * x * cos,
            vc: speed,
            vx: feed,
            vz: SLOPE * (feed * cos - speed * x * sin),
        };
        PathRow {
            point,
            section: Section::Cutting,
        }
    };
    (0..count).map(row).collect()
}

fn compare(file: &[PathRow], recipe: &[PathRow]) -> (ComparisonFigures, bool) {
    compare_within(HalfDigits::default(), file, recipe)
}

fn compare_within(
    digits: HalfDigits,
    file: &[PathRow],
    recipe: &[PathRow],
) -> (ComparisonFigures, bool) {
    let touch = touch_on(Plane { slope: SLOPE }, 2.5, 0.5, true);
    let comparison = RowComparison::new(touch, SegmentShape::Cubic, digits);
    compare_by(comparison, file, recipe)
}

/// The last digit of a file of distances, mm and rad.
const DIGIT: f64 = 1e-9;

/// The rows as a file of distances has them.
fn in_digits(rows: &[PathRow]) -> Vec<PathRow> {
    let rounded = |value: f64| (value / DIGIT).round() * DIGIT;
    let row = |row: &PathRow| PathRow {
        point: ControlPoint {
            c: rounded(row.point.c),
            x: rounded(row.point.x),
            z: rounded(row.point.z),
            ..row.point
        },
        ..*row
    };
    rows.iter().map(row).collect()
}

/// The comparison with a file of distances.
fn compare_distances(file: &[PathRow], recipe: &[PathRow]) -> (ComparisonFigures, bool) {
    let digits = HalfDigits {
        time: 1e-12,
        position: 0.5 * DIGIT,
        angle: 0.5 * DIGIT,
        ..HalfDigits::default()
    };
    let file = in_digits(file);
    let touch = touch_on(Plane { slope: SLOPE }, 2.5, 0.5, true);
    let comparison = RowComparison::new(touch, SegmentShape::Cubic, digits).of_distances();
    compare_by(comparison, &file, recipe)
}

/// The path of a file of distances whose distance to one row is changed so.
fn with_distance(row: usize, change: impl Fn(&mut ControlPoint)) -> Vec<PathRow> {
    let mut file = path(500);
    file[row..]
        .iter_mut()
        .for_each(|row| change(&mut row.point));
    file
}

fn compare_by(
    mut comparison: RowComparison,
    file: &[PathRow],
    recipe: &[PathRow],
) -> (ComparisonFigures, bool) {
    let mut rows = file.iter().copied();
    let mut next = || Ok::<_, StrategyError>(rows.next());
    for row in recipe {
        comparison.push(*row, &mut next).unwrap();
    }
    comparison.finish(&mut next).unwrap();
    let other = comparison.is_of_other_maker(file.len() as u64);
    (comparison.into_figures(), other)
}

/// The only anomaly: its row, fault and worth in nm.
#[track_caller]
fn only(file: &[PathRow], recipe: &[PathRow]) -> (u64, RowFault, f64) {
    let (figures, _) = compare(file, recipe);
    assert_eq!(figures.count, 1, "{figures:?}");
    let anomaly = figures.worst[0].clone();
    (anomaly.row, anomaly.fault, 1e6 * anomaly.worth)
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!(
        (found / expected - 1.0).abs() < 0.01,
        "{found} for {expected}"
    );
}

#[test]
fn a_path_differs_from_itself_in_nothing() {
    for count in [1, 2, 3, 500] {
        let (figures, other) = compare(&path(count), &path(count));
        assert_eq!((figures.count, other), (0, false));
    }
}

#[test]
fn a_height_is_worth_itself() {
    for row in [0, 1, 250, 498, 499] {
        let mut file = path(500);
        file[row].point.z += 20e-6;
        let (found, fault, worth) = only(&file, &path(500));
        assert_eq!(
            (found, fault),
            (row as u64 + 1, RowFault::Differs(vec![Column::Z]))
        );
        close(worth, 20.0);
    }
}

/// At C = 0 the plane rises by 0.1 along X, and by nothing along C.
#[test]
fn x_and_c_are_worth_what_the_surface_makes_of_them() {
    let row = (TAU / STEP).round() as usize;
    let mut file = path(500);
    file[row].point.x += 50e-6;
    let (_, fault, worth) = only(&file, &path(500));
    assert_eq!(fault, RowFault::Differs(vec![Column::X]));
    close(worth, 5.0);
    let quarter = (TAU / STEP / 4.0).round() as usize;
    let mut file = path(500);
    let x = file[quarter].point.x;
    file[quarter].point.c += 50e-6 / x;
    let (_, fault, worth) = only(&file, &path(500));
    assert_eq!(fault, RowFault::Differs(vec![Column::C]));
    close(worth, 5.0);
}

#[test]
fn a_velocity_is_worth_four_27ths_of_what_it_moves_in_a_step() {
    let mut file = path(500);
    file[100].point.vz += 0.05;
    let (row, fault, worth) = only(&file, &path(500));
    assert_eq!((row, fault), (101, RowFault::Differs(vec![Column::Vz])));
    close(worth, 0.05 * TIME * 4.0 / 27.0 * 1e6);
}

#[test]
fn a_row_that_is_lost_or_added_moves_no_other_out_of_its_place() {
    let whole = path(500);
    for row in [1, 250, 498] {
        let mut short = whole.clone();
        short.remove(row);
        let (found, fault, lost) = only(&short, &whole);
        assert_eq!((found, fault), (row as u64 + 1, RowFault::Lost));
        let (found, fault, added) = only(&whole, &short);
        assert_eq!((found, fault), (row as u64 + 1, RowFault::Added));
        // The same two curves, the other way round.
        assert!(lost > 0.0);
        close(lost, added);
    }
}

/// The row is no other's partner, and its own is left without one. All rows behind it keep theirs.
#[test]
fn a_wild_c_moves_no_other_row_out_of_its_place() {
    for wild in [-7.0, 0.4, 7.0] {
        let mut file = path(500);
        file[250].point.c += wild;
        let (figures, other) = compare(&file, &path(500));
        let mut rows: Vec<u64> = figures.worst.iter().map(|found| found.row).collect();
        rows.sort_unstable();
        assert!(
            !other && rows.iter().all(|row| (251..=252).contains(row)),
            "{figures:?}"
        );
        assert!((1..=2).contains(&figures.count), "{figures:?}");
    }
}

#[test]
fn rows_that_are_lost_at_an_end_are_counted_there_and_have_no_worth() {
    let whole = path(500);
    let (figures, other) = compare(&whole[3..495], &whole);
    let rows: Vec<u64> = figures.worst.iter().map(|lost| lost.row).collect();
    assert_eq!(rows, [1, 1, 1, 493, 493, 493, 493, 493]);
    assert_eq!((figures.count, other), (8, false));
    assert!(figures.worst.iter().all(|lost| lost.worth.is_nan()));
    let (figures, _) = compare(&whole, &whole[3..495]);
    assert!(figures.worst.iter().all(|row| row.fault == RowFault::Added));
    assert_eq!(figures.count, 8);
}

/// Half of the file is cut off. What is left is the recipe's own.
#[test]
fn a_file_that_was_cut_short_is_no_other_makers() {
    let whole = path(500);
    let (figures, other) = compare(&whole[..250], &whole);
    assert!(figures.worst.iter().all(|lost| lost.row == 251));
    assert_eq!((figures.count, other), (250, false));
}

#[test]
fn one_wrong_time_is_one_row_whether_or_not_the_rest_comes_later() {
    let mut file = path(500);
    file[100].point.t += 0.01 * TIME;
    let (row, fault, _) = only(&file, &path(500));
    assert_eq!((row, fault), (101, RowFault::Differs(vec![Column::Time])));
    for row in &mut file[101..] {
        row.point.t += 0.01 * TIME;
    }
    let (row, fault, _) = only(&file, &path(500));
    assert_eq!((row, fault), (101, RowFault::Differs(vec![Column::Time])));
}

/// A program has the time of a segment in the move that ends it: with the move goes the time.
#[test]
fn a_move_that_is_lost_with_its_time_is_one_row() {
    let mut file = path(500);
    file.remove(100);
    for row in &mut file[100..] {
        row.point.t -= TIME;
    }
    let (row, fault, worth) = only(&file, &path(500));
    assert_eq!((row, fault), (101, RowFault::Lost));
    assert!(worth > 10.0, "{worth}");
}

/// The step of C is 0.05 rad: a wrong distance of many steps leaves each row with its own partner.
#[test]
fn one_wrong_distance_is_one_row_though_all_rows_behind_it_are_moved() {
    let of = |row: usize, column: Column, file: &[PathRow]| {
        let (figures, other) = compare_distances(file, &path(500));
        assert_eq!((figures.count, other), (1, false), "{figures:?}");
        let found = &figures.worst[0];
        let differs = RowFault::Differs(vec![column]);
        assert_eq!((found.row, &found.fault), (row as u64 + 1, &differs));
        1e6 * found.worth
    };
    for row in [1, 250, 498, 499] {
        let file = with_distance(row, |point| point.z += 20e-6);
        close(of(row, Column::Z, &file), 20.0);
        let file = with_distance(row, |point| point.x -= 0.3);
        assert!(of(row, Column::X, &file) > 0.0);
        // No row behind the last one shows that it is moved by more than a step.
        let turns: &[f64] = if row < 499 {
            &[-0.01, 0.01, 0.3, 7.0]
        } else {
            &[-0.01, 0.01]
        };
        for turned in turns {
            let file = with_distance(row, |point| point.c += turned);
            assert!(of(row, Column::C, &file) > 0.0, "{turned}");
        }
    }
    // In a file of positions each row behind it is wrong by itself.
    let file = with_distance(250, |point| point.z += 20e-6);
    assert_eq!(compare(&file, &path(500)).0.count, 250);
}

#[test]
fn two_wrong_distances_are_two_rows_though_the_second_takes_the_first_back() {
    let mut file = with_distance(100, |point| point.z += 20e-6);
    file[101..].iter_mut().for_each(|row| row.point.z -= 20e-6);
    let (figures, _) = compare_distances(&file, &path(500));
    let mut rows: Vec<u64> = figures.worst.iter().map(|found| found.row).collect();
    rows.sort_unstable();
    assert_eq!(rows, [101, 102]);
}

/// With a line goes its distance, and all behind it is moved back by that.
#[test]
fn a_distance_that_is_lost_or_added_is_one_row() {
    let whole = path(500);
    let way = |rows: &[PathRow], row: usize| {
        let [from, to] = [rows[row - 1].point, rows[row].point];
        [to.t - from.t, to.c - from.c, to.x - from.x, to.z - from.z]
    };
    let moved = |rows: &mut [PathRow], [t, c, x, z]: [f64; 4], sign: f64| {
        for PathRow { point, .. } in rows {
            point.t += sign * t;
            point.c += sign * c;
            point.x += sign * x;
            point.z += sign * z;
        }
    };
    let in_file = in_digits(&whole);
    for row in [1, 250, 498] {
        let gone = way(&in_file, row);
        let mut file = in_file.clone();
        file.remove(row);
        moved(&mut file[row..], gone, -1.0);
        let (figures, other) = compare_distances(&file, &whole);
        assert_eq!((figures.count, other), (1, false), "{row}: {figures:?}");
        let found = &figures.worst[0];
        assert_eq!((found.row, &found.fault), (row as u64 + 1, &RowFault::Lost));

        let mut file = in_file.clone();
        let twice = file[row];
        file.insert(row, twice);
        moved(&mut file[row + 1..], gone, 1.0);
        let (figures, other) = compare_distances(&file, &whole);
        assert_eq!((figures.count, other), (1, false), "{row}: {figures:?}");
        let found = &figures.worst[0];
        assert_eq!(found.fault, RowFault::Added, "{figures:?}");
        assert!(found.row.abs_diff(row as u64 + 1) <= 1, "{}", found.row);
    }
}

#[test]
fn distances_of_another_path_are_another_makers() {
    let mut file = path(5000);
    for (k, row) in file.iter_mut().enumerate() {
        row.point.z += 1e-6 * (k % 7) as f64;
    }
    assert!(compare_distances(&file, &path(5000)).1);
}

#[test]
fn rounding_to_half_a_digit_is_no_difference() {
    let digits = HalfDigits {
        time: 0.5e-6,
        position: 0.5e-7,
        angle: 0.5e-9,
        velocity: 0.5e-7,
        angular_velocity: 0.5e-9,
    };
    let rounded = |value: f64, half: f64| (value / (2.0 * half)).round() * 2.0 * half;
    let mut file = path(500);
    for row in &mut file {
        let point = &mut row.point;
        point.x = rounded(point.x, digits.position);
        point.z = rounded(point.z, digits.position);
        point.vz = rounded(point.vz, digits.velocity);
    }
    assert_eq!(compare_within(digits, &file, &path(500)).0.count, 0);
    assert!(compare(&file, &path(500)).0.count > 100);
    file[100].point.z += 1e-7;
    assert_eq!(compare_within(digits, &file, &path(500)).0.count, 1);
}

#[test]
fn a_row_in_another_section_is_told() {
    let mut file = path(500);
    file[499].section = Section::LeadOut;
    let (row, fault, worth) = only(&file, &path(500));
    assert_eq!(
        (row, fault),
        (500, RowFault::Differs(vec![Column::Section]))
    );
    assert_eq!(worth, 0.0);
}

#[test]
fn a_path_of_which_more_than_a_hundredth_differs_is_another_makers() {
    let spoiled = |count: usize| {
        let mut file = path(5000);
        for k in 0..count {
            file[90 * k + 10].point.z += 1e-6;
        }
        compare(&file, &path(5000)).1
    };
    assert!(!spoiled(50));
    assert!(spoiled(51));
    let mut file = path(20);
    file[10].point.z += 1e-6;
    assert!(!compare(&file, &path(20)).1);
    for row in &mut file {
        row.point.z += 1e-6;
    }
    assert!(compare(&file, &path(20)).1);
    // Other steps of C.
    let coarse: Vec<PathRow> = path(5000).into_iter().step_by(3).collect();
    let shifted = |row: PathRow| PathRow {
        point: ControlPoint {
            c: row.point.c + 0.3 * STEP,
            ..row.point
        },
        ..row
    };
    let coarse: Vec<PathRow> = coarse.into_iter().map(shifted).collect();
    assert!(compare(&coarse, &path(5000)).1);
}

#[test]
fn however_many_rows_differ_only_the_worst_are_kept() {
    let mut file = path(MOST_KEPT + 500);
    for (k, row) in file.iter_mut().enumerate() {
        row.point.z += 1e-6 * (1.0 + 0.1 * (k % 7) as f64);
    }
    let (figures, _) = compare(&file, &path(MOST_KEPT + 500));
    assert_eq!(figures.count, MOST_KEPT as u64 + 500);
    assert_eq!(figures.worst.len(), MOST_KEPT);
    assert!(
        figures
            .worst
            .is_sorted_by(|one, other| one.worth >= other.worth)
    );
}

/// A gap of 3499 rows is played as one cubic, whose C and X are those of the path. So the worth is the
/// distance of that cubic from the path, wherever in the gap it is largest.
#[test]
fn a_long_gap_is_worth_what_its_largest_place_is() {
    let (from, to) = (1000, 4500);
    let across = |row: &PathRow, rows: &[PathRow]| {
        let [begin, end] = [rows[from].point, rows[to].point];
        let time = end.t - begin.t;
        let s = (row.point.t - begin.t) / time;
        let (rest, bend) = (1.0 - s, s * s * (3.0 - 2.0 * s));
        let ends = begin.z * (1.0 - bend) + end.z * bend;
        ends + time * s * rest * (begin.vz * rest - end.vz * s)
    };
    for (row, height) in [(1020, 0.0), (1020, 90.0), (4480, 90.0)] {
        let mut whole = path(5000);
        whole[row].point.z += height;
        let apart = |row: &PathRow| (row.point.z - across(row, &whole)).abs();
        let largest = whole[from..=to].iter().map(apart).fold(0.0, f64::max);
        assert!(largest > height - 40.0, "{largest}");
        let short = [&whole[..=from], &whole[to..]].concat();
        let (figures, _) = compare(&short, &whole);
        assert_eq!(figures.count, 3499);
        assert!(
            figures
                .worst
                .iter()
                .all(|lost| lost.fault == RowFault::Lost)
        );
        close(figures.worst[0].worth, largest);
    }
}
