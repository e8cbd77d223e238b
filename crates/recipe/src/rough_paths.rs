//! `[passes]`: paths before the finishing one, each with an allowance and with values of its own.
//!
//! ```toml
//! [passes.rough]
//! allowance = "30 um"                           # what it leaves along z
//! feed = { use = "constant", feed = "30 um/rev" }    # in place of the whole [feed]
//! tolerance.interpolation = "1 um"              # in place of that key alone
//! ```
//!
//! The key has the word of the shop. In the workspace a pass is one turn of the spiral, so what the
//! table lists is called a rough path.

use turnpath_core::UM;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Entry, Table, Value};
use crate::read::Sections;
use crate::recipe::{Recipe, build};
use crate::rough_place::RoughPlace;
use crate::set::{self, Setting};
use crate::span::Span;
use crate::suggest::{did_you_mean, listed, quoted};
use crate::tables::{self, PASSES_TABLE, USE};

/// The tables whose values a rough path may replace.
const OF_A_ROUGH_PATH: [&str; 4] = ["feed", "sampler", "tolerance", "spindle"];
/// What the names of the files of dry runs end with.
const DRY_RUN: &str = "dry-run";
/// What those of the parts of long programs end with, before their number.
const PART: &str = "part-";

/// A path before the finishing one.
#[derive(Debug, Clone, PartialEq)]
pub struct RoughPath {
    /// Its name, also at the end of its files' names.
    pub name: String,
    /// What it leaves on the wanted surface, along z, mm.
    pub allowance: f64,
    /// The recipe of its path: that of the finishing path with the rough path's own values, and with the
    /// surface lifted by the allowance.
    pub recipe: Recipe,
}

/// The tables that a rough path may have of its own.
pub fn rough_path_tables() -> [&'static str; 4] {
    OF_A_ROUGH_PATH
}

impl Recipe {
    /// The rough paths that `[passes]` lists, in their order; none for a recipe of such a path.
    ///
    /// # Errors
    /// When something in that table is wrong. The messages have their spans there.
    pub fn rough_paths(&self) -> Result<Vec<RoughPath>, Diagnostics> {
        let mut base = self.document().clone();
        base.remove(PASSES_TABLE);
        let mut diagnostics = Vec::new();
        let entries = self.listed_paths();
        let mut paths = Vec::new();
        for (entry, number) in entries.iter().zip(1..) {
            match taken_name(entry, entries) {
                Some(taken) => diagnostics.push(taken),
                None => paths.extend(self.rough_path((&base, entry), number, &mut diagnostics)),
            }
        }
        diagnostics.extend(idle_path(&paths, entries));
        Diagnostics::unless_any(Some(paths), diagnostics)
    }

    /// The number of the recipe's path among those of its run: 0 for the finishing one, and that of a rough one
    /// from 1. `None` where the run makes no other path.
    pub fn path_of_several(&self) -> Option<u32> {
        match &self.rough {
            Some(rough) => Some(rough.number),
            None => (self.rough_path_count() > 0).then_some(0),
        }
    }

    /// How many rough paths `[passes]` lists.
    pub fn rough_path_count(&self) -> usize {
        self.listed_paths().len()
    }

    /// The entries of `[passes]`.
    fn listed_paths(&self) -> &[Entry] {
        let passes = self.document().get(PASSES_TABLE);
        match passes.map(|entry| &entry.node.value) {
            Some(Value::Table(passes)) => passes.entries(),
            _ => &[],
        }
    }

