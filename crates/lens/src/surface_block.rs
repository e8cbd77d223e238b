//! The lines of one surface.

use crate::error::{LensProblem, ProblemKind};
use crate::numbers::{fixed_number, no_number, number};
use crate::record::Record;

/// The type of a surface whose lines do not name one.
const STANDARD: &str = "STANDARD";

/// A break of coordinates, which is no surface.
const BREAK: &str = "COORDBRK";

/// A metre in mm: the largest unit of a file.
const LARGEST_UNIT: f64 = 1e3;

/// What a mirror has for a glass.
const MIRROR: &str = "MIRROR";

/// The lines of one surface.
#[derive(Debug, Clone)]
pub struct SurfaceBlock<'a> {
    /// Its number, from 0, which is the object.
    pub number: usize,
    /// The line that begins it.
    pub line: usize,
    /// The lines after that.
    pub records: Vec<Record<'a>>,
}

impl<'a> SurfaceBlock<'a> {
    /// The only line with this key.
    ///
    /// # Errors
    /// When there are two.
    pub fn only(&self, key: &str) -> Result<Option<&Record<'a>>, LensProblem> {
        let mut found = self.records.iter().filter(|record| record.key == key);
        let first = found.next();
        match found.next() {
            None => Ok(first),
            Some(second) => {
                let key = key.to_owned();
                Err(ProblemKind::Twice { key }.at(second.line))
            }
        }
    }

    /// The first line with this key.
    pub fn first(&self, key: &str) -> Option<&Record<'a>> {
        self.records.iter().find(|record| record.key == key)
    }

    /// The type, in capital letters, and its line.
    pub fn kind(&self) -> (String, usize) {
        let record = self.first("TYPE");
        let word = record.and_then(|record| record.words().next());
        let line = record.map_or(self.line, |record| record.line);
        (word.unwrap_or(STANDARD).to_ascii_uppercase(), line)
    }

    /// Whether it is a break of coordinates.
    pub fn is_break(&self) -> bool {
        self.kind().0 == BREAK
    }

    /// The curvature at the vertex, 1 by the file's unit.
    pub fn curvature(&self) -> Result<f64, LensProblem> {
        match self.only("CURV")? {
            None => {
                let number = self.number;
                Err(ProblemKind::NoCurvature { number }.at(self.line))
            }
            Some(record) => {
                let curvature = fixed_number(record, "CURV")?;
                match curvature == 0.0 || (LARGEST_UNIT / curvature).is_finite() {
                    true => Ok(curvature),
                    false => Err(no_number(record.line, record.rest, "curvature")),
                }
            }
        }
    }

    /// The conic constant.
    pub fn conic(&self) -> Result<f64, LensProblem> {
        let record = self.only("CONI")?;
        record.map_or(Ok(0.0), |record| fixed_number(record, "CONI"))
    }

    /// What fills the space behind it: `None` is air, `Some(true)` a mirror, `Some(false)` a glass.
    pub fn glass(&self) -> Option<bool> {
        let word = self.first("GLAS")?.words().next()?;
        Some(word.eq_ignore_ascii_case(MIRROR))
    }

    /// The distance to the next surface in the file's unit; infinite for the word `INFINITY`.
    pub fn thickness(&self) -> Option<f64> {
        let word = self.first("DISZ")?.words().next()?;
        match word.eq_ignore_ascii_case("INFINITY") {
            true => Some(f64::INFINITY),
            false => word.parse().ok().filter(|value: &f64| value.is_finite()),
        }
    }

    /// The comment.
    pub fn comment(&self) -> Option<&'a str> {
        let text = self.first("COMM").map(Record::text);
        text.filter(|text| !text.is_empty())
    }

    /// The numbers of a break of coordinates that are not 0: two decentres, three tilts in deg.
    pub fn break_numbers(&self) -> Vec<(&'static str, f64)> {
        const NAMES: [&str; 5] = ["decentre x", "decentre y", "tilt x", "tilt y", "tilt z"];
        let parameters = self.records.iter().filter(|record| record.key == "PARM");
        let named = |record: &Record<'a>| {
            let mut words = record.words();
            let index: usize = words.next()?.parse().ok()?;
            let value = number(record.line, words.next()).ok()?;
            let name = NAMES.get(index.checked_sub(1)?)?;
            (value != 0.0).then_some((*name, value))
        };
        parameters.filter_map(named).collect()
    }

    /// Whether it has a shape: whether one of its numbers bends it.
    pub fn is_bent(&self) -> bool {
        let bends = |record: &Record<'a>| {
            let mut words = record.words();
            let value = match record.key {
                "CURV" => words.next(),
                "PARM" | "XDAT" => words.nth(1),
                _ => return false,
            };
            let parsed = value.and_then(|word| word.parse::<f64>().ok());
            value.is_some() && parsed != Some(0.0)
        };
        !self.is_break() && self.records.iter().any(bends)
    }
}
