//! `ablation.json` and `ablation.csv`.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};
use turnpath_core::Slot;
use turnpath_post::{Draft, FileError};
use turnpath_recipe::Variant;

use crate::summary::to_json;

use super::Outcome;
use super::columns::{self, figure};

const JSON: &str = "ablation.json";
const CSV: &str = "ablation.csv";

/// What each variant gave, in their order: a summary with `varied`, `program_bytes` and
/// `planning_time_s`, or a chain with `varied` and `error`.
pub fn entries(variants: &[Variant], outcomes: &[Outcome]) -> Vec<Value> {
    let both = variants.iter().zip(outcomes);
    both.map(|(variant, outcome)| entry(variant, outcome))
        .collect()
}

fn entry(variant: &Variant, outcome: &Outcome) -> Value {
    let mut entry = Map::new();
    match outcome {
        Ok(made) => {
            if let Value::Object(summary) = &made.summary {
                entry.extend(summary.clone());
            }
            // Names play no part in what is taken over.
            entry.insert("name".to_owned(), json!(variant.recipe.name));
            entry.insert("program_bytes".to_owned(), json!(made.program_bytes));
            entry.insert("planning_time_s".to_owned(), json!(made.planning_time_s));
        }
        Err(failure) => {
            entry.insert("chain".to_owned(), chain(variant));
            entry.insert("error".to_owned(), json!(failure.title()));
        }
    }
    let varied = variant.variations.iter();
    let varied: Map<String, Value> = varied
        .map(|varied| (varied.key.clone(), json!(varied.value)))
        .collect();
    entry.insert("varied".to_owned(), Value::Object(varied));
    Value::Object(entry)
}

fn chain(variant: &Variant) -> Value {
    let slots = Slot::ALL.into_iter();
    let names = slots.map(|slot| {
        let name = variant.recipe.choice(slot).name();
        (slot.key().to_owned(), json!(name))
    });
    Value::Object(names.collect())
}

/// The content of `ablation.json`.
pub fn document(entries: &[Value]) -> Value {
    json!({ "runs": entries })
}

/// The files of an ablation.
pub struct Report {
    folder: PathBuf,
}

impl Report {
    /// Makes the folder, and begins the files, so that one that takes none is told before the work.
    pub fn ready(folder: &Path) -> Result<Self, FileError> {
        fs::create_dir_all(folder).map_err(|error| FileError {
            path: folder.to_owned(),
            error,
        })?;
        for name in [JSON, CSV] {
            drop(Draft::begin(folder.join(name))?);
        }
        let folder = folder.to_owned();
        Ok(Self { folder })
    }

    /// Writes both files; gives their paths.
    pub fn write(
        &self,
        variants: &[Variant],
        entries: &[Value],
    ) -> Result<Vec<PathBuf>, FileError> {
        let first = variants
            .first()
            .map(|variant| variant.variations.as_slice());
        let keys = first.unwrap_or_default().iter();
        let keys: Vec<&str> = keys.map(|varied| varied.key.as_str()).collect();
        let (csv, json) = (self.folder.join(CSV), self.folder.join(JSON));
        let table = csv_table(&keys, entries).map_err(|error| FileError {
            path: csv.clone(),
            error,
        })?;
        let csv = write(csv, &table)?;
        let json = write(json, to_json(&document(entries)).as_bytes())?;
        Ok(vec![json, csv])
    }
}

fn write(path: PathBuf, bytes: &[u8]) -> Result<PathBuf, FileError> {
    let mut draft = Draft::begin(&path)?;
    match draft.write_all(bytes) {
        Ok(()) => draft.complete(),
        Err(error) => Err(FileError { path, error }),
    }
}

/// A header, and a row a run: its number, what varies, all figures, which tolerances and limits hold, why it
/// failed.
fn csv_table(keys: &[&str], entries: &[Value]) -> io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let limits = limits(entries);
    let texts = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
    let figures = columns::ALL.iter().map(|column| column.csv.to_owned());
    let within = limits.iter().map(|limit| format!("within_{limit}"));
    let header: Vec<Vec<String>> = vec![
        texts(&["run"]),
        texts(keys),
        figures.collect(),
        within.collect(),
        texts(&["reason"]),
    ];
    writer.write_record(header.concat())?;
    for (index, entry) in entries.iter().enumerate() {
        let varied = keys.iter().map(|key| text(&entry["varied"][*key]));
        let figures = columns::ALL.iter();
        let figures = figures.map(|column| figure(entry, column).map_or_else(String::new, text));
        let within = limits.iter().map(|limit| text(&entry["within"][*limit]));
        let row: Vec<Vec<String>> = vec![
            vec![(index + 1).to_string()],
            varied.collect(),
            figures.collect(),
            within.collect(),
            vec![text(&entry["error"])],
        ];
        writer.write_record(row.concat())?;
    }
    writer
        .into_inner()
        .map_err(|error| io::Error::other(error.to_string()))
}

/// The tolerances and limits of which any run tells whether they hold.
fn limits(entries: &[Value]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    let within = entries.iter().filter_map(|entry| entry.get("within"));
    for name in within.filter_map(Value::as_object).flat_map(Map::keys) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

/// A value as it stands in CSV: a string without quotes, nothing for null.
fn text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}
