//! Values that cross as JSON. A reader leaves out fields that it does not know, and refuses words
//! that it does not know by name. So neither a new field nor a new kind changes a layout.

use abi_stable::std_types::RString;
use serde::{Deserialize, Serialize};
use turnpath_core::{Result, StrategyError};

/// Writes a value. It fails only for a map whose keys are no texts, and nothing here has one.
pub fn write(value: &impl Serialize) -> RString {
    serde_json::to_string(value).unwrap_or_default().into()
}

/// Reads a value; `what` names it for the error.
pub fn read<'t, T: Deserialize<'t>>(text: &'t str, what: &str) -> Result<T> {
    let failed = |error| format!("the other side of the boundary gives an unknown {what}: {error}");
    serde_json::from_str(text).map_err(|error| StrategyError::failed(failed(error)))
}
