//! The static that a library exports, and how the host opens it.

use abi_stable::StableAbi;
use abi_stable::library::{AbiHeaderRef, CheckTypeLayout, LibHeader, RootModuleResult};
use abi_stable::prefix_type::PrefixRefTrait;
use abi_stable::std_types::RStr;

use super::catalogue::{CatalogueEntry, CatalogueError, entries};
use super::layout;
use super::root::{RootRef, own_root};
use crate::head::{EntryHead, OpenError};

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
        head: EntryHead::OURS,
        crate_name: RStr::from_str(crate_name),
        header,
    }
}

extern "C" fn constructor() -> RootModuleResult {
    abi_stable::library::__call_root_module_loader(own_root)
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
    (
        root,
        entries(&root.catalogue()(), |_| true).unwrap_or_default(),
    )
}

/// How old a library is, beside this program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Age {
    /// It has nothing that this program lacks. Such libraries may be opened side by side.
    NotNewer,
    /// It has more. Such libraries are compared with each other, so they are opened one after the other.
    Newer,
}

/// Opens the entry that a library exports, and lists the strategies of its own crate. `None` where the
/// library is opened as one that is not newer, and is newer or does not fit.
///
/// # Safety
/// `entry` is the address of a symbol whose name begins with
/// [`SYMBOL_PREFIX`](crate::head::SYMBOL_PREFIX), in a library that stays loaded for the rest of the
/// program.
pub unsafe fn open(
    entry: *const u8,
    age: Age,
) -> Result<Option<(RootRef, Vec<CatalogueEntry>)>, OpenError> {
    // SAFETY: the caller makes the same promise.
    let Some((crate_name, root)) = (unsafe { open_root::<RootRef>(entry, age) })? else {
        return Ok(None);
    };
    let entries = entries(&root.catalogue()(), |name| name == crate_name);
    let entries = entries.map_err(|error| match error {
        CatalogueError::Damaged => OpenError::NotAPlugin,
        CatalogueError::UnknownKind(unknown) => OpenError::UnknownKind(unknown),
    })?;
    Ok(Some((root, entries)))
}

/// Checks and opens an entry: the name of its crate, and its root. `None` as for [`open`].
///
/// # Safety
/// That of [`open`].
pub unsafe fn open_root<R: StableAbi + PrefixRefTrait>(
    entry: *const u8,
    age: Age,
) -> Result<Option<(&'static str, R)>, OpenError> {
    // SAFETY: every version of a plugin entry begins with a head, and the symbol's name marks an
    // entry.
    let head = unsafe { entry.cast::<EntryHead>().read_unaligned() };
    head.check()?;
    // SAFETY: magic and version show that this is a `PluginEntry`, and its library stays loaded.
    let entry: &'static PluginEntry = unsafe { &*entry.cast::<PluginEntry>() };
    // SAFETY: an `AbiHeaderRef` is the address of the header with which a `LibHeader` begins.
    let header: AbiHeaderRef = unsafe { std::mem::transmute(&raw const entry.header) };
    let library = header
        .upgrade()
        .map_err(|error| OpenError::Layout(error.to_string()))?;
    let layout = library.layout().ok_or(OpenError::NotAPlugin)?;
    match age {
        Age::NotNewer if !layout::is_not_newer::<R>(layout) => return Ok(None),
        Age::NotNewer => {}
        Age::Newer => layout::check_newer::<R>(layout).map_err(OpenError::Layout)?,
    }
    // SAFETY: the layouts were just compared.
    let root = unsafe { library.unchecked_layout::<R>() };
    let root = root.map_err(|error| OpenError::Layout(error.to_string()))?;
    Ok(Some((entry.crate_name.as_str(), root)))
}
