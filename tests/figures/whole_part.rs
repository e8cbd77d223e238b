//! Random parts and tools, cut whole: brute force checks every path, with formulas of this file's own.
//!
//! With `overrun = "contact"` no circle of the nose may go below the surface by more than 0.1 nm
//! anywhere, and nothing within the aperture may be left higher than the residual tolerance.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]
#![allow(
    clippy::disallowed_methods,
    reason = "formulas of this file's own, for brute force"
)]

use std::f64::consts::TAU;

use crate::support::bench::Bench;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseResult, TestRng, TestRunner};

/// Random parts for each compensator and direction.
const CASES: u32 = 6;
/// The same in the long tests, which begin with those parts.
const LONG_CASES: u32 = 350;
/// Sections of a turn, one control point on each.
const SECTIONS: usize = 24;
/// Places along a section's radius where the uncut height is measured.
const PLACES: usize = 400;
/// Places over the reach of a nose where the search for its deepest one begins.
const LOOKS: usize = 48;
/// Deepest penetration, mm.
const DEEPEST: f64 = 1e-7;
/// A tolerance holds when measured ≤ this × tolerance.
const ALLOWED: f64 = 1.001;

#[derive(Debug, Clone)]
enum Shape {
    /// Σ c xⁱ yʲ.
    Polynomial(Vec<(i32, i32, f64)>),
    /// A (cos 2πfx + cos 2πfy).
    Array { amplitude: f64, frequency: f64 },
}

#[derive(Debug, Clone)]
struct Job {
    shape: Shape,
    nose: f64,
    rim: f64,
    hole: f64,
    residual: f64,
    feed: &'static str,
}

impl Shape {
    fn height(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Polynomial(terms) => {
                let term = |(i, j, c): &(i32, i32, f64)| c * x.powi(*i) * y.powi(*j);
                terms.iter().map(term).sum()
            }
            Self::Array {
                amplitude,
                frequency,
            } => {
                let wave = |u: f64| (TAU * frequency * u).cos();
                amplitude * (wave(x) + wave(y))
            }
        }
    }

    fn table(&self) -> String {
        match self {
            Self::Polynomial(terms) => {
                let rows: Vec<String> = terms
                    .iter()
                    .map(|(i, j, c)| format!("[{i}, {j}, {c:e}]"))
                    .collect();
                format!("use = \"xy-polynomial\"\nterms = [{}]", rows.join(", "))
            }
            Self::Array {
                amplitude,
                frequency,
            } => format!(
                "use = \"sinusoidal-array\"\namplitude_x = \"{amplitude} mm\"\namplitude_y = \
                 \"{amplitude} mm\"\nfrequency_x = \"{frequency} /mm\"\nfrequency_y = \
                 \"{frequency} /mm\""
            ),
        }
    }
}

impl Job {
    fn recipe(&self, compensator: &str, direction: &str) -> String {
        let Self {
            shape,
            nose,
            rim,
            hole,
            residual,
            feed,
        } = self;
        let (aperture, inner, step) = (2.0 * rim, 2.0 * hole, 360.0 / SECTIONS as f64);
        format!(
            r#"format = 1
refine = false
[part]
aperture = "{aperture} mm"
inner = "{inner} mm"
[surface]
{}
[tool]
nose_radius = "{nose} mm"
[tolerance]
interpolation = "1 mm"
residual = "{residual} mm"
[spindle]
speed = "100 rpm"
[path]
direction = "{direction}"
lead = false
[feed]
use = "{feed}"
[sampler]
use = "equal-angle"
step = "{step} deg"
[compensator]
use = "{compensator}"
[velocity]
use = "analytic"
"#,
            shape.table()
        )
    }
}

