//! How far the digits of a program move X.

use super::numbers::Numbers;
use super::*;
use crate::POSTS;

/// The largest distance in X between a path and its program, in parts of what its digits may move it by.
fn part_of_bound(layout: &Layout) -> f64 {
    const TIME: f64 = 0.004;
    let mut numbers = Numbers(7);
    let steps: Vec<[f64; 6]> = (0..1000)
        .map(|_| [(); 4].map(|()| numbers.part()))
        .map(|[x, z, vx, vz]| [TIME, 1.0, x, z, vx, vz])
        .collect();
    let points = path_of(&steps);
    let read = read(layout, program(layout, &points).as_bytes()).unwrap();
    let distance = |(path, program): (&[ControlPoint], &[ControlPoint])| {
        let [path, program] = [path, program].map(|ends| Segment::between(&ends[0], &ends[1]));
        let places = (0..=64).map(|place| f64::from(place) / 64.0);
        let distances = places.map(|s| (path.x.value(s) - program.x.value(s)).abs());
        distances.fold(0.0, f64::max)
    };
    let pairs = points.windows(2).zip(read.windows(2));
    let largest = pairs.map(distance).fold(0.0, f64::max);
    largest / layout.format.moves_x_by(TIME)
}

#[test]
fn digits_move_x_by_no_more_than_they_may_and_nearly_by_that() {
    for post in POSTS.iter().filter(|post| post.writes_velocities()) {
        for (position_decimals, velocity_decimals, per_minute) in [
            (4, 7, false),
            (7, 2, false),
            (7, 2, true),
            (5, 2, false),
            (5, 1, true),
        ] {
            let mut layout = plain(post);
            layout.format = ProgramFormat {
                position_decimals,
                velocity_decimals,
                per_minute,
                ..layout.format
            };
            let part = part_of_bound(&layout);
            let case = format!(
                "{} {position_decimals} {velocity_decimals} {per_minute}",
                post.name
            );
            assert!((0.7..=1.001).contains(&part), "{case}: {part}");
        }
    }
}
