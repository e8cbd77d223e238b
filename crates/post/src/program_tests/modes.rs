//! The modes in which a path is played: each of them is said before its first point.

use super::*;
use crate::POSTS;

/// What is not missed: a word that no controller needs for the path.
fn is_needless(word: &str) -> bool {
    word.starts_with("//") || word.starts_with(';')
}

/// After an approach, which stops at each line, a path without its own modes stops at each segment.
#[test]
fn no_word_before_the_first_segment_of_a_path_may_be_missing() {
    let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 4]);
    for post in POSTS {
        let layout = plain(post);
        let text = program(&layout, &points);
        let lines: Vec<&str> = text.lines().collect();
        let begin = lines
            .iter()
            .position(|line| line.contains("-- cutting"))
            .unwrap()
            + 1;
        let modes = lines[begin..].iter().take_while(|line| !line.contains('C'));
        let mut tried = 0;
        for number in begin..begin + modes.count() {
            let words: Vec<&str> = lines[number].split_whitespace().collect();
            for missing in 0..words.len() {
                let mut kept = words.clone();
                let word = kept.remove(missing);
                assert!(!is_needless(word));
                let line = kept.join(" ");
                let mut spoiled = lines.clone();
                spoiled[number] = &line;
                let said = read(&layout, spoiled.join("\n").as_bytes());
                assert!(said.is_err(), "{}: without {word}", post.name);
                tried += 1;
            }
        }
        let expected = match post.name {
            // `ABS` and `PVT1000`; `G90` and `G93`.
            "pmac-pvt" | "power-pmac-pvt" | "nanotech-g93" => 2,
            "automation1-pvt" => 3,
            "siemens-840d-poly" => 5,
            _ => 6,
        };
        assert_eq!(tried, expected, "{}", post.name);
    }
}

#[test]
fn two_words_of_a_group_in_a_block_are_refused() {
    let points = path_of(&[[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 4]);
    for post in POSTS.iter().filter(|post| post.dialect.ends_program("M30")) {
        let layout = plain(post);
        let text = program(&layout, &points);
        for (from, to) in [("G93", "G93 G93"), ("G1 C", "G1 G1 C"), ("G90", "G90 G90")] {
            assert!(text.contains(from), "{text}");
            let said = read(&layout, text.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert!(
                said.contains("is the second word of its group"),
                "{}: {said}",
                post.name
            );
        }
    }
    let poly = plain(crate::post_named("beckhoff-poly").unwrap());
    let text = program(&poly, &points);
    for (from, to) in [
        ("G93", "G94 G93"),
        ("G94 G1", "G93 G94 G1"),
        ("G94 G1", "G94 G0 G1"),
    ] {
        let said = read(&poly, text.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(
            said.contains("is the second word of its group"),
            "{to}: {said}"
        );
    }
}