/// Slopes up to 0.6 and hollows down to 1.3 nose radii on all that the nose can reach.
fn polynomial(nose: f64, rim: f64) -> impl Strategy<Value = Shape> {
    let bound = move |i: i32, j: i32| {
        let (degree, far) = (f64::from(i + j), rim + nose);
        let slope = 0.15 / (degree * far.powi(i + j - 1));
        let bend = 0.2 / (nose * degree * (degree - 1.0).max(0.1) * far.powi((i + j - 2).max(0)));
        slope.min(bend)
    };
    let powers = [
        (1, 0),
        (0, 1),
        (2, 0),
        (1, 1),
        (0, 2),
        (3, 0),
        (1, 2),
        (2, 2),
    ];
    let parts = proptest::collection::vec(-1.0..1.0f64, powers.len());
    parts.prop_map(move |parts| {
        let term = |((i, j), part): ((i32, i32), f64)| (i, j, part * bound(i, j));
        Shape::Polynomial(powers.into_iter().zip(parts).map(term).collect())
    })
}

fn array(nose: f64) -> impl Strategy<Value = Shape> {
    (0.3..1.5f64, 0.2..0.7f64).prop_map(move |(frequency, fit)| {
        let wave = TAU * frequency;
        Shape::Array {
            amplitude: fit / (2.0 * nose * wave * wave),
            frequency,
        }
    })
}

fn job() -> impl Strategy<Value = Job> {
    let sizes = (
        0.2..0.6f64,
        0.3..0.8f64,
        1e-4..4e-4f64,
        prop::bool::ANY,
        0.15..0.5f64,
    );
    let feed = prop_oneof![5 => Just("constant"), 1 => Just("atpg")];
    (sizes, feed).prop_flat_map(|((nose, rim, residual, ring, hole), feed)| {
        let shape = prop_oneof![polynomial(nose, rim), array(nose)];
        shape.prop_map(move |shape| Job {
            shape,
            nose,
            rim,
            hole: if ring { hole * rim } else { 0.0 },
            residual,
            feed,
        })
    })
}

/// The nose at one section: X is signed along the section's line.
#[derive(Debug, Clone, Copy)]
struct Nose {
    x: f64,
    z: f64,
}

/// The part's profile along one line through the axis.
struct Line<'a> {
    shape: &'a Shape,
    sin: f64,
    cos: f64,
}

impl Line<'_> {
    fn height(&self, s: f64) -> f64 {
        self.shape.height(s * self.cos, s * self.sin)
    }

    fn slope(&self, s: f64) -> f64 {
        const STEP: f64 = 1e-5;
        (self.height(s + STEP) - self.height(s - STEP)) / (2.0 * STEP)
    }

    /// How deep the nose goes below the profile, mm.
    fn penetration(&self, nose: Nose, radius: f64) -> f64 {
        let depth = |s: f64| {
            let off = s - nose.x;
            self.height(s) - nose.z + (radius * radius - off * off).max(0.0).sqrt()
        };
        let step = 2.0 * radius / LOOKS as f64;
        let place = |i: usize| nose.x - radius + i as f64 * step;
        let deepest = (0..=LOOKS)
            .max_by(|a, b| depth(place(*a)).total_cmp(&depth(place(*b))))
            .unwrap_or(0);
        let (mut low, mut high) = (place(deepest) - step, place(deepest) + step);
        while high - low > 1e-6 * radius {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if depth(a) < depth(b) {
                low = a
            } else {
                high = b
            }
        }
        depth(0.5 * (low + high))
    }
}

/// (section, X, Z) of each control point on a section.
fn passes(csv: &str) -> Vec<(usize, f64, f64)> {
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
        let turns = numbers[1] / 360.0;
        let at = (turns - turns.floor()) * SECTIONS as f64;
        let on = (at - at.round()).abs() < 1e-6;
        on.then(|| (at.round() as usize % SECTIONS, numbers[2], numbers[3]))
    };
    csv.lines().skip(1).filter_map(row).collect()
}

