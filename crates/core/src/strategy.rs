//! What every strategy declares about itself.

use crate::{ParamInfo, Params, Result, Slot};

/// What every strategy declares about itself, and its constructor.
///
/// `Strategy` is not a supertrait of the slot's own trait ([`Surface`](crate::Surface),
/// [`FeedStrategy`](crate::FeedStrategy), [`Sampler`](crate::Sampler),
/// [`Compensator`](crate::Compensator), [`VelocitySolver`](crate::VelocitySolver)), so that the
/// slot's trait stays object-safe.
pub trait Strategy: Sized {
    /// The name in a recipe's `use = "…"`: lower case, with hyphens between words.
    const NAME: &'static str;
    /// One line that says what the strategy does.
    const SUMMARY: &'static str;
    /// The source of the method: a paper with the equation, or a standard; empty if there is none.
    const SOURCE: &'static str = "";
    /// The declarations of the strategy's parameters: [`Param::info`](crate::Param::info) of each.
    const PARAMS: &'static [ParamInfo] = &[];
    /// Builds the strategy from values that the host has checked against [`Self::PARAMS`].
    fn new(params: &Params) -> Result<Self>;
}

/// A strategy as `turnpath list` and `turnpath explain` show it.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    pub params: &'static [ParamInfo],
}
