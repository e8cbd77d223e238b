//! The spindle strategy `constant`.

use turnpath_plugin::prelude::*;

/// The spindle turns at the recipe's speed from the first point to the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConstantSpeed;

impl Strategy for ConstantSpeed {
    const NAME: &'static str = "constant";
    const SUMMARY: &'static str = "the speed of the recipe from the first point to the last";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl SpindleStrategy for ConstantSpeed {
    fn plan(&self, _: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        Ok(SpindleLaw::constant(ask.speed))
    }
}
