//! Lines of a lens file: a key of up to four characters, and words.

/// A line that says something.
#[derive(Debug, Clone, Copy)]
pub struct Record<'a> {
    /// Its number, from 1.
    pub line: usize,
    /// Its first word.
    pub key: &'a str,
    /// What follows.
    pub rest: &'a str,
    /// Whether it is indented, as the lines of a surface are.
    pub indented: bool,
}

/// Longest part of a file that a message repeats.
const SHOWN: usize = 24;

/// The lines of a text that are not empty.
pub fn records(text: &str) -> impl Iterator<Item = Record<'_>> {
    (1..).zip(text.lines()).filter_map(|(line, whole)| {
        // The character that ends a file on old systems says nothing.
        let content = whole.trim_matches(|c: char| c.is_whitespace() || c == '\u{1a}');
        let (key, rest) = match content.split_once(char::is_whitespace) {
            Some((key, rest)) => (key, rest.trim()),
            None => (content, ""),
        };
        let indented = whole.starts_with([' ', '\t']);
        (!key.is_empty()).then_some(Record {
            line,
            key,
            rest,
            indented,
        })
    })
}

impl<'a> Record<'a> {
    /// The words behind the key.
    pub fn words(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.rest.split_whitespace()
    }

    /// The text behind the key, without its quotes.
    pub fn text(&self) -> &'a str {
        self.rest.trim_matches('"').trim()
    }
}

/// A part of a file as messages show it.
pub fn shown(word: &str) -> String {
    match word.char_indices().nth(SHOWN) {
        None => word.to_owned(),
        Some((end, _)) => format!("{}…", word.get(..end).unwrap_or_default()),
    }
}
