//! The key of a run: the hash of all that its figures depend on.
//!
//! These are the variant's own values, the contents of the files that it names, the plugins that it
//! chooses, and the program that runs. The key does not depend on comments, on the order of keys, on
//! the job's name, or on what else the ablation varies.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::PathBuf;

use serde_json::{Map, Value as Json, json};
use turnpath_host::{Catalogue, sha256_hex, sha256_hex_of_file};
use turnpath_recipe::{Recipe, Table, Value, Variant};

use crate::plugins;

/// Counts the changes of what a record holds.
const RECORD_FORMAT: u32 = 3;
/// Keys that no figure depends on.
const NO_PART: [&str; 3] = ["format", "name", "plugins"];
/// Keys of `[output]` that a program's size depends on.
const OUTPUT_PART: [&str; 3] = ["posts", "z_reference", "pmac-pvt"];

/// A run's key.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// SHA-256 in lower-case hexadecimal.
    pub hash: String,
    /// What was hashed.
    pub of: Json,
}

/// Makes the keys of runs.
pub struct Keys<'a> {
    catalogue: &'a Catalogue,
    program: Option<String>,
    /// Hashes of files that were read already.
    files: RefCell<BTreeMap<PathBuf, Option<String>>>,
}

impl<'a> Keys<'a> {
    /// Nothing hashed yet; plugins are looked up in the catalogue.
    pub fn new(catalogue: &'a Catalogue) -> Self {
        let program = std::env::current_exe().and_then(|path| sha256_hex_of_file(&path));
        Self {
            catalogue,
            program: program.ok(),
            files: RefCell::default(),
        }
    }

    /// A key for each variant.
    pub fn of_all(&self, variants: &[Variant]) -> Vec<Key> {
        let key = |variant: &Variant| self.of(&variant.recipe);
        variants.iter().map(key).collect()
    }

    fn of(&self, recipe: &Recipe) -> Key {
        let values = values(recipe.document());
        let mut files = Map::new();
        self.add_files(recipe, &values, &mut files);
        let of = json!({
            "record": RECORD_FORMAT,
            "turnpath": env!("CARGO_PKG_VERSION"),
            "program": self.program,
            "plugins": self.plugins(recipe),
            "files": files,
            "values": values,
        });
        Key {
            hash: sha256_hex(of.to_string().as_bytes()),
            of,
        }
    }

    fn plugins(&self, recipe: &Recipe) -> Vec<Json> {
        let mut used = plugins::used(recipe, self.catalogue);
        used.sort_by(|one, other| one.name.cmp(&other.name));
        let one = |plugin: &turnpath_host::Plugin| json!({ "name": plugin.name, "version": plugin.version, "sha256": plugin.sha256 });
        used.into_iter().map(one).collect()
    }

    /// Every text of the recipe that is the name of a file beside it, with the file's hash: which
    /// parameters are files, strategies alone know.
    fn add_files(&self, recipe: &Recipe, value: &Json, files: &mut Map<String, Json>) {
        match value {
            Json::String(text) => {
                let path = recipe.resolve(text);
                if path.is_file() {
                    files.insert(text.clone(), json!(self.hash_once(path)));
                }
            }
            Json::Array(items) => items
                .iter()
                .for_each(|item| self.add_files(recipe, item, files)),
            Json::Object(entries) => entries
                .values()
                .for_each(|entry| self.add_files(recipe, entry, files)),
            _ => {}
        }
    }

    /// None for a file that cannot be read; whoever needs it will say so.
    fn hash_once(&self, path: PathBuf) -> Option<String> {
        let mut known = self.files.borrow_mut();
        let hash = known.entry(path);
        hash.or_insert_with_key(|path| sha256_hex_of_file(path).ok())
            .clone()
    }
}

/// The values that figures depend on, their keys in alphabetic order.
fn values(document: &Table) -> Json {
    let mut values = canonical_table(document, |key| !NO_PART.contains(&key));
    if let Some(Json::Object(output)) = values.get_mut("output") {
        output.retain(|key, _| OUTPUT_PART.contains(&key.as_str()));
    }
    values.retain(|key, value| key != "output" || *value != json!({}));
    Json::Object(values)
}

fn canonical_table(table: &Table, takes: impl Fn(&str) -> bool) -> Map<String, Json> {
    let entries = table.entries().iter();
    let entries = entries.filter(|entry| takes(&entry.key));
    let sorted: BTreeMap<&String, Json> = entries
        .map(|entry| (&entry.key, canonical(&entry.node.value)))
        .collect();
    let owned = |(key, value): (&String, Json)| (key.clone(), value);
    sorted.into_iter().map(owned).collect()
}

fn canonical(value: &Value) -> Json {
    match value {
        Value::Text(text) => json!(text),
        Value::Number(number) => json!(number),
        Value::Flag(flag) => json!(flag),
        // No key of a recipe takes one.
        Value::Date => Json::Null,
        Value::Array(items) => items.iter().map(|item| canonical(&item.value)).collect(),
        Value::Table(table) => Json::Object(canonical_table(table, |_| true)),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    const RECIPE: &str = r#"format = 1
name = "Map"
[part]
aperture = "5 mm"
[surface]
use = "grid"
map = "map.dat"
[tool]
nose_radius = "1 mm"
[tolerance]
interpolation = "100 nm"
residual = "100 nm"
[spindle]
speed = "500 rpm"
[path]
overrun = "none"
lead = false
[feed]
use = "constant"
[sampler]
use = "equal-angle"
[compensator]
use = "z-direction"
[velocity]
use = "analytic"
"#;

    fn key(folder: &Path, text: &str) -> Key {
        let recipe = Recipe::parse(text, folder.join("recipe.toml"), &[]).unwrap();
        Keys::new(&Catalogue::new()).of(&recipe)
    }

    #[test]
    fn the_contents_of_files_that_the_recipe_names_count() {
        let folder = tempfile::tempdir().unwrap();
        let map = folder.path().join("map.dat");
        std::fs::write(&map, "1 2 3").unwrap();
        let before = key(folder.path(), RECIPE);
        assert_eq!(before, key(folder.path(), RECIPE));
        let hash = before.of["files"]["map.dat"].as_str().unwrap();
        assert_eq!(hash, sha256_hex(b"1 2 3"));
        std::fs::write(&map, "1 2 4").unwrap();
        assert_ne!(before.hash, key(folder.path(), RECIPE).hash);
    }

    #[test]
    fn names_comments_and_the_order_of_keys_do_not_count_and_values_do() {
        let folder = tempfile::tempdir().unwrap();
        let key = |from: &str, to: &str| {
            assert!(RECIPE.contains(from), "{from}");
            key(folder.path(), &RECIPE.replacen(from, to, 1)).hash
        };
        let same = key("Map", "Map");
        assert_eq!(same, key("Map", "Another"));
        assert_eq!(same, key("[tool]", "# the old one\n[tool]"));
        assert_eq!(
            same,
            key(
                "overrun = \"none\"\nlead = false",
                "lead = false\noverrun = \"none\""
            )
        );
        assert_eq!(same, key("[feed]", "[output]\ndata = []\n[feed]"));
        assert_ne!(same, key("1 mm", "2 mm"));
        assert_ne!(
            same,
            key("[feed]", "[output]\nposts = [\"pmac-pvt\"]\n[feed]")
        );
    }
}
