//! The parts of a program by their names, and what a dialect writes around their lines.

/// A part of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartName {
    /// Its file's name without the ending.
    pub stem: String,
    /// Its file's name.
    pub file: String,
    /// Its number, from 1.
    pub number: u32,
}

/// What a dialect writes for a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartLines {
    /// The line of the main program that calls it.
    pub call: String,
    /// What stands before its lines, each with its line end.
    pub begin: String,
    /// What stands behind them.
    pub end: String,
}

impl PartName {
    /// That of the part of this number of a program. Controllers differ in the characters that they
    /// take in names, so only letters, digits and `-` and `_` are kept, in lower case.
    pub fn of(program: &str, number: u32) -> Self {
        let (stem, extension) = program.rsplit_once('.').unwrap_or((program, ""));
        let plain = |c: char| match c {
            'a'..='z' | '0'..='9' | '-' | '_' => c,
            'A'..='Z' => c.to_ascii_lowercase(),
            _ => '_',
        };
        let stem: String = stem.chars().map(plain).collect();
        let stem = format!("{stem}-part-{number}");
        Self {
            file: format!("{stem}.{extension}"),
            stem,
            number,
        }
    }
}
