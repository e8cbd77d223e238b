//! Every strategy that is built in passes.

use turnpath_host::Catalogue;
use turnpath_plugin_test::{Conformance, Promise, Trial};

use turnpath_atpg as _;
use turnpath_ats as _;
use turnpath_fft_adaptive as _;
use turnpath_formula as _;
use turnpath_grid as _;
use turnpath_minimax as _;
use turnpath_polynomials as _;

/// The plugins that are built in; each has a test here.
const PLUGINS: [&str; 13] = [
    "turnpath-atpg",
    "turnpath-ats",
    "turnpath-constant",
    "turnpath-fft-adaptive",
    "turnpath-formula",
    "turnpath-grid",
    "turnpath-integrated",
    "turnpath-minimax",
    "turnpath-nose-radius",
    "turnpath-polynomials",
    "turnpath-spindle",
    "turnpath-surfaces",
    "turnpath-triangle-rotary",
];

/// Checks a plugin crate with these trials; every strategy of it is tried on both parts.
#[track_caller]
fn passes(plugin: &str, trials: impl IntoIterator<Item = Trial>) {
    let checks = Conformance::of(Catalogue::linked(), plugin);
    trials.into_iter().fold(checks, Conformance::with).assert();
}

fn trial(name: &str, lines: &str) -> Trial {
    Trial::of(name).with(lines)
}

#[test]
fn the_tests_here_are_of_all_plugins_that_are_built_in() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../plugins");
    let folders = std::fs::read_dir(folder).expect("the plugins").flatten();
    let mut names: Vec<String> = folders
        .map(|entry| format!("turnpath-{}", entry.file_name().display()))
        .collect();
    names.sort();
    assert_eq!(names, PLUGINS);
    let tests = include_str!("built_ins.rs");
    for name in PLUGINS {
        // Once in the list, and once where it is checked.
        assert!(tests.matches(&format!("\"{name}\"")).count() >= 2, "{name}");
    }
}

#[test]
fn surfaces() {
    passes(
        "turnpath-surfaces",
        [
            trial("astigmatic", "k = \"0.05 /mm\""),
            trial(
                "biconic",
                "radius_x = \"30 mm\"\nradius_y = \"-50 mm\"\nconic_x = -0.5",
            ),
            trial("conic", "radius = \"20 mm\"\nconic = -1.5"),
            trial(
                "even-asphere",
                "radius = \"25 mm\"\ncoefficients = { 4 = 1e-4, 6 = -1e-6 }",
            ),
            trial(
                "lenslet-array",
                "layout = \"square\"\npitch = \"40 mm\"\nradius = \"30 mm\"",
            ),
            trial(
                "odd-asphere",
                "radius = \"25 mm\"\ncoefficients = { 3 = 1e-4, 5 = -1e-6 }",
            ),
            trial(
                "off-axis-conic",
                "vertex_radius = \"60 mm\"\nconic = -0.8\noff_axis_distance = \"12 mm\"",
            ),
            trial(
                "off-axis-paraboloid",
                "vertex_radius = \"60 mm\"\noff_axis_distance = \"12 mm\"",
            ),
            trial(
                "sinusoidal-array",
                "amplitude_x = \"3 um\"\nfrequency_x = \"0.3 /mm\"\nform = \"product\"",
            ),
            trial(
                "toric",
                "radius_rotation = \"40 mm\"\nradius_base = \"25 mm\"",
            ),
            trial(
                "toroid-yz",
                "radius_rotation = \"40 mm\"\nradius = \"25 mm\"\ncoefficients = { 4 = 1e-5 }",
            ),
            trial(
                "xy-polynomial",
                "terms = [[2, 0, 0.01], [1, 1, -0.02], [3, 2, 1e-5]]",
            ),
        ],
    );
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_polynomials() {
    passes(
        "turnpath-polynomials",
        [
            trial(
                "chebyshev",
                "normalization_x = \"4 mm\"\ncoefficients = { \"2,1\" = \"1 um\", \"0,4\" = \"-0.5 um\" }",
            ),
            trial(
                "forbes-q2d",
                "radius = \"40 mm\"\nnormalization_radius = \"5 mm\"\ncoefficients = { \"1,2\" = \"1 um\", \"2,-1\" = \"0.4 um\" }",
            ),
            trial(
                "forbes-qbfs",
                "radius = \"40 mm\"\nnormalization_radius = \"5 mm\"\ncoefficients = { 0 = \"1 um\", 3 = \"-0.4 um\" }",
            ),
            trial(
                "forbes-qcon",
                "radius = \"40 mm\"\nnormalization_radius = \"5 mm\"\ncoefficients = { 0 = \"1 um\", 2 = \"-0.4 um\" }",
            ),
            trial(
                "zernike",
                "indexing = \"noll\"\nnormalization_radius = \"5 mm\"\ncoefficients = { 7 = \"1 um\", 11 = \"-0.4 um\" }",
            ),
        ],
    );
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_formula_and_grid() {
    passes(
        "turnpath-formula",
        [trial(
            "formula",
            "z = \"rho^2/(2*R) + A*cos(0.7*x/one)*sin(0.4*y/one)\"\nconstants = { R = \"50 mm\", A = \"2 um\", one = \"1 mm\" }",
        )],
    );
    passes(
        "turnpath-grid",
        [trial("grid-sag", "file = \"measured-error.gsf\"\nsmooth = \"0.5 mm\"\n[part]\naperture = \"4 mm\"\n[tolerance]\ninterpolation = \"200 nm\"")
            .with_files_in(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/recipes/surfaces"))],
    );
}

#[test]
fn the_constant_feed_and_the_constant_spindle() {
    passes("turnpath-constant", []);
}

/// Feeds that follow the residual keep it.
#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_feeds_and_their_samplers() {
    passes(
        "turnpath-atpg",
        [
            Trial::of("feed/atpg").promising(Promise::Residual),
            Trial::of("sampler/atpg").promising(Promise::Tolerance),
        ],
    );
    passes(
        "turnpath-ats",
        [
            Trial::of("feed/ats").promising(Promise::Residual),
            Trial::of("sampler/ats").promising(Promise::Tolerance),
        ],
    );
    passes("turnpath-fft-adaptive", []);
}

#[test]
fn samplers() {
    passes(
        "turnpath-integrated",
        [
            Trial::of("equal-angle").promising(Promise::Tolerance),
            trial("equal-arc", "spacing = \"0.2 mm\""),
            trial("integrated", "spacing = \"0.2 mm\""),
        ],
    );
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_minimax() {
    passes(
        "turnpath-minimax",
        [Trial::of("minimax").promising(Promise::Tolerance)],
    );
}

#[test]
fn compensators() {
    passes("turnpath-nose-radius", []);
}

#[test]
fn velocity_solvers() {
    passes(
        "turnpath-triangle-rotary",
        [
            Trial::of("analytic").promising(Promise::ExactOnCubics),
            Trial::of("area"),
            Trial::of("linear"),
            Trial::of("three-point"),
            Trial::of("triangle-rotary").promising(Promise::ExactOnCubics),
        ],
    );
}

#[test]
fn spindles() {
    let surface_speed = trial("surface-speed", "cutting_speed = \"2 m/min\"");
    passes("turnpath-spindle", [surface_speed]);
}
