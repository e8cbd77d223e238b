//! The key of a run: the hash of all that its figures depend on.
//!
//! These are the variant's own values, the contents of its data files, the plugins that it
//! chooses, and [`FIGURES`]. The key does not depend on comments, on the order of keys, on
//! the job's name, or on what else the ablation varies.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde_json::{Map, Value as Json, json};
use turnpath_host::{Catalogue, Identity, Plugin, sha256_hex};
use turnpath_post::POST_NAMES;
use turnpath_recipe::{Recipe, Table, Value, Variant};

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::named_files::UsedFile;
use crate::plugins;
use crate::strategies::{choices, used_files};

/// Counts the changes of what a record holds.
const RECORD_FORMAT: u32 = 5;
/// Counts the changes of figures that an ablation reports: raise it when a change moves a figure. The
/// test `recorded_figures` of the suite `figures` fails where that was forgotten.
pub const FIGURES: u32 = 7;
/// Keys that no figure depends on.
const NO_PART: [&str; 3] = ["format", "name", "plugins"];
/// Keys of `[output]` that a program's size depends on, besides the tables of posts.
const OUTPUT_PART: [&str; 2] = ["posts", "z_reference"];

/// A run's key.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// SHA-256 in lower-case hexadecimal.
    pub hash: String,
    /// What was hashed.
    pub of: Json,
    /// Why no record is known to be of this run; `None` where its record is.
    pub unknown: Option<String>,
}

/// Makes the keys of runs.
pub struct Keys<'a> {
    catalogue: &'a Catalogue,
    files: &'a DataFiles,
}

impl<'a> Keys<'a> {
    /// Plugins are looked up in the catalogue, and data files are read unless they were before.
    pub fn new(catalogue: &'a Catalogue, files: &'a DataFiles) -> Self {
        Self { catalogue, files }
    }

    /// A key for each variant.
    ///
    /// # Errors
    /// When a data file of a variant cannot be read, or the hash of a library cannot be calculated.
    pub fn of_all(&self, variants: &[Variant]) -> Result<Vec<Key>, Error> {
        let key = |variant: &Variant| {
            let recipe = &variant.recipe;
            let files = used_files(recipe, self.catalogue, self.files)?;
            self.of(recipe, &files)
        };
        variants.iter().map(key).collect()
    }

    fn of(&self, recipe: &Recipe, files: &[UsedFile]) -> Result<Key, Error> {
        let values = values(recipe.document());
        let hash = |file: &UsedFile| {
            let key = format!("{}.{}", file.table, file.param);
            (key, json!(file.contents.sha256))
        };
        let files: Map<String, Json> = files.iter().map(hash).collect();
        let mut of = json!({
            "record": RECORD_FORMAT,
            "turnpath": env!("CARGO_PKG_VERSION"),
            "figures": FIGURES,
            "plugins": self.plugins(recipe)?,
            "files": files,
            "values": values,
        });
        let own = self.identities(recipe).filter_map(|(name, of)| match of {
            Identity::Hash(hash) => Some((name, hash)),
            Identity::Unknown(_) => None,
        });
        let own: BTreeMap<String, &String> = own.collect();
        if !own.is_empty() {
            of["own"] = json!(own);
        }
        Ok(Key {
            hash: sha256_hex(of.to_string().as_bytes()),
            of,
            unknown: self.unknown(recipe),
        })
    }

    /// The strategies of a recipe that cannot be told from others of their names.
    fn unknown(&self, recipe: &Recipe) -> Option<String> {
        let texts = self.identities(recipe).filter_map(|(name, of)| match of {
            Identity::Unknown(why) => Some(format!("the {name}: {why}")),
            Identity::Hash(_) => None,
        });
        let texts: BTreeSet<String> = texts.collect();
        let texts: Vec<String> = texts.into_iter().collect();
        (!texts.is_empty()).then(|| texts.join("; "))
    }

    /// The strategies of the program among those of a recipe, `sampler even`, with what tells them from
    /// others of their names.
    fn identities(&self, recipe: &Recipe) -> impl Iterator<Item = (String, &'a Identity)> {
        choices(recipe).filter_map(|choice| {
            let strategy = self.catalogue.find(choice.slot, choice.name())?;
            let name = format!("{} {}", choice.slot, choice.name());
            Some((name, strategy.identity()?))
        })
    }

    fn plugins(&self, recipe: &Recipe) -> Result<Vec<Json>, Error> {
        let mut used = plugins::used(recipe, self.catalogue);
        used.sort_by(|one, other| one.name.cmp(&other.name));
        let one = |plugin: &Arc<Plugin>| {
            let sha256 = plugin.sha256()?;
            Ok(json!({ "name": plugin.name, "version": plugin.version, "sha256": sha256 }))
        };
        used.into_iter().map(one).collect()
    }
}

/// The values that figures depend on, their keys in alphabetic order.
fn values(document: &Table) -> Json {
    let mut values = canonical_table(document, |key| !NO_PART.contains(&key));
    if let Some(Json::Object(output)) = values.get_mut("output") {
        let parts = [&OUTPUT_PART[..], POST_NAMES].concat();
        output.retain(|key, _| parts.contains(&key.as_str()));
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
    use super::*;
    use crate::data_files::Contents;

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

    fn key(text: &str, files: &[UsedFile]) -> Key {
        let recipe = Recipe::parse(text, "recipe.toml", &[]).unwrap();
        let (catalogue, data) = (Catalogue::new(), DataFiles::default());
        Keys::new(&catalogue, &data).of(&recipe, files).unwrap()
    }

    #[test]
    fn the_contents_of_data_files_count() {
        let file = |bytes: &[u8]| UsedFile {
            table: "surface".to_owned(),
            param: "map",
            path: "map.dat".to_owned(),
            contents: Contents {
                bytes: bytes.into(),
                sha256: sha256_hex(bytes),
            },
        };
        let before = key(RECIPE, &[file(b"1 2 3")]);
        assert_eq!(before, key(RECIPE, &[file(b"1 2 3")]));
        let hash = before.of["files"]["surface.map"].as_str().unwrap();
        assert_eq!(hash, sha256_hex(b"1 2 3"));
        assert_ne!(before.hash, key(RECIPE, &[file(b"1 2 4")]).hash);
    }

    #[test]
    fn names_comments_and_the_order_of_keys_do_not_count_and_values_do() {
        let key = |from: &str, to: &str| {
            assert!(RECIPE.contains(from), "{from}");
            key(&RECIPE.replacen(from, to, 1), &[]).hash
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
