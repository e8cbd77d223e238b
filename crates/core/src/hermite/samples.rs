//! |φ⁗| along the path on an even grid of angles, in batches that follow the steps.

use std::f64::consts::TAU;

use super::Steps;
use super::bound::Jumps;
use crate::{
    CentreSeries, DEG, Misfit, Path, Rates, Result, Revolutions, Series, StrategyError, angle,
    per_radian,
};

/// Samples a revolution on the coarsest grid. A prime, so that no array of equal features on a
/// ring has all its samples at the same phase.
const COARSEST: f64 = 367.0;
/// Samples of a batch.
const BATCH: u64 = 256;
/// Slopes up to this count when it is judged whether X's own interpolation matters.
const STEEPEST: f64 = 10.0;
/// It does not where it changes Z by less than this part of the tolerance.
const NEGLIGIBLE: f64 = 1e-3;

/// With [`Misfit::CutWhatFits`] steps are no shorter than this, rad: where the nose passes from one
/// side of a seam to the other the path has a kink, and no step of any length is right. Refinement
/// halves there what is too long.
const LEAST_NEAR_SEAMS: f64 = 0.1 * DEG;

/// A knot of the law: |φ⁗| before and after it, and what jumps there.
#[derive(Debug, Clone, Copy)]
pub struct Knot {
    /// Where it is, in revolutions.
    pub n: f64,
    /// |φ⁗| of the piece that ends, mm/rad⁴.
    pub before: f64,
    /// |φ⁗| of the piece that begins, mm/rad⁴.
    pub after: f64,
    /// The jumps of φ's lower derivatives.
    pub jumps: Jumps,
}

/// φ = e_Z − Z_X·e_X: what interpolation of Z and of X together leave between the played and the
/// true tool centre at the played X.
struct Played<'a> {
    path: Path<'a>,
    /// X's 4th derivative below this does not matter, mm/rad⁴.
    still: f64,
    /// Largest error of φ, mm.
    allowed: f64,
    /// Part of the distance between passes that X's own error may take.
    feed_part: f64,
    /// |φ⁗| counts as no more than this, mm/rad⁴.
    sharpest: f64,
    theta: Vec<f64>,
    rho: Vec<f64>,
    x: Vec<Series>,
    z: Vec<Series>,
    spare: [Vec<f64>; 3],
    slope: Vec<f64>,
}

impl Played<'_> {
    /// Fills x and z with the series at `n`, and slope with ∂Z/∂X where it matters, else 0.
    fn look(&mut self, n: &[f64]) -> Result<()> {
        self.make_room(n.len());
        self.path.series_at(n, &mut self.x, &mut self.z)?;
        let moves = self.x.iter().any(|x| 24.0 * x[4].abs() > self.still);
        if moves {
            self.find_slopes(n)?;
        }
        for (i, n) in n.iter().enumerate() {
            if !self.phi(i).iter().all(|c| c.is_finite()) {
                return Err(no_value(*n, self.path.radius_at(*n)));
            }
        }
        Ok(())
    }

    fn make_room(&mut self, count: usize) {
        self.x.resize(count, [f64::NAN; 5]);
        self.z.resize(count, [f64::NAN; 5]);
        self.slope.clear();
        self.slope.resize(count, 0.0);
        for spare in &mut self.spare {
            spare.resize(count, f64::NAN);
        }
    }

    fn find_slopes(&mut self, n: &[f64]) -> Result<()> {
        self.theta.clear();
        self.theta.extend(n.iter().map(|n| angle(*n)));
        self.rho.clear();
        self.rho.extend(n.iter().map(|n| self.path.law.value(*n)));
        let [x_theta, x_rho, z_theta] = &mut self.spare;
        let rates = Rates {
            x_theta,
            x_rho,
            z_theta,
            z_x: &mut self.slope,
        };
        self.path.locus.rates(&self.theta, &self.rho, rates)
    }

    /// |φ⁗| at place `i` of the last look, `n` revolutions on; or |X⁗| in the measure in which X's
    /// own error may be as large as φ's, where that is more.
    fn fourth(&self, i: usize, n: f64) -> f64 {
        let (phi, x) = (self.phi(i)[4].abs(), self.x[i][4].abs());
        if x == 0.0 {
            return (24.0 * phi).min(self.sharpest);
        }
        (24.0 * phi.max(x * self.x_measure(n))).min(self.sharpest)
    }

    /// What X's own error counts against φ's, `n` revolutions on.
    fn x_measure(&self, n: f64) -> f64 {
        self.allowed / (self.feed_part * pitch(&self.path, n))
    }

    /// The series of φ at place `i` of the last look.
    fn phi(&self, i: usize) -> Series {
        let (x, z, slope) = (&self.x[i], &self.z[i], self.slope[i]);
        std::array::from_fn(|k| z[k] - slope * x[k])
    }
}

