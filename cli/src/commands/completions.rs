//! `turnpath completions`: what a shell needs to complete the program's words.

use clap::CommandFactory;

use crate::args::{CompletionsArgs, Program};
use crate::print::print;
use crate::{Outcome, Status};

/// Prints the script of a shell.
pub fn completions(args: &CompletionsArgs) -> Outcome {
    let mut command = Program::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(Status::Holds)
}
