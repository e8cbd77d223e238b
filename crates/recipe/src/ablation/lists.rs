//! The table `[ablation]` as lists: which keys vary, and over which values.

use turnpath_core::Slot;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Entry, Node, Table, Value};
use crate::place::Place;
use crate::read::Section;
use crate::suggest::{did_you_mean, listed, quoted};
use crate::tables::{SCHEMA, TOP_KEYS};
use crate::value;

/// How the lists go together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    /// The full product.
    AllPairs,
    /// Each value alone.
    OneAtATime,
}

/// All of `[ablation]`.
pub(super) struct Lists {
    pub(super) mode: Mode,
    /// In the order of the text.
    pub(super) lists: Vec<List>,
}

/// A key that varies.
pub(super) struct List {
    /// The path of the key, each part with its place in `[ablation]`.
    pub(super) path: Vec<(String, Place)>,
    /// The recipe's own value first, none if it leaves the key out; then those of the list.
    pub(super) choices: Vec<Option<Node>>,
}

impl List {
    /// `feed`, `tolerance.residual`.
    pub(super) fn key(&self) -> String {
        dotted(&self.path)
    }

    /// Whether it chooses strategies, by whole tables.
    pub(super) fn is_slot(&self) -> bool {
        matches!(self.path.as_slice(), [(key, _)] if is_slot(key))
    }

    fn order(&self) -> (usize, usize) {
        let last = self.path.last();
        last.map_or((0, 0), |(_, place)| {
            (place.source().rank, place.span().start)
        })
    }
}

/// Tables and keys that no run depends on, or that are not the recipe's to vary, and why.
const FIXED: [(&str, &str); 5] = [
    ("format", "it says how the recipe is read"),
    ("name", "it changes nothing of the path"),
    ("plugins", "all runs choose from the same plugins"),
    ("output", "an ablation writes no paths and programs"),
    ("ablation", "it cannot vary itself"),
];

impl Lists {
    /// Reads `[ablation]` of a whole document; `base` has the recipe's own values.
    pub(super) fn read(document: &Table, base: &Table, whole: &Place) -> Result<Self, Diagnostics> {
        let Some(entry) = document.get("ablation") else {
            return Err(nothing(whole, "the recipe has no table [ablation]").into());
        };
        let Value::Table(table) = &entry.node.value else {
            // The recipe itself was complained about.
            return Err(nothing(&entry.node.place, "[ablation] is no table").into());
        };
        let mut found = Vec::new();
        let mode = mode(table, &entry.node.place, &mut found);
        let mut walk = Walk {
            base,
            lists: Vec::new(),
            found,
        };
        walk.table(table, &[]);
        let Walk {
            mut lists, found, ..
        } = walk;
        lists.sort_by_key(List::order);
        if lists.is_empty() && found.is_empty() {
            return Err(nothing(&entry.node.place, "[ablation] names nothing to vary").into());
        }
        Diagnostics::unless_any(Some(Self { mode, lists }), found)
    }
}

fn nothing(place: &Place, title: &str) -> Diagnostic {
    Diagnostic::new(place.clone(), title).help(
        "write the line [ablation] and below it what to vary, for example: \
         velocity = [{ use = \"three-point\" }, { use = \"analytic\" }]",
    )
}

fn mode(table: &Table, place: &Place, found: &mut Vec<Diagnostic>) -> Mode {
    let mut section = Section {
        name: "ablation",
        table: Some(table),
        place: place.clone(),
        misspelt: false,
        found,
    };
    match section.word("mode", &["all-pairs", "one-at-a-time"]) {
        Some(word) if word.value == "one-at-a-time" => Mode::OneAtATime,
        _ => Mode::AllPairs,
    }
}

/// Goes through the tables within `[ablation]`.
struct Walk<'a> {
    base: &'a Table,
    lists: Vec<List>,
    found: Vec<Diagnostic>,
}

impl Walk<'_> {
    fn table(&mut self, table: &Table, above: &[(String, Place)]) {
        for entry in table.entries() {
            if above.is_empty() && entry.key == "mode" {
                continue;
            }
            let mut path = above.to_vec();
            path.push((entry.key.clone(), entry.place.clone()));
            if let Some(diagnostic) = cannot_vary(&path, entry) {
                self.found.push(diagnostic);
                continue;
            }
            match &entry.node.value {
                Value::Table(inner) if is_strategy(&path, inner) => {
                    let complaint = not_a_strategy(&dotted(&path), &entry.node);
                    self.found.push(complaint);
                }
                Value::Table(inner) if !is_final(&path) => self.table(inner, &path),
                _ => match self.list(path, &entry.node) {
                    Ok(list) => self.lists.push(list),
                    Err(diagnostic) => self.found.push(diagnostic),
                },
            }
        }
    }

    fn list(&self, path: Vec<(String, Place)>, node: &Node) -> Result<List, Diagnostic> {
        let key = dotted(&path);
        let items = value::items(&key, node)
            .map_err(|diagnostic| diagnostic.help(format!("for example: {}", example(&path))))?;
        if items.is_empty() {
            let title = format!("the list of `{key}` is empty");
            return Err(Diagnostic::new(node.place.clone(), title)
                .label("nothing to vary")
                .help("give it one or more values, or leave the line out"));
        }
        let own = self.base.find(path.iter().map(|(key, _)| key.as_str()));
        let choices = vec![own.map(|entry| entry.node.clone())];
        let mut list = List { path, choices };
        for item in items {
            if list.is_slot() && !matches!(item.value, Value::Table(_)) {
                return Err(not_a_strategy(&key, item));
            }
            let same = |choice: &Option<Node>| {
                choice.as_ref().is_some_and(|choice| are_same(choice, item))
            };
            if !list.choices.iter().any(same) {
                list.choices.push(Some(item.clone()));
            }
        }
        Ok(list)
    }
}

