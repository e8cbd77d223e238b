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

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Entry, Table, Value};
use crate::read::Sections;
use crate::recipe::{Recipe, build};
use crate::set::{self, Setting};
use crate::span::Span;
use crate::suggest::{did_you_mean, listed, quoted};
use crate::tables::{self, PASSES_TABLE, USE};

/// The tables whose values a rough path may replace.
const OF_A_ROUGH_PATH: [&str; 4] = ["feed", "sampler", "tolerance", "spindle"];
/// A name that the files of dry runs have.
const TAKEN: &str = "dry-run";
/// What names of the parts of long programs begin with, before their number.
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
        let Some(Value::Table(passes)) = self
            .document()
            .get(PASSES_TABLE)
            .map(|entry| &entry.node.value)
        else {
            return Ok(Vec::new());
        };
        let mut base = self.document().clone();
        base.remove(PASSES_TABLE);
        let mut diagnostics = Vec::new();
        let entries = passes.entries().iter();
        let paths = entries.filter_map(|entry| self.rough_path(&base, entry, &mut diagnostics));
        let paths = paths.collect();
        Diagnostics::unless_any(Some(paths), diagnostics)
    }

    fn rough_path(
        &self,
        base: &Table,
        entry: &Entry,
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
        recipe.rough = Some((entry.key.clone(), allowance));
        Some(RoughPath {
            name: entry.key.clone(),
            allowance,
            recipe,
        })
    }
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
    if !is_of_a_file(&entry.key) || is_taken(&entry.key) {
        let title = format!("{} cannot be the end of a file's name", quoted(&entry.key));
        let help = "use letters, digits, `-` and `_`, and not `dry-run` or `part-1`";
        diagnostics.push(Diagnostic::new(entry.span.clone(), title).with_help(help));
        return None;
    }
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

/// Whether other files of a result have this name. Names of parts are in small letters.
fn is_taken(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let number = name.strip_prefix(PART);
    let is_part = number.is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()));
    name == TAKEN || is_part
}
