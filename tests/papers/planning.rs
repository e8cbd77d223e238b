//! What the fewest points and the least time cost: processor time to plan them, on AST-50.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::support::bench::Bench;
use crate::support::repository;
use serde_json::Value;

/// Changes that all variants of AST-50 have. The schedule is one that changes the speed: the machine has
/// a fast spindle, and at its largest speed Z would accelerate too much.
const SETS: [&str; 5] = [
    "path.lead=false",
    "path.overrun=none",
    "spindle.speed=3000 rpm",
    "machine={ c_acceleration = \"1000 rad/s^2\", c_jerk = \"5e4 rad/s^3\", z_acceleration = \
     \"500 mm/s^2\", z_jerk = \"2e5 mm/s^3\" }",
    "ablation.spindle=[{ use = \"per-revolution\", speed = \"3000 rpm\" }]",
];
/// How many times the processor time of `atpg` seven states may take, and how many times that of a
/// constant speed a schedule may.
const SEVEN_STATES: f64 = 3.0;
const SCHEDULE: f64 = 2.0;
/// The fastest of so many rounds counts: other work on the machine makes a round slower, and none
/// faster.
const ROUNDS: usize = 3;

/// The processor time to make the path of a chain, in the fastest round.
fn processor_time(rounds: &[Value], sampler: &str, spindle: &str) -> f64 {
    let time = |ablation: &Value| {
        let runs = ablation["runs"].as_array().unwrap();
        let is_it =
            |run: &&Value| run["chain"]["sampler"] == sampler && run["chain"]["spindle"] == spindle;
        let run = runs.iter().find(is_it).unwrap();
        run["planning_time_s"].as_f64().unwrap()
    };
    rounds.iter().map(time).fold(f64::INFINITY, f64::min)
}

/// The ablation of docs/fewest-points.md.
fn times_are_within_the_bounds(max_step: &str) {
    let recipe = repository().join("docs/recipes/astigmatic-50mm.toml");
    let fixed = ["ablate", recipe.to_str().unwrap(), "-o"];
    let one = ["--threads", "1", "--columns", "points,time,planning-time"];
    let steps = format!("sampler.max_step={max_step}");
    let other = format!("ablation.sampler=[{{ use = \"minimax\", max_step = \"{max_step}\" }}]");
    let of_steps = [steps.as_str(), other.as_str()];
    let set = SETS.into_iter().chain(of_steps);
    let set = set.flat_map(|set| ["--set", set]);
    let bench = Bench::empty();
    let changes: Vec<&str> = one.into_iter().chain(set).collect();
    let round = |number: usize| -> Value {
        let folder = format!("round-{number}");
        let words = fixed.into_iter().chain([folder.as_str()]);
        let said = bench.call(words.chain(changes.iter().copied())).ends(0);
        println!("{said}");
        serde_json::from_str(&bench.read(format!("{folder}/ablation.json"))).unwrap()
    };
    let rounds: Vec<Value> = (0..ROUNDS).map(round).collect();
    let [atpg, minimax] = ["atpg", "minimax"].map(|sampler| {
        let [constant, changing] =
            ["constant", "per-revolution"].map(|spindle| processor_time(&rounds, sampler, spindle));
        let schedule = changing / constant;
        assert!(
            schedule <= SCHEDULE,
            "a schedule with {sampler} at {max_step}: {schedule}"
        );
        constant
    });
    let states = minimax / atpg;
    assert!(
        states <= SEVEN_STATES,
        "seven states at {max_step}: {states}"
    );
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_seven_states_take_thrice_the_time_of_atpg_at_most_and_a_schedule_twice() {
    for max_step in ["90 deg", "45 deg"] {
        times_are_within_the_bounds(max_step);
    }
}
