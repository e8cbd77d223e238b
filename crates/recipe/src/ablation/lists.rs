//! The table `[ablation]` as lists: the keys that vary, and their values.

use turnpath_core::Slot;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Entry, Node, Table, Value};
use crate::read::{Section, known_keys};
use crate::span::Span;
use crate::suggest::{did_you_mean, listed, quoted};
use crate::tables::{DEFAULT_SPINDLE, SCHEMA, TOP, is_one_at_a_time};
use crate::value;

use super::sums::{are_strategies, is_strategy_or_sum, without_number, without_single_sum};

/// How the lists are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    /// Every value with every other: the full product.
    AllPairs,
    /// Each value alone, with the recipe's own values of all other keys.
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
    /// The path of the key, each part with its span in `[ablation]`.
    pub(super) path: Vec<(String, Span)>,
    /// The recipe's own value first, `None` if the recipe leaves the key out; then the values of the
    /// list.
    pub(super) choices: Vec<Option<Node>>,
}

impl List {
    /// `feed`, `tolerance.residual`.
    pub(super) fn key(&self) -> String {
        dotted(&self.path)
    }

    /// Whether the values are strategies, each a whole table.
    pub(super) fn is_slot(&self) -> bool {
        are_strategies(&keys(&self.path))
    }

    fn order(&self) -> (usize, usize) {
        let last = self.path.last();
        last.map_or((0, 0), |(_, span)| (span.source().rank, span.range().start))
    }
}

/// Tables and keys that cannot vary, and why.
const FIXED: [(&str, &str); 6] = [
    ("format", "it says how the recipe is read"),
    ("name", "it does not change the path"),
    ("plugins", "all runs choose from the same plugins"),
    ("output", "an ablation writes neither paths nor programs"),
    ("passes", "an ablation makes the finishing path alone"),
    ("ablation", "it cannot vary itself"),
];

impl Lists {
    /// Reads `[ablation]` of a whole document; `base` has the recipe's own values.
    pub(super) fn read(document: &Table, base: &Table, whole: &Span) -> Result<Self, Diagnostics> {
        let Some(entry) = document.get("ablation") else {
            return Err(nothing_to_vary(whole, "the recipe has no table [ablation]").into());
        };
        let Value::Table(table) = &entry.node.value else {
            // Reading the recipe has reported this value already.
            return Err(nothing_to_vary(&entry.node.span, "[ablation] is not a table").into());
        };
        let mut diagnostics = Vec::new();
        let mode = mode(table, &entry.node.span, &mut diagnostics);
        let mut walker = Walker {
            base,
            lists: Vec::new(),
            diagnostics,
        };
        walker.table(table, &[]);
        let Walker {
            mut lists,
            diagnostics,
            ..
        } = walker;
        lists.sort_by_key(List::order);
        if lists.is_empty() && diagnostics.is_empty() {
            return Err(
                nothing_to_vary(&entry.node.span, "[ablation] names nothing to vary").into(),
            );
        }
        Diagnostics::unless_any(Some(Self { mode, lists }), diagnostics)
    }
}

fn nothing_to_vary(span: &Span, title: &str) -> Diagnostic {
    Diagnostic::new(span.clone(), title).with_help(
        "write the line [ablation] and below it what to vary, for example: \
         velocity = [{ use = \"three-point\" }, { use = \"analytic\" }]",
    )
}

fn mode(table: &Table, span: &Span, diagnostics: &mut Vec<Diagnostic>) -> Mode {
    let mut section = Section {
        name: "ablation",
        table: Some(table),
        span: span.clone(),
        misspelt: false,
        schema: SCHEMA,
        diagnostics,
    };
    match is_one_at_a_time(&mut section) {
        true => Mode::OneAtATime,
        false => Mode::AllPairs,
    }
}

/// Goes through the tables within `[ablation]`.
struct Walker<'a> {
    base: &'a Table,
    lists: Vec<List>,
    diagnostics: Vec<Diagnostic>,
}

