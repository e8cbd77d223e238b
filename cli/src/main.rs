//! The program `turnpath`: a recipe in, a measured tool path out.

mod ablate;
mod args;
mod check;
mod coverage;
mod explain;
mod failure;
mod figures;
mod files;
mod interference;
mod job;
mod lead;
mod list;
mod machine;
mod plots;
mod plotting;
mod programs;
mod progress;
mod reach;
mod run;
mod sag;
mod servo;
mod strategies;
mod summary;
mod surface_error;
mod suspects;
mod unreached;
mod verify;

// A plugin that nothing names is dropped by the linker.
#[cfg(feature = "built-ins")]
use {
    turnpath_atpg as _, turnpath_ats as _, turnpath_constant as _, turnpath_fft_adaptive as _,
    turnpath_integrated as _, turnpath_nose_radius as _, turnpath_surfaces as _,
    turnpath_triangle_rotary as _,
};

use std::process::ExitCode;

use clap::Parser;

use args::{Command, Program};
use failure::Failure;

/// How a command ended that did what it was asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// All tolerances hold, and all limits of the machine.
    Holds,
    /// A tolerance or a limit of the machine does not hold.
    Exceeded,
}

fn main() -> ExitCode {
    let Program { command } = Program::parse();
    let done = match command {
        Command::Run(args) => run::run(&args),
        Command::Ablate(args) => ablate::ablate(&args),
        Command::Check(args) => check::check(&args),
        Command::Verify(args) => verify::verify(&args),
        Command::Sag(args) => sag::sag(&args),
        Command::List(args) => list::list(&args),
        Command::Explain(args) => explain::explain(&args),
    };
    match done {
        Ok(Verdict::Holds) => ExitCode::SUCCESS,
        Ok(Verdict::Exceeded) => ExitCode::from(1),
        Err(failure) => {
            failure.report();
            ExitCode::from(failure.status())
        }
    }
}

/// What a command gives.
type Done = Result<Verdict, Failure>;