    fn rough_path(
        &self,
        (base, entry): (&Table, &Entry),
        number: u32,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<RoughPath> {
        let (allowance, own) = own_values(entry, self.whole(), diagnostics)?;
        let mut document = base.clone();
        for setting in own {
            diagnostics.extend(set::put(&mut document, setting).err());
        }
        let sets = self.sets().to_vec();
        let whole = self.whole().clone();
        let mut recipe = build(document, sets, whole, self.path(), diagnostics)?;
        recipe.name = format!("{}, {}", recipe.name, entry.key);
        recipe.rough = Some(RoughPlace {
            name: entry.key.clone(),
            allowance,
            number,
        });
        Some(RoughPath {
            name: entry.key.clone(),
            allowance,
            recipe,
        })
    }
}

/// Digits behind the point of lengths in messages.
const DIGITS: f64 = 1e6;

/// What is wrong with the first path that leaves more than the one before it, which would cut nothing.
fn idle_path(paths: &[RoughPath], entries: &[Entry]) -> Option<Diagnostic> {
    let mut pairs = paths.windows(2);
    let (before, idle) = pairs.find_map(|pair| match pair {
        [before, next] if next.allowance > before.allowance => Some((before, next)),
        _ => None,
    })?;
    let entry = entries.iter().find(|entry| entry.key == idle.name)?;
    let in_um = |path: &RoughPath| (path.allowance / UM * DIGITS).round() / DIGITS;
    let [leaves, left] = [idle, before].map(in_um);
    let title = format!(
        "{} would cut nothing: it leaves {leaves} um, and {} before it only {left} um",
        quoted(&idle.name),
        quoted(&before.name)
    );
    let help = "the paths are cut in their order, so the allowances must fall";
    Some(Diagnostic::new(entry.span.clone(), title).with_help(help))
}

/// The allowance of a rough path, and the values that it has instead of the recipe's.
fn own_values(
    entry: &Entry,
    whole: &Span,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<(f64, Vec<Setting>)> {
    let path = format!("{PASSES_TABLE}.{}", entry.key);
    let Value::Table(table) = &entry.node.value else {
        let title = format!("`{path}` must be a table");
        let help = format!("write the line [{path}], and its keys below it");
        diagnostics.push(Diagnostic::new(entry.span.clone(), title).with_help(help));
        return None;
    };
    let known: Vec<&str> = tables::allowance_key().chain(OF_A_ROUGH_PATH).collect();
    let mut own = Vec::new();
    for inner in table.entries() {
        let key = inner.key.as_str();
        if OF_A_ROUGH_PATH.contains(&key) {
            own.extend(settings(inner));
        } else if !known.contains(&key) {
            let title = format!("[{path}] has no key {}", quoted(key));
            let diagnostic = Diagnostic::new(inner.span.clone(), title)
                .with_label("unknown key")
                .with_helps(did_you_mean(key, &known))
                .with_help(format!("keys of [{path}]: {}", listed(&known)));
            diagnostics.push(diagnostic);
        }
    }
    let mut sections = Sections {
        root: table,
        whole,
        schema: tables::SCHEMA,
        diagnostics,
    };
    let mut section = sections.open_table(&path, table, entry.node.span.clone());
    let allowance = tables::allowance(&mut section)?;
    Some((allowance, own))
}

/// A table with a strategy stands for the recipe's whole one; of another table each key stands for
/// itself.
fn settings(entry: &Entry) -> Vec<Setting> {
    let table_key = (entry.key.clone(), entry.span.clone());
    match &entry.node.value {
        Value::Table(table) if table.get(USE.name()).is_none() => {
            let one = |inner: &Entry| Setting {
                keys: vec![table_key.clone(), (inner.key.clone(), inner.span.clone())],
                node: inner.node.clone(),
            };
            table.entries().iter().map(one).collect()
        }
        _ => vec![Setting {
            keys: vec![table_key],
            node: entry.node.clone(),
        }],
    }
}

fn is_of_a_file(name: &str) -> bool {
    let good = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    !name.is_empty() && name.chars().all(good)
}

/// A path's name as in the names of parts: in small letters, and some controllers take no `-`.
fn as_in_parts(name: &str) -> String {
    name.to_ascii_lowercase().replace('_', "-")
}

/// Why a path's name cannot be the end of the names of its files, if it cannot.
fn taken_name(entry: &Entry, all: &[Entry]) -> Option<Diagnostic> {
    let own = as_in_parts(&entry.key);
    let wrong = |title: String, help: &str| {
        Some(Diagnostic::new(entry.span.clone(), title).with_help(help))
    };
    if !is_of_a_file(&own) || is_other_file(&own) {
        let title = format!("{} cannot be the end of a file's name", quoted(&entry.key));
        let help = "use letters, digits, `-` and `_`, and not `dry-run` or `part-1`";
        return wrong(title, help);
    }
    let mut is_earlier = true;
    for other in all {
        let (name, said) = (as_in_parts(&other.key), quoted(&other.key));
        is_earlier &= other.key != entry.key;
        let rest = own.strip_prefix(&name);
        if rest == Some("") && is_earlier {
            let title = format!(
                "{} and {said} give the same names of parts",
                quoted(&entry.key)
            );
            return wrong(
                title,
                "capital letters do not count there, nor do `-` and `_`",
            );
        }
        if rest
            .and_then(|rest| rest.strip_prefix('-'))
            .is_some_and(is_other_file)
        {
            let title = format!(
                "{} is the name of other files of {said}",
                quoted(&entry.key)
            );
            let help = "the dry run of a program, or a part of it, would have the same name: choose another one";
            return wrong(title, help);
        }
    }
    None
}

/// Whether other files of a path have this behind its name.
fn is_other_file(end: &str) -> bool {
    let number = end
        .strip_prefix(PART)
        .and_then(|number| number.strip_prefix(|digit| matches!(digit, '1'..='9')));
    end == DRY_RUN || number.is_some_and(|rest| rest.bytes().all(|byte| byte.is_ascii_digit()))
}
