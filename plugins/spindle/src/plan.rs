//! The plan that both strategies share: what each part of the path allows, and the fastest schedule
//! within it.

use turnpath_plugin::prelude::*;

use crate::grid::Grid;
use crate::limits::Limits;
use crate::motion::{CellMotion, motion};
use crate::search::Conditions;

/// The fastest law within the machine's limits, as measured on the path and as played before, that is
/// nowhere faster than `wanted` asks of a cell, rad/s.
pub fn fastest_law(
    path: &Path<'_>,
    ask: &SpindleAsk<'_>,
    wanted: impl Fn(&CellMotion) -> f64,
) -> Result<SpindleLaw> {
    let grid = Grid::new(path.law.end());
    let cells = motion(path, &grid)?;
    let limits = Limits::of(&path.task.machine);
    let bounds = cells.iter().zip(played_speeds(ask, &grid));
    let bounds: Vec<f64> = bounds
        .map(|(cell, played)| wanted(cell).min(played))
        .collect();
    let speeds = cells.iter().zip(&bounds);
    let speeds = speeds
        .map(|(cell, bound)| limits.steady_speed(cell).min(*bound))
        .collect();
    let conditions = Conditions {
        grid,
        cells: &cells,
        limits,
        bounds,
        speed: ask.speed,
    };
    Ok(conditions.fastest(speeds))
}

/// The largest speed of each cell at which the axes as played keep to the limits, rad/s.
fn played_speeds(ask: &SpindleAsk<'_>, grid: &Grid) -> Vec<f64> {
    let speed = |cell: usize| {
        let factors = grid.halves(cell).filter_map(|half| ask.factors.get(half));
        ask.speed * factors.copied().fold(1.0, f64::min)
    };
    (0..grid.cells).map(speed).collect()
}