/// The noses on each line through the axis; sections of its other half count backwards.
fn noses(job: &Job, compensator: &str, csv: &str) -> Vec<Vec<Nose>> {
    let mut lines = vec![Vec::new(); SECTIONS / 2];
    for (section, x, z) in passes(csv) {
        let (line, sign) = match section < SECTIONS / 2 {
            true => (section, 1.0),
            false => (section - SECTIONS / 2, -1.0),
        };
        let mut nose = Nose { x: sign * x, z };
        if compensator == "none" {
            // The path is that of the contact: the nose that cuts there stands on its normal.
            let slope = job.line(line).slope(nose.x);
            let w = (1.0 + slope * slope).sqrt();
            nose = Nose {
                x: nose.x - job.nose * slope / w,
                z: z + job.nose / w,
            };
        }
        lines[line].push(nose);
    }
    lines
}

impl Job {
    fn line(&self, index: usize) -> Line<'_> {
        let (sin, cos) = (TAU * index as f64 / SECTIONS as f64).sin_cos();
        Line {
            shape: &self.shape,
            sin,
            cos,
        }
    }

    /// The largest uncut height within the aperture on a line, along the normal, mm.
    fn uncut(&self, line: &Line<'_>, noses: &[Nose]) -> f64 {
        let place = |i: usize| {
            let s = self.hole + (self.rim - self.hole) * i as f64 / PLACES as f64;
            [-s, s]
        };
        let height = |s: f64| {
            let reached = noses.iter().filter(|nose| (nose.x - s).abs() < self.nose);
            let arc = |nose: &Nose| nose.z - (self.nose * self.nose - (nose.x - s).powi(2)).sqrt();
            let lowest = reached.map(arc).fold(f64::INFINITY, f64::min);
            let slope = line.slope(s);
            (lowest - line.height(s)) / (1.0 + slope * slope).sqrt()
        };
        let all = (0..=PLACES).flat_map(place).map(height);
        all.fold(f64::NEG_INFINITY, f64::max)
    }
}

fn check(job: &Job, compensator: &str, direction: &str) -> TestCaseResult {
    let bench = Bench::with(&job.recipe(compensator, direction));
    let said = bench.line("run recipe.toml -o out");
    prop_assert_eq!(said.status, Some(0), "{}", said);
    let lines = noses(job, compensator, &bench.read("out/toolpath.csv"));
    for (index, noses) in lines.iter().enumerate() {
        let line = job.line(index);
        for nose in noses {
            let depth = line.penetration(*nose, job.nose);
            prop_assert!(
                depth <= DEEPEST,
                "{} nm deep at X = {}",
                depth * 1e6,
                nose.x
            );
        }
        let (uncut, allowed) = (job.uncut(&line, noses), ALLOWED * job.residual);
        prop_assert!(
            uncut <= allowed,
            "{uncut} mm of {allowed} mm are uncut on line {index}"
        );
    }
    Ok(())
}

#[track_caller]
fn check_all(cases: u32, compensator: &str, direction: &str) {
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut runner = TestRunner::new_with_rng(config, rng);
    if let Err(found) = runner.run(&job(), |job| check(&job, compensator, direction)) {
        panic!("{found}");
    }
}

macro_rules! whole_parts {
    ($($name:ident, $long:ident: $compensator:literal, $direction:literal;)*) => {
        $(#[test]
        fn $name() {
            check_all(CASES, $compensator, $direction);
        }

        #[test]
        #[ignore = "takes half a minute; `cargo xtask long` runs it"]
        fn $long() {
            check_all(LONG_CASES, $compensator, $direction);
        })*
    };
}

whole_parts! {
    along_z_inward, long_along_z_inward: "z-direction", "inward";
    along_z_outward, long_along_z_outward: "z-direction", "outward";
    along_the_normal_inward, long_along_the_normal_inward: "normal", "inward";
    along_the_normal_outward, long_along_the_normal_outward: "normal", "outward";
    uncompensated_inward, long_uncompensated_inward: "none", "inward";
    uncompensated_outward, long_uncompensated_outward: "none", "outward";
}
