//! A JSON schema of recipes, from the declarations of tables and strategies: an editor completes and
//! checks a recipe with it.
//!
//! A schema knows keys, words, units and signs. What depends on several values, such as a nose that
//! does not fit, is for [`Job::new`](crate::Job::new).

mod strategy_table;
mod value;

use serde_json::{Map, Value, json};
use turnpath_core::{ParamInfo, Slot};
use turnpath_host::Catalogue;
use turnpath_recipe::{TableInfo, rough_path_tables, tables};

use strategy_table::{of_slot, properties, required};

/// The dialect of JSON schema: the newest one that checkers of TOML read.
const DIALECT: &str = "http://json-schema.org/draft-07/schema#";
/// Tables with a form of their own.
const ABLATION: &str = "ablation";
const PASSES: &str = "passes";

/// The JSON schema of recipes that use the strategies of this catalogue.
///
/// ```
/// use turnpath::{Catalogue, recipe_schema};
/// let schema = recipe_schema(&Catalogue::linked()?);
/// let speed = &schema["definitions"]["spindle"]["allOf"][0]["then"]["properties"]["speed"];
/// assert!(speed["pattern"].as_str().is_some_and(|pattern| pattern.contains("rpm")));
/// # Ok::<(), turnpath::LoadError>(())
/// ```
pub fn recipe_schema(catalogue: &Catalogue) -> Value {
    let slots = Slot::ALL.map(|slot| (slot.key().to_owned(), of_slot(slot, catalogue)));
    let mut root = Map::new();
    let mut needed: Vec<&str> = Vec::new();
    for table in tables() {
        if table.name.is_empty() {
            root.extend(properties(table.keys.iter()));
            needed.extend(required(table.keys.iter()));
        } else if is_fixed(table) {
            insert(&mut root, table);
            needed.extend(table.required.then_some(table.name));
        }
    }
    for slot in Slot::ALL {
        root.insert(slot.key().to_owned(), in_recipe(slot));
        needed.push(slot.key());
    }
    root.insert(ABLATION.to_owned(), ablation());
    root.insert(PASSES.to_owned(), passes());
    json!({
        "$schema": DIALECT,
        "title": "Recipe of turnpath",
        "type": "object",
        "properties": root,
        "required": needed,
        "additionalProperties": false,
        "definitions": Map::from_iter(slots),
    })
}

/// Whether a table is neither a slot's nor one with a form of its own.
fn is_fixed(table: &TableInfo) -> bool {
    let own = [ABLATION, PASSES];
    !own.contains(&table.name) && Slot::ALL.iter().all(|slot| slot.key() != table.name)
}

fn of_table(table: &TableInfo) -> Value {
    json!({
        "type": "object",
        "description": table.summary,
        "properties": properties(table.keys.iter()),
        "required": required(table.keys.iter()),
        "additionalProperties": false,
    })
}

/// Puts a table into the schema of its parent, `part.pose` into `part`. Parents come first.
fn insert(root: &mut Map<String, Value>, table: &TableInfo) {
    let Some((parent, name)) = table.name.split_once('.') else {
        root.insert(table.name.to_owned(), of_table(table));
        return;
    };
    let parent = root.get_mut(parent).and_then(|of| of.get_mut("properties"));
    if let Some(inner) = parent.and_then(Value::as_object_mut) {
        inner.insert(name.to_owned(), of_table(table));
    }
}

fn reference(slot: Slot) -> Value {
    json!({ "$ref": format!("#/definitions/{}", slot.key()) })
}

/// A slot's table; of surfaces there may be several.
fn in_recipe(slot: Slot) -> Value {
    let one = reference(slot);
    match slot {
        Slot::Surface => json!({
            "anyOf": [one, { "type": "array", "items": one, "minItems": 1 }],
        }),
        _ => one,
    }
}

/// `[ablation]`: a list of tables for a slot, and a list of values for any other path of keys.
fn ablation() -> Value {
    let mut inner = properties(keys_of(ABLATION));
    for slot in Slot::ALL {
        let lists = json!({
            "anyOf": [
                { "type": "array", "items": in_recipe(slot), "minItems": 1 },
                { "type": "object", "minProperties": 1 },
            ],
        });
        inner.insert(slot.key().to_owned(), lists);
    }
    json!({
        "type": "object",
        "description": about(ABLATION),
        "properties": inner,
        "additionalProperties": { "type": ["array", "object"], "minItems": 1, "minProperties": 1 },
    })
}

/// `[passes]`: a table for each rough path.
fn passes() -> Value {
    let mut inner = properties(keys_of(PASSES));
    for name in rough_path_tables() {
        let slot = Slot::ALL.into_iter().find(|slot| slot.key() == name);
        let whole = slot.map(reference);
        let some_keys = json!({ "type": "object", "not": { "required": ["use"] } });
        let schema = match (whole, tables().find(|table| table.name == name)) {
            (Some(whole), _) => json!({ "anyOf": [whole, some_keys] }),
            (None, Some(table)) => json!({
                "type": "object",
                "properties": properties(table.keys.iter()),
                "additionalProperties": false,
            }),
            (None, None) => some_keys,
        };
        inner.insert(name.to_owned(), schema);
    }
    json!({
        "type": "object",
        "description": about(PASSES),
        "additionalProperties": {
            "type": "object",
            "properties": inner,
            "required": required(keys_of(PASSES)),
            "additionalProperties": false,
        },
    })
}

fn keys_of(name: &str) -> impl Iterator<Item = &'static ParamInfo> {
    let of_name = tables().filter(move |table| table.name == name);
    of_name.flat_map(|table| table.keys)
}

fn about(name: &str) -> &'static str {
    let table = tables().find(|table| table.name == name);
    table.map_or("", |table| table.summary)
}
