//! The comparison as CSV.

use crate::ablation::AblationRun;
use crate::unit::rounded;

use super::all_columns::all;
use super::column::{Column, Form};

/// A header, and a row a run: its number, what varies, all figures, which tolerances and limits
/// hold, why it failed, and where a run has no record, why it has none.
///
/// # Errors
/// When the CSV cannot be put together; its sink is memory, so there is no such case known.
pub fn csv_table(runs: &[AblationRun]) -> csv::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let keys = runs.first().map(|run| run.varied.as_slice());
    let keys: Vec<&str> = keys
        .unwrap_or_default()
        .iter()
        .map(|pair| pair.0.as_str())
        .collect();
    let limits = limits(runs);
    let unrecorded = runs.iter().any(|run| run.not_recorded.is_some());
    let last = |text: String| unrecorded.then_some(text);
    let header = header(&keys, &limits).into_iter();
    writer.write_record(header.chain(last("not_recorded".to_owned())))?;
    for (index, run) in runs.iter().enumerate() {
        let row = row(index + 1, run, &keys, &limits).into_iter();
        writer.write_record(row.chain(last(run.not_recorded.clone().unwrap_or_default())))?;
    }
    writer
        .into_inner()
        .map_err(|error| error.into_error().into())
}

fn header(keys: &[&str], limits: &[&str]) -> Vec<String> {
    let keys = keys.iter().map(|key| (*key).to_owned());
    let figures = all().into_iter().map(|one| one.csv.to_owned());
    let within = limits.iter().map(|limit| format!("within_{limit}"));
    let row = std::iter::once("run".to_owned()).chain(keys);
    let row = row.chain(figures).chain(within);
    row.chain(["reason".to_owned()]).collect()
}

fn row(number: usize, run: &AblationRun, keys: &[&str], limits: &[&str]) -> Vec<String> {
    let value = |key: &&str| {
        let pair = run.varied.iter().find(|pair| pair.0 == *key);
        pair.map_or_else(String::new, |pair| pair.1.clone())
    };
    let figures = all().into_iter().map(|column| figure(run, column));
    let holds = |limit: &&str| {
        let mut entries = run.verdict().into_iter().flat_map(|one| one.entries());
        let entry = entries.find(|(name, _)| name == limit);
        let holds = entry.and_then(|(_, holds)| holds);
        holds.map_or_else(String::new, |holds| holds.to_string())
    };
    let row = std::iter::once(number.to_string());
    let row = row.chain(keys.iter().map(value)).chain(figures);
    let row = row.chain(limits.iter().map(holds));
    row.chain([run.error().unwrap_or_default().to_owned()])
        .collect()
}

/// The tolerances and limits that an ablation judges; a run of it has no programs and no file.
fn limits(runs: &[AblationRun]) -> Vec<&'static str> {
    let judged = runs.iter().find_map(AblationRun::verdict);
    let names = judged.into_iter().flat_map(|one| one.entries());
    let names = names.map(|(name, _)| name);
    names
        .filter(|name| !["reach", "result", "whole", "spindle", "programs"].contains(name))
        .collect()
}

/// A figure with all its digits; nothing where a run has none.
pub(super) fn figure(run: &AblationRun, column: &Column) -> String {
    let number = run.measured().and_then(column.figure);
    match number.filter(|number| number.is_finite()) {
        None => String::new(),
        Some(number) if matches!(column.form, Form::Count | Form::Bytes) => {
            (number as u64).to_string()
        }
        Some(number) => serde_json::Number::from_f64(rounded(number))
            .map_or_else(String::new, |number| number.to_string()),
    }
}
