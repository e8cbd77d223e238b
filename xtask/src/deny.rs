//! `cargo xtask deny`: what `deny.toml` allows of dependencies.

use crate::commands::{cargo, run, succeeds};
use crate::step::{Outcome, Step};

/// Advisories come from the network; the other checks need none.
const CHECKS: [&str; 3] = ["licenses", "bans", "sources"];

/// Checks licences, bans and sources, and advisories where their database can be fetched.
pub fn run_checks() -> Vec<Step> {
    if !succeeds(cargo(&["deny", "--version"])) {
        return vec![Step::run("deny", || {
            Outcome::Skipped(
                "cargo-deny is not installed: `cargo install cargo-deny --locked`".to_owned(),
            )
        })];
    }
    let call = |checks: &[&str]| cargo(&[&["deny", "--locked", "check"], checks].concat());
    vec![
        Step::run("deny", || run(call(&CHECKS))),
        Step::run("deny, advisories", || {
            if succeeds(cargo(&["deny", "fetch", "db"])) {
                run(call(&["advisories"]))
            } else {
                Outcome::Skipped("the advisory database cannot be fetched".to_owned())
            }
        }),
    ]
}
