//! The smallest held feed on the part: a look at a grid, then closing in on its lowest places.

use turnpath_plugin::prelude::*;

/// Angles of the grid: a wave with 36 periods on a revolution still has 10 of them.
const ANGLES: usize = 360;
/// Steps of the grid along the radius.
const RADII: usize = 256;
/// How many of the grid's lowest places are closed in on: a lattice of equal hollows has many
/// that look alike.
const CANDIDATES: usize = 16;
/// Rounds of closing in; a step is halved where none of its neighbours is lower. 2⁻²⁰ of a grid
/// step changes a feed, flat at its minimum, by less than rounding.
const ROUNDS: usize = 40;

/// The eight neighbours of a place, in steps of the grid.
const NEIGHBOURS: [(f64, f64); 8] = [
    (-1.0, -1.0),
    (-1.0, 0.0),
    (-1.0, 1.0),
    (0.0, -1.0),
    (0.0, 1.0),
    (1.0, -1.0),
    (1.0, 0.0),
    (1.0, 1.0),
];

/// The smallest feed over the job's range, mm, that leaves no cusp above the residual tolerance.
///
/// # Errors
/// Where the locus has no value.
pub fn smallest_held_feed(setup: Setup<'_>) -> Result<f64> {
    let grid = Grid::new(setup.job.range);
    let mut lowest = grid.lowest(setup)?;
    let mut scales = vec![0.5; lowest.len()];
    for _ in 0..ROUNDS {
        let around = grid.neighbours(&lowest, &scales);
        let tried = Spot::measure(setup, &around)?;
        for ((spot, scale), tried) in lowest.iter_mut().zip(&mut scales).zip(tried.chunks(8)) {
            match tried.iter().min_by(|a, b| a.feed.total_cmp(&b.feed)) {
                Some(best) if best.feed < spot.feed => *spot = *best,
                _ => *scale *= 0.5,
            }
        }
    }
    Ok(lowest
        .iter()
        .fold(f64::INFINITY, |least, spot| spot.feed.min(least)))
}

/// A place and its held feed.
#[derive(Debug, Clone, Copy)]
struct Spot {
    theta: f64,
    rho: f64,
    feed: f64,
}

impl Spot {
    fn measure(setup: Setup<'_>, places: &[(f64, f64)]) -> Result<Vec<Spot>> {
        let (theta, rho): (Vec<f64>, Vec<f64>) = places.iter().copied().unzip();
        let mut feed = vec![f64::NAN; places.len()];
        let (residual, radial) = (setup.job.tolerance.residual, setup.locus.radial());
        setup
            .locus
            .held_feed(residual, radial, &theta, &rho, &mut feed)?;
        let spots = places.iter().zip(feed);
        let spots: Vec<Spot> = spots
            .map(|(&(theta, rho), feed)| Spot { theta, rho, feed })
            .collect();
        match spots.iter().find(|spot| spot.feed.is_nan()) {
            Some(spot) => Err(no_feed(spot)),
            None => Ok(spots),
        }
    }
}

struct Grid {
    range: RadialRange,
    theta_step: f64,
    rho_step: f64,
}

impl Grid {
    fn new(range: RadialRange) -> Self {
        Self {
            range,
            theta_step: TAU / ANGLES as f64,
            rho_step: (range.outer - range.inner) / RADII as f64,
        }
    }

    /// The lowest of the grid's places that are no higher than the four next to them.
    fn lowest(&self, setup: Setup<'_>) -> Result<Vec<Spot>> {
        let rows: Vec<Vec<Spot>> = (0..=RADII)
            .map(|i| {
                let rho = self.range.inner + i as f64 * self.rho_step;
                let row: Vec<(f64, f64)> = (0..ANGLES)
                    .map(|j| (j as f64 * self.theta_step, rho))
                    .collect();
                Spot::measure(setup, &row)
            })
            .collect::<Result<_>>()?;
        let mut found = Vec::new();
        for (i, row) in rows.iter().enumerate() {
            let (inside, outside) = (&rows[i.saturating_sub(1)], &rows[(i + 1).min(RADII)]);
            for (j, spot) in row.iter().enumerate() {
                let (before, after) = ((j + ANGLES - 1) % ANGLES, (j + 1) % ANGLES);
                let next = [row[before], row[after], inside[j], outside[j]];
                if next.iter().all(|next| spot.feed <= next.feed) {
                    found.push(*spot);
                }
            }
        }
        found.sort_by(|a, b| a.feed.total_cmp(&b.feed));
        found.truncate(CANDIDATES);
        Ok(found)
    }

    /// The eight neighbours of each spot, at its own part of the grid's step.
    fn neighbours(&self, spots: &[Spot], scales: &[f64]) -> Vec<(f64, f64)> {
        let around = spots.iter().zip(scales).flat_map(|(spot, scale)| {
            NEIGHBOURS.iter().map(move |(turn, out)| {
                let theta = spot.theta + turn * scale * self.theta_step;
                let rho = spot.rho + out * scale * self.rho_step;
                (theta, rho.clamp(self.range.inner, self.range.outer))
            })
        });
        around.collect()
    }
}

fn no_feed(spot: &Spot) -> StrategyError {
    let (sin, cos) = Scalar::sin_cos(spot.theta);
    StrategyError::failed(format!(
        "no feed can be found at x = {:.4} mm, y = {:.4} mm: the tool centre has no value there; \
         choose a smaller aperture, or give `feed`",
        spot.rho * cos,
        spot.rho * sin
    ))
}
