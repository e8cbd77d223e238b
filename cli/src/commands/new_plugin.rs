//! `turnpath new-plugin`: a crate with a small strategy that works.

use turnpath::{Catalogue, CrateSource, Error, NewPluginError, PluginRequest};
use turnpath_core::printable_line;

use super::setup::with_plugins;
use crate::args::{NewPluginArgs, slot_of};
use crate::failure::Failure;
use crate::print::print;
use crate::{Outcome, Status};

/// Writes the crate, and prints what to call next.
pub fn new_plugin(args: &NewPluginArgs, catalogue: Catalogue) -> Outcome {
    let catalogue = with_plugins(catalogue, &args.plugins)?;
    let Some(slot) = slot_of(&args.slot) else {
        return Err(Failure::Call(format!("there is no slot `{}`", args.slot)));
    };
    let crates = match &args.crates {
        None => CrateSource::of_this_build(),
        Some(text) => text.parse(),
    };
    let crates = crates.map_err(|error| Error::from(NewPluginError::Source(error)))?;
    let request = PluginRequest {
        name: args.name.clone(),
        slot,
        folder: args.dir.clone(),
        crates,
    };
    let plugin = turnpath::new_plugin(&request, &catalogue)?;
    let folder = plugin.folder.display().to_string();
    let mut text = format!("wrote the {} `{}`:\n", slot.noun(), args.name);
    for file in &plugin.files {
        let path = plugin.folder.join(file).display().to_string();
        text += &format!("  {}\n", printable_line(&path));
    }
    text += &format!(
        "turnpath's crates come from {}\n\
         next: cd {}, cargo test, cargo build,\n\
         turnpath ablate recipe.toml --plugin-dir target/debug\n",
        printable_line(&request.crates.to_string()),
        printable_line(&folder),
    );
    print(&text)?;
    Ok(Status::Holds)
}
