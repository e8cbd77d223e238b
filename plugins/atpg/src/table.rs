//! F(ρ), the feed that holds the residual at every angle, tabulated over the radius.

use turnpath_plugin::prelude::*;
use turnpath_plugin::ring::{Measure, least_over_angles};

/// The largest feed is this part of the nose radius, as for the held feed of the locus.
const LARGEST_FEED: f64 = 0.1;
/// Cells of the table at first.
const FEWEST_CELLS: usize = 256;
/// Cells at which the table is no longer halved.
const MOST_CELLS: usize = 4096;
/// Cells are halved while their floors lie this much below the feed, over the whole table: it is
/// what the table costs in revolutions.
const TABLE_COST: f64 = 1e-4;
/// Where in a cell it is probed, as a part of its width: the golden section, in step with nothing.
const PROBE: f64 = 0.381_966;
/// Parts of a cell, each with a floor of its own: more borders without more angles to look at.
pub const FLOORS: usize = 8;

/// Which feed F is the smallest of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Residual {
    /// The feed that holds the residual for what ρ is, curvature and slope at the contact.
    Held,
    /// Wang et al. 2019, eq. 1–4: that of a contact's radius whatever ρ is, with the smallest
    /// curvature and the largest slope on the bare surface at ρ, each at its own angle.
    Paper,
}

/// F at equal steps of ρ, and a floor under it in every cell between them.
#[derive(Debug, Clone)]
pub struct FeedTable {
    /// Where the first cell begins, mm.
    pub from: f64,
    /// Width of a cell, mm.
    pub step: f64,
    /// F at the cells' borders, mm.
    pub feed: Vec<f64>,
    /// What F does not fall below in each eighth of a cell, as far as the cells resolve it, mm.
    pub floor: Vec<f64>,
    /// Whether the table begins at the axis, and F(−ρ) = F(ρ).
    pub even: bool,
}

impl FeedTable {
    /// Tabulates F over the job's range.
    ///
    /// # Errors
    /// Where the range has no length, or surface or locus no value.
    pub fn new(setup: Setup<'_>, residual: Residual) -> Result<Self> {
        let RadialRange { inner, outer } = setup.job.range;
        if !(inner.is_finite() && outer.is_finite() && inner < outer) {
            return Err(StrategyError::failed(format!(
                "there is nothing to cut: ρ runs from {inner} mm to {outer} mm"
            )));
        }
        let even = inner <= 0.0;
        let (from, to) = if even {
            (0.0, outer.max(-inner))
        } else {
            (inner, outer)
        };
        let mut table = Self {
            from,
            step: to - from,
            feed: vec![
                feed_at(setup, residual, from)?,
                feed_at(setup, residual, to)?,
            ],
            floor: Vec::new(),
            even,
        };
        while table.cells() < FEWEST_CELLS {
            table.halve(setup, residual)?;
        }
        table.lay_floor();
        while table.cells() < MOST_CELLS
            && (table.cost() > TABLE_COST || table.sink(setup, residual)?)
        {
            table.halve(setup, residual)?;
            table.lay_floor();
        }
        table.sink(setup, residual)?;
        Ok(table)
    }

    /// Probes every cell at an inner place, off the borders' rhythm: a ripple in step with the
    /// cells shows there. Sinks the floors of cells that F falls through; whether there were any.
    fn sink(&mut self, setup: Setup<'_>, residual: Residual) -> Result<bool> {
        let mut any = false;
        for (cell, floors) in self.floor.chunks_mut(FLOORS).enumerate() {
            let rho = self.from + (cell as f64 + PROBE) * self.step;
            let found = feed_at(setup, residual, rho)?;
            let floor = floors.get((PROBE * FLOORS as f64) as usize).copied();
            if let Some(through) = floor.map(|floor| floor - found).filter(|by| *by > 0.0) {
                any = true;
                for floor in floors {
                    *floor = (*floor - 2.0 * through).max(0.5 * found);
                }
            }
        }
        Ok(any)
    }

    fn cells(&self) -> usize {
        self.feed.len() - 1
    }

    /// The largest F in the table, mm.
    pub fn largest(&self) -> f64 {
        self.feed
            .iter()
            .fold(0.0, |largest, feed| feed.max(largest))
    }

    /// The radii that the table covers, mm.
    pub fn range(&self) -> (f64, f64) {
        (self.from, self.from + self.step * self.cells() as f64)
    }

    /// ∫ dρ/F over the table: revolutions of the fastest law that holds.
    pub fn fewest_revolutions(&self) -> f64 {
        let turns = |pair: &[f64]| 0.5 / pair[0] + 0.5 / pair[1];
        self.step * self.feed.windows(2).map(turns).sum::<f64>()
    }

    /// F at `rho` by the cubic through the four borders around it.
    pub fn value(&self, rho: f64) -> f64 {
        let place = ((rho - self.from) / self.step).clamp(0.0, self.cells() as f64);
        let first = (place.floor() as usize)
            .saturating_sub(1)
            .min(self.feed.len().saturating_sub(4));
        let t = place - first as f64;
        let Some([a, b, c, d]) = self.feed.get(first..first + 4) else {
            return f64::NAN;
        };
        let (t1, t2, t3) = (t - 1.0, t - 2.0, t - 3.0);
        (d * t * t1 * t2 - a * t1 * t2 * t3) / 6.0 + (b * t * t2 * t3 - c * t * t1 * t3) / 2.0
    }

