//! The kinds of entries.

/// What an entry stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DraftKind {
    /// A file without its name.
    File,
    /// A folder that goes when it is empty.
    Folder,
    /// The file that keeps other writers out of a folder. It goes after what it protects.
    Claim,
}
