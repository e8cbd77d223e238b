//! The lines of a file that belong to no surface: what they must say, and which of them are known to
//! change no shape.
//!
//! They stand in three places. Before the surfaces they set the whole design. Behind the surfaces come
//! the operands of the merit function, then tolerances (`TOL`), then the number of configurations
//! (`MNUM`) and what differs between these.

use std::collections::BTreeSet;

use crate::error::{LensProblem, ProblemKind};
use crate::keys::{is_of_surface, is_system, is_word};
use crate::record::{Record, shown};

/// Numbers of an operand of the merit function: two of its own, four coordinates, target, weight, and
/// two more.
const NUMBERS_OF_OPERAND: usize = 10;

/// Most words that notes name.
const MOST_NOTES: usize = 30;

/// What a line is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// Its first word is known, and no shape depends on it.
    Known,
    /// The unit, which is read for itself.
    Unit,
    /// The mode of the design.
    Mode,
    /// How many configurations there are.
    Count,
    /// An operand of the merit function, whatever its name: it measures.
    Operand,
    /// Something unknown before the surfaces.
    Setting,
    /// A line of a surface that does not stand with one.
    OfSurface,
    /// Nothing of these.
    Unknown,
}

/// The lines that belong to no surface.
pub struct SystemLines<'a> {
    lines: Vec<Record<'a>>,
    /// The lines with which the first surface and the last one begin.
    surfaces: (usize, usize),
    /// The line behind the operands of the merit function; 0 without one.
    end_of_operands: usize,
    /// Whether a line says the mode of the design.
    says_mode: bool,
}

impl<'a> SystemLines<'a> {
    /// These lines of a design whose first surface and last one begin with these.
    pub fn new(lines: Vec<Record<'a>>, surfaces: (usize, usize)) -> Self {
        let ends = |one: &&Record<'_>| one.line > surfaces.1 && matches!(one.key, "TOL" | "MNUM");
        Self {
            end_of_operands: lines.iter().find(ends).map_or(0, |end| end.line),
            says_mode: lines.iter().any(|one| one.key == "MODE"),
            lines,
            surfaces,
        }
    }

    /// The lines with this word, in their order.
    pub fn of(&self, key: &'static str) -> impl Iterator<Item = &Record<'a>> {
        self.lines.iter().filter(move |record| record.key == key)
    }

    /// The lines that are not known, and those that say that the design cannot be read.
    pub fn problems(&self) -> Vec<LensProblem> {
        let problem = |record: &Record<'_>| {
            let first = record.words().next().unwrap_or_default();
            let found = || shown(first);
            let kind = match self.role(record) {
                Role::Mode if first != "SEQ" => ProblemKind::Mode { found: found() },
                Role::Count if first != "1" => ProblemKind::Configurations { count: found() },
                Role::OfSurface => ProblemKind::OfNoSurface {
                    key: shown(record.key),
                },
                Role::Unknown => ProblemKind::UnknownKey {
                    key: shown(record.key),
                },
                _ => return None,
            };
            Some(kind.at(record.line))
        };
        self.lines.iter().filter_map(problem).collect()
    }

    /// A last line without its end: what a copy that stopped half-way leaves. A number in it may lack
    /// digits. Behind the number of configurations all lines that could change a surface are refused, so
    /// a file may end there as it likes.
    pub fn cut_off(&self, text: &str) -> Option<LensProblem> {
        // The character that ends a file on old systems stands behind the last line.
        let whole = text.trim_end_matches('\u{1a}');
        let ends = whole.is_empty() || whole.ends_with(['\n', '\r']);
        let last = text.lines().count();
        let mut counts = self.of("MNUM").filter(|record| self.is_behind(record));
        let is_counted = counts.any(|record| record.line < last);
        (!ends && !is_counted).then(|| ProblemKind::CutOff.at(last))
    }

    /// The first line with each word that is taken for a setting of the whole design.
    pub fn unknown_settings(&self) -> impl Iterator<Item = &Record<'a>> {
        let mut named = BTreeSet::new();
        let settings = self.lines.iter();
        settings
            .filter(|record| self.role(record) == Role::Setting)
            .filter(move |record| named.insert(record.key))
            .take(MOST_NOTES)
    }

    fn role(&self, record: &Record<'_>) -> Role {
        match record.key {
            "UNIT" => Role::Unit,
            "MODE" => Role::Mode,
            "MNUM" => Role::Count,
            key if is_system(key) => Role::Known,
            _ if self.is_operand(record) => Role::Operand,
            _ if self.is_setting(record) => Role::Setting,
            key if is_of_surface(key) && !self.is_behind(record) => Role::OfSurface,
            _ => Role::Unknown,
        }
    }

    /// Whether a line stands where the merit function has its operands, and is as they are: ten numbers
    /// and nothing else.
    fn is_operand(&self, record: &Record<'_>) -> bool {
        let is_number = |word: &str| word.parse::<f64>().is_ok_and(f64::is_finite);
        self.is_behind(record)
            && record.line < self.end_of_operands
            && is_of_no_surface(record)
            && record.words().count() == NUMBERS_OF_OPERAND
            && record.words().all(is_number)
    }

    /// Whether a line is taken to set something of the whole design and no shape: it stands before the
    /// surfaces, and is none of theirs. That holds for all such lines that readers know, but for `UNIT`.
    /// A design that does not say its mode may have it misspelt.
    fn is_setting(&self, record: &Record<'_>) -> bool {
        self.says_mode && record.line < self.surfaces.0 && is_of_no_surface(record)
    }

    fn is_behind(&self, record: &Record<'_>) -> bool {
        record.line > self.surfaces.1
    }
}

/// Whether a line is not one of a surface, by its word and its place in the line.
fn is_of_no_surface(record: &Record<'_>) -> bool {
    is_word(record.key) && !record.indented && !is_of_surface(record.key)
}
