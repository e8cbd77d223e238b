//! |φ⁗| along the path on an even grid of angles, sampled in batches as the steps advance.

use std::f64::consts::TAU;

use super::bound::{Bound, Jumps};
use super::clock::Clock;
use crate::{
    CentreSeries, DEG, Misfit, Pace, Path, Rates, Result, Revolutions, Series, SpindleLaw,
    StrategyError, angle, per_radian,
};

/// Samples on a revolution of the coarsest grid. The number is a prime, so that no ring of equal
/// features has all its samples at the same phase.
const COARSEST: f64 = 367.0;
/// Number of samples in a batch.
const BATCH: u64 = 256;
/// The largest slope that is assumed in the test whether X's own interpolation matters.
const STEEPEST: f64 = 10.0;
/// X's own interpolation does not matter if it changes Z by less than this part of the tolerance.
const NEGLIGIBLE: f64 = 1e-3;

/// With [`Misfit::CutWhatFits`] no step is shorter than this, rad. The path has a kink where the
/// nose passes from one side of a seam to the other, and no step of any length is right there.
/// Refinement halves the segments that are too long there.
const LEAST_NEAR_SEAMS: f64 = 0.1 * DEG;

/// A knot of the law: |φ⁗| before and after it, and the jumps there.
#[derive(Debug, Clone, Copy)]
pub struct Knot {
    /// Position of the knot, in revolutions.
    pub n: f64,
    /// |φ⁗| of the piece that ends, mm/rad⁴.
    pub before: f64,
    /// |φ⁗| of the piece that begins, mm/rad⁴.
    pub after: f64,
    /// The jumps of φ's lower derivatives.
    pub jumps: Jumps,
}

/// Evaluates φ = e_Z − Z_X·e_X: the error that interpolation of Z and of X together leaves between
/// the played and the true tool centre at the played X.
struct PhiEvaluator<'a> {
    path: Path<'a>,
    /// A 4th derivative of X below this does not matter, mm/rad⁴.
    negligible_fourth: f64,
    /// Largest error of φ, mm.
    allowed: f64,
    /// Part of the distance between passes that X's own error may take.
    feed_part: f64,
    /// Upper limit for |φ⁗|, mm/rad⁴.
    sharpest: f64,
    theta: Vec<f64>,
    rho: Vec<f64>,
    x: Vec<Series>,
    z: Vec<Series>,
    spare: [Vec<f64>; 3],
    slope: Vec<f64>,
    clock: Clock<'a>,
    /// The largest step, rad.
    max_step: f64,
    /// The pace at each place of the last evaluation, and the speed over that at the clock's
    /// reference; empty where the speed is constant.
    paces: Vec<(Pace, f64)>,
}

