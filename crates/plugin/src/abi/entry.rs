//! The static that a library exports, and how the host opens it.

use abi_stable::StableAbi;
use abi_stable::library::{AbiHeaderRef, CheckTypeLayout, LibHeader, RootModuleResult};
use abi_stable::prefix_type::PrefixRefTrait;
use abi_stable::std_types::RStr;
use abi_stable::type_layout::TypeLayout;

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

/// What a library offers: its root, and the strategies of its own crate.
pub type LibraryContents = (RootRef, Vec<CatalogueEntry>);

/// Opens the entry of a library that has nothing that this program lacks, and fits it. `None` for any
/// other. Several entries may be opened in this way at the same time.
///
/// # Safety
/// `entry` is the address of a symbol whose name begins with
/// [`SYMBOL_PREFIX`](crate::head::SYMBOL_PREFIX), in a library that stays loaded for the rest of the
/// program.
pub unsafe fn open_if_not_newer(entry: *const u8) -> Result<Option<LibraryContents>, OpenError> {
    // SAFETY: the caller makes the same promise.
    let root = unsafe { root_if_not_newer::<RootRef>(entry) }?;
    root.map(own_strategies).transpose()
}

/// Opens the entry of a newer library. Such libraries are compared with each other, so one is opened
/// after the other.
///
/// # Safety
/// That of [`open_if_not_newer`].
pub unsafe fn open_newer(entry: *const u8) -> Result<LibraryContents, OpenError> {
    // SAFETY: the caller makes the same promise.
    let entry = unsafe { checked(entry) }?;
    layout::check_newer::<RootRef>(entry.layout).map_err(OpenError::Layout)?;
    // SAFETY: the layouts were just compared.
    own_strategies((entry.crate_name, unsafe { entry.root() }?))
}

/// The name of the crate of an entry, and its root; `None` as for [`open_if_not_newer`].
///
/// # Safety
/// That of [`open_if_not_newer`].
pub unsafe fn root_if_not_newer<R: StableAbi + PrefixRefTrait>(
    entry: *const u8,
) -> Result<Option<(&'static str, R)>, OpenError> {
    // SAFETY: the caller makes the same promise.
    let entry = unsafe { checked(entry) }?;
    if !layout::is_not_newer::<R>(entry.layout) {
        return Ok(None);
    }
    // SAFETY: the layouts were just compared.
    Ok(Some((entry.crate_name, unsafe { entry.root() }?)))
}

/// An entry whose head was checked.
struct CheckedEntry {
    crate_name: &'static str,
    library: &'static LibHeader,
    layout: &'static TypeLayout,
}

/// Checks the head of an entry.
///
/// # Safety
/// That of [`open_if_not_newer`].
unsafe fn checked(entry: *const u8) -> Result<CheckedEntry, OpenError> {
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
    Ok(CheckedEntry {
        crate_name: entry.crate_name.as_str(),
        library,
        layout: library.layout().ok_or(OpenError::NotAPlugin)?,
    })
}

impl CheckedEntry {
    /// The root of the library.
    ///
    /// # Safety
    /// The layout fits `R`.
    unsafe fn root<R: PrefixRefTrait>(&self) -> Result<R, OpenError> {
        // SAFETY: the caller compared the layouts.
        let root = unsafe { self.library.unchecked_layout::<R>() };
        root.map_err(|error| OpenError::Layout(error.to_string()))
    }
}

/// The root of a library, with the strategies of the crate of this name.
fn own_strategies((crate_name, root): (&str, RootRef)) -> Result<LibraryContents, OpenError> {
    let entries = entries(&root.catalogue()(), |name| name == crate_name);
    let entries = entries.map_err(|error| match error {
        CatalogueError::Damaged => OpenError::NotAPlugin,
        CatalogueError::UnknownKind(unknown) => OpenError::UnknownKind(unknown),
    })?;
    Ok((root, entries))
}
