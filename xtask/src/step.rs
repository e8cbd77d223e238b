//! A step of a command, and how it ended.

use std::process::ExitCode;

/// How a step ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    Passed,
    /// The tool or package that the step needs is not installed.
    Skipped(String),
    Failed(String),
}

/// A step that was tried.
pub struct Step {
    pub name: String,
    pub outcome: Outcome,
}

impl Step {
    /// Announces a step, runs it and keeps how it ended.
    pub fn run(name: impl Into<String>, body: impl FnOnce() -> Outcome) -> Self {
        let name = name.into();
        println!("== {name}");
        let outcome = body();
        Self { name, outcome }
    }
}

/// Prints how each step ended. The status is a failure if one step failed.
pub fn report(steps: &[Step]) -> ExitCode {
    println!();
    for step in steps {
        match &step.outcome {
            Outcome::Passed => println!("passed   {}", step.name),
            Outcome::Skipped(reason) => println!("skipped  {}: {reason}", step.name),
            Outcome::Failed(reason) => println!("FAILED   {}: {reason}", step.name),
        }
    }
    let failed = |step: &Step| matches!(step.outcome, Outcome::Failed(_));
    ExitCode::from(u8::from(steps.iter().any(failed)))
}
