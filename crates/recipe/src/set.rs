//! `--set key.path=value`: overrides a value of the recipe, or adds one.

use std::sync::Arc;

use toml::de::DeValue;

use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Node, Reader, Table, Value};
use crate::place::{Place, Source};
use crate::suggest::quoted;

/// Longest path of keys; no recipe nests deeper.
const DEEPEST: usize = 8;

/// A value for a key, such as one `--set` argument.
pub(crate) struct Setting {
    /// The path to the key, each part with its place.
    pub(crate) keys: Vec<(String, Place)>,
    /// The value.
    pub(crate) node: Node,
}

/// Applies the arguments in their order, so that a later one wins.
pub(crate) fn apply(table: &mut Table, sets: &[String], found: &mut Vec<Diagnostic>) {
    for (index, argument) in sets.iter().enumerate() {
        let source = Source {
            name: "--set".to_owned(),
            text: argument.clone(),
            rank: index + 1,
        };
        let done = take_apart(Arc::new(source)).and_then(|setting| put(table, setting));
        found.extend(done.err());
    }
}

fn take_apart(source: Arc<Source>) -> Result<Setting, Diagnostic> {
    let all = Place::new(source.clone(), 0..source.text.len());
    let wrong = |title: &str| {
        Diagnostic::new(all.clone(), title)
            .help("write it as key.path=value, for example: --set tool.nose_radius=0.5mm")
    };
    let text = &source.text;
    let Some((path, _)) = text.split_once('=') else {
        return Err(wrong("this `--set` has no `=`"));
    };
    let keys = keys(&source, path);
    if keys.iter().any(|(key, _)| !is_key(key)) {
        return Err(wrong("this `--set` does not begin with a key"));
    }
    if keys.len() > DEEPEST {
        return Err(wrong("the path of this `--set` is too long"));
    }
    let node = read_value(&source, path.len() + 1);
    Ok(Setting { keys, node })
}

fn keys(source: &Arc<Source>, path: &str) -> Vec<(String, Place)> {
    let mut start = 0;
    let mut keys = Vec::new();
    for part in path.split('.') {
        let key = part.trim();
        let from = start + (part.len() - part.trim_start().len());
        keys.push((
            key.to_owned(),
            Place::new(source.clone(), from..from + key.len()),
        ));
        start += part.len() + 1;
    }
    keys
}

fn is_key(text: &str) -> bool {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    !text.is_empty() && text.chars().all(bare)
}

/// The value as TOML, else as a string.
fn read_value(source: &Arc<Source>, start: usize) -> Node {
    let after = source.text.get(start..).unwrap_or("");
    let text = after.trim();
    let offset = start + (after.len() - after.trim_start().len());
    let reader = Reader {
        source: source.clone(),
        offset,
    };
    match DeValue::parse(text) {
        Ok(value) => reader.node(&value),
        Err(_) => Node {
            value: Value::Text(text.to_owned()),
            place: reader.place(0..text.len()),
        },
    }
}

/// Puts the value in the place of the key's own, or adds the key.
pub(crate) fn put(table: &mut Table, setting: Setting) -> Result<(), Diagnostic> {
    let mut keys = setting.keys.into_iter();
    let Some((mut key, mut place)) = keys.next() else {
        return Ok(());
    };
    let mut table = table;
    for (next_key, next_place) in keys {
        table = inner_table(table, &key, &place)?;
        (key, place) = (next_key, next_place);
    }
    table.put(Entry {
        key,
        place,
        node: setting.node,
    });
    Ok(())
}

fn inner_table<'t>(
    table: &'t mut Table,
    key: &str,
    place: &Place,
) -> Result<&'t mut Table, Diagnostic> {
    if table.get(key).is_none() {
        let node = Node {
            value: Value::Table(Table::default()),
            place: place.clone(),
        };
        table.put(Entry {
            key: key.to_owned(),
            place: place.clone(),
            node,
        });
    }
    match table.get_mut(key).map(|entry| &mut entry.node.value) {
        Some(Value::Table(inner)) => Ok(inner),
        _ => {
            let title = format!("{} is not a table", quoted(key));
            Err(Diagnostic::new(place.clone(), title).label("has a value, not keys of its own"))
        }
    }
}
