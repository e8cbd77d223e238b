//! What a plugin library exports, and how the host opens it.

use std::sync::OnceLock;

use abi_stable::StableAbi;
use abi_stable::library::{
    AbiHeaderRef, CheckTypeLayout, LibHeader, LibraryError, RootModule, RootModuleResult,
};
use abi_stable::prefix_type::PrefixTypeTrait;
use abi_stable::sabi_trait::TD_Opaque;
use abi_stable::sabi_types::VersionStrings;
use abi_stable::std_types::{RStr, RString, RVec};
use turnpath_core::{Params, Result, Slot, StrategyError};

use super::catalogue::{AbiStrategy, CatalogueEntry};
use super::compensator::{AbiCompensator_TO, OutgoingCompensator, OwnedCompensator};
use super::data::{AbiArgument, Answer, answer, params};
use super::feed::{AbiFeed_TO, OutgoingFeed, OwnedFeed};
use super::panic_safe_box::PanicSafeBox;
use super::sampler::{AbiSampler_TO, OutgoingSampler, OwnedSampler};
use super::spindle::{AbiSpindle_TO, OutgoingSpindle, OwnedSpindle};
use super::surface::{AbiSurface_TO, OutgoingSurface, OwnedSurface};
use super::velocity::{AbiVelocity_TO, OutgoingVelocity, OwnedVelocity};
use crate::{Build, Registration};

/// Which strategy to build, and from which parameters.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiRequest {
    pub crate_name: RString,
    pub name: RString,
    pub arguments: RVec<AbiArgument>,
}

/// A library's functions: the catalogue, and one constructor for each slot.
#[repr(C)]
#[derive(StableAbi)]
#[sabi(kind(Prefix(prefix_ref = RootRef)))]
pub struct Root {
    pub catalogue: extern "C" fn() -> RVec<AbiStrategy>,
    pub surface: extern "C" fn(AbiRequest) -> Answer<OwnedSurface>,
    pub feed: extern "C" fn(AbiRequest) -> Answer<OwnedFeed>,
    pub sampler: extern "C" fn(AbiRequest) -> Answer<OwnedSampler>,
    pub compensator: extern "C" fn(AbiRequest) -> Answer<OwnedCompensator>,
    pub velocity: extern "C" fn(AbiRequest) -> Answer<OwnedVelocity>,
    #[sabi(last_prefix_field)]
    pub spindle: extern "C" fn(AbiRequest) -> Answer<OwnedSpindle>,
}

impl RootModule for RootRef {
    abi_stable::declare_root_module_statics! {RootRef}
    const BASE_NAME: &'static str = "turnpath_plugin";
    const NAME: &'static str = "turnpath_plugin";
    const VERSION_STRINGS: VersionStrings = VersionStrings::new(env!("CARGO_PKG_VERSION"));
}

/// The root of this program or library itself.
pub fn own_root() -> RootRef {
    static ROOT: OnceLock<RootRef> = OnceLock::new();
    *ROOT.get_or_init(|| {
        Root {
            catalogue,
            surface,
            feed,
            sampler,
            compensator,
            velocity,
            spindle,
        }
        .leak_into_prefix()
    })
}

extern "C" fn catalogue() -> RVec<AbiStrategy> {
    registrations().iter().map(AbiStrategy::from).collect()
}

/// The registrations that are linked in here, in an order that does not depend on the linker.
fn registrations() -> Vec<Registration> {
    let mut all: Vec<Registration> = inventory::iter::<Registration>().copied().collect();
    all.sort_by_key(|one| (one.info.slot, one.info.name, one.crate_name));
    all
}

