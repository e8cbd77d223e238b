//! The plugins of `tests/fixtures`, which misbehave on purpose: which check sees which fault.

#[path = "../../../../tests/support/fixtures.rs"]
mod support;

use std::fs;
use std::path::Path;

use turnpath_host::{Catalogue, LoadError};
use turnpath_plugin_test::Check::{self, Construction, Contract, Declaration, Heights, Velocities};
use turnpath_plugin_test::{Conformance, Promise, Trial};

/// A fault that a check sees: the strategy, the check, words of the message.
type Seen = (&'static str, Check, &'static str);

/// The faults of each fixture; one without faults passes.
const SEEN: [(&str, &[Seen]); 20] = [
    ("bowl-file", &[]),
    ("builds-on", &[]),
    ("conics", &[]),
    ("constant-arc", &[]),
    (
        "host-keys",
        &[("hasty", Declaration, "declares the parameter `speed`")],
    ),
    (
        "nan",
        &[
            (
                "nan-surface",
                Heights,
                "has no height, slope or curvature at",
            ),
            ("nan-surface", Contract, "no number for z anywhere"),
            ("returns-nan", Contract, "node 6 is NaN"),
            ("nan-velocity", Velocities, "vC is NaN at node 0"),
        ],
    ),
    (
        "panics",
        &[
            ("panicking-surface", Contract, "panicked: the table ends"),
            ("panics-in-constructor", Construction, "the table is empty"),
            ("panics-twice", Construction, "a value that is not text"),
            ("panics-in-call", Contract, "panicked: index out of bounds"),
            ("panics-in-drop", Contract, "no node in revolutions"),
        ],
    ),
    ("plain-compensator", &[]),
    ("sequential", &[]),
    ("template-compensator", &[]),
    ("template-feed", &[]),
    ("template-sampler", &[]),
    ("template-spindle", &[]),
    ("template-surface", &[]),
    ("template-velocity", &[]),
    ("twins-a", &[]),
    ("twins-b", &[]),
    (
        "two-speeds",
        &[
            ("too-far", Contract, "off the locus"),
            ("backwards", Contract, "t does not grow at"),
            ("jumps", Contract, "the speed jumps from"),
        ],
    ),
    (
        "unordered",
        &[
            ("decreasing-nodes", Contract, "does not lie beyond"),
            ("too-few", Contract, "no node in revolutions"),
            ("outside-block", Contract, "lies outside the block"),
        ],
    ),
    (
        "unusable-name",
        &[("Lab Arc\n", Declaration, "no recipe could choose")],
    ),
];

/// Those that are asked very often: fixtures are built without optimisation.
const SLOW: [&str; 6] = [
    "bowl-file",
    "builds-on",
    "conics",
    "plain-compensator",
    "template-compensator",
    "template-surface",
];

/// Fixtures whose faults no check can see, and why.
const UNSEEN: [(&str, &str); 4] = [
    (
        "acts-when-loaded",
        "its initialiser ends the process before any test begins; `turnpath` tries libraries in a \
         process of their own",
    ),
    (
        "ends-process",
        "a call ends the process of the test, which fails without a name; `turnpath` names it",
    ),
    (
        "foreign",
        "the checks link the crate, and only a load sees that a library exports no plugin",
    ),
    (
        "other-version",
        "the checks link the crate with its own boundary, so that both versions are one",
    ),
];

/// What the fixtures' parameters need, and what the templates of `turnpath new-plugin` promise.
fn trials(fixture: &str) -> Vec<Trial> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures/boundary-0.2.0");
    match fixture {
        "bowl-file" => vec![
            Trial::of("bowl-file")
                .with("file = \"curvature.txt\"")
                .with_files_in(folder),
        ],
        "builds-on" => vec![Trial::of("rippled-conic").with("radius = \"40 mm\"")],
        "conics" => vec![Trial::of("labs-conic").with("radius = \"40 mm\"")],
        "template-feed" => vec![Trial::of("even-pitch").promising(Promise::Residual)],
        "template-velocity" => {
            vec![Trial::of("five-points").promising(Promise::ExactOnCubics)]
        }
        "constant-arc" => vec![Trial::of("constant-arc").with("spacing = \"0.3 mm\"")],
        _ => Vec::new(),
    }
}

fn checks(fixture: &str, catalogue: Result<Catalogue, LoadError>) -> Conformance {
    let checks = Conformance::of(catalogue, fixture);
    trials(fixture).into_iter().fold(checks, Conformance::with)
}

fn with_fixture(
    catalogue: Result<Catalogue, LoadError>,
    fixture: &str,
) -> Result<Catalogue, LoadError> {
    catalogue?.with_file(support::library(fixture))
}

/// Checks the fixtures of these rows.
fn check_rows(is_asked: impl Fn(&str) -> bool) {
    let mut wrong = Vec::new();
    for (fixture, seen) in SEEN.into_iter().filter(|(fixture, _)| is_asked(fixture)) {
        let catalogue = with_fixture(Catalogue::linked(), fixture);
        let findings = checks(fixture, catalogue).findings();
        let is = |(strategy, check, words): &Seen, fault: &turnpath_plugin_test::Fault| {
            let text = fault.to_string();
            fault.strategy == *strategy && fault.kind.check() == *check && text.contains(words)
        };
        for row in seen {
            if !findings.faults.iter().any(|fault| is(row, fault)) {
                wrong.push(format!("{fixture}: not seen: {row:?}\n{findings}"));
            }
        }
        for fault in &findings.faults {
            if !seen.iter().any(|row| is(row, fault)) {
                wrong.push(format!("{fixture}: not in the table: {fault}"));
            }
        }
        let tried = !findings.figures.is_empty() || !findings.faults.is_empty();
        assert!(tried, "{fixture}: nothing was tried");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn each_fault_is_seen_by_its_check_and_nothing_else_is_found() {
    check_rows(|fixture| !SLOW.contains(&fixture));
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_fixtures_that_take_their_time_pass() {
    check_rows(|fixture| SLOW.contains(&fixture));
}

#[test]
fn two_plugins_with_one_name_are_a_fault_of_their_declaration() {
    let both = with_fixture(with_fixture(Catalogue::linked(), "twins-a"), "twins-b");
    let findings = checks("twins-b", both).findings();
    let [fault] = &findings.faults[..] else {
        panic!("{findings}");
    };
    assert_eq!(fault.kind.check(), Declaration);
    let text = fault.to_string();
    assert!(
        text.contains("two strategies of the slot `sampler` are named `twin`"),
        "{text}"
    );
}

#[test]
fn every_fixture_has_its_row() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures");
    let packages = fs::read_dir(folder).expect("the fixtures").flatten();
    let packages = packages.filter(|entry| entry.path().join("Cargo.toml").is_file());
    for package in packages {
        let name = package.file_name();
        // An older boundary is no fault: `tests/program/frozen_boundary.rs` loads it.
        let has_row = SEEN.iter().any(|(fixture, _)| name == *fixture)
            || UNSEEN.iter().any(|(fixture, _)| name == *fixture)
            || name == "boundary-0.2.0";
        assert!(has_row, "{} has no row", name.display());
    }
    for (fixture, reason) in UNSEEN {
        assert!(!reason.is_empty(), "{fixture}");
    }
}
