//! What can be done about plugins that end the process where there are no signals of Unix: the limit
//! on the time of a call alone. docs/plugins.md says so, under what is not caught.

use std::io::{self, IsTerminal, Stdin, Stdout, Write};

/// The exit status of a plugin that failed.
const PLUGIN_FAILED: i32 = 3;

/// Standard output stays where it is.
///
/// # Errors
/// None.
pub fn take_output() -> io::Result<()> {
    Ok(())
}

/// Standard input, which stays where it is.
///
/// # Errors
/// None.
pub fn take_input() -> io::Result<Stdin> {
    Ok(io::stdin())
}

/// Writes an answer to standard output.
///
/// # Errors
/// Those of writing.
pub fn answer_to(text: &[u8]) -> io::Result<()> {
    let mut output = io::stdout();
    output.write_all(text)?;
    output.flush()
}

/// Standard output, if it is a terminal.
pub fn output_is_terminal() -> Option<Stdout> {
    Some(io::stdout()).filter(IsTerminal::is_terminal)
}

/// The system keeps no core dump unless it was told to.
pub fn leave_no_core() {}

/// Nothing can be caught here.
pub fn guard() {}

/// Ends the process with the status of a plugin that failed, after this message.
pub fn end<const N: usize>(message: [&str; N]) -> ! {
    let _ = io::stderr().write_all(message.concat().as_bytes());
    turnpath_files::remove_drafts();
    std::process::exit(PLUGIN_FAILED)
}

/// Ends the process at once without a message, for one whose end nobody hears of; drafts go.
pub fn end_unheard() -> ! {
    turnpath_files::remove_drafts();
    std::process::exit(PLUGIN_FAILED)
}