/// How far the next turn lies, mm; at the path's last turn, the one before. The rate is no measure of
/// it: a law may come to rest at its ends, and one that follows the angle moves back and forth.
fn pitch(path: &Path<'_>, n: f64) -> f64 {
    let law = path.law;
    let to = |other: f64| (law.value(other) - law.value(n)).abs();
    if n + 1.0 <= law.end() {
        to(n + 1.0)
    } else if n >= 1.0 {
        to(n - 1.0)
    } else {
        law.rate(n).abs()
    }
}

/// |φ⁗| on the grid around the step in hand, or |X⁗| in its measure.
pub struct Samples<'a> {
    played: Played<'a>,
    block: Revolutions,
    /// The grid's spacing, in revolutions.
    spacing: f64,
    /// Number of the first sample held; sample i lies at block.start + i·spacing.
    first: u64,
    fourth: Vec<f64>,
    n: Vec<f64>,
}

impl<'a> Samples<'a> {
    /// None yet. Steps will be at most those of `steps`, errors at most `allowed` mm.
    pub fn new(path: &Path<'a>, block: Revolutions, steps: &Steps, allowed: f64) -> Self {
        let squared = steps.max_step * steps.max_step;
        let played = Played {
            path: *path,
            still: NEGLIGIBLE * allowed * 384.0 / (STEEPEST * squared * squared),
            allowed,
            feed_part: steps.feed_part,
            sharpest: sharpest(path.task.tool.misfit, allowed),
            theta: Vec::new(),
            rho: Vec::new(),
            x: Vec::new(),
            z: Vec::new(),
            spare: Default::default(),
            slope: Vec::new(),
        };
        Self {
            played,
            block,
            spacing: 1.0 / COARSEST,
            first: 0,
            fourth: Vec::new(),
            n: Vec::new(),
        }
    }

    /// The grid's spacing, rad.
    pub fn spacing(&self) -> f64 {
        TAU * self.spacing
    }

    /// Whether the grid is finer than need be anywhere.
    pub fn is_coarsest(&self) -> bool {
        self.spacing >= 1.0 / COARSEST
    }

    /// Scales the spacing, and starts anew.
    pub fn rescale(&mut self, factor: f64) {
        self.spacing *= factor;
        self.fourth.clear();
    }

    /// Where sample `i` lies, in revolutions; the last ones at the block's end.
    pub fn place(&self, i: u64) -> f64 {
        (self.block.start + i as f64 * self.spacing).min(self.block.end)
    }

    /// The sample at or before `n`, before which none are needed any more.
    pub fn begin(&mut self, n: f64) -> u64 {
        let near = ((n - self.block.start) / self.spacing).floor().max(0.0) as u64;
        let start = if self.place(near) > n {
            near.saturating_sub(1)
        } else {
            near
        };
        let held = self.first + self.fourth.len() as u64;
        if start < self.first || start >= held {
            self.fourth.clear();
            self.first = start;
        } else {
            self.fourth.drain(..(start - self.first) as usize);
            self.first = start;
        }
        start
    }

