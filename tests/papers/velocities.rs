//! Whole runs of every velocity solver, against published and independently computed figures.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;

use crate::support::bench::{Answer, Bench};
use crate::support::recipe::{SADDLE, changed, with_table};
use serde_json::Value;

/// The saddle z = kρ² sin 2θ, without what the tests choose: no refinement, no step of its own,
/// exact rates, no angles of the tool. With 40 mm and 0.0015 /mm it stands in for the third
/// paper's toric surface, whose radii are not given.
fn recipe() -> String {
    let plain = changed(SADDLE, "name =", "refine = false\nname =");
    let plain = with_table(&plain, "tool", "nose_radius = \"1 mm\"");
    let plain = with_table(&plain, "sampler", "use = \"equal-angle\"");
    with_table(&plain, "velocity", "use = \"analytic\"")
}

/// 1000 points inward from the rim: 999 steps of 5 deg are 0.69375 mm of the radius.
const TORIC: &[&str] = &[
    "part.aperture=40 mm",
    "part.inner=38.6125 mm",
    "surface.k=0.0015 /mm",
    "feed.feed=0.05 mm",
    "sampler.step=5 deg",
    "compensator.use=none",
];

/// The array sin sin of 0.05 mm, radius 10 mm: 999 steps of 1 deg are 0.13875 mm of the radius.
const ARRAY: &[&str] = &[
    "part.aperture=20 mm",
    "part.inner=19.7225 mm",
    "surface={ use = \"sinusoidal-array\", form = \"product\", amplitude_x = \"0.05 mm\", \
     frequency_x = \"1 /mm\", frequency_y = \"1 /mm\" }",
    "tool.nose_radius=0.1 mm",
    "feed.feed=0.05 mm",
    "sampler.step=1 deg",
    "compensator.use=none",
];

const TWO_THIRDS: &str = "velocity={ use = \"area\", c = 0.6666666666666666 }";
const HALF: &str = "velocity={ use = \"area\", c = 0.5 }";
const THREE_POINT: &str = "velocity.use=three-point";
const TRIANGLE_ROTARY: &str = "velocity.use=triangle-rotary";
const NATURAL: &str = "velocity={ use = \"triangle-rotary\", ends = \"natural\" }";
const ANALYTIC: &str = "velocity.use=analytic";
const LINEAR: &str = "velocity.use=linear";

/// A folder with the recipe.
struct RecipeFolder(Bench);

impl RecipeFolder {
    fn new() -> Self {
        Self(Bench::with(&recipe()))
    }

    fn call(&self, command: &[&str], set: &[&str]) -> Answer {
        let set = set.iter().flat_map(|set| ["--set", *set]);
        self.0.call(command.iter().copied().chain(set))
    }

    /// Runs the recipe; gives the exit status and the summary.
    fn run(&self, set: &[&str]) -> (i32, Value) {
        let command = ["run", "recipe.toml", "-o", "out", "--format", "json"];
        let said = self.call(&command, set);
        (said.status.unwrap(), said.json())
    }

    /// The report of `turnpath verify` on the path that the last run wrote.
    fn verify(&self, set: &[&str]) -> Value {
        let file = "out/toolpath.csv";
        let command = ["verify", "recipe.toml", file, "--format", "json"];
        self.call(&command, set).json()
    }
}

fn error_nm(summary: &Value) -> f64 {
    summary["interpolation_error"]["max_nm"].as_f64().unwrap()
}

fn points(summary: &Value) -> u64 {
    summary["control_points"].as_u64().unwrap()
}

/// Each solver's largest error, nm, to `within`.
fn assert_errors(base: &[&str], count: u64, within: f64, expected: &[(&str, f64)]) {
    let folder = RecipeFolder::new();
    for (velocity, expected) in expected {
        let (_, summary) = folder.run(&[base, &[*velocity]].concat());
        assert_eq!(points(&summary), count, "{velocity}");
        let found = error_nm(&summary);
        let off = (found / expected - 1.0).abs();
        assert!(off < within, "{velocity}: {found:.3} nm for {expected}");
    }
}

