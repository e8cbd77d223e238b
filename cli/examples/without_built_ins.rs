//! The program with a catalogue of one's own: this one is empty, so every strategy comes from a
//! plugin folder.
//!
//! ```text
//! cargo run -p turnpath-cli --example without_built_ins -- list --plugin-dir FOLDER
//! ```

use std::process::ExitCode;

use turnpath::Catalogue;

fn main() -> ExitCode {
    turnpath_cli::main_with(std::env::args_os(), Ok(Catalogue::new()))
}
