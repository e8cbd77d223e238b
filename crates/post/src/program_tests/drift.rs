//! The times of a program add up to the time of the path.

use super::*;
use crate::{FeedMeaning, POSTS};

/// The millimetres that the axis of time goes in a second, by default.
const TIME_AXIS_MM_PER_S: f64 = 10.0;

/// Where the axis of time stands behind a line, in seconds of the path.
fn said_instant(line: &str) -> Option<f64> {
    let place = line
        .split_whitespace()
        .find_map(|word| word.strip_prefix('W'));
    Some(place?.parse::<f64>().unwrap() / TIME_AXIS_MM_PER_S)
}

/// The time of a segment in seconds, from a line of text alone. F is one over minutes, or seconds.
fn said_time(line: &str, f_is_seconds: bool) -> Option<f64> {
    if let Some(ms) = line.strip_prefix("PVT") {
        return Some(ms.parse::<f64>().unwrap() / 1e3);
    }
    if let Some((_, feed)) = line.split_once(" F") {
        let feed: Option<f64> = feed.parse().ok();
        return feed.map(|feed| if f_is_seconds { feed } else { 60.0 / feed });
    }
    let call = line.strip_prefix("MovePvt(")?.strip_suffix(')')?;
    Some(call.rsplit(", ").next().unwrap().parse().unwrap())
}

/// The sum of the times in the text stays within half a step of the path's time, however many segments
/// it has. The sum is counted in steps, so that it has no rounding of its own.
fn times_do_not_drift(layout: &Layout, segments: u32) {
    let steps_per_s = layout.format.steps_per_s as f64;
    let chords = layout.format.chords;
    let f_is_seconds = chords.is_some_and(|chords| chords.feed == FeedMeaning::Seconds);
    // 1/3 ms and a little is never a whole number of steps.
    let point = |k: u32| ControlPoint {
        t: f64::from(k) * (1e-3 / 3.0 + 1e-10 / 7.0),
        c: f64::from(k) * 0.01,
        vc: 30.0,
        ..ControlPoint::default()
    };
    let (mut sum, mut time, mut first) = (0i64, 0i64, true);
    let mut instant = 0i64;
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
            if let Some(s) = said_instant(line) {
                let last = std::mem::replace(&mut instant, (s * steps_per_s).round() as i64);
                sum += instant - last;
                continue;
            }
            time = said_time(line, f_is_seconds).map_or(time, |s| (s * steps_per_s).round() as i64);
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