/// Published: 0.15, 0.3, 0.06 and 0.0015 µm on a toric surface of unknown radii. Three-point with
/// exact rates at both ends, where it is worst; without them, 51 nm (see the plugin's own test).
#[test]
fn toric_stand_in_of_the_third_paper() {
    let expected = [
        (HALF, 79.0),
        (TWO_THIRDS, 297.0),
        (THREE_POINT, 77.0),
        (TRIANGLE_ROTARY, 1.45),
        (NATURAL, 840.0),
    ];
    assert_errors(TORIC, 1000, 0.05, &expected);
}

/// Published: 1.5, 1.9, 1.8 and 0.37 µm on an array of unknown amplitude.
#[test]
fn sinusoidal_array_of_the_third_paper() {
    let expected = [
        (HALF, 1430.0),
        (TWO_THIRDS, 2390.0),
        (THREE_POINT, 2440.0),
        (TRIANGLE_ROTARY, 540.0),
        (ANALYTIC, 310.0),
    ];
    assert_errors(ARRAY, 1000, 0.05, &expected);
}

/// The conventional path of Zhong et al. on straight segments, a feed of 10 µm: 58 nm published for
/// 256 points a revolution. On a crest at ρ = 5 mm a chord of Δθ errs by A(2πf)²(ρΔθ)²/8, 59.45 nm,
/// where it lies across it, as some do with 254 points; with 256 they end there, and the largest
/// error is 58.626 nm, as computed independently. No cubic comes near that.
#[test]
fn conventional_path_of_the_lens_array_on_straight_segments() {
    let array = |step: &'static str| {
        [
            "part.aperture=10 mm",
            "surface={ use = \"sinusoidal-array\", form = \"sum\", amplitude_x = \"5 um\", \
             frequency_x = \"0.4 /mm\", frequency_y = \"0.4 /mm\" }",
            "feed.feed=10 um",
            step,
            "compensator.use=none",
        ]
    };
    let conventional = array("sampler.step=1.40625 deg");
    assert_errors(&conventional, 128_001, 5e-5, &[(LINEAR, 58.626)]);
    let across = |steps: f64| {
        let phase = TAU * 0.4 * 5.0 * TAU / steps;
        5e3 * phase * phase / 8.0
    };
    assert!((across(256.0) - 59.45).abs() < 0.005);
    let step = "sampler.step=1.4173228346456694 deg";
    assert_errors(&array(step), 127_001, 3e-3, &[(LINEAR, across(254.0))]);
    let folder = RecipeFolder::new();
    let (_, straight) = folder.run(&[&conventional[..], &[LINEAR]].concat());
    let at = &straight["interpolation_error"]["at"]["x_mm"];
    assert!(at.as_f64().unwrap() > 4.95, "{at}");
    assert!(error_nm(&folder.run(&conventional).1) < 0.2);
}

/// Wang et al.: the smallest residual feed makes 101.11 revolutions; the 101 whole ones at 6 deg are
/// their 6061 points, 98 at 9 deg are 3921 with both ends (3920 published).
#[test]
fn conventional_spirals_of_the_first_paper() {
    let folder = RecipeFolder::new();
    let contact = "compensator.use=none";
    let (_, derived) = folder.run(&[contact, "sampler.step=6 deg"]);
    let revolutions = derived["revolutions"].as_f64().unwrap();
    assert!((revolutions - 101.11).abs() < 0.02, "{revolutions}");
    for (turns, step, count) in [(101.0, "6 deg", 6061), (98.0, "9 deg", 3921)] {
        let feed = format!("feed.feed={} mm", 2.5 / turns);
        let step = format!("sampler.step={step}");
        let (_, summary) = folder.run(&[contact, &feed, &step]);
        assert_eq!(points(&summary), count);
    }
}

