//! `turnpath man`: the manual pages.

use std::fs;

use clap::CommandFactory;
use turnpath::FileError;

use crate::args::{ManArgs, Program};
use crate::{Outcome, Status};

/// Writes a page for the program and one for each command.
pub fn man(args: &ManArgs) -> Outcome {
    let written = fs::create_dir_all(&args.folder)
        .and_then(|()| clap_mangen::generate_to(Program::command(), &args.folder));
    written.map_err(|error| FileError {
        path: args.folder.clone(),
        error,
    })?;
    Ok(Status::Holds)
}