impl Walker<'_> {
    fn table(&mut self, table: &Table, above: &[(String, Span)]) {
        for entry in table.entries() {
            if above.is_empty() && entry.key == "mode" {
                continue;
            }
            let mut path = above.to_vec();
            path.push((entry.key.clone(), entry.span.clone()));
            if let Some(diagnostic) = cannot_vary(&path, entry) {
                self.diagnostics.push(diagnostic);
                continue;
            }
            match &entry.node.value {
                Value::Table(inner) if is_strategy(&path, inner) => {
                    let diagnostic = not_a_strategy(&dotted(&path), &entry.node);
                    self.diagnostics.push(diagnostic);
                }
                Value::Table(inner) if !is_final(&path) => self.table(inner, &path),
                _ => match self.list(path, &entry.node) {
                    Ok(list) => self.add(list, &entry.span),
                    Err(diagnostic) => self.diagnostics.push(diagnostic),
                },
            }
        }
    }

    /// Adds a list, unless another one varies the same key: that of a single surface has two names,
    /// `surface.radius` and `surface.0.radius`.
    fn add(&mut self, list: List, span: &Span) {
        let one_name = |list: &List| without_number(keys(&list.path), self.base).join(".");
        let name = one_name(&list);
        let Some(other) = self.lists.iter().find(|other| one_name(other) == name) else {
            self.lists.push(list);
            return;
        };
        let title = format!("`{}` and `{}` are the same key", other.key(), list.key());
        let diagnostic = Diagnostic::new(span.clone(), title)
            .with_label("varies twice")
            .with_help("write all values in one list");
        self.diagnostics.push(diagnostic);
    }

    fn list(&self, path: Vec<(String, Span)>, node: &Node) -> Result<List, Diagnostic> {
        let key = dotted(&path);
        let items = value::items(&key, node).map_err(|diagnostic| {
            diagnostic.with_help(format!("for example: {}", example(&path)))
        })?;
        if items.is_empty() {
            let title = format!("the list of `{key}` is empty");
            return Err(Diagnostic::new(node.span.clone(), title)
                .with_label("nothing to vary")
                .with_help("give it one or more values, or leave the line out"));
        }
        let names = keys(&path);
        let own = self.base.find(names.iter().copied());
        let own = own.map(|node| whole_spindle(&key, node, self.base));
        let own = own.map(|node| without_single_sum(&names, node));
        let mut choices = vec![own];
        for item in items {
            if are_strategies(&names) && !is_strategy_or_sum(&names, &item.value) {
                return Err(not_a_strategy(&key, item));
            }
            let item = without_single_sum(&names, whole_spindle(&key, item, self.base));
            let same = |choice: &Option<Node>| {
                choice
                    .as_ref()
                    .is_some_and(|choice| are_same(choice, &item))
            };
            if !choices.iter().any(same) {
                choices.push(Some(item));
            }
        }
        Ok(List { path, choices })
    }
}

/// A value of the list `spindle` with what it may leave out: `use` has a default, and `speed` is the
/// recipe's. A value of another list stays as it is.
fn whole_spindle(key: &str, node: &Node, base: &Table) -> Node {
    let mut node = node.clone();
    let Value::Table(table) = &mut node.value else {
        return node;
    };
    if key != Slot::Spindle.key() {
        return node;
    }
    if table.get("use").is_none() {
        let value = Value::Text(DEFAULT_SPINDLE.to_owned());
        let span = node.span.clone();
        table.put(Entry {
            key: "use".to_owned(),
            span: span.clone(),
            node: Node { value, span },
        });
    }
    let own = match base.get(key).map(|entry| &entry.node.value) {
        Some(Value::Table(own)) => own.get("speed"),
        _ => None,
    };
    if let (None, Some(speed)) = (table.get("speed"), own) {
        table.put(speed.clone());
    }
    node
}

/// Whether a path leads to a key, not to a table. This is known only of tables with fixed keys.
fn is_final(path: &[(String, Span)]) -> bool {
    match path {
        [(first, _)] => TOP.has(first),
        [(first, _), ..] => !is_slot(first) && !is_table(&dotted(path)),
        [] => false,
    }
}

/// Whether the value is a single strategy where a list of strategies belongs.
fn is_strategy(path: &[(String, Span)], table: &Table) -> bool {
    let name = table.get("use").map(|entry| &entry.node.value);
    are_strategies(&keys(path)) && matches!(name, Some(Value::Text(_)))
}

fn not_a_strategy(key: &str, item: &Node) -> Diagnostic {
    let help = match &item.value {
        Value::Text(name) => format!("write it as a table: {{ use = {name:?} }}"),
        _ => format!("for example: {key} = [{{ use = \"…\" }}, {{ use = \"…\" }}]"),
    };
    value::wrong_type(key, item, "a list of strategies").with_help(help)
}

