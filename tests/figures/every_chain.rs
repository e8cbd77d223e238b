//! Every chain of built-in feeds, samplers, compensators and velocity solvers, on the middle of
//! AST-5 and MLA-5 with their tolerances: each holds after refinement, or reports that it does not.
//!
//! Refinement holds the error along z at the played X, and X's own error to what the residual
//! leaves it. One solver is exempt: `area` with c = 1/2, whose errors do not die away. With `normal`
//! compensation, where X follows the slope, it may leave cusps beyond the residual, and reports them.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::support::bench::{Answer, Bench};

const FEEDS: [&str; 4] = ["constant", "atpg", "ats", "fft-adaptive"];
const SAMPLERS: [&str; 6] = [
    "use = \"equal-angle\"",
    "use = \"equal-arc\"\nspacing = \"50 um\"",
    "use = \"integrated\"\nspacing = \"50 um\"",
    "use = \"atpg\"",
    "use = \"ats\"",
    "use = \"fft-adaptive\"",
];
/// A sampler that needs exact rates, and the one solver here that gives them.
const FEWEST_POINTS: &str = "use = \"minimax\"";
const EXACT: &str = SOLVERS[0];
const COMPENSATORS: [&str; 3] = ["z-direction", "normal", "none"];
const SOLVERS: [&str; 6] = [
    "use = \"analytic\"",
    "use = \"triangle-rotary\"",
    "use = \"three-point\"",
    "use = \"area\"\nc = 0.6666666666666666",
    "use = \"area\"\nc = 0.5",
    "use = \"linear\"",
];

/// The middle of a part: as much of it as some hundreds of runs can afford.
struct Part {
    recipe: &'static str,
    aperture: &'static str,
}

const PARTS: [Part; 2] = [
    Part {
        recipe: include_str!("../../docs/recipes/astigmatic-5mm.toml"),
        aperture: "1.2 mm",
    },
    Part {
        recipe: include_str!("../../docs/recipes/sinusoidal-array-10mm.toml"),
        aperture: "1.6 mm",
    },
];

/// The spindle of both parts.
const SPEED: &str = "[spindle]\nspeed = \"500 rpm\"\n\n";
/// A spindle that the limits of a machine slow down, from some 150 rpm at the rims to 1200 rpm. A
/// limit that a rough chain exceeds is no complaint here.
const CHANGING: &str = "[spindle]\nuse = \"per-revolution\"\nspeed = \"1200 rpm\"\n\n[machine]\n\
    z_acceleration = \"50 mm/s^2\"\nc_acceleration = \"400 rad/s^2\"\n\n";

#[derive(Debug, Clone, Copy)]
struct Chain {
    /// Whether the spindle changes its speed, as the limits of a machine ask.
    changes_speed: bool,
    part: usize,
    feed: &'static str,
    sampler: &'static str,
    compensator: &'static str,
    solver: &'static str,
}

impl Chain {
    fn all() -> Vec<Self> {
        let mut chains = Vec::new();
        for part in 0..PARTS.len() {
            for feed in FEEDS {
                for sampler in SAMPLERS {
                    for compensator in COMPENSATORS {
                        chains.extend(SOLVERS.map(|solver| Self {
                            changes_speed: false,
                            part,
                            feed,
                            sampler,
                            compensator,
                            solver,
                        }));
                    }
                }
            }
        }
        chains
    }

    /// All chains of the sampler that needs exact rates.
    fn with_the_fewest_points() -> Vec<Self> {
        let mut chains = Self::all();
        chains.retain(|chain| chain.sampler == SAMPLERS[0] && chain.solver == EXACT);
        for chain in &mut chains {
            chain.sampler = FEWEST_POINTS;
        }
        chains
    }

    /// Whether the chain is in the eighth that every run of the tests tries. The sum of the
    /// positions fixes one part and one feed for every choice of the rest.
    fn is_in_the_eighth(&self) -> bool {
        let place = |names: &[&str], name| names.iter().position(|one| *one == name).unwrap();
        let sum = FEEDS.len() * self.part
            + place(&FEEDS, self.feed)
            + place(&SAMPLERS, self.sampler)
            + place(&COMPENSATORS, self.compensator)
            + place(&SOLVERS, self.solver);
        sum.is_multiple_of(PARTS.len() * FEEDS.len())
    }

