//! The strategies of a recipe, with what they say of themselves.

use turnpath_core::{ParamInfo, Slot};
use turnpath_host::Catalogue;
use turnpath_page::StageChoice;
use turnpath_recipe::declared::default_value;
use turnpath_recipe::{Choice, Entry, Recipe, Value};

/// The key that names the strategy.
const USE: &str = "use";

/// The strategies that a recipe chooses, slot by slot.
pub fn choices(recipe: &Recipe, catalogue: &Catalogue) -> Vec<StageChoice> {
    let all = Slot::ALL.into_iter().flat_map(|slot| recipe.choices(slot));
    all.map(|choice| stage(recipe, choice, catalogue)).collect()
}

fn stage(recipe: &Recipe, choice: &Choice, catalogue: &Catalogue) -> StageChoice {
    let info = catalogue
        .find(choice.slot, choice.name())
        .map(|strategy| strategy.info());
    let entries = entries(recipe, choice);
    let params = info.as_ref().map_or(&[][..], |info| info.params);
    let is_left_out = |param: &&ParamInfo| entries.iter().all(|entry| entry.key != param.name);
    let left_out = params.iter().filter(is_left_out);
    let default = |param: &ParamInfo| Some((param.name.to_owned(), default_value(param)?));
    let parameters = entries.iter().filter(|entry| entry.key != USE);
    let parameters = parameters.map(|entry| (entry.key.clone(), text_of(&entry.node.value)));
    StageChoice {
        slot: choice.path.clone(),
        name: choice.name().to_owned(),
        summary: info.as_ref().map_or("", |info| info.summary).to_owned(),
        source: info.as_ref().map_or("", |info| info.source).to_owned(),
        parameters: parameters.collect(),
        defaults: left_out.filter_map(default).collect(),
    }
}

/// All keys of the table of a choice, those of the host too.
fn entries<'a>(recipe: &'a Recipe, choice: &Choice) -> &'a [Entry] {
    let node = recipe.document().find(choice.path.split('.'));
    match node.map(|node| &node.value) {
        Some(Value::Table(table)) => table.entries(),
        Some(Value::Array(items)) => match items.first().map(|item| &item.value) {
            Some(Value::Table(table)) => table.entries(),
            _ => &[],
        },
        _ => &[],
    }
}

/// A value as a recipe would give it.
fn text_of(value: &Value) -> String {
    match value {
        Value::Text(text) => format!("{text:?}"),
        Value::Number(number) => number.to_string(),
        Value::Flag(flag) => flag.to_string(),
        // No key of a recipe takes one.
        Value::Date => String::new(),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| text_of(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(table) => {
            let entries = table.entries().iter();
            let entries =
                entries.map(|entry| format!("{} = {}", entry.key, text_of(&entry.node.value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}
