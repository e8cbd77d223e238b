//! The runs that the figures need: each is made once, and several run at a time.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::thread;

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::repository;

/// A run: a recipe of docs/recipes, and its changes.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Call {
    pub recipe: String,
    pub set: Vec<String>,
}

/// The summaries of all runs.
pub struct Runs(BTreeMap<Call, Value>);

impl Runs {
    /// Makes all runs, each once.
    pub fn of(mut calls: Vec<Call>) -> Self {
        calls.sort();
        calls.dedup();
        // The list is taken from its end: large parts first.
        calls.sort_by_key(|call| call.recipe.starts_with("off-axis"));
        let (left, made) = (Mutex::new(calls), Mutex::new(BTreeMap::new()));
        let workers = thread::available_parallelism().map_or(1, usize::from);
        thread::scope(|scope| {
            for _ in 0..workers {
                scope.spawn(|| {
                    while let Some(call) = next(&left) {
                        let summary = call.summary();
                        made.lock().unwrap().insert(call, summary);
                    }
                });
            }
        });
        Self(made.into_inner().unwrap())
    }

    /// A figure of a run's summary.
    pub fn figure(&self, call: &Call, pointer: &str) -> f64 {
        let summary = &self.0[call];
        let figure = summary.pointer(pointer).and_then(Value::as_f64);
        figure.unwrap_or_else(|| panic!("{} {:?}: no {pointer}", call.recipe, call.set))
    }
}

fn next(left: &Mutex<Vec<Call>>) -> Option<Call> {
    left.lock().unwrap().pop()
}

impl Call {
    /// Runs the program on one thread; a tolerance that does not hold is a finding.
    fn summary(&self) -> Value {
        let recipes = repository().join("docs/recipes");
        let recipe = recipes.join(format!("{}.toml", self.recipe));
        let fixed = ["run", recipe.to_str().unwrap(), "--format", "json"];
        let fixed = fixed.into_iter().chain(["--threads", "1"]);
        let set = self.set.iter().flat_map(|set| ["--set", set.as_str()]);
        let said = Bench::empty().call(fixed.chain(set));
        assert!(matches!(said.status, Some(0 | 1)), "{:?}\n{said}", self.set);
        said.json()
    }
}
