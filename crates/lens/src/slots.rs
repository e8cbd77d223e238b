//! The numbered parameters of a surface: `PARM`, and `XDAT` for those of long lists.

use std::collections::BTreeMap;

use crate::error::{LensProblem, ProblemKind};
use crate::numbers::{check_fixed, no_number, number, whole};
use crate::record::Record;
use crate::surface_block::SurfaceBlock;

/// Numbered parameters, each with its line.
#[derive(Debug, Clone)]
pub struct Slots {
    key: &'static str,
    line: usize,
    values: BTreeMap<u32, (usize, f64)>,
}

impl Slots {
    /// All parameters with this key.
    pub fn read(block: &SurfaceBlock<'_>, key: &'static str) -> Result<Self, LensProblem> {
        let mut values = BTreeMap::new();
        for record in block.records.iter().filter(|record| record.key == key) {
            let (index, value) = slot(record, key)?;
            if values.insert(index, (record.line, value)).is_some() {
                let key = format!("{key} {index}");
                return Err(ProblemKind::Twice { key }.at(record.line));
            }
        }
        let line = block.line;
        Ok(Self { key, line, values })
    }

    /// A parameter; 0 if the file does not name it.
    pub fn get(&self, index: u32) -> f64 {
        self.values.get(&index).map_or(0.0, |(_, value)| *value)
    }

    /// The line of a parameter; that of the surface if the file does not name it.
    pub fn line(&self, index: u32) -> usize {
        self.values.get(&index).map_or(self.line, |(line, _)| *line)
    }

    /// A parameter that counts, up to `most`.
    pub fn count(&self, index: u32, most: u32) -> Result<u32, LensProblem> {
        let value = self.get(index);
        match value.fract() == 0.0 && (0.0..=f64::from(most)).contains(&value) {
            true => Ok(value as u32),
            false => {
                let found = value.to_string();
                Err(no_number(self.line(index), &found, "count of terms"))
            }
        }
    }

    /// Refuses parameters that are not 0 and that `is_known` does not take.
    pub fn check(&self, kind: &'static str, is_known: impl Fn(u32) -> bool) -> Vec<LensProblem> {
        let all = self.values.iter();
        let unknown = all.filter(|(index, (_, value))| *value != 0.0 && !is_known(**index));
        let problem = |(index, (line, value)): (&u32, &(usize, f64))| {
            let (key, index, value) = (self.key, *index, *value);
            let slot = ProblemKind::Slot {
                key,
                index,
                kind,
                value,
            };
            slot.at(*line)
        };
        unknown.map(problem).collect()
    }
}

/// The line `PARM number value`, or `XDAT number value status …`.
fn slot(record: &Record<'_>, key: &'static str) -> Result<(u32, f64), LensProblem> {
    let mut words = record.words();
    let index = whole(record.line, words.next())?;
    let value = number(record.line, words.next())?;
    check_fixed(record, words.next(), key)?;
    Ok((index, value))
}
