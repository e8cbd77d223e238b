//! Libraries that are damaged anywhere: each is refused by its name, or works.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::collections::BTreeMap;
use std::fs;

use crate::support::bench::Bench;
use crate::support::bench_with_plugins::bench;
use crate::support::fixtures::{file_name, library};
use crate::support::recipe::saddle_with;

/// Damaged libraries in all, and how many of them every run of the tests tries.
const DAMAGED: u64 = 320;
const IN_EVERY_RUN: u64 = 20;
/// Parts of the file that get as many hits as the whole: what the loader reads.
const EDGE: usize = 1 << 14;

/// A sequence of numbers that looks random: the multiplier of Knuth's MMIX.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % limit.max(1)
    }
}

/// The library with the damage of this number, and what was done.
fn damaged(whole: &[u8], number: u64) -> (Vec<u8>, String) {
    let mut numbers = Numbers(number.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    numbers.below(1);
    let length = whole.len();
    let at = match numbers.below(4) {
        0 => numbers.below(EDGE.min(length)),
        1 => length - 1 - numbers.below(EDGE.min(length)),
        _ => numbers.below(length),
    };
    let mut bytes = whole.to_vec();
    let what = match number % 4 {
        0 => {
            bytes.truncate(at);
            "cut"
        }
        1 => {
            bytes[at] ^= 1 << numbers.below(8);
            "one bit"
        }
        2 => {
            let end = (at + 1 + numbers.below(4096)).min(length);
            bytes[at..end].fill(0);
            "zeros"
        }
        _ => {
            let end = (at + 1 + numbers.below(64)).min(length);
            bytes[at..end]
                .iter_mut()
                .for_each(|byte| *byte = numbers.below(256) as u8);
            "noise"
        }
    };
    (bytes, format!("{what} at {at}"))
}

/// Runs a recipe with the damaged library, and gives the status.
fn status_of(bench: &Bench, whole: &[u8], number: u64) -> i32 {
    let (bytes, what) = damaged(whole, number);
    let name = file_name("constant-arc");
    bench.write(&format!("plugins/{name}"), bytes);
    let mut words: Vec<&str> = "run recipe.toml -o out --plugin-dir plugins"
        .split(' ')
        .collect();
    words.extend(["--plugin-time-limit", "20 s"]);
    let said = bench.call(words);
    // 2 where a name or a range of the plugin's parameters was hit: the recipe does not fit it.
    assert!(
        matches!(said.status, Some(0 | 2 | 3)),
        "{number}, {what}: {said}"
    );
    if said.status == Some(3) {
        assert!(said.stderr.contains(&name), "{number}, {what}: {said}");
    }
    if said.status != Some(0) && bench.path("out").exists() {
        // What a library does when it is let go comes after the result, which is whole then.
        let is_told = said.stdout.contains("out/summary.json");
        assert!(
            is_told && bench.path("out/summary.json").exists(),
            "{number}, {what}: {said}"
        );
    }
    assert!(bench.scratch_is_empty(), "{number}, {what}: {said}");
    let _ = fs::remove_dir_all(bench.path("out"));
    said.status.unwrap()
}

/// How often each status came.
fn statuses(numbers: impl Iterator<Item = u64>) -> BTreeMap<i32, u32> {
    let recipe = saddle_with("sampler", "use = \"constant-arc\"\nspacing = \"0.5 mm\"");
    let bench = bench(&recipe, &[]);
    let whole = fs::read(library("constant-arc")).unwrap();
    let mut found = BTreeMap::new();
    for number in numbers {
        *found.entry(status_of(&bench, &whole, number)).or_default() += 1;
    }
    found
}

#[test]
fn a_damaged_library_works_or_is_named() {
    let step = (DAMAGED / IN_EVERY_RUN) as usize + 1;
    let found = statuses((0..DAMAGED).step_by(step));
    assert!(found.get(&3).is_some_and(|count| *count >= 5), "{found:?}");
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_hundreds_of_damaged_libraries_work_or_are_named() {
    let found = statuses(0..DAMAGED);
    println!("statuses: {found:?}");
    assert!(found.len() >= 2, "{found:?}");
}
