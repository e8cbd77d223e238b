//! Spindles that change their speed: the time against the fastest constant speed under the same
//! limits, the limits on the path as played, and nodes that need no refinement.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::repository;

/// Limits of X and Z, the same for both machines.
const SLIDES: &str = "[machine]\nx_velocity = \"50 mm/s\"\nz_velocity = \"50 mm/s\"\n\
    x_acceleration = \"500 mm/s^2\"\nz_acceleration = \"500 mm/s^2\"\n\
    x_jerk = \"5e4 mm/s^3\"\nz_jerk = \"2e5 mm/s^3\"\n";

/// What a machine's spindle can do.
#[derive(Clone, Copy)]
struct Spindle {
    rpm: f64,
    acceleration: f64,
    jerk: f64,
}

/// A slow spindle, and a fast one.
const SLOW: Spindle = Spindle {
    rpm: 1000.0,
    acceleration: 100.0,
    jerk: 1000.0,
};
const FAST: Spindle = Spindle {
    rpm: 3000.0,
    acceleration: 1000.0,
    jerk: 5e4,
};

/// A recipe of the documentation with these limits, over the aperture alone, without leads.
struct Case {
    recipe: &'static str,
    spindle: Spindle,
    sampler: &'static str,
}

impl Case {
    fn with_atpg(recipe: &'static str, spindle: Spindle) -> Self {
        Self {
            recipe,
            spindle,
            sampler: "atpg",
        }
    }

    /// The recipe with this table `[spindle]`.
    fn recipe(&self, spindle: &str) -> String {
        let file = format!("docs/recipes/{}.toml", self.recipe);
        let text = std::fs::read_to_string(repository().join(file)).unwrap();
        let (head, _) = text.split_once("[spindle]").unwrap();
        let Spindle {
            rpm,
            acceleration,
            jerk,
        } = self.spindle;
        format!(
            "{head}[spindle]\n{spindle}\n\n{SLIDES}c_velocity = \"{rpm} rpm\"\n\
             c_acceleration = \"{acceleration} rad/s^2\"\nc_jerk = \"{jerk} rad/s^3\"\n\n\
             [path]\noverrun = \"none\"\nlead = false\n\n[feed]\nuse = \"atpg\"\n\n\
             [sampler]\nuse = \"{}\"\nmax_step = \"45 deg\"\n\n[compensator]\n\
             use = \"z-direction\"\n\n[velocity]\nuse = \"analytic\"\n\n[output]\ndata = []\n",
            self.sampler
        )
    }

    /// The summary of a run, whose status may be that of a limit that does not hold.
    fn run(&self, spindle: &str) -> Value {
        let bench = Bench::with(&self.recipe(spindle));
        let said = bench.line("run recipe.toml -o out --format json --set refine=false");
        assert!(matches!(said.status, Some(0 | 1)), "{said}");
        said.json()
    }

    /// The path of the fastest constant speed under the limits.
    fn fastest_constant(&self) -> Value {
        let Spindle { rpm, .. } = self.spindle;
        let first = self.run(&format!("speed = \"{rpm} rpm\""));
        let highest = number(&first, "/highest_spindle/speed_rpm").min(rpm);
        let fastest = self.run(&format!("speed = \"{} rpm\"", (1.0 - 1e-9) * highest));
        assert_eq!(fastest["within"]["machine"], true);
        fastest
    }

    fn per_revolution(&self) -> Value {
        self.run(&format!(
            "use = \"per-revolution\"\nspeed = \"{} rpm\"",
            self.spindle.rpm
        ))
    }

    /// Holds the schedule to this part of the fastest constant speed's time, to every limit, and its
    /// nodes, which nothing refines, to the tolerance.
    fn takes_at_most(&self, part: f64) {
        let (constant, changing) = (self.fastest_constant(), self.per_revolution());
        let of = |pointer: &str| [&constant, &changing].map(|summary| number(summary, pointer));
        let [slow, fast] = of("/cutting_time_s");
        assert!(fast <= part * slow, "{fast} s of {slow} s");
        let [before, after] = of("/control_points");
        assert!((after / before - 1.0).abs() < 0.005, "{before}, {after}");
        let [_, error] = of("/interpolation_error/max_nm");
        let tolerance = number(&changing, "/tolerance/interpolation_nm");
        assert!(error <= 1.001 * tolerance, "{error} nm of {tolerance} nm");
        for limit in changing["machine"]["limits"].as_array().unwrap() {
            assert_eq!(limit["holds"], true, "{limit}");
        }
    }
}

