//! Numbers in the lines of a lens file.

use crate::error::{LensProblem, ProblemKind};
use crate::record::{Record, shown};

/// Largest number that a design has. Beyond it products and quotients leave the range of doubles.
const LARGEST: f64 = 1e100;

/// A number that a design may have.
pub fn number(line: usize, word: Option<&str>) -> Result<f64, LensProblem> {
    let word = word.unwrap_or_default();
    match word.parse::<f64>() {
        Ok(number) if number.abs() <= LARGEST => Ok(number),
        _ => Err(no_number(line, word, "number")),
    }
}

/// A whole number.
pub fn whole(line: usize, word: Option<&str>) -> Result<u32, LensProblem> {
    let word = word.unwrap_or_default();
    let parsed = word.parse();
    parsed.map_err(|_| no_number(line, word, "whole number"))
}

/// The error for a word that should be something else.
pub fn no_number(line: usize, word: &str, wanted: &'static str) -> LensProblem {
    let found = shown(word);
    ProblemKind::NoNumber { found, wanted }.at(line)
}

/// The number of a line whose second word says how it comes about: 0 fixed, 1 variable. Other values
/// follow from solves.
pub fn fixed_number(record: &Record<'_>, key: &'static str) -> Result<f64, LensProblem> {
    let mut words = record.words();
    let value = number(record.line, words.next())?;
    check_fixed(record, words.next(), key)?;
    Ok(value)
}

/// Refuses a value that follows from a solve.
pub fn check_fixed(
    record: &Record<'_>,
    status: Option<&str>,
    key: &'static str,
) -> Result<(), LensProblem> {
    match status {
        None | Some("0" | "1") => Ok(()),
        Some(word) if word.parse::<f64>().is_ok() => {
            Err(ProblemKind::Solve { key }.at(record.line))
        }
        Some(word) => Err(no_number(record.line, word, "number of a solve")),
    }
}

/// A value that may be 0, the word for infinity, as a radius has it.
pub fn radius(value: f64) -> Option<f64> {
    (value != 0.0).then_some(value)
}

/// base to the power of n.
pub fn power(base: f64, n: u32) -> f64 {
    (0..n).fold(1.0, |product, _| product * base)
}