/// Finds the requested strategy and builds it.
fn build<T>(
    slot: Slot,
    request: AbiRequest,
    with: impl FnOnce(Build, &Params) -> Option<Result<T>>,
) -> Answer<T> {
    answer(|| {
        let AbiRequest {
            crate_name,
            name,
            arguments,
        } = request;
        let matches = |one: &Registration| {
            one.info.slot == slot && one.info.name == name && one.crate_name == crate_name
        };
        registrations()
            .iter()
            .find(|one| matches(one))
            .and_then(|one| with(one.build, &params(arguments)))
            .unwrap_or_else(|| {
                Err(StrategyError::failed(format!(
                    "there is no {} `{name}` here",
                    slot.noun()
                )))
            })
    })
}

macro_rules! constructor {
    ($function:ident, $slot:ident, $owned:ident, $object:ident, $outgoing:ident) => {
        extern "C" fn $function(request: AbiRequest) -> Answer<$owned> {
            build(Slot::$slot, request, |build, params| match build {
                Build::$slot(build) => Some(build(params).map(|strategy| {
                    $object::from_value($outgoing(PanicSafeBox::new(strategy)), TD_Opaque)
                })),
                _ => None,
            })
        }
    };
}

constructor!(
    surface,
    Surface,
    OwnedSurface,
    AbiSurface_TO,
    OutgoingSurface
);
constructor!(feed, Feed, OwnedFeed, AbiFeed_TO, OutgoingFeed);
constructor!(
    sampler,
    Sampler,
    OwnedSampler,
    AbiSampler_TO,
    OutgoingSampler
);
constructor!(
    compensator,
    Compensator,
    OwnedCompensator,
    AbiCompensator_TO,
    OutgoingCompensator
);
constructor!(
    velocity,
    Velocity,
    OwnedVelocity,
    AbiVelocity_TO,
    OutgoingVelocity
);
constructor!(
    spindle,
    Spindle,
    OwnedSpindle,
    AbiSpindle_TO,
    OutgoingSpindle
);

/// The strategies behind a root, as entries for the host.
pub fn catalogue_entries(root: RootRef) -> Vec<CatalogueEntry> {
    root.catalogue()()
        .into_iter()
        .filter_map(AbiStrategy::receive)
        .collect()
}

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

    fn check(&self) -> std::result::Result<(), OpenError> {
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
}

/// Checks an entry in the library's file, before any code of the library runs.
///
/// # Errors
/// The errors of `open`, except for the layout, which can be compared only after loading.
pub fn inspect(entry: &[u8]) -> std::result::Result<(), OpenError> {
    EntryHead::read(entry)
        .ok_or(OpenError::NotAPlugin)?
        .check()?;
    if entry.len() < size_of::<PluginEntry>() {
        return Err(OpenError::NotAPlugin);
    }
    Ok(())
}

/// Opens the entry that a library exports, and lists the strategies of its own crate.
///
/// # Safety
/// `entry` is the address of a symbol whose name begins with [`SYMBOL_PREFIX`], in a library that
/// stays loaded for the rest of the program.
pub unsafe fn open(
    entry: *const u8,
) -> std::result::Result<(RootRef, Vec<CatalogueEntry>), OpenError> {
    // SAFETY: every version of a plugin entry begins with a head, and the symbol's name marks an
    // entry.
    let head = unsafe { entry.cast::<EntryHead>().read_unaligned() };
    head.check()?;
    // SAFETY: magic and version show that this is a `PluginEntry`, and its library stays loaded.
    let entry = unsafe { &*entry.cast::<PluginEntry>() };
    // SAFETY: an `AbiHeaderRef` is the address of the header with which a `LibHeader` begins.
    let header: AbiHeaderRef = unsafe { std::mem::transmute(&raw const entry.header) };
    let layout = |error: LibraryError| OpenError::Layout(error.to_string());
    let library = header.upgrade().map_err(layout)?;
    let root = library.init_root_module::<RootRef>().map_err(layout)?;
    let own = |one: &CatalogueEntry| one.crate_name == entry.crate_name.as_str();
    Ok((
        root,
        catalogue_entries(root).into_iter().filter(own).collect(),
    ))
}
