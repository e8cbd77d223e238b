//! Damaged programs are refused with a line, or read.

use super::numbers::Numbers;
use super::*;
use crate::POSTS;

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

/// Lines of a program that bring the axes to the path, at the most.
const WAY_LINES: usize = 4;

/// Whether a place in a line of the way to the path is in its time, which is no part of the path.
fn is_in_time(line: &str, at: usize) -> bool {
    let (before, behind) = line.split_at(at);
    let word = before.rsplit(' ').next().unwrap_or_default();
    let is_last = line.starts_with("MovePvt") && !behind.contains(", ");
    is_last || ["F", "PVT", "TM"].iter().any(|name| word.starts_with(name))
}

/// A digit, a point or a comma becomes another character of numbers. The line is then refused by its number,
/// or by that of the next one, whose velocity no longer fits; or it is read as it is.
#[test]
fn a_line_with_another_character_in_a_number_is_refused_at_its_place_or_read_as_it_is() {
    let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 40]);
    for post in POSTS {
        let layout = plain(post);
        let text = program(&layout, &points);
        let good = read(&layout, text.as_bytes()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let is_mark = |line: &str| line.contains("-- cutting") || line.contains("-- end of path");
        let begin = lines.iter().position(|line| is_mark(line)).unwrap() + 1;
        let end = lines.iter().rposition(|line| is_mark(line)).unwrap();
        let (mut numbers, mut refused) = (Numbers(13), 0);
        for damaged in begin..end {
            for other in ["0", "7", ".", ",", "-", ""] {
                let line = lines[damaged];
                let places: Vec<usize> = (0..line.len())
                    .filter(|at| matches!(line.as_bytes()[*at], b'0'..=b'9' | b'.' | b','))
                    .collect();
                let Some(at) = places.get(numbers.next() as usize % places.len().max(1)) else {
                    continue;
                };
                let line = format!("{}{other}{}", &line[..*at], &line[at + 1..]);
                let mut spoiled = lines.clone();
                spoiled[damaged] = &line;
                match read(&layout, spoiled.join("\n").as_bytes()) {
                    // The time of the way to the path is no part of it, and a zero may change nothing. All
                    // other numbers of its lines are read: places, velocities and modes.
                    Ok(read) => assert!(
                        read != good
                            || (damaged < begin + WAY_LINES && is_in_time(lines[damaged], *at))
                            || same_numbers(lines[damaged], &line),
                        "{line}"
                    ),
                    Err(said) => {
                        let at = |line: usize| said.contains(&format!("line {line}: "));
                        // A time or a mode that is no longer said is missed by the next move. Where
                        // polynomials begin elsewhere, the second one does not fit to the first.
                        let next = if damaged < begin + WAY_LINES { 4 } else { 2 };
                        let near = (1..=next).any(|lines| at(damaged + lines));
                        assert!(near, "{line}: {said}");
                        refused += 1;
                    }
                }
            }
        }
        assert!(refused > 20, "{}: only {refused} are refused", post.name);
    }
}

/// Whether two lines have the same numbers, apart from zeros that change nothing.
fn same_numbers(one: &str, other: &str) -> bool {
    let numbers = |line: &str| -> Vec<f64> {
        let parts = line.split(|c: char| !c.is_ascii_digit() && c != '.' && c != '-');
        parts.filter_map(|part| part.parse().ok()).collect()
    };
    numbers(one) == numbers(other) || one == other
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