/// The message that the key at the end of a path cannot vary, unless it can.
fn cannot_vary(path: &[(String, Span)], entry: &Entry) -> Option<Diagnostic> {
    match path {
        [(first, span)] => cannot_start_with(first, span, entry),
        [(table, _), (key, span)] if !is_slot(table) => {
            let known = keys_of(table);
            (!known.contains(&key.as_str())).then(|| unknown_key(table, key, span, &known))
        }
        [above @ .., (key, span)] if is_table(&dotted(above)) => {
            let (table, key) = (dotted(above), key.as_str());
            let known = keys_of(&table);
            (!known.contains(&key)).then(|| unknown_key(&table, key, span, &known))
        }
        _ => None,
    }
}

fn cannot_start_with(first: &str, span: &Span, entry: &Entry) -> Option<Diagnostic> {
    if let Some((_, why)) = FIXED.iter().find(|(key, _)| *key == first) {
        let title = format!("{} cannot vary", quoted(first));
        return Some(Diagnostic::new(span.clone(), title).with_label(*why));
    }
    let is_table = matches!(entry.node.value, Value::Table(_));
    let known = first_keys();
    match keys_of(first) {
        _ if is_slot(first) => None,
        _ if !known.contains(&first) => Some(unknown_first_key(first, span, &known)),
        keys if keys.is_empty() => None,
        _ if is_table => None,
        keys => {
            let title = format!("`{first}` is a table: name the key that varies");
            let help: Vec<String> = keys.iter().map(|key| format!("{first}.{key}")).collect();
            let help: Vec<&str> = help.iter().map(String::as_str).collect();
            Some(
                Diagnostic::new(span.clone(), title)
                    .with_label("not a key")
                    .with_help(format!("one of {}", listed(&help))),
            )
        }
    }
}

fn unknown_first_key(first: &str, span: &Span, known: &[&str]) -> Diagnostic {
    let elsewhere = || {
        let mut tables = SCHEMA.iter().filter(|table| table.has(first));
        tables
            .next()
            .map(|table| format!("write it with its table: {}.{first}", table.name))
    };
    let title = format!("the recipe has no key or table {} to vary", quoted(first));
    Diagnostic::new(span.clone(), title)
        .with_label("unknown")
        .with_helps(did_you_mean(first, known).or_else(elsewhere))
        .with_help(format!("known: {}", listed(known)))
}

fn unknown_key(table: &str, key: &str, span: &Span, known: &[&str]) -> Diagnostic {
    Diagnostic::new(
        span.clone(),
        format!("[{table}] has no key {}", quoted(key)),
    )
    .with_label("unknown key")
    .with_helps(did_you_mean(key, known))
    .with_help(format!("keys of [{table}]: {}", listed(known)))
}

/// The keys that a path may start with.
fn first_keys() -> Vec<&'static str> {
    let slots = Slot::ALL.iter().map(|slot| slot.key());
    let tables = SCHEMA.iter().map(|table| table.name);
    let tables = tables.filter(|name| !is_slot(name));
    let all = slots.chain(tables).chain(TOP.names());
    all.filter(|name| !name.contains('.') && !FIXED.iter().any(|(fixed, _)| fixed == name))
        .collect()
}

/// The keys of a table with fixed keys; none for any other table.
fn keys_of(table: &str) -> Vec<&'static str> {
    let info = SCHEMA.iter().find(|info| info.name == table);
    info.map_or_else(Vec::new, |info| known_keys(SCHEMA, info))
}

fn is_slot(key: &str) -> bool {
    Slot::ALL.iter().any(|slot| slot.key() == key)
}

fn is_table(name: &str) -> bool {
    SCHEMA.iter().any(|table| table.name == name)
}

/// The keys of a path, without their spans.
fn keys(path: &[(String, Span)]) -> Vec<&str> {
    path.iter().map(|(key, _)| key.as_str()).collect()
}

fn dotted(path: &[(String, Span)]) -> String {
    keys(path).join(".")
}

fn example(path: &[(String, Span)]) -> String {
    match path {
        [(slot, _)] if is_slot(slot) => format!("{slot} = [{{ use = \"…\" }}, {{ use = \"…\" }}]"),
        _ => format!("{} = […, …]", dotted(path)),
    }
}

/// Whether two values are the same. Their spans and the order of their keys do not matter.
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
            let is_in_other = |entry: &Entry| {
                let same_key = other.get(&entry.key);
                same_key.is_some_and(|other| are_same(&entry.node, &other.node))
            };
            one.entries().len() == other.entries().len() && one.entries().iter().all(is_in_other)
        }
        (one, other) => one == other,
    }
}