fn number(value: &Value, pointer: &str) -> f64 {
    let found = value.pointer(pointer).and_then(Value::as_f64);
    found.unwrap_or_else(|| panic!("no number at {pointer} of {value}"))
}

const SADDLE: &str = "astigmatic-5mm";
const ARRAY: &str = "sinusoidal-array-10mm";

#[test]
fn small_parts_take_half_the_time_of_a_constant_speed() {
    for recipe in [SADDLE, ARRAY] {
        for spindle in [SLOW, FAST] {
            Case::with_atpg(recipe, spindle).takes_at_most(0.54);
        }
    }
}

/// Nodes that take the whole tolerance as played: they are placed for the schedule that is played, and
/// not for the first one, at which errors were a tenth larger.
#[test]
fn the_fewest_points_hold_the_tolerance_at_the_speed_that_is_played() {
    for spindle in [SLOW, FAST] {
        let sampler = "minimax";
        let recipe = SADDLE;
        let case = Case {
            recipe,
            spindle,
            sampler,
        };
        case.takes_at_most(0.54);
    }
}

/// With these jerks of C longer changes of the speed pay, or none at all.
#[test]
fn no_schedule_takes_longer_than_the_fastest_constant_speed() {
    for (recipe, jerk, part) in [
        (SADDLE, 10.0, 0.62),
        (ARRAY, 10.0, 0.64),
        (ARRAY, 0.1, 1.001),
        (ARRAY, 1e-3, 1.001),
    ] {
        let spindle = Spindle { jerk, ..SLOW };
        Case::with_atpg(recipe, spindle).takes_at_most(part);
    }
}

/// `speed` is a bound and nothing else. However far beyond the limits it is, they hold.
#[test]
fn a_speed_far_beyond_the_limits_gives_a_schedule_within_them() {
    let case = Case::with_atpg("astigmatic-50mm", SLOW);
    let gentle = "[machine]\nz_acceleration = \"50 mm/s^2\"\n";
    let spindle = "use = \"per-revolution\"\nspeed = \"1e6 rpm\"";
    let recipe = case.recipe(spindle).replace(SLIDES, gentle);
    let recipe = recipe.replace("c_velocity = \"1000 rpm\"\n", "");
    let said = Bench::with(&recipe).line("run recipe.toml -o out --format json");
    let found = said.ends(0).json();
    assert_eq!(found["within"]["machine"], true);
}

/// Refinement adds points to this chain after the schedule was made, and they ask more of Z.
#[test]
fn limits_hold_with_the_points_that_refinement_adds() {
    let recipe = "format = 1\nname = \"Ring of a torus\"\n\n[part]\naperture = \"9.878 mm\"\n\
        inner = \"0.508 mm\"\n\n[surface]\nuse = \"toric\"\nradius_rotation = \"37.872 mm\"\n\
        radius_base = \"68.458 mm\"\n\n[tool]\nnose_radius = \"0.355 mm\"\n\n[compensator]\n\
        use = \"normal\"\n\n[tolerance]\ninterpolation = \"560 nm\"\nresidual = \"452 nm\"\n\n\
        [spindle]\nuse = \"per-revolution\"\nspeed = \"230 rpm\"\n\n[machine]\n\
        c_acceleration = \"14.13 rad/s^2\"\nz_acceleration = \"9.27 mm/s^2\"\n\n[path]\n\
        direction = \"outward\"\n\n[feed]\nuse = \"fft-adaptive\"\n\n[sampler]\nuse = \"atpg\"\n\n\
        [velocity]\nuse = \"analytic\"\n\n[output]\ndata = []\n";
    let found = Bench::with(recipe).line("run recipe.toml -o out --format json");
    let found = found.ends(0).json();
    assert!(number(&found, "/points_added_by_refine") > 100.0);
    assert_eq!(found["within"]["machine"], true);
}

/// Under the first limits the flat part runs at the spindle's own largest speed all along.
#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_large_parts_take_no_more_time_than_published_schedules() {
    let bounds = [
        ("astigmatic-50mm", SLOW, 1.0 + 1e-8),
        ("astigmatic-50mm", FAST, 0.78),
        ("off-axis-paraboloid-213mm", SLOW, 0.515),
        ("off-axis-paraboloid-213mm", FAST, 0.515),
    ];
    for (recipe, spindle, part) in bounds {
        Case::with_atpg(recipe, spindle).takes_at_most(part);
    }
}

/// Where no limit asks for less than the largest speed, the schedule is the constant one, to the
/// byte.
#[test]
fn a_schedule_without_need_is_the_constant_speed() {
    let case = Case::with_atpg(SADDLE, SLOW);
    let table = |spindle: &str| {
        let recipe = case.recipe(&format!("{spindle}speed = \"100 rpm\""));
        let bench = Bench::with(&recipe.replace("data = []", "data = [\"csv\"]"));
        bench.line("run recipe.toml -o out").ends(0);
        bench.read("out/toolpath.csv")
    };
    assert!(table("use = \"per-revolution\"\n") == table(""));
}

