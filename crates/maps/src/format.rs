//! The formats.

/// A format of maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Zemax grid sag, `.DAT`: a text.
    Zemax,
    /// CODE V grid, `.INT`: a text.
    CodeV,
    /// Lines `x y z`: a text.
    Xyz,
    /// Gwyddion Simple Field, `.gsf`: a text header and 32-bit floats.
    Gsf,
    /// Zygo MetroPro, `.dat`: binary.
    MetroPro,
}

impl Format {
    /// All formats with the words that a recipe has for them.
    pub const WORDS: [(&'static str, Self); 5] = [
        ("zemax", Self::Zemax),
        ("code-v", Self::CodeV),
        ("xyz", Self::Xyz),
        ("gsf", Self::Gsf),
        ("metropro", Self::MetroPro),
    ];

    /// The format of this word.
    pub fn of_word(word: &str) -> Option<Self> {
        let found = Self::WORDS.into_iter().find(|(known, _)| *known == word);
        found.map(|(_, format)| format)
    }
}
