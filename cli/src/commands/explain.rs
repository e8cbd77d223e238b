//! `turnpath explain`: one strategy in full.

use turnpath::{Catalogue, Strategy};
use turnpath_core::{ParamDefault, ParamInfo, ParamKind, Slot};

use super::setup::with_plugins;
use crate::args::{ExplainArgs, slot_of};
use crate::failure::Failure;
use crate::print::print;
use crate::{Outcome, Status};

/// How alike two names must be to be taken for a misspelling (Jaro–Winkler).
const ALIKE: f64 = 0.8;

/// Explains every strategy of that name.
pub fn explain(args: &ExplainArgs, catalogue: Catalogue) -> Outcome {
    let catalogue = with_plugins(catalogue, &args.plugins)?;
    let found = find(&catalogue, &args.name)?;
    let texts: Vec<String> = found.into_iter().map(explanation).collect();
    print(&texts.join("\n"))?;
    Ok(Status::Holds)
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
            _ => "strategy",
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
    let alike = slots
        .iter()
        .flat_map(|slot| catalogue.names(*slot))
        .map(|known| (strsim::jaro_winkler(known, name), known))
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .max_by(|one, other| one.0.total_cmp(&other.0));
    match alike {
        Some((_, known)) => format!("did you mean `{known}`?"),
        None => "`turnpath list` shows all".to_owned(),
    }
}

fn explanation(strategy: &Strategy) -> String {
    let info = strategy.info();
    let mut text = format!("{}/{}: {}\n", info.slot, info.name, info.summary);
    if !info.source.is_empty() {
        text += &format!("  source  {}\n", info.source);
    }
    text += &format!("  plugin  {}\n", strategy.plugin());
    text += &format!("\n  [{}]\n  use = \"{}\"\n", info.slot, info.name);
    for param in info.params {
        text += &format!("\n  {} = {}\n", param.name, kind(param));
        text += &format!("      {}\n      {}\n", param.help, range(param));
    }
    text
}

fn kind(param: &ParamInfo) -> String {
    match param.kind {
        ParamKind::Number => "a number".to_owned(),
        ParamKind::Count => "a whole number".to_owned(),
        ParamKind::Flag => "true or false".to_owned(),
        ParamKind::Rows(columns) => format!("a list of rows of {columns} numbers"),
        ParamKind::Choice(words) => words
            .iter()
            .map(|word| format!("\"{word}\""))
            .collect::<Vec<_>>()
            .join(" | "),
        ParamKind::Quantity(quantity) => {
            format!("{}, such as \"{}\"", quantity.noun(), quantity.example())
        }
        ParamKind::File => "a file, by its path relative to the recipe".to_owned(),
    }
}

fn range(param: &ParamInfo) -> String {
    let shown = |value: f64| match param.kind.quantity() {
        Some(quantity) => quantity.format(value),
        None => value.to_string(),
    };
    let mut parts = vec![match param.default {
        ParamDefault::Required => "required".to_owned(),
        ParamDefault::Absent => "may be left out".to_owned(),
        ParamDefault::Number(value) => format!("default {}", shown(value)),
        ParamDefault::Flag(value) => format!("default {value}"),
        ParamDefault::Text(word) => format!("default \"{word}\""),
    }];
    if param.min.is_finite() {
        let word = if param.above_min { "above" } else { "at least" };
        parts.push(format!("{word} {}", shown(param.min)));
    }
    if param.max.is_finite() {
        parts.push(format!("at most {}", shown(param.max)));
    }
    if param.nonzero {
        parts.push("not zero".to_owned());
    }
    parts.join("; ")
}
