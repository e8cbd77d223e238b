//! Texts of numbers, line by line.

use crate::error::{MapError, MapProblem};
use crate::map::check_length;

/// Longest part of a file that a message repeats.
const SHOWN: usize = 24;

/// The text of a file, without the mark that some editors put in front.
pub fn text(bytes: &[u8]) -> Result<&str, MapError> {
    match str::from_utf8(bytes) {
        Ok(text) => Ok(text.strip_prefix('\u{feff}').unwrap_or(text)),
        Err(error) => {
            let before = bytes.get(..error.valid_up_to()).unwrap_or_default();
            let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
            Err(MapError::at_line(line, MapProblem::NoText))
        }
    }
}

/// The text of a whole file: its last line has its end. A copy that stopped half-way ends within a line, whose
/// last number may lack digits.
pub fn whole_text(bytes: &[u8]) -> Result<&str, MapError> {
    let text = text(bytes)?;
    let last = text.lines().last().unwrap_or_default();
    // A number that has an end of any kind is whole, and a comment has none.
    match text.is_empty() || text.ends_with(char::is_whitespace) || last.starts_with(['#', '!']) {
        true => Ok(text),
        false => Err(MapError::at_line(text.lines().count(), MapProblem::CutOff)),
    }
}

/// The lines that have something to say, with their numbers from 1. A line that begins with one of
/// `comments` has nothing to say.
pub fn lines<'a>(
    text: &'a str,
    comments: &'static [char],
) -> impl Iterator<Item = (usize, &'a str)> {
    let lines = (1..)
        .zip(text.lines())
        .map(|(number, line)| (number, line.trim()));
    lines.filter(move |(_, line)| !line.is_empty() && !line.starts_with(comments))
}

/// The words of a line, between blanks.
pub fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split_ascii_whitespace()
}

/// A number that is finite.
pub fn number(line: usize, word: &str) -> Result<f64, MapError> {
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(no_number(line, word, "finite number")),
        Err(_) => Err(no_number(line, word, "number")),
    }
}

/// A length in mm that a map may have.
pub fn length(line: usize, length: f64) -> Result<f64, MapError> {
    check_length(length).map_err(|problem| MapError::at_line(line, problem))
}

/// A whole number of points.
pub fn count(line: usize, word: &str) -> Result<usize, MapError> {
    let parsed = word.parse();
    parsed.map_err(|_| no_number(line, word, "whole number"))
}

/// The error for a word that should be something else.
pub fn no_number(line: usize, word: &str, wanted: &'static str) -> MapError {
    let found = shown(word);
    MapError::at_line(line, MapProblem::NoNumber { found, wanted })
}

/// A part of a file as messages show it.
pub fn shown(word: &str) -> String {
    match word.char_indices().nth(SHOWN) {
        None => word.to_owned(),
        Some((end, _)) => format!("{}…", word.get(..end).unwrap_or_default()),
    }
}
