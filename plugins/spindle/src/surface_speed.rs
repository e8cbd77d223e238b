//! The spindle strategy `surface-speed`.

use turnpath_plugin::prelude::*;

use crate::grid::Grid;
use crate::limits::Limits;
use crate::motion::{CellMotion, motion};
use crate::per_revolution::played_speeds;
use crate::search::Conditions;

/// One cutting speed for the whole part, between the lowest and the largest speed of the spindle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceSpeed {
    cutting_speed: f64,
    lowest: f64,
}

const CUTTING_SPEED: Param<Velocity> = Param::velocity(
    "cutting_speed",
    "speed of the part under the nose: the spindle's speed times |X|, such as \"100 m/min\"",
)
.positive()
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
        let grid = Grid::new(path.law.end());
        let cells = motion(path, &grid)?;
        let limits = Limits::of(&path.task.machine);
        let wanted = |cell: &CellMotion| (self.cutting_speed / cell.radius).max(self.lowest);
        let played = played_speeds(ask, &grid);
        let bounds = cells.iter().zip(played);
        let bounds: Vec<f64> = bounds
            .map(|(cell, played)| wanted(cell).min(played))
            .collect();
        let speeds = cells.iter().zip(&bounds);
        let speeds = speeds.map(|(cell, bound)| limits.steady_speed(cell).min(*bound));
        let speeds = speeds.collect();
        let conditions = Conditions {
            grid,
            cells: &cells,
            limits,
            bounds,
            speed: ask.speed,
        };
        Ok(conditions.fastest(speeds))
    }

    fn follows_factors(&self) -> bool {
        true
    }
}
