//! The largest fourth derivative of the played coordinate on the path. It limits the step.
//!
//! The search evaluates points along the spiral and then refines the sharpest of them. The played
//! coordinate φ is Z of the tool centre along the true spiral. Where X bends too, its own error
//! moves the position at which Z is compared, by the slope: φ⁗ = Z⁗ − ∂Z/∂X·X⁗ (after Wang et al.
//! 2019, §3.4, for the tool centre instead of the contact). Where the speed of the spindle changes, the
//! cubics run in time, and the search takes the derivative in time.

use turnpath_plugin::prelude::*;

/// Points of a revolution: one in each degree. The number is not whole, so that the points of the
/// next revolution lie between them. In this way the search also meets ripples that are narrower
/// than a degree.
const POINTS: f64 = 360.618;
/// Most points of a path. On longer paths the search evaluates only every so many revolutions.
/// These are a thousandth of the radius apart, or less.
const MOST_POINTS: f64 = 2e6;
/// Points in a batch.
const BATCH: usize = 4096;
/// How many of the sharpest points the search refines. Waves have many crests that look alike.
const CANDIDATES: usize = 16;
/// The longest step that a sampler may take, rad.
const LONGEST: f64 = 0.5 * PI;
/// Rounds of refinement. A round that finds nothing sharper halves the distance. After ten such
/// rounds a crest is known to a thousandth of a degree, where it is flat to 1e-6.
const ROUNDS: usize = 24;

/// A point of the path, and |d⁴φ/dθ⁴| there, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Revolutions.
    pub n: f64,
    /// |d⁴φ/dθ⁴|, mm.
    pub sharpness: f64,
}

/// The sharpest point of the path.
///
/// # Errors
/// If the tool centre has no fourth derivative somewhere.
pub fn sharpest(path: &Path<'_>) -> Result<Spot> {
    let scan = Scan::new(path.law.end());
    let mut best = scan.evaluate(path)?;
    let mut reach = vec![(0.5 / POINTS, scan.stride / 2.0); best.len()];
    for _ in 0..ROUNDS {
        let around: Vec<f64> = best
            .iter()
            .zip(&reach)
            .flat_map(|(spot, reach)| scan.neighbours(spot.n, *reach))
            .collect();
        let neighbours = measure(path, &around)?;
        for ((spot, reach), neighbours) in best.iter_mut().zip(&mut reach).zip(neighbours.chunks(8))
        {
            match neighbours.iter().max_by(by_sharpness) {
                Some(sharper) if sharper.sharpness > spot.sharpness => *spot = *sharper,
                _ => *reach = (0.5 * reach.0, 0.5 * reach.1),
            }
        }
    }
    let flat = Spot {
        n: 0.0,
        sharpness: 0.0,
    };
    Ok(best
        .into_iter()
        .max_by(|a, b| by_sharpness(&a, &b))
        .unwrap_or(flat))
}

fn by_sharpness(a: &&Spot, b: &&Spot) -> std::cmp::Ordering {
    a.sharpness.total_cmp(&b.sharpness)
}

/// The points of a path that the search evaluates.
struct Scan {
    end: f64,
    /// Revolutions from the start of one evaluated revolution to the start of the next.
    stride: f64,
}

impl Scan {
    fn new(end: f64) -> Self {
        let stride = (end * POINTS / MOST_POINTS).ceil().max(1.0);
        Self { end, stride }
    }

    /// The sharpest of the points that are no flatter than the two next to them.
    fn evaluate(&self, path: &Path<'_>) -> Result<Vec<Spot>> {
        let mut found = Vec::new();
        let mut start = 0.0;
        while start < self.end {
            self.evaluate_turn(path, start, &mut found)?;
            start += self.stride;
        }
        if self.stride > 1.0 {
            self.evaluate_turn(path, self.end - 1.0, &mut found)?;
        }
        Ok(found)
    }

    fn evaluate_turn(&self, path: &Path<'_>, start: f64, found: &mut Vec<Spot>) -> Result<()> {
        let spots = measure(path, &self.turn(start))?;
        for (k, spot) in spots.iter().enumerate() {
            let next = [k.checked_sub(1), Some(k + 1)];
            let next = next.into_iter().flatten().filter_map(|k| spots.get(k));
            if next
                .into_iter()
                .all(|next| next.sharpness <= spot.sharpness)
            {
                found.push(*spot);
            }
        }
        found.sort_by(|a, b| b.sharpness.total_cmp(&a.sharpness));
        found.truncate(CANDIDATES);
        Ok(())
    }

