//! Whether the layouts of a library and of this program fit together.
//!
//! abi_stable compares an interface with its implementation. The implementation may have more
//! fields at the end of a table of functions. Of a program and a library, the older one is the
//! interface, whichever it is: then every function that the older one knows is there, and the newer
//! one finds out at run time which of its own are missing. abi_stable's own loading takes the
//! program for the interface and so refuses every older library.

use std::sync::{Mutex, PoisonError};

use abi_stable::StableAbi;
use abi_stable::abi_stability::abi_checking::{
    AbiInstabilityErrors, CheckingGlobals, check_layout_compatibility,
    check_layout_compatibility_with_globals,
};
use abi_stable::type_layout::TypeLayout;

/// Whether a library has nothing of `T` that this program lacks, and fits it.
///
/// Such libraries fit each other too: what they have lies where this program has it. So the comparison
/// needs to know of no other library, and libraries may be compared side by side.
pub fn is_not_newer<T: StableAbi>(library: &'static TypeLayout) -> bool {
    compare_as_older::<T>(library).is_ok()
}

/// Checks that a newer library fits the layout of `T` here, and the newer libraries that were compared
/// before it. Parts of a refused library count too, since abi_stable keeps what it compared before it
/// found a difference.
///
/// # Errors
/// If this program is not the library with fewer functions. The text is that of the shorter of both
/// comparisons, hundreds of lines long.
pub fn check_newer<T: StableAbi>(library: &'static TypeLayout) -> Result<(), String> {
    /// A comparison leaves what it met to the next ones, so there is one at a time.
    static COMPARISON: Mutex<()> = Mutex::new(());
    let _comparison = COMPARISON.lock().unwrap_or_else(PoisonError::into_inner);
    let Err(as_newer) = check_layout_compatibility(T::LAYOUT, library) else {
        return Ok(());
    };
    let mut texts = vec![as_newer.to_string()];
    texts.extend(
        compare_as_older::<T>(library)
            .err()
            .map(|error| error.to_string()),
    );
    Err(texts
        .into_iter()
        .min_by_key(String::len)
        .unwrap_or_default())
}

fn compare_as_older<T: StableAbi>(
    library: &'static TypeLayout,
) -> Result<(), AbiInstabilityErrors> {
    check_layout_compatibility_with_globals(library, T::LAYOUT, &CheckingGlobals::new())
}
