//! `turnpath import`: a surface of a lens design as a recipe.

use turnpath::{ImportRequest, Side};
use turnpath_core::{Quantity, printable_line};

use super::output::is_standard;
use crate::args::{ImportArgs, ToolSide};
use crate::failure::Failure;
use crate::message::note;
use crate::print::print;
use crate::{Outcome, Status};

/// Makes the recipe, and writes or prints it.
pub fn import(args: &ImportArgs) -> Outcome {
    let request = ImportRequest {
        surface: args.surface,
        side: args.tool_side.map(|side| match side {
            ToolSide::MinusZ => Side::MinusZ,
            ToolSide::PlusZ => Side::PlusZ,
        }),
        aperture: args.aperture.as_deref().map(aperture).transpose()?,
    };
    let recipe = turnpath::import(&args.file, &request)?;
    match args.output.as_deref().filter(|output| !is_standard(output)) {
        Some(output) => recipe.write(output, args.force)?,
        None => print(&recipe.text)?,
    }
    for text in &recipe.notes {
        note(&printable_line(text));
    }
    Ok(Status::Holds)
}

/// A diameter in mm.
fn aperture(text: &str) -> Result<f64, Failure> {
    let refused = |why: String| Failure::Call(format!("--aperture: {why}"));
    let parsed = Quantity::Length.parse(text);
    match parsed.map_err(|error| refused(error.to_string()))? {
        diameter if diameter > 0.0 => Ok(diameter),
        _ => Err(refused("a diameter is above 0 mm".to_owned())),
    }
}