    /// Whether the errors of X ring on, however many points there are.
    fn rings(&self) -> bool {
        self.compensator == "normal" && self.solver == SOLVERS[4]
    }

    /// The part's recipe with this chain, over the aperture alone.
    fn recipe(&self) -> String {
        let recipe = PARTS[self.part].recipe;
        let (head, _) = recipe.split_once("[path]").unwrap();
        let Self {
            feed,
            sampler,
            compensator,
            solver,
            ..
        } = self;
        let (head, _) = head.split_once("[spindle]").unwrap();
        let speed = if self.changes_speed { CHANGING } else { SPEED };
        format!(
            "{head}{speed}[path]\noverrun = \"none\"\nlead = false\n\n[feed]\nuse = \"{feed}\"\n\n\
             [sampler]\n{sampler}\n\n[compensator]\nuse = \"{compensator}\"\n\n\
             [velocity]\n{solver}\n\n[output]\ndata = []\n"
        )
    }

    /// The same with a table, and verified: what is not as the recipe gives it.
    fn anomalies(&self, bench: &Bench) -> Option<String> {
        let aperture = PARTS[self.part].aperture.replace(' ', "");
        bench.write("recipe.toml", self.recipe());
        let sets = format!("--set part.aperture={aperture} --set output.data=[\"csv\"]");
        let run = bench.line(&format!("run recipe.toml -o out --threads 1 {sets}"));
        if !matches!(run.status, Some(0 | 1)) {
            return Some(run.to_string());
        }
        let verify = "verify recipe.toml out/toolpath.csv --threads 1 --format json";
        let said = bench.line(&format!("{verify} {sets}"));
        let anomalies = &said.json()["anomalies"];
        let clean = anomalies["count"] == 0 && anomalies["compared_with"] == "recipe";
        (!clean || said.status != run.status).then(|| anomalies.to_string())
    }

    fn run(&self, bench: &Bench) -> Answer {
        let aperture = PARTS[self.part].aperture.replace(' ', "");
        bench.write("recipe.toml", self.recipe());
        bench.line(&format!(
            "run recipe.toml -o out --threads 1 --format json --set part.aperture={aperture}"
        ))
    }
}

/// What is wrong with a chain; none if it does what it should.
fn complaint(chain: &Chain, said: &Answer) -> Option<String> {
    if !matches!(said.status, Some(0 | 1)) {
        return Some(said.to_string());
    }
    let summary = said.json();
    let holds = |what: &str| summary["within"][what] == true;
    let of_machine = !chain.changes_speed || holds("machine");
    let all = holds("interpolation") && holds("residual") && of_machine;
    let reported = (said.status == Some(0)) == all;
    let kept = holds("interpolation") && (holds("residual") || chain.rings());
    (!reported || !kept).then(|| {
        let figures = [
            &summary["interpolation_error"]["max_nm"],
            &summary["residual"]["max_nm"],
        ];
        format!(
            "status {:?}, interpolation and residual {figures:?}",
            said.status
        )
    })
}

/// Runs the chains and complains about all that do what they should not.
fn hold_or_report(chains: &[Chain]) {
    check_all(chains, |chain, bench| complaint(chain, &chain.run(bench)));
}

/// Runs the chains and complains about all whose file is not found to be as the recipe gives it.
fn have_no_anomaly(chains: &[Chain]) {
    check_all(chains, Chain::anomalies);
}

/// Checks the chains in parallel and shows all complaints.
fn check_all(chains: &[Chain], check: impl Fn(&Chain, &Bench) -> Option<String> + Sync) {
    let (next, wrong) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        let bench = Bench::empty();
        while let Some(chain) = chains.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Some(complaint) = check(chain, &bench) {
                wrong
                    .lock()
                    .unwrap()
                    .push(format!("{chain:?}: {complaint}"));
            }
        }
    };
    std::thread::scope(|scope| {
        let workers = std::thread::available_parallelism().map_or(2, usize::from);
        (0..workers).for_each(|_| drop(scope.spawn(work)));
    });
    let wrong = wrong.into_inner().unwrap();
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