/// Whether a path is that of a key, not of a table: known of the tables with fixed keys.
fn is_final(path: &[(String, Place)]) -> bool {
    match path {
        [(first, _)] => TOP_KEYS.contains(&first.as_str()),
        [(first, _), ..] => !is_slot(first),
        [] => false,
    }
}

/// Whether a strategy stands where a list of them should.
fn is_strategy(path: &[(String, Place)], table: &Table) -> bool {
    let name = table.get("use").map(|entry| &entry.node.value);
    matches!(path, [(key, _)] if is_slot(key)) && matches!(name, Some(Value::Text(_)))
}

fn not_a_strategy(key: &str, item: &Node) -> Diagnostic {
    let help = match &item.value {
        Value::Text(name) => format!("write it as a table: {{ use = {name:?} }}"),
        _ => format!("for example: {key} = [{{ use = \"…\" }}, {{ use = \"…\" }}]"),
    };
    value::wrong_type(key, item, "a list of strategies").help(help)
}

/// Why the last key of a path does not lead to what can vary, if it does not.
fn cannot_vary(path: &[(String, Place)], entry: &Entry) -> Option<Diagnostic> {
    match path {
        [(first, place)] => cannot_begin(first, place, entry),
        [(table, _), (key, place)] if !is_slot(table) => {
            let known = keys_of(table);
            (!known.contains(&key.as_str())).then(|| unknown_key(table, key, place, known))
        }
        _ => None,
    }
}

fn cannot_begin(first: &str, place: &Place, entry: &Entry) -> Option<Diagnostic> {
    if let Some((_, why)) = FIXED.iter().find(|(key, _)| *key == first) {
        let title = format!("{} cannot vary", quoted(first));
        return Some(Diagnostic::new(place.clone(), title).label(*why));
    }
    let is_table = matches!(entry.node.value, Value::Table(_));
    let known = beginnings();
    match keys_of(first) {
        _ if !known.contains(&first) => Some(unknown_beginning(first, place, &known)),
        [] => None,
        _ if is_table => None,
        keys => {
            let title = format!("`{first}` is a table: name the key of it that varies");
            let help: Vec<String> = keys.iter().map(|key| format!("{first}.{key}")).collect();
            let help: Vec<&str> = help.iter().map(String::as_str).collect();
            Some(
                Diagnostic::new(place.clone(), title)
                    .label("not a key")
                    .help(format!("one of {}", listed(&help))),
            )
        }
    }
}

fn unknown_beginning(first: &str, place: &Place, known: &[&str]) -> Diagnostic {
    let elsewhere = || {
        let mut tables = SCHEMA.iter().filter(|(_, keys)| keys.contains(&first));
        tables
            .next()
            .map(|(table, _)| format!("write it with its table: {table}.{first}"))
    };
    let title = format!("the recipe has no key or table {} to vary", quoted(first));
    Diagnostic::new(place.clone(), title)
        .label("unknown")
        .helps(did_you_mean(first, known).or_else(elsewhere))
        .help(format!("known: {}", listed(known)))
}

fn unknown_key(table: &str, key: &str, place: &Place, known: &[&str]) -> Diagnostic {
    Diagnostic::new(
        place.clone(),
        format!("[{table}] has no key {}", quoted(key)),
    )
    .label("unknown key")
    .helps(did_you_mean(key, known))
    .help(format!("keys of [{table}]: {}", listed(known)))
}

/// What a path may begin with.
fn beginnings() -> Vec<&'static str> {
    let slots = Slot::ALL.iter().map(|slot| slot.key());
    let tables = SCHEMA.iter().map(|(name, _)| *name);
    let all = slots.chain(tables).chain(TOP_KEYS.iter().copied());
    all.filter(|name| !name.contains('.') && !FIXED.iter().any(|(fixed, _)| fixed == name))
        .collect()
}

/// The keys of a table that has fixed ones.
fn keys_of(table: &str) -> &'static [&'static str] {
    let found = SCHEMA.iter().find(|(name, _)| *name == table);
    found.map_or(&[], |(_, keys)| keys)
}

fn is_slot(key: &str) -> bool {
    Slot::ALL.iter().any(|slot| slot.key() == key)
}

fn dotted(path: &[(String, Place)]) -> String {
    let keys: Vec<&str> = path.iter().map(|(key, _)| key.as_str()).collect();
    keys.join(".")
}

fn example(path: &[(String, Place)]) -> String {
    match path {
        [(slot, _)] if is_slot(slot) => format!("{slot} = [{{ use = \"…\" }}, {{ use = \"…\" }}]"),
        _ => format!("{} = […, …]", dotted(path)),
    }
}

/// Whether two values are the same, wherever they stand and in whatever order their keys.
pub(super) fn are_same(one: &Node, other: &Node) -> bool {
    match (&one.value, &other.value) {
        (Value::Array(one), Value::Array(other)) => {
            one.len() == other.len()
                && one
                    .iter()
                    .zip(other)
                    .all(|(one, other)| are_same(one, other))
        }
        (Value::Table(one), Value::Table(other)) => {
            let there = |entry: &Entry| {
                let found = other.get(&entry.key);
                found.is_some_and(|found| are_same(&entry.node, &found.node))
            };
            one.entries().len() == other.entries().len() && one.entries().iter().all(there)
        }
        (one, other) => one == other,
    }
}
