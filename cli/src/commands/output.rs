//! `-`, which stands for standard output where a command gives one text.

use std::path::Path;

use crate::failure::Failure;

/// Whether an answer goes to standard output.
pub fn is_standard(output: &Path) -> bool {
    output.as_os_str() == "-"
}

/// Refuses standard output for an option of a command that prints a report there.
pub fn refuse_output(output: Option<&Path>, option: &str) -> Result<(), Failure> {
    match output.is_some_and(is_standard) {
        false => Ok(()),
        true => Err(Failure::Call(format!(
            "`{option} -`: standard output has the report; give a name, or `./-` for one of that name"
        ))),
    }
}