    /// The points from `start` on over one revolution, with both ends.
    fn turn(&self, start: f64) -> Vec<f64> {
        let end = (start + 1.0).min(self.end);
        let first = (start * POINTS).floor() + 1.0;
        let inner = (0..).map(|k| (first + f64::from(k)) / POINTS);
        let inner = inner.take_while(|n| *n < end);
        std::iter::once(start).chain(inner).chain([end]).collect()
    }

    /// The eight points next to `n`: `along` revolutions away along the path, and `across` whole
    /// revolutions away across it.
    fn neighbours(&self, n: f64, (along, across): (f64, f64)) -> impl Iterator<Item = f64> {
        let (end, turns) = (self.end, across.floor());
        let steps = [-1.0, 0.0, 1.0];
        steps.into_iter().flat_map(move |out| {
            let on = steps.into_iter().filter(move |on| *on != 0.0 || out != 0.0);
            on.map(move |on| (n + on * along + out * turns).clamp(0.0, end))
        })
    }
}

/// |φ⁗| at points of the path.
fn measure(path: &Path<'_>, places: &[f64]) -> Result<Vec<Spot>> {
    let mut spots = Vec::with_capacity(places.len());
    let steady = path.spindle.is_constant();
    for batch in places.chunks(BATCH) {
        let blank = vec![[f64::NAN; 5]; batch.len()];
        let (mut x, mut z) = (blank.clone(), blank);
        path.series_at(batch, &mut x, &mut z)?;
        let slopes = slopes(path, batch, &x)?;
        for (i, n) in batch.iter().enumerate() {
            let phi: Series = std::array::from_fn(|k| z[i][k] - slopes[i] * x[i][k]);
            let sharpness = match steady {
                true => 24.0 * phi[4].abs(),
                false => in_time(path, *n, &phi),
            };
            if !sharpness.is_finite() {
                return Err(no_derivative(path, *n));
            }
            spots.push(Spot { n: *n, sharpness });
        }
    }
    Ok(spots)
}

/// |φ⁗| where the speed of the spindle changes: in the time of a radian, without what C's own error
/// makes of it. A step is an angle, and its fastest radian counts.
fn in_time(path: &Path<'_>, n: f64, phi: &Series) -> f64 {
    let pace = Pace::after(path.spindle, n);
    let fourth = 24.0 * pace.beside_c(phi)[4].abs();
    let natural = (384.0 * path.task.tolerance.interpolation / fourth)
        .sqrt()
        .sqrt();
    let faster = 1.0 + 0.5 * pace.change() * natural.min(LONGEST);
    let square = faster * faster;
    fourth * square * square
}

/// ∂Z/∂X at the points; 0 everywhere if X has no fourth derivative.
fn slopes(path: &Path<'_>, places: &[f64], x: &[Series]) -> Result<Vec<f64>> {
    let mut slopes = vec![0.0; places.len()];
    if x.iter().all(|x| x[4] == 0.0) {
        return Ok(slopes);
    }
    let theta: Vec<f64> = places.iter().map(|n| angle(*n)).collect();
    let rho: Vec<f64> = places.iter().map(|n| path.radius_at(*n)).collect();
    let mut rest = [slopes.clone(), slopes.clone(), slopes.clone()];
    let [x_theta, x_rho, z_theta] = &mut rest;
    let rates = Rates {
        x_theta,
        x_rho,
        z_theta,
        z_x: &mut slopes,
    };
    path.locus.rates(&theta, &rho, rates)?;
    Ok(slopes)
}

/// The position of a point on the part, for messages.
pub fn position(path: &Path<'_>, n: f64) -> String {
    let (sin, cos) = Scalar::sin_cos(angle(n));
    let rho = path.radius_at(n);
    format!("x = {:.4} mm, y = {:.4} mm", rho * cos, rho * sin)
}

fn no_derivative(path: &Path<'_>, n: f64) -> StrategyError {
    StrategyError::failed(format!(
        "no step can be found at {}: the tool centre has no fourth derivative there; give `step`",
        position(path, n)
    ))
}
