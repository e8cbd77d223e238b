//! `turnpath list`: the strategies that can be chosen.

use std::path::Path;

use turnpath::report::to_json;
use turnpath::{Catalogue, PluginsLock};
use turnpath_core::{Slot, printable_line};

use super::output::is_standard;
use super::setup::with_plugins;
use super::strategy_list::StrategyList;
use crate::args::{Format, ListArgs, slot_of};
use crate::print::print;
use crate::{Outcome, Status};

/// Lists strategies by slot and name.
pub fn list(args: &ListArgs, catalogue: Catalogue) -> Outcome {
    let catalogue = with_plugins(catalogue, &args.plugins)?;
    if let Some(file) = &args.lock {
        return lock(&catalogue, file.as_deref());
    }
    let only = args.slot.as_deref().and_then(slot_of);
    let slots: Vec<Slot> = Slot::ALL
        .into_iter()
        .filter(|slot| only.is_none_or(|only| only == *slot))
        .collect();
    match args.format {
        Format::Json => print(&to_json(&StrategyList::new(&catalogue, &slots)?))?,
        Format::Human => print(&text(&catalogue, &slots))?,
    }
    Ok(Status::Holds)
}

fn text(catalogue: &Catalogue, slots: &[Slot]) -> String {
    let width = catalogue
        .strategies()
        .map(|one| one.info().name.len())
        .max()
        .unwrap_or(0);
    let mut text = String::new();
    for slot in slots.iter().copied() {
        text += &format!("{slot}\n");
        for strategy in catalogue.strategies().filter(|one| one.info().slot == slot) {
            let info = strategy.info();
            text += &format!(
                "  {:<width$}  {}\n",
                info.name,
                printable_line(info.summary)
            );
            if let Some(file) = &strategy.plugin().file {
                text += &format!(
                    "  {:<width$}  from {}\n",
                    "",
                    printable_line(&file.display().to_string())
                );
            }
        }
        if catalogue.names(slot).is_empty() {
            text += "  none; give a folder of plugins with --plugin-dir\n";
        }
    }
    text
}

/// Prints the lock of the loaded plugins, or writes it to a file.
fn lock(catalogue: &Catalogue, file: Option<&Path>) -> Outcome {
    match file {
        Some(file) if is_standard(file) => print(&PluginsLock::text_of(catalogue)?)?,
        None => print(&PluginsLock::text_of(catalogue)?)?,
        Some(file) => PluginsLock::write(catalogue, file)?,
    }
    Ok(Status::Holds)
}
