//! How the file of a program is compressed. What its name ends with says it.

use std::path::Path;

/// What stands behind the name of a text that is compressed.
const ZST: &str = "zst";

/// How a file of text is compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// The file is the text.
    #[default]
    None,
    /// Zstandard, `.zst`.
    Zst,
}

impl Compression {
    /// That of the file of this name.
    pub fn of_file(file: &Path) -> Self {
        match file.extension() {
            Some(end) if end.eq_ignore_ascii_case(ZST) => Self::Zst,
            _ => Self::None,
        }
    }

    /// The name of the file that holds the text of this name.
    pub fn file_of(self, text: &str) -> String {
        match self {
            Self::None => text.to_owned(),
            Self::Zst => format!("{text}.{ZST}"),
        }
    }

    /// Whether this build writes and reads it.
    pub fn is_built_in(self) -> bool {
        match self {
            Self::None => true,
            Self::Zst => cfg!(feature = "zst"),
        }
    }
}

/// The name of the text that is in the file of this name.
pub fn text_name(file: &str) -> &str {
    match (Compression::of_file(Path::new(file)), file.rsplit_once('.')) {
        (Compression::Zst, Some((text, _))) => text,
        _ => file,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_says_how_a_file_is_compressed_and_how_its_text_is_named() {
        for (file, compression, text) in [
            ("part.pmc", Compression::None, "part.pmc"),
            ("part.pmc.zst", Compression::Zst, "part.pmc"),
            ("part.PMC.ZST", Compression::Zst, "part.PMC"),
            ("zst", Compression::None, "zst"),
            (".zst", Compression::None, ".zst"),
        ] {
            assert_eq!(Compression::of_file(Path::new(file)), compression, "{file}");
            assert_eq!(text_name(file), text);
        }
        for compression in [Compression::None, Compression::Zst] {
            let file = compression.file_of("part.pmc");
            assert_eq!(Compression::of_file(Path::new(&file)), compression);
            assert_eq!(text_name(&file), "part.pmc");
        }
    }
}
