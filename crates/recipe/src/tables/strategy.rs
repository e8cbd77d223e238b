//! The key by which every table of a slot chooses its strategy.

use turnpath_core::Param;
use turnpath_core::kind::Text;

/// The name of the strategy.
pub(crate) const USE: Param<Text> = Param::text(
    "use",
    "the name of the strategy; `turnpath list` shows all names",
);
