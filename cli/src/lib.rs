//! The command line of turnpath: arguments, printing, progress and colours. What a command means
//! lives in the library `turnpath`.
//!
//! [`main_with`] is the whole program for arguments and strategies of one's own:
//!
//! ```
//! use turnpath::Catalogue;
//! let status = turnpath_cli::main_with(["turnpath", "list", "sampler"], Catalogue::linked());
//! assert_eq!(status, std::process::ExitCode::SUCCESS);
//! ```

mod args;
mod background;
mod commands;
mod crash;
mod failure;
mod memory;
mod message;
mod print;
mod progress;
mod signals;
mod trial;
mod width;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use turnpath::{Catalogue, LoadError};

use args::{Command, Program};
use failure::Failure;

pub use memory::keep_memory;

/// How a command ended that did what it was asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Status {
    /// All tolerances hold, and all limits of the machine.
    Holds,
    /// A tolerance or a limit of the machine does not hold.
    Exceeded,
}

impl Status {
    fn of(verdict: &turnpath::report::Verdict) -> Self {
        match verdict.holds() {
            true => Self::Holds,
            false => Self::Exceeded,
        }
    }
}

/// What a command gives.
type Outcome = Result<Status, Failure>;

/// Runs the program with these arguments, the program's name first, and with the strategies of
/// this catalogue beside those of plugin folders. Answers on standard output and standard error.
/// Wrong arguments and `--help` end the process. So does an interrupt, after it has removed the files
/// that are not whole.
///
/// This is for the whole of a process, which does nothing before it: the process is started once more
/// to try the libraries of plugins, a plugin that ends it is named, and what else the process
/// prints to standard output, now or later, goes to standard error.
pub fn main_with(
    args: impl IntoIterator<Item = impl Into<OsString> + Clone>,
    catalogue: Result<Catalogue, LoadError>,
) -> ExitCode {
    keep_memory();
    if let Some(status) = trial::child() {
        return status;
    }
    let Program { command } = Program::parse_from(args);
    signals::remove_drafts_on_signals();
    let details = command
        .plugins()
        .is_some_and(|plugins| plugins.layout_details);
    crash::guard();
    let outcome = crash::take_output()
        .map_err(Failure::Output)
        .and_then(|()| catalogue.map_err(Failure::from))
        .and_then(|catalogue| run(&command, catalogue));
    turnpath_files::wait_if_ending();
    match outcome {
        Ok(Status::Holds) => ExitCode::SUCCESS,
        Ok(Status::Exceeded) => ExitCode::from(1),
        Err(failure) => {
            failure.report(details);
            ExitCode::from(failure.status())
        }
    }
}

fn run(command: &Command, catalogue: Catalogue) -> Outcome {
    match command {
        Command::Run(args) => commands::run(args, catalogue),
        Command::Ablate(args) => commands::ablate(args, catalogue),
        Command::Check(args) => commands::check(args, catalogue),
        Command::Verify(args) => commands::verify(args, catalogue),
        Command::Report(args) => commands::report(args, catalogue),
        Command::Sag(args) => commands::sag(args, catalogue),
        Command::Import(args) => commands::import(args),
        Command::List(args) => commands::list(args, catalogue),
        Command::Explain(args) => commands::explain(args, catalogue),
        Command::NewPlugin(args) => commands::new_plugin(args, catalogue),
        Command::Init(args) => commands::init(args),
        Command::Schema(args) => commands::schema(args, catalogue),
        Command::Completions(args) => commands::completions(args),
        Command::Man(args) => commands::man(args),
    }
}
