//! The fuzzer's targets, on their corpus and on damage to it.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::damage::damaged;
use super::seeded::SeededNumbers;
use crate::fuzz::{TARGETS, Target};
use crate::support::repository;

const SEED: u64 = 20_261_122;
/// Cases of each target in every run of the tests.
const CASES: u64 = 700;
/// Cases of each target under `cargo xtask long`.
const MANY_CASES: u64 = 60_000;

/// The files of a target's corpus with their names, in the order of their names.
fn corpus(target: &Target) -> Vec<(String, Vec<u8>)> {
    let folder = repository().join("tests/fuzz/corpus").join(target.name);
    let entries = fs::read_dir(&folder).expect("the target's corpus");
    let mut files: Vec<(String, Vec<u8>)> = entries
        .map(|entry| {
            let entry = entry.expect("a file of the corpus");
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, fs::read(entry.path()).expect("a file of the corpus"))
        })
        .collect();
    files.sort();
    files
}

/// The input, if the target panics on it. It is kept in the tests' scratch folder.
fn complaint(target: &Target, name: &str, bytes: &[u8]) -> Option<String> {
    catch_unwind(AssertUnwindSafe(|| (target.read)(bytes))).err()?;
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}-{name}", target.name));
    fs::write(&file, bytes).expect("a file in the scratch folder");
    Some(format!(
        "{}: {name}, kept as {}",
        target.name,
        file.display()
    ))
}

fn try_damage(cases: u64) {
    let mut wrong = Vec::new();
    for target in &TARGETS {
        let corpus = corpus(target);
        for case in 0..cases {
            let mut random = SeededNumbers::of_case(SEED, case);
            let (_, first) = random.pick(&corpus).clone();
            let (_, other) = random.pick(&corpus);
            let bytes = damaged(&first, other, target.words, &mut random);
            wrong.extend(complaint(target, &format!("case-{case}"), &bytes));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_target_takes_its_corpus() {
    let mut wrong = Vec::new();
    for target in &TARGETS {
        let corpus = corpus(target);
        assert!(corpus.len() > 3, "{} has next to no corpus", target.name);
        let bad = corpus
            .iter()
            .filter_map(|(name, bytes)| complaint(target, name, bytes));
        wrong.extend(bad);
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_target_takes_damaged_files() {
    try_damage(CASES);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_every_target_takes_many_damaged_files() {
    try_damage(MANY_CASES);
}