/// Every sampler, compensator and velocity solver together, each time with another feed on another
/// part: so every two strategies of two slots are together, and every strategy is on both parts.
#[test]
fn an_eighth_of_all_chains_holds_both_tolerances_or_reports_that_it_does_not() {
    let mut chains = Chain::all();
    chains.retain(Chain::is_in_the_eighth);
    assert_eq!(chains.len(), 6 * 3 * 6);
    let parts_and_feeds = |of: &dyn Fn(&Chain) -> &'static str| {
        let found = chains.iter().map(|one| (of(one), one.part, one.feed));
        found.collect::<BTreeSet<_>>().len()
    };
    assert_eq!(parts_and_feeds(&|one| one.sampler), 6 * 2 * 4);
    assert_eq!(parts_and_feeds(&|one| one.compensator), 3 * 2 * 4);
    assert_eq!(parts_and_feeds(&|one| one.solver), 6 * 2 * 4);
    hold_or_report(&chains);
}

#[test]
#[ignore = "takes more than a minute; `cargo xtask long` runs it"]
fn long_every_chain_holds_both_tolerances_or_reports_that_it_does_not() {
    let chains = Chain::all();
    assert_eq!(chains.len(), 2 * 4 * 6 * 3 * 6);
    hold_or_report(&chains);
}

/// The chains of the list with a spindle that changes its speed.
fn changing(mut chains: Vec<Chain>) -> Vec<Chain> {
    chains
        .iter_mut()
        .for_each(|chain| chain.changes_speed = true);
    chains
}

/// Of the eighth, every sampler and every solver together.
#[test]
fn some_chains_hold_both_tolerances_under_a_changing_speed() {
    let mut chains = Chain::all();
    let place = |names: &[&str], name| names.iter().position(|one| *one == name).unwrap();
    chains.retain(|chain| {
        let sum = place(&SAMPLERS, chain.sampler) + place(&SOLVERS, chain.solver);
        let compensator = place(&COMPENSATORS, chain.compensator);
        chain.is_in_the_eighth() && (sum + compensator).is_multiple_of(6)
    });
    assert_eq!(chains.len(), 6 * 3);
    hold_or_report(&changing(chains));
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_every_chain_holds_both_tolerances_under_a_changing_speed() {
    let chains = Chain::all();
    assert_eq!(chains.len(), 2 * 4 * 6 * 3 * 6);
    hold_or_report(&changing(chains));
}

/// Of the eighth, every sampler and every solver with three others, on both parts.
#[test]
fn the_files_of_some_chains_have_no_anomaly() {
    let mut chains = Chain::all();
    let place = |names: &[&str], name| names.iter().position(|one| *one == name).unwrap();
    chains.retain(|chain| {
        let sampler = place(&SAMPLERS, chain.sampler);
        let solver = place(&SOLVERS, chain.solver);
        let sum = sampler + solver + 2 * place(&COMPENSATORS, chain.compensator);
        chain.is_in_the_eighth() && sum.is_multiple_of(6)
    });
    assert_eq!(chains.len(), 6 * 3);
    let names = |of: fn(&Chain) -> &'static str| chains.iter().map(of).collect::<BTreeSet<_>>();
    assert_eq!(names(|one| one.sampler).len(), 6);
    assert_eq!(names(|one| one.solver).len(), 6);
    have_no_anomaly(&chains);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_the_files_of_all_chains_have_no_anomaly() {
    let chains = Chain::all();
    assert_eq!(chains.len(), 2 * 4 * 6 * 3 * 6);
    have_no_anomaly(&chains);
}

/// Every feed with every compensator, on one part or the other, at a constant speed or at a changing
/// one.
#[test]
fn half_of_the_chains_with_the_fewest_points_hold_both_tolerances() {
    let mut chains = Chain::with_the_fewest_points();
    let place = |names: &[&str], name| names.iter().position(|one| *one == name).unwrap();
    chains.retain_mut(|chain| {
        let feed = place(&FEEDS, chain.feed);
        chain.changes_speed = !feed.is_multiple_of(2);
        (feed + place(&COMPENSATORS, chain.compensator) + chain.part).is_multiple_of(2)
    });
    assert_eq!(chains.len(), 4 * 3);
    hold_or_report(&chains);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_every_chain_with_the_fewest_points_holds_both_tolerances() {
    let chains = Chain::with_the_fewest_points();
    assert_eq!(chains.len(), 2 * 4 * 3);
    hold_or_report(&chains);
    hold_or_report(&changing(chains.clone()));
    have_no_anomaly(&chains);
    have_no_anomaly(&changing(chains));
}
