//! The number of the boundary, and the beginning of the static that every plugin exports.

use crate::abi::catalogue::UnknownKind;

/// The version of the boundary, which is the version of this crate.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BoundaryVersion {
    /// The number of changes that break plugins.
    pub major: u32,
    /// Below 1.0, the number of changes that break plugins too.
    pub minor: u32,
    /// The number of changes that do not break plugins.
    pub patch: u32,
}

impl std::fmt::Display for BoundaryVersion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

/// The version of this build's boundary.
pub const BOUNDARY_VERSION: BoundaryVersion = BoundaryVersion {
    major: digits(env!("CARGO_PKG_VERSION_MAJOR")),
    minor: digits(env!("CARGO_PKG_VERSION_MINOR")),
    patch: digits(env!("CARGO_PKG_VERSION_PATCH")),
};

const fn digits(text: &str) -> u32 {
    let (bytes, mut value, mut i) = (text.as_bytes(), 0, 0);
    while i < bytes.len() {
        value = value * 10 + (bytes[i] - b'0') as u32;
        i += 1;
    }
    value
}

/// The prefix of the exported symbol's name. The crate's name follows.
pub const SYMBOL_PREFIX: &str = "turnpath_plugin_root__";
/// The first bytes of the exported static.
const MAGIC: [u8; 16] = *b"turnpath plugin\0";

/// The beginning of the static that a plugin exports. It never changes in any version, so that a host recognises
/// another version before it reads anything whose layout may differ.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct EntryHead {
    magic: [u8; 16],
    version: BoundaryVersion,
}

impl EntryHead {
    /// The head of entries of this version.
    pub const OURS: Self = Self {
        magic: MAGIC,
        version: BOUNDARY_VERSION,
    };

    /// Reads the head from the bytes of an entry in a file; `None` if there are too few bytes.
    pub fn read(entry: &[u8]) -> Option<Self> {
        let (magic, rest) = entry.split_first_chunk::<16>()?;
        let (words, _) = rest.as_chunks::<4>();
        let [major, minor, patch, ..] = words else {
            return None;
        };
        Some(Self {
            magic: *magic,
            version: BoundaryVersion {
                major: u32::from_ne_bytes(*major),
                minor: u32::from_ne_bytes(*minor),
                patch: u32::from_ne_bytes(*patch),
            },
        })
    }

    /// Checks that the entry is one of a plugin, and of this number of the boundary.
    pub fn check(&self) -> Result<(), OpenError> {
        let BoundaryVersion { major, minor, .. } = self.version;
        if self.magic != MAGIC {
            return Err(OpenError::NotAPlugin);
        }
        if (major, minor) != (BOUNDARY_VERSION.major, BOUNDARY_VERSION.minor) {
            return Err(OpenError::Version(self.version));
        }
        Ok(())
    }
}

/// Why the host could not open a library's entry.
#[derive(Debug)]
pub enum OpenError {
    /// The symbol does not point to a plugin entry.
    NotAPlugin,
    /// The library's description of itself contradicts itself: it cannot be read to its end.
    Damaged,
    /// The plugin was built against another version of the boundary.
    Version(BoundaryVersion),
    /// The version is the same, but the layout is not: the compiler target differs, or the boundary
    /// crate was changed. The text is from abi_stable and hundreds of lines long.
    Layout(String),
    /// A strategy declares a parameter of a kind that this program does not know.
    UnknownKind(UnknownKind),
}
