//! `turnpath schema`: a JSON schema of recipes.

use turnpath::report::to_json;
use turnpath::{Catalogue, recipe_schema};

use super::setup::with_plugins;
use crate::args::SchemaArgs;
use crate::print::print;
use crate::{Outcome, Status};

/// Prints the schema, with the strategies of the plugins that are loaded.
pub fn schema(args: &SchemaArgs, catalogue: Catalogue) -> Outcome {
    let catalogue = with_plugins(catalogue, &args.plugins)?;
    print(&to_json(&recipe_schema(&catalogue)))?;
    Ok(Status::Holds)
}
