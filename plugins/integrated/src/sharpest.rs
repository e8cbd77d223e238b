//! The largest fourth derivative that the played coordinate has on the path: what limits a step.
//!
//! A look along the spiral, then closing in on the sharpest places. The played coordinate φ is Z
//! of the tool centre along the true spiral. Where X bends too, its own error moves the place at
//! which Z is compared, by the slope: φ⁗ = Z⁗ − ∂Z/∂X·X⁗ (after Wang et al. 2019, §3.4, for the
//! tool centre instead of the contact).

use turnpath_plugin::prelude::*;

/// Places of a revolution that are looked at: one in a degree. Not a whole number, so that the
/// next revolution's lie between them: ripples narrower than a degree are met as well.
const PLACES: f64 = 360.618;
/// Most places that are looked at. On longer paths only every so many revolutions are: there
/// they are a thousandth of the radius apart, or less.
const MOST_PLACES: f64 = 2e6;
/// Places in a batch.
const BATCH: usize = 4096;
/// How many of the sharpest places are closed in on: waves have many crests that look alike.
const CANDIDATES: usize = 16;
/// Rounds of closing in; a round that finds nothing sharper halves the distance. After ten such
/// a crest is known to a thousandth of a degree, where it is flat to 1e-6.
const ROUNDS: usize = 24;

/// A place of the path, and |d⁴φ/dθ⁴| there, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Revolutions.
    pub n: f64,
    /// |d⁴φ/dθ⁴|, mm.
    pub sharpness: f64,
}

/// The sharpest place of the path.
///
/// # Errors
/// Where the tool centre has no fourth derivative.
pub fn sharpest(path: &Path<'_>) -> Result<Spot> {
    let scan = Scan::new(path.law.end());
    let mut best = scan.look(path)?;
    let mut reach = vec![(0.5 / PLACES, scan.stride / 2.0); best.len()];
    for _ in 0..ROUNDS {
        let around: Vec<f64> = best
            .iter()
            .zip(&reach)
            .flat_map(|(spot, reach)| scan.neighbours(spot.n, *reach))
            .collect();
        let tried = measure(path, &around)?;
        for ((spot, reach), tried) in best.iter_mut().zip(&mut reach).zip(tried.chunks(8)) {
            match tried.iter().max_by(by_sharpness) {
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

/// Which places of a path are looked at.
struct Scan {
    end: f64,
    /// Revolutions from one that is looked at to the next.
    stride: f64,
}

impl Scan {
    fn new(end: f64) -> Self {
        let stride = (end * PLACES / MOST_PLACES).ceil().max(1.0);
        Self { end, stride }
    }

    /// The sharpest of the places that are no flatter than the two next to them.
    fn look(&self, path: &Path<'_>) -> Result<Vec<Spot>> {
        let mut found = Vec::new();
        let mut start = 0.0;
        while start < self.end {
            self.look_at_turn(path, start, &mut found)?;
            start += self.stride;
        }
        if self.stride > 1.0 {
            self.look_at_turn(path, self.end - 1.0, &mut found)?;
        }
        Ok(found)
    }

    fn look_at_turn(&self, path: &Path<'_>, start: f64, found: &mut Vec<Spot>) -> Result<()> {
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

    /// The places from `start` on over one revolution, with both ends.
    fn turn(&self, start: f64) -> Vec<f64> {
        let end = (start + 1.0).min(self.end);
        let first = (start * PLACES).floor() + 1.0;
        let inner = (0..).map(|k| (first + f64::from(k)) / PLACES);
        let inner = inner.take_while(|n| *n < end);
        std::iter::once(start).chain(inner).chain([end]).collect()
    }

    /// The eight places next to `n`, so many revolutions on along the path and whole ones across.
    fn neighbours(&self, n: f64, (along, across): (f64, f64)) -> impl Iterator<Item = f64> {
        let (end, turns) = (self.end, across.floor());
        let steps = [-1.0, 0.0, 1.0];
        steps.into_iter().flat_map(move |out| {
            let on = steps.into_iter().filter(move |on| *on != 0.0 || out != 0.0);
            on.map(move |on| (n + on * along + out * turns).clamp(0.0, end))
        })
    }
}

/// |φ⁗| at places of the path.
fn measure(path: &Path<'_>, places: &[f64]) -> Result<Vec<Spot>> {
    let mut spots = Vec::with_capacity(places.len());
    for batch in places.chunks(BATCH) {
        let blank = vec![[f64::NAN; 5]; batch.len()];
        let (mut x, mut z) = (blank.clone(), blank);
        path.series_at(batch, &mut x, &mut z)?;
        let slopes = slopes(path, batch, &x)?;
        for (i, n) in batch.iter().enumerate() {
            let sharpness = 24.0 * (z[i][4] - slopes[i] * x[i][4]).abs();
            if !sharpness.is_finite() {
                return Err(no_derivative(path, *n));
            }
            spots.push(Spot { n: *n, sharpness });
        }
    }
    Ok(spots)
}

/// ∂Z/∂X at the places; 0 everywhere where X has no fourth derivative.
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

/// Where a place lies on the part, for messages.
pub fn where_is(path: &Path<'_>, n: f64) -> String {
    let (sin, cos) = Scalar::sin_cos(angle(n));
    let rho = path.radius_at(n);
    format!("x = {:.4} mm, y = {:.4} mm", rho * cos, rho * sin)
}

fn no_derivative(path: &Path<'_>, n: f64) -> StrategyError {
    StrategyError::failed(format!(
        "no step can be found at {}: the tool centre has no fourth derivative there; give `step`",
        where_is(path, n)
    ))
}
