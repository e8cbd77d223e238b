//! The controller's commands in a recipe's own header and footer.

use crate::program::ControllerCommand;

use super::numbers::line;

/// A line for each command.
pub fn commands(commands: &[ControllerCommand]) -> String {
    let of_command = |one: &ControllerCommand| {
        let trusted = match one.harmless {
            true => "",
            false => " (may move, set or start something)",
        };
        line(
            &one.template,
            format!("line {}: {}{trusted}", one.line, one.command),
        )
    };
    commands.iter().map(of_command).collect()
}
