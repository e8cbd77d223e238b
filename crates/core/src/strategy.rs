//! What every strategy declares about itself.

use serde::{Deserialize, Deserializer, Serialize};

use crate::{ParamInfo, Params, Result, Slot};

/// What every strategy declares about itself, and its constructor.
///
/// `Strategy` is not a supertrait of the slot's own trait ([`Surface`](crate::Surface),
/// [`FeedStrategy`](crate::FeedStrategy), [`Sampler`](crate::Sampler),
/// [`Compensator`](crate::Compensator), [`VelocitySolver`](crate::VelocitySolver)), so that the
/// slot's trait stays object-safe.
pub trait Strategy: Sized {
    /// The name in a recipe's `use = "…"`: lower-case letters, digits and hyphens.
    const NAME: &'static str;
    /// One line that says what the strategy does.
    const SUMMARY: &'static str;
    /// The source of the method: a paper with the equation, or a standard; empty if there is none.
    const SOURCE: &'static str = "";
    /// The declarations of the strategy's parameters: [`Param::info`](crate::Param::info) of each.
    /// [Some names](HOST_KEYS) belong to the host.
    const PARAMS: &'static [ParamInfo] = &[];
    /// Builds the strategy from values that the host has checked against [`Self::PARAMS`].
    fn new(params: &Params) -> Result<Self>;
}

/// The keys that belong to the host in the tables of strategies: no strategy may declare a parameter
/// of such a name. `use` is in every table. The others are for the bound of the spindle's speed and
/// for the place of a surface in a sum; they are kept free even where they do not apply yet.
pub const HOST_KEYS: [&str; 7] = [
    "use",
    "speed",
    "scale",
    "decentre_x",
    "decentre_y",
    "clocking",
    "piston",
];

/// Whether a recipe can choose a strategy of this name: lower-case letters, digits and hyphens.
///
/// ```
/// use turnpath_core::is_strategy_name;
/// assert!(is_strategy_name("constant-arc"));
/// assert!(!is_strategy_name("Constant Arc") && !is_strategy_name(""));
/// ```
pub fn is_strategy_name(name: &str) -> bool {
    let valid = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    !name.is_empty() && name.chars().all(valid)
}

/// A strategy as `turnpath list` and `turnpath explain` show it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StrategyInfo {
    /// The slot that the strategy fills.
    pub slot: Slot,
    /// The strategy's name in a recipe.
    pub name: &'static str,
    /// One line that says what the strategy does.
    pub summary: &'static str,
    /// The paper and the equation, or empty.
    pub source: &'static str,
    /// The strategy's parameters.
    #[serde(deserialize_with = "kept_params")]
    pub params: &'static [ParamInfo],
}

/// Reads declarations, which stay for the whole program.
fn kept_params<D: Deserializer<'static>>(
    params: D,
) -> std::result::Result<&'static [ParamInfo], D::Error> {
    Ok(Vec::deserialize(params)?.leak())
}
