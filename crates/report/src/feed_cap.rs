//! Whether the feed comes near to the largest one of the nose, and where.

use serde::{Deserialize, Serialize};

use crate::unit;

/// Where the feed comes within a tenth of the largest one of which neighbouring noses meet within
/// their edges. No residual tolerance makes it larger than that.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct FeedCap {
    /// Whether there is such a place.
    pub binds: bool,
    /// The least radius of these places, mm; `None` where it binds nowhere.
    #[serde(rename = "from_mm", with = "unit::mm")]
    pub from: Option<f64>,
    /// The largest radius of these places, mm; `None` where it binds nowhere.
    #[serde(rename = "to_mm", with = "unit::mm")]
    pub to: Option<f64>,
    /// The least of the largest feeds there, mm per revolution; `None` where it binds nowhere.
    #[serde(rename = "feed_um_per_rev", with = "unit::um")]
    pub feed: Option<f64>,
}