    /// |φ⁗| at sample `i`, not before the last [`begin`](Self::begin).
    pub fn fourth(&mut self, i: u64) -> Result<f64> {
        let at = i.saturating_sub(self.first) as usize;
        while self.fourth.len() <= at {
            self.load()?;
        }
        Ok(self.fourth[at])
    }

    fn load(&mut self) -> Result<()> {
        let from = self.first + self.fourth.len() as u64;
        let mut n = std::mem::take(&mut self.n);
        n.clear();
        n.extend((from..from + BATCH).map(|i| self.place(i)));
        self.played.look(&n)?;
        for (i, n) in n.iter().enumerate() {
            self.fourth.push(self.played.fourth(i, *n));
        }
        self.n = n;
        Ok(())
    }

    /// The knots of the law within the block.
    pub fn knots(&mut self) -> Result<Vec<Knot>> {
        let law = self.played.path.law;
        let places: Vec<f64> = law.knots(self.block.start, self.block.end).collect();
        let mut knots = Vec::with_capacity(places.len());
        for batch in places.chunks(BATCH as usize) {
            self.played.look(batch)?;
            let after = self.played.watched(batch);
            self.played.look_before(batch)?;
            let before = self.played.watched(batch);
            for ((n, before), after) in batch.iter().zip(before).zip(after) {
                knots.push(Knot::between(*n, before, after, self.played.sharpest));
            }
        }
        Ok(knots)
    }
}

impl Played<'_> {
    /// The series of φ, of Z, and of X in φ's measure, at every place `n` of the last look.
    fn watched(&self, n: &[f64]) -> Vec<[Series; 3]> {
        n.iter()
            .enumerate()
            .map(|(i, n)| {
                let measure = self.x_measure(*n);
                let x = self.x[i].map(|c| if c == 0.0 { 0.0 } else { c * measure });
                [self.phi(i), self.z[i], x]
            })
            .collect()
    }

    /// Looks at knots as the pieces have them that end there; the slopes are at hand.
    fn look_before(&mut self, knots: &[f64]) -> Result<()> {
        let law = self.path.law;
        let theta: Vec<Series> = knots
            .iter()
            .map(|n| [angle(*n), 1.0, 0.0, 0.0, 0.0])
            .collect();
        let rho: Vec<Series> = knots
            .iter()
            .map(|n| per_radian(law.series_before(*n)))
            .collect();
        let out = CentreSeries {
            x: &mut self.x,
            z: &mut self.z,
        };
        self.path.locus.series(&theta, &rho, out)
    }
}

impl Knot {
    /// From φ, Z and X on both sides. A jump counts as the largest of theirs: in φ those of Z and X
    /// cancel at the knot's own slope, which is not the slope all over the step.
    fn between(n: f64, before: [Series; 3], after: [Series; 3], sharpest: f64) -> Self {
        let jump = |k: usize, factorial: f64| {
            let of = |which: usize| (after[which][k] - before[which][k]).abs();
            factorial * of(0).max(of(1)).max(of(2))
        };
        let fourth = |[phi, _, x]: [Series; 3]| {
            let larger = phi[4].abs().max(x[4].abs());
            (24.0 * larger).min(sharpest)
        };
        Self {
            n,
            before: fourth(before),
            after: fourth(after),
            jumps: Jumps {
                first: jump(1, 1.0),
                second: jump(2, 2.0),
                third: jump(3, 6.0),
            },
        }
    }
}

/// The largest |φ⁗| that counts, mm/rad⁴: that of the least step where there may be seams.
fn sharpest(misfit: Misfit, allowed: f64) -> f64 {
    match misfit {
        Misfit::Refuse => f64::INFINITY,
        Misfit::CutWhatFits => {
            let squared = LEAST_NEAR_SEAMS * LEAST_NEAR_SEAMS;
            384.0 * allowed / (squared * squared)
        }
    }
}

fn no_value(n: f64, rho: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the path's 4th derivative is no number at C = {:.3} deg, ρ = {rho:.4} mm",
        360.0 * n
    ))
}