impl PhiEvaluator<'_> {
    /// Fills `x` and `z` with the series at each `n`, and `slope` with ∂Z/∂X where it matters, else
    /// with 0.
    fn evaluate(&mut self, n: &[f64]) -> Result<()> {
        self.resize(n.len());
        self.path.series_at(n, &mut self.x, &mut self.z)?;
        self.find_paces(n, Pace::after);
        let moves = (0..n.len())
            .any(|i| 24.0 * self.in_time(i, self.x[i])[4].abs() > self.negligible_fourth);
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

    fn resize(&mut self, count: usize) {
        self.x.resize(count, [f64::NAN; 5]);
        self.z.resize(count, [f64::NAN; 5]);
        self.slope.clear();
        self.slope.resize(count, 0.0);
        for spare in &mut self.spare {
            spare.resize(count, f64::NAN);
        }
    }

    fn find_paces(&mut self, n: &[f64], pace: fn(&SpindleLaw, f64) -> Pace) {
        self.paces.clear();
        if let Some(spindle) = self.clock.spindle() {
            let clock = self.clock;
            let paces = n.iter().map(|n| (pace(spindle, *n), clock.speed(*n)));
            self.paces.extend(paces);
        }
    }

    /// The series in the clock's time of an axis at element `i`, beside C's own.
    fn in_time(&self, i: usize, series: Series) -> Series {
        let Some((pace, speed)) = self.paces.get(i) else {
            return series;
        };
        let mut scale = 1.0;
        pace.beside_c(&series).map(|c| {
            let scaled = c * scale;
            scale *= speed;
            scaled
        })
    }

    /// What C's own error can add to φ⁗ at element `i`: Z_θ is not the same all over the step.
    fn of_c(&self, i: usize, phi: f64) -> f64 {
        let Some((pace, speed)) = self.paces.get(i) else {
            return 0.0;
        };
        let square = speed * speed;
        self.turn_of_slope(i, phi) * pace.fourth_of_c() * square * square
    }

    /// By how much Z_θ changes over the longest step at element `i`, mm/rad. `phi` is |φ⁗| there.
    fn turn_of_slope(&self, i: usize, phi: f64) -> f64 {
        let bound = Bound {
            fourth: phi,
            ..Bound::default()
        };
        let longest = bound.natural_length(self.allowed).min(self.max_step);
        2.0 * (self.z[i][2] - self.slope[i] * self.x[i][2]).abs() * longest
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

    /// |φ⁗| at element `i` of the last evaluation, where N = `n`; or |X⁗| in the measure of
    /// [`x_weight`](Self::x_weight), if that is larger.
    fn fourth(&self, i: usize, n: f64) -> f64 {
        let of_x = self.in_time(i, self.x[i])[4].abs();
        let (phi, x) = (self.phi(i)[4].abs(), of_x);
        let of_c = self.of_c(i, 24.0 * phi);
        if x == 0.0 {
            return (24.0 * phi + of_c).min(self.sharpest);
        }
        (24.0 * phi.max(x * self.x_weight(n)) + of_c).min(self.sharpest)
    }

    /// The weight of X's own error against φ's at `n` revolutions. With this weight X's error may
    /// be as large as φ's.
    fn x_weight(&self, n: f64) -> f64 {
        self.allowed / (self.feed_part * pitch(&self.path, n))
    }

    /// The series of φ in the clock's time at element `i` of the last evaluation.
    fn phi(&self, i: usize) -> Series {
        let (x, z, slope) = (&self.x[i], &self.z[i], self.slope[i]);
        self.in_time(i, std::array::from_fn(|k| z[k] - slope * x[k]))
    }
}

/// The distance to the next turn, mm; on the path's last turn, the distance to the turn before. The
/// rate is no measure of this distance: a law may come to rest at its ends, and a law that follows
/// the angle moves back and forth.
pub fn pitch(path: &Path<'_>, n: f64) -> f64 {
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

/// |φ⁗|, or |X⁗| in its measure, on the grid around the current step.
pub struct Samples<'a> {
    phi: PhiEvaluator<'a>,
    block: Revolutions,
    /// The grid's spacing, in revolutions.
    spacing: f64,
    /// Number of the first sample in the buffer. Sample i lies at block.start + i·spacing.
    first: u64,
    fourth: Vec<f64>,
    n: Vec<f64>,
}

impl<'a> Samples<'a> {
    /// Samples for steps of at most `max_step` rad, with errors of at most `allowed` mm. X's own
    /// error may take `feed_part` of the distance between passes. No sample is evaluated yet.
    pub fn new(
        path: &Path<'a>,
        block: Revolutions,
        (max_step, feed_part): (f64, f64),
        allowed: f64,
    ) -> Self {
        let squared = max_step * max_step;
        let phi = PhiEvaluator {
            path: *path,
            negligible_fourth: NEGLIGIBLE * allowed * 384.0 / (STEEPEST * squared * squared),
            allowed,
            feed_part,
            sharpest: sharpest(path.task.tool.misfit, allowed),
            theta: Vec::new(),
            rho: Vec::new(),
            x: Vec::new(),
            z: Vec::new(),
            spare: Default::default(),
            slope: Vec::new(),
            clock: Clock::new(path, block.start),
            max_step,
            paces: Vec::new(),
        };
        Self {
            phi,
            block,
            spacing: 1.0 / COARSEST,
            first: 0,
            fourth: Vec::new(),
            n: Vec::new(),
        }
    }

    /// How the lengths of steps are measured.
    pub fn clock(&self) -> Clock<'a> {
        self.phi.clock
    }

    /// The grid's spacing, rad.
    pub fn spacing(&self) -> f64 {
        TAU * self.spacing
    }

    /// Whether the grid is the coarsest one.
    pub fn is_coarsest(&self) -> bool {
        self.spacing >= 1.0 / COARSEST
    }

    /// Scales the spacing and starts anew.
    pub fn rescale(&mut self, factor: f64) {
        self.spacing *= factor;
        self.fourth.clear();
    }

    /// Position of sample `i`, in revolutions. The last samples lie at the block's end.
    pub fn position(&self, i: u64) -> f64 {
        (self.block.start + i as f64 * self.spacing).min(self.block.end)
    }

    /// The number of the sample at or before `n`. Samples before it are no longer needed.
    pub fn begin(&mut self, n: f64) -> u64 {
        let near = ((n - self.block.start) / self.spacing).floor().max(0.0) as u64;
        let start = if self.position(near) > n {
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

    /// |φ⁗| at sample `i`, which must not lie before the result of the last [`begin`](Self::begin).
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
        n.extend((from..from + BATCH).map(|i| self.position(i)));
        self.phi.evaluate(&n)?;
        for (i, n) in n.iter().enumerate() {
            self.fourth.push(self.phi.fourth(i, *n));
        }
        self.n = n;
        Ok(())
    }

    /// The knots of both laws within the block.
    pub fn knots(&mut self) -> Result<Vec<Knot>> {
        let (law, Revolutions { start, end }) = (self.phi.path.law, self.block);
        let mut places: Vec<f64> = law.knots(start, end).collect();
        if let Some(spindle) = self.phi.clock.spindle() {
            places.extend(spindle.as_time().knots(start, end));
            places.sort_by(f64::total_cmp);
            places.dedup();
        }
        let mut knots = Vec::with_capacity(places.len());
        for batch in places.chunks(BATCH as usize) {
            self.phi.evaluate(batch)?;
            let (after, paces) = (self.phi.sides(batch), self.phi.paces.clone());
            self.phi.evaluate_before(batch)?;
            let before = self.phi.sides(batch);
            for (i, (before, after)) in before.into_iter().zip(after).enumerate() {
                let mut knot = Knot::between(batch[i], before, after, self.phi.sharpest);
                knot.jumps.third += self.phi.jump_of_c(i, &paces);
                knots.push(knot);
            }
        }
        Ok(knots)
    }
}

impl PhiEvaluator<'_> {
    /// One side of every knot of the last evaluation.
    fn sides(&self, n: &[f64]) -> Vec<Side> {
        n.iter()
            .enumerate()
            .map(|(i, n)| {
                let measure = self.x_weight(*n);
                let x = self.in_time(i, self.x[i]);
                let phi = self.phi(i);
                Side {
                    of_c: self.of_c(i, 24.0 * phi[4].abs()),
                    series: [
                        phi,
                        self.in_time(i, self.z[i]),
                        x.map(|c| if c == 0.0 { 0.0 } else { c * measure }),
                    ],
                }
            })
            .collect()
    }

    /// What the jump of C's third derivative can add to that of φ at knot `i`. `after` are the
    /// paces after the knots.
    fn jump_of_c(&self, i: usize, after: &[(Pace, f64)]) -> f64 {
        let (Some((before, speed)), Some((after, _))) = (self.paces.get(i), after.get(i)) else {
            return 0.0;
        };
        let phi = 24.0 * self.phi(i)[4].abs();
        self.turn_of_slope(i, phi) * before.jump_of_c(after) * speed * speed * speed
    }

    /// Evaluates at knots with the pieces that end there. The slopes are already known.
    fn evaluate_before(&mut self, knots: &[f64]) -> Result<()> {
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
        self.path.locus.series(&theta, &rho, out)?;
        self.find_paces(knots, Pace::before);
        Ok(())
    }
}

