//! `turnpath explain`: one strategy, or one table of the recipe, in full.

use turnpath::declared::{default, kind_with_example, limits};
use turnpath::{Catalogue, Strategy, TableInfo, slot_keys, tables};
use turnpath_core::{ParamInfo, Slot, printable};

use super::setup::with_plugins;
use crate::args::{ExplainArgs, slot_of};
use crate::failure::Failure;
use crate::print::print;
use crate::{Outcome, Status};

/// How alike two names must be to be taken for a misspelling (Jaro–Winkler).
const ALIKE: f64 = 0.8;

/// The name under which the keys above the first table are explained.
const TOP: &str = "recipe";

/// Explains every strategy and every table of that name.
pub fn explain(args: &ExplainArgs, catalogue: Catalogue) -> Outcome {
    let catalogue = with_plugins(catalogue, &args.plugins)?;
    let mut texts = of_host(&args.name);
    match find(&catalogue, &args.name) {
        Ok(found) => texts.extend(found.into_iter().map(of_strategy)),
        Err(failure) if texts.is_empty() => return Err(failure),
        Err(_) => {}
    }
    print(&printable(&texts.join("\n")))?;
    Ok(Status::Holds)
}

/// The tables of this name: one whose keys are the host's, or that of a slot.
fn of_host(name: &str) -> Vec<String> {
    let fixed = tables().filter(|table| name_of(table) == name);
    let texts: Vec<String> = fixed.map(of_table).collect();
    if !texts.is_empty() {
        return texts;
    }
    let slots = Slot::ALL.into_iter().filter(|slot| slot.key() == name);
    slots.map(of_slot).collect()
}

fn find<'a>(catalogue: &'a Catalogue, wanted: &str) -> Result<Vec<&'a Strategy>, Failure> {
    let (slots, name) = match wanted.split_once('/') {
        None => (Slot::ALL.to_vec(), wanted),
        Some((key, name)) => match slot_of(key) {
            Some(slot) => (vec![slot], name),
            None => {
                let keys = Slot::ALL.map(Slot::key).join(", ");
                return Err(Failure::Call(format!(
                    "there is no slot `{key}`; slots are {keys}"
                )));
            }
        },
    };
    let found: Vec<&Strategy> = slots
        .iter()
        .filter_map(|slot| catalogue.find(*slot, name))
        .collect();
    if !found.is_empty() {
        return Ok(found);
    }
    Err(Failure::Call(format!(
        "there is no {} named `{name}`; {}",
        match slots[..] {
            [slot] => slot.noun(),
            _ => "strategy or table",
        },
        hint(catalogue, &slots, name)
    )))
}

/// What may have been meant: the same name in another slot, a like one, or something in the list.
fn hint(catalogue: &Catalogue, slots: &[Slot], name: &str) -> String {
    let elsewhere = Slot::ALL
        .into_iter()
        .find(|slot| catalogue.find(*slot, name).is_some());
    if let Some(slot) = elsewhere {
        return format!("did you mean `{}/{name}`?", slot.key());
    }
    let of_strategies = slots.iter().flat_map(|slot| catalogue.names(*slot));
    let of_tables = tables().map(name_of).filter(|_| slots.len() > 1);
    let alike = of_strategies
        .chain(of_tables)
        .map(|known| (strsim::jaro_winkler(known, &plain(name)), known))
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .max_by(|one, other| one.0.total_cmp(&other.0));
    match alike {
        Some((_, known)) => format!("did you mean `{known}`?"),
        None => "`turnpath list` shows all".to_owned(),
    }
}

/// A name in the spelling of strategies: `equal-angle` for `Equal_Angle`.
fn plain(name: &str) -> String {
    name.to_lowercase().replace(['_', ' '], "-")
}

fn of_strategy(strategy: &Strategy) -> String {
    let info = strategy.info();
    let mut text = format!("{}/{}: {}\n", info.slot, info.name, info.summary);
    if !info.source.is_empty() {
        text += &format!("  source  {}\n", info.source);
    }
    text += &format!("  plugin  {}\n", strategy.plugin());
    text += &format!("\n  [{}]\n  use = \"{}\"\n", info.slot, info.name);
    text += &keys(info.params);
    text + &keys_of_host(info.slot)
}

/// The keys that every strategy of a slot takes besides its own, because the host reads them.
fn keys_of_host(slot: Slot) -> String {
    let besides = slot_keys(slot).iter().filter(|key| key.name != "use");
    match keys(besides) {
        none if none.is_empty() => none,
        of_host => format!("\n  every {slot} takes:\n{of_host}"),
    }
}

/// The name of a table as a person gives it.
fn name_of(table: &TableInfo) -> &'static str {
    match table.name {
        "" => TOP,
        name => name,
    }
}

fn of_table(table: &TableInfo) -> String {
    let mut text = format!("{}: {}\n", name_of(table), table.summary);
    if !table.name.is_empty() {
        text += &format!("\n  [{}]\n", table.name);
    }
    text + &keys(table.keys)
}

fn of_slot(slot: Slot) -> String {
    let (key, noun) = (slot.key(), slot.noun());
    let head =
        format!("{key}: which {noun} to use; the other keys are its parameters\n\n  [{key}]\n");
    head + &keys(slot_keys(slot))
}

fn keys<'a>(declared: impl IntoIterator<Item = &'a ParamInfo>) -> String {
    let key = |info: &ParamInfo| {
        let mut range = default(info);
        let limits = limits(info);
        if !limits.is_empty() {
            range = format!("{range}; {limits}");
        }
        let (name, kind, help) = (info.name, kind_with_example(info), info.help);
        format!("\n  {name} = {kind}\n      {help}\n      {range}\n")
    };
    declared.into_iter().map(key).collect()
}
