//! The schema of a table that names a strategy.

use serde_json::{Map, Value, json};
use turnpath_core::{ParamDefault, ParamInfo, Slot, StrategyInfo};
use turnpath_host::Catalogue;
use turnpath_recipe::slot_keys;

use super::value::of_key;

/// The key that names the strategy.
const USE: &str = "use";

/// The table of a slot: the host's keys and those of the strategy that it names.
pub fn of_slot(slot: Slot, catalogue: &Catalogue) -> Value {
    let strategies: Vec<StrategyInfo> = catalogue
        .strategies()
        .map(|strategy| strategy.info())
        .filter(|info| info.slot == slot)
        .collect();
    let names: Vec<&str> = strategies.iter().map(|info| info.name).collect();
    let usual = usual(slot);
    let one: Vec<Value> = strategies
        .iter()
        .map(|info| if_used(info, usual == Some(info.name)))
        .collect();
    let mut schema = json!({
        "type": "object",
        "properties": { USE: { "enum": names, "description": format!("the {}", slot.noun()) } },
        "allOf": one,
    });
    if let (None, Some(schema)) = (usual, schema.as_object_mut()) {
        schema.insert("required".to_owned(), json!([USE]));
    }
    schema
}

/// The strategy of a table that names none, where there is one.
fn usual(slot: Slot) -> Option<&'static str> {
    let key = slot_keys(slot).iter().find(|key| key.name == USE)?;
    match key.default {
        ParamDefault::Text(name) => Some(name),
        _ => None,
    }
}

/// The keys of a table that names this strategy.
fn if_used(info: &StrategyInfo, is_usual: bool) -> Value {
    let is_named = json!({ "properties": { USE: { "const": info.name } }, "required": [USE] });
    let condition = match is_usual {
        true => json!({ "anyOf": [is_named, { "not": { "required": [USE] } }] }),
        false => is_named,
    };
    let of_host = slot_keys(info.slot).iter().filter(|key| key.name != USE);
    let keys: Vec<&ParamInfo> = info.params.iter().chain(of_host).collect();
    let mut properties = properties(keys.iter().copied());
    let name = json!({ "const": info.name, "description": info.summary });
    properties.insert(USE.to_owned(), name);
    json!({
        "if": condition,
        "then": {
            "properties": properties,
            "required": required(keys.iter().copied()),
            "additionalProperties": false,
        },
    })
}

/// The schemas of keys by their names.
pub fn properties<'a>(keys: impl Iterator<Item = &'a ParamInfo>) -> Map<String, Value> {
    keys.map(|key| (key.name.to_owned(), of_key(key))).collect()
}

/// The names of the keys that a table must have.
pub fn required<'a>(keys: impl Iterator<Item = &'a ParamInfo>) -> Vec<&'static str> {
    keys.filter(|key| key.default == ParamDefault::Required)
        .map(|key| key.name)
        .collect()
}
