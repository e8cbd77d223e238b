//! The spindle strategy `surface-speed`.

use turnpath_plugin::prelude::*;

use crate::plan::fastest_law;

/// One cutting speed for the whole part, between the lowest and the largest speed of the spindle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceSpeed {
    cutting_speed: f64,
    lowest: f64,
}

/// The slowest cut, mm/s: at a millimetre from the axis a turn takes two hours. Nobody cuts so slowly,
/// and times of a path stay numbers.
const SLOWEST_CUT: f64 = 1e-3;
const CUTTING_SPEED: Param<Velocity> = Param::velocity(
    "cutting_speed",
    "speed of the part under the nose: the spindle's speed times |X|, such as \"100 m/min\"",
)
.min(SLOWEST_CUT)
.example("100 m/min");
const LOWEST: Param<RotationSpeed> = Param::rotation_speed(
    "lowest",
    "lowest speed of the spindle, at large radii; the machine's limits may ask for less",
)
.min(0.0)
.default(0.0);

impl Strategy for SurfaceSpeed {
    const NAME: &'static str = "surface-speed";
    const SUMMARY: &'static str = "one cutting speed, between `lowest` and `speed`, within the \
        machine's limits";
    const SOURCE: &'static str = "the constant surface speed of lathes (G96), with limits as in \
        `per-revolution`";
    const PARAMS: &'static [ParamInfo] = &[CUTTING_SPEED.info(), LOWEST.info()];

    fn new(params: &Params) -> Result<Self> {
        Ok(Self {
            cutting_speed: params.get(CUTTING_SPEED),
            lowest: params.get(LOWEST),
        })
    }
}

impl SpindleStrategy for SurfaceSpeed {
    fn plan(&self, path: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        if self.lowest > ask.speed {
            return Err(LOWEST.refused("it is more than `speed`, the largest; choose less"));
        }
        fastest_law(path, ask, |cell| {
            (self.cutting_speed / cell.radius).max(self.lowest)
        })
    }

    fn follows_factors(&self) -> bool {
        true
    }
}
