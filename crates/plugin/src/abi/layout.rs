//! Whether the layouts of a library and of this program fit together.
//!
//! abi_stable compares an interface with its implementation. The implementation may have more
//! fields at the end of a table of functions. Of a program and a library, the older one is the
//! interface, whichever it is: then every function that the older one knows is there, and the newer
//! one finds out at run time which of its own are missing. abi_stable's own loading takes the
//! program for the interface and so refuses every older library.

use abi_stable::StableAbi;
use abi_stable::abi_stability::abi_checking::check_layout_compatibility;
use abi_stable::type_layout::TypeLayout;

/// Checks that the layout of `T` here fits the one that a library was built with.
///
/// # Errors
/// If neither is the other with more functions. The text is that of the shorter
/// comparison, hundreds of lines long.
pub fn check<T: StableAbi>(library: &'static TypeLayout) -> Result<(), String> {
    let older = check_layout_compatibility(library, T::LAYOUT);
    let Err(as_older) = older else {
        return Ok(());
    };
    let newer = check_layout_compatibility(T::LAYOUT, library);
    let Err(as_newer) = newer else {
        return Ok(());
    };
    let texts = [as_older, as_newer].map(|errors| errors.to_string());
    let shorter = texts.into_iter().min_by_key(String::len);
    Err(shorter.unwrap_or_default())
}
