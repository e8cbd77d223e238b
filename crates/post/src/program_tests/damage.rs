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
