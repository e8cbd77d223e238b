//! `--set key.path=value`: overrides a value of the recipe, or adds one.

use std::sync::Arc;

use toml::de::DeValue;

use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Node, Reader, Table, Value};
use crate::span::{Source, Span};
use crate::suggest::quoted;
use crate::surface_list::surface_of;

/// Longest path of keys; no recipe nests deeper.
const DEEPEST: usize = 8;

/// A value for a key, such as one `--set` argument.
pub(crate) struct Setting {
    /// The path to the key, each part with its span.
    pub(crate) keys: Vec<(String, Span)>,
    /// The value.
    pub(crate) node: Node,
}

/// Applies the arguments in their order, so that a later one wins.
pub(crate) fn apply_all(table: &mut Table, sets: &[String], diagnostics: &mut Vec<Diagnostic>) {
    for (index, argument) in sets.iter().enumerate() {
        diagnostics.extend(apply(table, argument, index + 1).err());
    }
}

/// Applies one argument, the `rank`-th, counted from 1.
pub(crate) fn apply(table: &mut Table, argument: &str, rank: usize) -> Result<(), Diagnostic> {
    put(table, parse(source(argument, rank))?)
}

/// The argument `key=value`.
///
/// # Errors
/// When the key holds a `=`: the argument would be read as a shorter key.
pub(crate) fn argument(key: &str, value: &str, rank: usize) -> Result<String, Diagnostic> {
    let argument = format!("{key}={value}");
    if key.contains('=') {
        return Err(wrong(&source(&argument, rank), NO_KEY));
    }
    Ok(argument)
}

const NO_KEY: &str = "this `--set` does not begin with a key";

fn source(argument: &str, rank: usize) -> Arc<Source> {
    Arc::new(Source {
        name: "--set".to_owned(),
        text: argument.to_owned(),
        rank,
    })
}

fn wrong(source: &Arc<Source>, title: &str) -> Diagnostic {
    let all = Span::new(source.clone(), 0..source.text.len());
    Diagnostic::new(all, title)
        .with_help("write it as key.path=value, for example: --set tool.nose_radius=0.5mm")
}

fn parse(source: Arc<Source>) -> Result<Setting, Diagnostic> {
    let text = &source.text;
    let Some((path, _)) = text.split_once('=') else {
        return Err(wrong(&source, "this `--set` has no `=`"));
    };
    let keys = keys(&source, path);
    if keys.iter().any(|(key, _)| !is_key(key)) {
        return Err(wrong(&source, NO_KEY));
    }
    if keys.len() > DEEPEST {
        return Err(wrong(&source, "the path of this `--set` is too long"));
    }
    let node = read_value(&source, path.len() + 1);
    Ok(Setting { keys, node })
}

fn keys(source: &Arc<Source>, path: &str) -> Vec<(String, Span)> {
    let mut start = 0;
    let mut keys = Vec::new();
    for part in path.split('.') {
        let key = part.trim();
        let from = start + (part.len() - part.trim_start().len());
        keys.push((
            key.to_owned(),
            Span::new(source.clone(), from..from + key.len()),
        ));
        start += part.len() + 1;
    }
    keys
}

fn is_key(text: &str) -> bool {
    // A comma stands between the whole numbers of a coefficient.
    let bare = |c: char| c.is_ascii_alphanumeric() || "_-,".contains(c);
    !text.is_empty() && text.chars().all(bare)
}

/// The value as TOML if it is TOML, else as a string.
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
            span: reader.span(0..text.len()),
        },
    }
}

/// Replaces the key's value, or adds the key.
pub(crate) fn put(table: &mut Table, setting: Setting) -> Result<(), Diagnostic> {
    let Setting { mut keys, node } = setting;
    let Some((surface, used)) = surface_of(table, &keys)? else {
        return put_below(table, keys, node);
    };
    let path: Vec<&str> = keys
        .iter()
        .take(used)
        .map(|(key, _)| key.as_str())
        .collect();
    let (path, span) = (path.join("."), keys[used - 1].1.clone());
    keys.drain(..used);
    match &mut surface.value {
        _ if keys.is_empty() => *surface = node,
        Value::Table(inner) => return put_below(inner, keys, node),
        _ => return Err(not_a_table(&path, &span)),
    }
    Ok(())
}

/// Replaces the value of a key of this table, or of a table within it.
fn put_below(
    mut table: &mut Table,
    keys: Vec<(String, Span)>,
    node: Node,
) -> Result<(), Diagnostic> {
    let mut keys = keys.into_iter();
    let Some((mut key, mut span)) = keys.next() else {
        return Ok(());
    };
    for (next_key, next_span) in keys {
        table = inner_table(table, &key, &span)?;
        (key, span) = (next_key, next_span);
    }
    table.put(Entry { key, span, node });
    Ok(())
}

fn inner_table<'t>(
    table: &'t mut Table,
    key: &str,
    span: &Span,
) -> Result<&'t mut Table, Diagnostic> {
    if table.get(key).is_none() {
        let node = Node {
            value: Value::Table(Table::default()),
            span: span.clone(),
        };
        table.put(Entry {
            key: key.to_owned(),
            span: span.clone(),
            node,
        });
    }
    match table.get_mut(key).map(|entry| &mut entry.node.value) {
        Some(Value::Table(inner)) => Ok(inner),
        _ => Err(not_a_table(key, span)),
    }
}

fn not_a_table(key: &str, span: &Span) -> Diagnostic {
    let title = format!("{} is not a table", quoted(key));
    let label = "this key has a value, not keys of its own";
    Diagnostic::new(span.clone(), title).with_label(label)
}