/// The cutting speed is the one asked for, to a thousandth below, wherever neither the lowest speed
/// of the spindle nor the largest ends it. Nothing but the lowest speed makes it larger.
#[test]
fn the_cutting_speed_is_the_one_asked_for() {
    let case = Case::with_atpg(SADDLE, FAST);
    let run = |lowest: f64| {
        case.run(&format!(
            "use = \"surface-speed\"\nspeed = \"600 rpm\"\nlowest = \"{lowest} rpm\"\n\
             cutting_speed = \"0.6 m/min\""
        ))
    };
    let [free, bound] = [run(30.0), run(60.0)];
    for summary in [&free, &bound] {
        assert_eq!(summary["within"]["machine"], true);
        let largest = number(summary, "/cutting_speed/spindle_most_rpm");
        assert!((599.0..=600.000001).contains(&largest), "{largest}");
    }
    let [mean, most] =
        ["mean", "most"].map(|which| number(&free, &format!("/cutting_speed/{which}_mm_per_s")));
    // The mean has the middle of the part, where the spindle is at its largest speed.
    assert!((9.99..=10.0 * (1.0 + 1e-6)).contains(&most), "{most}");
    assert!((9.0..most).contains(&mean), "{mean}");
    let least = |summary| number(summary, "/cutting_speed/spindle_least_rpm");
    let at_rim = 60.0 * 10.0 / (std::f64::consts::TAU * 2.5);
    assert!(
        (least(&free) / at_rim - 1.0).abs() < 0.01,
        "{}",
        least(&free)
    );
    // The limits of C slow the whole schedule down by a little, and go before `lowest`.
    assert!(
        (59.94..=60.001).contains(&least(&bound)),
        "{}",
        least(&bound)
    );
}

/// With leads and a program: the whole path keeps to the limits, the file is as the recipe gives it,
/// and the program too.
#[test]
fn leads_and_programs_follow_a_changing_speed() {
    let case = Case::with_atpg(SADDLE, SLOW);
    let spindle = format!("use = \"per-revolution\"\nspeed = \"{} rpm\"", SLOW.rpm);
    for direction in ["inward", "outward"] {
        let recipe = case.recipe(&spindle).replace(
            "overrun = \"none\"\nlead = false",
            &format!("direction = \"{direction}\""),
        );
        let outputs = "posts = [\"pmac-pvt\"]\ndata = [\"csv\"]";
        let bench = Bench::with(&recipe.replace("data = []", outputs));
        let made = bench.line("run recipe.toml -o out --format json").ends(0);
        let made = made.json();
        assert_eq!(made["within"]["machine"], true);
        let of_lead = made["lead"]["limits"].as_array().unwrap();
        assert!(
            of_lead.iter().all(|limit| limit["holds"] == true),
            "{of_lead:?}"
        );
        let verify = "verify recipe.toml out/toolpath.csv --format json";
        let read = bench.line(verify).ends(0).json();
        assert_eq!(read["anomalies"]["count"], 0);
        let [from_file, from_path] =
            [&read, &made].map(|summary| number(summary, "/cutting_speed/mean_mm_per_s"));
        assert!(
            (from_file / from_path - 1.0).abs() < 1e-9,
            "{from_file}, {from_path}"
        );
        let [from_file, from_path] =
            [&read, &made].map(|summary| number(summary, "/highest_spindle/speed_rpm"));
        assert!(
            (from_file / from_path - 1.0).abs() < 1e-9,
            "{from_file}, {from_path}"
        );
        let checked = bench.line("check recipe.toml --format json").ends(0).json();
        let [expected, found] = [
            number(&checked, "/expected/cutting_time_s"),
            number(&made, "/cutting_time_s"),
        ];
        assert!((expected / found - 1.0).abs() < 1e-3, "{expected}, {found}");
    }
}

/// `highest_spindle` is a speed at which the same schedule holds all limits, and it cannot be faster.
#[test]
fn a_schedule_reaches_its_limits() {
    let case = Case::with_atpg(SADDLE, SLOW);
    let summary = case.per_revolution();
    let highest = number(&summary, "/highest_spindle/speed_rpm");
    let largest = number(&summary, "/cutting_speed/spindle_most_rpm");
    assert!(
        (highest / largest - 1.0).abs() < 1e-3,
        "{highest}, {largest}"
    );
}
