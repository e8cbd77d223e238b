//! Paths that are too long are the recipe's: they are refused at once, at the number that makes
//! them so.

use std::time::Instant;

use crate::support::bench::Bench;
use crate::support::recipe::SADDLE;

/// Seconds within which a refusal must come.
const AT_ONCE: u64 = 20;

#[track_caller]
fn refusal(words: &str) -> String {
    let bench = Bench::with(SADDLE);
    let begin = Instant::now();
    let said = bench.line(words);
    assert!(begin.elapsed().as_secs() < AT_ONCE, "{said}");
    assert_eq!(said.status, Some(2), "{said}");
    bench.shown(&said)
}

#[test]
fn an_overrun_of_a_million_kilometres() {
    insta::assert_snapshot!(refusal("check recipe.toml --set path.overrun=1e9m"));
}

#[test]
fn an_aperture_beyond_all_measure() {
    insta::assert_snapshot!(refusal("check recipe.toml --set part.aperture=1e300mm"));
    let run = refusal("run recipe.toml --set part.aperture=1e300mm");
    assert!(run.contains("the path is too long"), "{run}");
}

/// A saddle so flat that the tool fits everywhere.
const FLAT: &str = "--set surface.k=1e-12/mm";

#[test]
fn an_aperture_of_too_many_revolutions_is_not_the_strategys_fault() {
    for feed in ["constant", "atpg", "ats", "fft-adaptive"] {
        let line = format!(
            "check recipe.toml {FLAT} --set part.aperture=2000m --set feed={{use=\"{feed}\"}}"
        );
        let said = refusal(&line);
        assert!(said.contains("part.aperture=2000m"), "{feed}: {said}");
        assert!(said.contains("the path is too long"), "{feed}: {said}");
    }
}

#[test]
fn a_step_of_too_many_points_in_too_many_turns() {
    let line = format!(
        "check recipe.toml {FLAT} --set part.aperture=100m --set sampler.step=0.01deg \
         --set feed={{use=\"atpg\"}}"
    );
    let said = refusal(&line);
    assert!(said.contains("control points"), "{said}");
}