    fn halve(&mut self, setup: Setup<'_>, residual: Residual) -> Result<()> {
        self.step *= 0.5;
        let mut feed = Vec::with_capacity(2 * self.feed.len() - 1);
        for (i, known) in self.feed.iter().enumerate() {
            if i > 0 {
                let between = self.from + (2 * i - 1) as f64 * self.step;
                feed.push(feed_at(setup, residual, between)?);
            }
            feed.push(*known);
        }
        self.feed = feed;
        Ok(())
    }

    /// The largest |second difference| of F around a cell.
    fn bend(&self, cell: usize) -> f64 {
        let second = |i: usize| match self.feed.get(i.saturating_sub(1)..i + 2) {
            Some([before, at, after]) if i > 0 => (before - 2.0 * at + after).abs(),
            _ => 0.0,
        };
        (cell.saturating_sub(1)..cell + 3).fold(0.0, |most: f64, i| most.max(second(i)))
    }

    /// Within a cell a parabola falls below its chord by at most an eighth of its second
    /// difference. Twice that, with the largest second difference around the cell, also serves
    /// where F changes from one angle's branch to another's, which is an arch above the chord.
    fn lay_floor(&mut self) {
        let mut floor = Vec::with_capacity(FLOORS * self.cells());
        for (cell, ends) in self.feed.windows(2).enumerate() {
            let sag = 0.25 * self.bend(cell);
            let chord = |i: usize| ends[0] + (ends[1] - ends[0]) * i as f64 / FLOORS as f64;
            for i in 0..FLOORS {
                let lower = chord(i).min(chord(i + 1));
                floor.push((lower - sag).max(0.5 * lower));
            }
        }
        self.floor = floor;
    }

    /// How far the floors lie below the feed, relatively and on average.
    fn cost(&self) -> f64 {
        let cells = self.feed.windows(2).enumerate();
        let lost: f64 = cells
            .map(|(cell, ends)| 0.5 * self.bend(cell) / (ends[0] + ends[1]))
            .sum();
        lost / self.cells() as f64
    }
}

/// F at one radius, mm.
fn feed_at(setup: Setup<'_>, residual: Residual, rho: f64) -> Result<f64> {
    match residual {
        Residual::Held => {
            let (locus, radial) = (setup.locus, setup.locus.radial());
            let cusp = setup.job.tolerance.residual;
            let measure: &Measure<'_> =
                &|theta, rho, out| locus.held_feed(cusp, radial, theta, rho, out);
            least_over_angles(measure, rho)
        }
        Residual::Paper => paper_feed(setup, rho),
    }
}

/// Eq. 1–4: f = sqrt(8Rε/(1 − R·min κ))/sqrt(1 + max g_ρ²).
fn paper_feed(setup: Setup<'_>, rho: f64) -> Result<f64> {
    let surface = setup.locus.surface();
    let curvature = |profile: Section| profile.curvature();
    let flatness = |profile: Section| -profile.slope.abs();
    let curvature = least_over_angles(&sections(surface, &curvature), rho)?;
    let slope = least_over_angles(&sections(surface, &flatness), rho)?;
    let radius = setup.job.tool.nose_radius;
    let (gap, cap) = (1.0 - radius * curvature, LARGEST_FEED * radius);
    if gap <= 0.0 {
        return Ok(cap);
    }
    let along = (8.0 * radius * setup.job.tolerance.residual / gap).sqrt();
    Ok((along / (1.0 + slope * slope).sqrt()).min(cap))
}

/// The radial section at one place of the bare surface.
#[derive(Clone, Copy)]
struct Section {
    slope: f64,
    second: f64,
}

impl Section {
    fn curvature(self) -> f64 {
        let w = (1.0 + self.slope * self.slope).sqrt();
        self.second / (w * w * w)
    }
}

/// What `of` says of the radial sections.
fn sections<'a>(
    surface: &'a dyn SurfaceModel,
    of: &'a dyn Fn(Section) -> f64,
) -> impl Fn(&[f64], &[f64], &mut [f64]) -> Result<()> + 'a {
    move |theta, rho, out| {
        let ray = |(theta, rho): (&f64, &f64)| -> (Series, Series) {
            let (sin, cos) = Scalar::sin_cos(*theta);
            let along = |unit: f64| [rho * unit, unit, 0.0, 0.0, 0.0];
            (along(cos), along(sin))
        };
        let (x, y): (Vec<Series>, Vec<Series>) = theta.iter().zip(rho).map(ray).unzip();
        let mut z = vec![[f64::NAN; 5]; x.len()];
        surface.height_series(&x, &y, &mut z)?;
        for (out, z) in out.iter_mut().zip(&z) {
            *out = of(Section {
                slope: z[1],
                second: 2.0 * z[2],
            });
        }
        Ok(())
    }
}
