//! The static that a library exports, and how the host opens it.

use abi_stable::library::{AbiHeaderRef, CheckTypeLayout, LibHeader, RootModuleResult};
use abi_stable::std_types::RStr;

use super::catalogue::{CatalogueEntry, UnknownKind};
use super::layout;
use super::root::{RootRef, own_root};

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

/// The beginning of [`PluginEntry`]. It never changes in any version, so that a host recognises
/// another version before it reads anything whose layout may differ.
#[repr(C)]
#[derive(Clone, Copy)]
struct EntryHead {
    magic: [u8; 16],
    version: BoundaryVersion,
}

impl EntryHead {
    /// Reads the head from the bytes of an entry in a file; `None` if there are too few bytes.
    fn read(entry: &[u8]) -> Option<Self> {
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

    fn check(&self) -> Result<(), OpenError> {
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

/// The one static that a plugin library exports.
#[repr(C)]
pub struct PluginEntry {
    head: EntryHead,
    crate_name: RStr<'static>,
    header: LibHeader,
}

/// The entry of the crate with this name. [`export!`](crate::export) uses it.
pub const fn plugin_entry(crate_name: &'static str) -> PluginEntry {
    // SAFETY: `constructor` returns a `PrefixRef` that was a `RootRef`.
    let header =
        unsafe { LibHeader::from_constructor::<RootRef>(constructor, CheckTypeLayout::Yes) };
    PluginEntry {
        head: EntryHead {
            magic: MAGIC,
            version: BOUNDARY_VERSION,
        },
        crate_name: RStr::from_str(crate_name),
        header,
    }
}

extern "C" fn constructor() -> RootModuleResult {
    abi_stable::library::__call_root_module_loader(own_root)
}

/// Why the host could not open a library's entry.
#[derive(Debug)]
pub enum OpenError {
    /// The symbol does not point to a plugin entry.
    NotAPlugin,
    /// The plugin was built against another version of the boundary.
    Version(BoundaryVersion),
    /// The version is the same, but the layout is not: the compiler target differs, or the boundary
    /// crate was changed. The text is from abi_stable and hundreds of lines long.
    Layout(String),
    /// A strategy declares a parameter of a kind that this program does not know.
    UnknownKind(UnknownKind),
}

/// Checks an entry in the library's file, before any code of the library runs.
///
/// # Errors
/// The errors of `open` that show in the file: layout and parameters show only after loading.
pub fn inspect(entry: &[u8]) -> Result<(), OpenError> {
    EntryHead::read(entry)
        .ok_or(OpenError::NotAPlugin)?
        .check()?;
    if entry.len() < size_of::<PluginEntry>() {
        return Err(OpenError::NotAPlugin);
    }
    Ok(())
}

/// The strategies of this program or library itself, and its root.
pub fn own() -> (RootRef, Vec<CatalogueEntry>) {
    let root = own_root();
    // The kinds are this build's own, so all of them are known.
    (root, entries(root, |_| true).unwrap_or_default())
}

/// The strategies behind a root, of the crates that `wanted` names.
fn entries(
    root: RootRef,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<CatalogueEntry>, UnknownKind> {
    let all = root.catalogue()().into_iter();
    all.filter(|one| wanted(one.crate_name()))
        .filter_map(|one| one.receive().transpose())
        .collect()
}

/// Opens the entry that a library exports, and lists the strategies of its own crate.
///
/// # Safety
/// `entry` is the address of a symbol whose name begins with [`SYMBOL_PREFIX`], in a library that
/// stays loaded for the rest of the program.
pub unsafe fn open(entry: *const u8) -> Result<(RootRef, Vec<CatalogueEntry>), OpenError> {
    // SAFETY: every version of a plugin entry begins with a head, and the symbol's name marks an
    // entry.
    let head = unsafe { entry.cast::<EntryHead>().read_unaligned() };
    head.check()?;
    // SAFETY: magic and version show that this is a `PluginEntry`, and its library stays loaded.
    let entry = unsafe { &*entry.cast::<PluginEntry>() };
    // SAFETY: an `AbiHeaderRef` is the address of the header with which a `LibHeader` begins.
    let header: AbiHeaderRef = unsafe { std::mem::transmute(&raw const entry.header) };
    let library = header
        .upgrade()
        .map_err(|error| OpenError::Layout(error.to_string()))?;
    let layout = library
        .layout()
        .ok_or_else(|| OpenError::Layout("no layout".to_owned()))?;
    layout::check::<RootRef>(layout).map_err(OpenError::Layout)?;
    // SAFETY: the layouts were just compared.
    let root = unsafe { library.unchecked_layout::<RootRef>() };
    let root = root.map_err(|error| OpenError::Layout(error.to_string()))?;
    let own = |name: &str| name == entry.crate_name.as_str();
    Ok((root, entries(root, own).map_err(OpenError::UnknownKind)?))
}
