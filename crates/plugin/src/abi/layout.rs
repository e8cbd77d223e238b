//! Whether the layouts of a library and of this program fit together.
//!
//! abi_stable compares an interface with its implementation. The implementation may have more
//! fields at the end of a table of functions. Of a program and a library, the older one is the
//! interface, whichever it is: then every function that the older one knows is there, and the newer
//! one finds out at run time which of its own are missing. abi_stable's own loading takes the
//! program for the interface and so refuses every older library.

use abi_stable::StableAbi;
use abi_stable::abi_stability::abi_checking::{
    CheckingGlobals, check_layout_compatibility, check_layout_compatibility_with_globals,
};
use abi_stable::type_layout::TypeLayout;

/// Checks that a library has nothing of `T` that this program lacks.
///
/// Such libraries fit each other too: what they have lies where this program has it. So the comparison
/// needs to know of no other library, and libraries may be compared side by side.
///
/// # Errors
/// If the library is newer, or does not fit. The text is hundreds of lines long.
pub fn check_as_older<T: StableAbi>(library: &'static TypeLayout) -> Result<(), String> {
    let others = CheckingGlobals::new();
    let checked = check_layout_compatibility_with_globals(library, T::LAYOUT, &others);
    checked.map_err(|errors| errors.to_string())
}

/// Checks that the layout of `T` here fits the one that a library was built with. A newer library is
/// compared with the newer ones before it too.
///
/// # Errors
/// If neither is the other with more functions. The text is that of the shorter
/// comparison, hundreds of lines long.
pub fn check<T: StableAbi>(library: &'static TypeLayout) -> Result<(), String> {
    let Err(as_older) = check_as_older::<T>(library) else {
        return Ok(());
    };
    let newer = check_layout_compatibility(T::LAYOUT, library);
    let Err(as_newer) = newer else {
        return Ok(());
    };
    let shorter = [as_older, as_newer.to_string()].into_iter();
    Err(shorter.min_by_key(String::len).unwrap_or_default())
}