/// One side of a knot.
struct Side {
    /// The series of φ, of Z, and of X in φ's measure.
    series: [Series; 3],
    /// What C's own error can add to |φ⁗|, mm/rad⁴.
    of_c: f64,
}

impl Knot {
    /// Builds a knot from φ, Z and X on both sides. A jump counts as the largest jump of the three.
    /// The jumps of Z and X cancel in φ at the knot's own slope, but the slope differs elsewhere on
    /// the step.
    fn between(n: f64, before: Side, after: Side, sharpest: f64) -> Self {
        let jump = |k: usize, factorial: f64| {
            let of = |which: usize| (after.series[which][k] - before.series[which][k]).abs();
            factorial * of(0).max(of(1)).max(of(2))
        };
        let fourth = |Side { series, of_c }: &Side| {
            let [phi, _, x] = series;
            let larger = phi[4].abs().max(x[4].abs());
            (24.0 * larger + of_c).min(sharpest)
        };
        Self {
            n,
            before: fourth(&before),
            after: fourth(&after),
            jumps: Jumps {
                first: jump(1, 1.0),
                second: jump(2, 2.0),
                third: jump(3, 6.0),
            },
        }
    }
}

/// The upper limit for |φ⁗|, mm/rad⁴: the value for the least step, if there may be seams.
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
        "the path's 4th derivative is not a number at C = {:.3} deg, ρ = {rho:.4} mm",
        360.0 * n
    ))
}
