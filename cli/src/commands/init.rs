//! `turnpath init`: a recipe to begin with.

use turnpath::write_recipe;

use super::output::is_standard;
use crate::args::InitArgs;
use crate::print::print;
use crate::{Outcome, Status};

/// A part that is cut in seconds, with a comment at each key.
const TEMPLATE: &str = include_str!("init.toml");

/// Writes the recipe, or prints it.
pub fn init(args: &InitArgs) -> Outcome {
    if is_standard(&args.file) {
        print(TEMPLATE)?;
        return Ok(Status::Holds);
    }
    write_recipe(TEMPLATE, &args.file, args.force)?;
    let file = args.file.display();
    print(&format!(
        "wrote {file}; `turnpath check {file}` looks at it, `turnpath run {file}` makes its path\n"
    ))?;
    Ok(Status::Holds)
}
