//! The program `turnpath`.

use std::process::ExitCode;

use turnpath::Catalogue;

fn main() -> ExitCode {
    turnpath_cli::main_with(std::env::args_os(), Catalogue::linked())
}