/// A derived step with exact velocities leaves refinement nothing to do, and wastes little.
#[test]
fn the_derived_step_holds_the_tolerance_as_played() {
    let folder = RecipeFolder::new();
    for compensator in ["z-direction", "normal", "none"] {
        let compensator = format!("compensator.use={compensator}");
        let (status, summary) = folder.run(&[&compensator, "refine=true", ANALYTIC]);
        assert_eq!(status, 0);
        assert_eq!(summary["points_added_by_refine"], 0, "{compensator}");
        let error = error_nm(&summary);
        assert!((94.0..98.0).contains(&error), "{compensator}: {error}");
    }
}

/// Every solver holds 100 nm once refined, both from a derived step and from the largest; if
/// the area method with ½ does not, the run reports it with the place.
#[test]
fn every_solver_holds_the_tolerance_or_says_where_not() {
    let folder = RecipeFolder::new();
    for velocity in [
        ANALYTIC,
        TRIANGLE_ROTARY,
        NATURAL,
        THREE_POINT,
        TWO_THIRDS,
        HALF,
        LINEAR,
    ] {
        for step in [None, Some("sampler.step=45 deg")] {
            let set: Vec<&str> = ["refine=true", velocity].into_iter().chain(step).collect();
            let (status, summary) = folder.run(&set);
            let holds = error_nm(&summary) <= 100.1;
            assert_eq!(summary["within"]["interpolation"], holds);
            assert_eq!(status, i32::from(!holds), "{velocity}");
            assert!(
                holds || velocity == HALF,
                "{velocity}: {}",
                error_nm(&summary)
            );
            assert!(summary["interpolation_error"]["at"]["x_mm"].is_f64());
        }
    }
}

/// `verify` measures in the file what the run measured while it made the path. That includes straight
/// segments, which it knows from the recipe alone.
#[test]
fn the_files_are_played_as_the_solver_meant_them() {
    let folder = RecipeFolder::new();
    for velocity in [LINEAR, HALF, THREE_POINT] {
        let set = ["feed.feed=10 um", "refine=true", velocity];
        let (_, run) = folder.run(&set);
        let verified = folder.verify(&set);
        let close = |of: &dyn Fn(&Value) -> &Value| {
            let (run, verified) = (of(&run).as_f64().unwrap(), of(&verified).as_f64().unwrap());
            let off = (run - verified).abs() / run.abs().max(1e-9);
            assert!(
                off < 1e-6,
                "{velocity}: {run} in the run, {verified} in the file"
            );
        };
        close(&|of| &of["interpolation_error"]["max_nm"]);
        close(&|of| &of["axes"]["z"]["max_acceleration_mm_per_s2"]);
        close(&|of| &of["axes"]["z"]["rms_acceleration_mm_per_s2"]);
    }
    let (_, straight) = folder.run(&["refine=true", LINEAR]);
    let as_cubics = folder.verify(&[ANALYTIC]);
    let ratio = error_nm(&as_cubics) / error_nm(&straight);
    assert!((ratio - 1.0).abs() > 0.1, "{ratio}");
}

/// Blocks of 64 revolutions: the area method's state goes on from one to the next.
#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_count_of_threads_does_not_show() {
    let folder = RecipeFolder::new();
    for velocity in [HALF, TWO_THIRDS, THREE_POINT, LINEAR] {
        let file = |threads: &str| {
            let command = ["run", "recipe.toml", "-o", threads, "--threads", threads];
            let set = ["feed.feed=8 um", "refine=true", velocity];
            folder.call(&command, &set);
            folder.0.read(format!("{threads}/toolpath.csv"))
        };
        assert!(file("1") == file("3"), "{velocity}");
    }
}

#[test]
fn an_unstable_area_share_is_refused_with_the_reason() {
    let folder = RecipeFolder::new();
    let said = folder.call(
        &["run", "recipe.toml"],
        &["velocity={ use = \"area\", c = 0.4 }"],
    );
    assert_eq!(said.status, Some(2));
    insta::assert_snapshot!(said.stderr, @r#"
    error: the velocity solver `area` cannot work with this: c = 0.4 is unstable: an error of velocity grows from point to point, by |1 − 1/c| = 1.500; choose 0.5 to 1
     --> --set:1:30
      |
    1 | velocity={ use = "area", c = 0.4 }
      |                              ^^^ `c`
    "#);
}
