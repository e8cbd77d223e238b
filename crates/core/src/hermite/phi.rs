//! |φ⁗| at places of a path.

use super::bound::Bound;
use super::clock::Clock;
use crate::{
    DEG, Misfit, Pace, Path, Radial, Rates, Result, Revolutions, Series, SpindleLaw, StrategyError,
    angles, per_radian,
};

/// The largest slope that is assumed in the test whether X's own interpolation matters.
const STEEPEST: f64 = 10.0;
/// X's own interpolation does not matter if it changes Z by less than this part of the tolerance.
const NEGLIGIBLE: f64 = 1e-3;

/// X's own error is measured against the distance between passes, and at least against this many feeds that
/// leave the residual. Passes that lie closer leave less than a hundredth of the residual between them.
pub const LEAST_PITCH: f64 = 0.1;

/// With [`Misfit::CutWhatFits`] no step is shorter than this, rad. The path has a kink where the
/// nose passes from one side of a seam to the other, and no step of any length is right there.
/// Refinement halves the segments that are too long there.
const LEAST_NEAR_SEAMS: f64 = 0.1 * DEG;

/// Evaluates φ = e_Z − Z_X·e_X: the error that interpolation of Z and of X together leaves between
/// the played and the true tool centre at the played X.
pub(super) struct PhiEvaluator<'a> {
    pub(super) path: Path<'a>,
    /// A 4th derivative of X below this does not matter, mm/rad⁴.
    negligible_fourth: f64,
    /// Whether X's own interpolation mattered in any evaluation.
    pub(super) x_has_mattered: bool,
    /// Largest error of φ, mm.
    allowed: f64,
    /// Part of the distance between passes that X's own error may take.
    feed_part: f64,
    /// Upper limit for |φ⁗|, mm/rad⁴.
    pub(super) sharpest: f64,
    theta: Vec<f64>,
    rho: Vec<f64>,
    pub(super) x: Vec<Series>,
    pub(super) z: Vec<Series>,
    spare: [Vec<f64>; 3],
    slope: Vec<f64>,
    pub(super) clock: Clock<'a>,
    /// The largest step, rad.
    max_step: f64,
    /// The pace at each place of the last evaluation, and the speed over that at the clock's
    /// reference; empty where the speed is constant.
    pub(super) paces: Vec<(Pace, f64)>,
}

impl<'a> PhiEvaluator<'a> {
    /// For steps of at most `max_step` rad within `block`, with errors of at most `allowed` mm. X's own error may
    /// take `feed_part` of the distance between passes.
    pub(super) fn new(
        path: &Path<'a>,
        block: Revolutions,
        (max_step, feed_part): (f64, f64),
        allowed: f64,
    ) -> Self {
        let squared = max_step * max_step;
        Self {
            path: *path,
            negligible_fourth: NEGLIGIBLE * allowed * 384.0 / (STEEPEST * squared * squared),
            x_has_mattered: false,
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
        }
    }

    /// Whether values in `block` do not depend on the places that are evaluated with them. So it is where C runs evenly,
    /// and X is ρ and so smooth that its own interpolation matters nowhere. The 4th derivative of each piece is a line,
    /// so its ends decide.
    pub(super) fn is_pointwise(&self, block: Revolutions) -> bool {
        let (law, Revolutions { start, end }) = (self.path.law, block);
        let is_still =
            |series: Series| 24.0 * per_radian(series)[4].abs() <= self.negligible_fourth;
        self.clock.spindle().is_none()
            && self.path.locus.radial() == Radial::Centre
            && is_still(law.series(start))
            && is_still(law.series_before(end))
            && is_still(law.series(end))
            && law
                .knots(start, end)
                .all(|n| is_still(law.series_before(n)) && is_still(law.series(n)))
    }
}

impl PhiEvaluator<'_> {
    /// Fills `x` and `z` with the series at each `n`, and `slope` with ∂Z/∂X where it matters, else
    /// with 0.
    pub(super) fn evaluate(&mut self, n: &[f64]) -> Result<()> {
        self.resize(n.len());
        self.path.series_at(n, &mut self.x, &mut self.z)?;
        self.find_paces(n, Pace::after);
        let moves = (0..n.len())
            .any(|i| 24.0 * self.in_time(i, self.x[i])[4].abs() > self.negligible_fourth);
        self.x_has_mattered |= moves;
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

    pub(super) fn find_paces(&mut self, n: &[f64], pace: fn(&SpindleLaw, f64) -> Pace) {
        self.paces.clear();
        if let Some(spindle) = self.clock.spindle() {
            let clock = self.clock;
            let paces = n.iter().map(|n| (pace(spindle, *n), clock.speed(*n)));
            self.paces.extend(paces);
        }
    }

    /// The series in the clock's time of an axis at element `i`, beside C's own.
    pub(super) fn in_time(&self, i: usize, series: Series) -> Series {
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
    pub(super) fn of_c(&self, i: usize, phi: f64) -> f64 {
        let Some((pace, speed)) = self.paces.get(i) else {
            return 0.0;
        };
        let square = speed * speed;
        self.turn_of_slope(i, phi) * pace.fourth_of_c() * square * square
    }

    /// By how much Z_θ changes over the longest step at element `i`, mm/rad. `phi` is |φ⁗| there.
    pub(super) fn turn_of_slope(&self, i: usize, phi: f64) -> f64 {
        let bound = Bound {
            fourth: phi,
            ..Bound::default()
        };
        let longest = bound.natural_length(self.allowed).min(self.max_step);
        2.0 * (self.z[i][2] - self.slope[i] * self.x[i][2]).abs() * longest
    }

    fn find_slopes(&mut self, n: &[f64]) -> Result<()> {
        self.theta.resize(n.len(), f64::NAN);
        angles(n, &mut self.theta);
        self.rho.resize(n.len(), f64::NAN);
        self.path.law.values(n, &mut self.rho);
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
    pub(super) fn fourth(&self, i: usize, n: f64) -> f64 {
        let [phi, x] = self.signed_fourths(i, n).map(f64::abs);
        (phi.max(x) + self.of_c(i, phi)).min(self.sharpest)
    }

    /// φ⁗ and X⁗ in its measure, with their signs, at element `i` of the last evaluation, where N = `n`.
    pub(super) fn signed_fourths(&self, i: usize, n: f64) -> [f64; 2] {
        let x = self.in_time(i, self.x[i])[4];
        let of_x = if x == 0.0 { 0.0 } else { x * self.x_weight(n) };
        [24.0 * self.phi(i)[4], 24.0 * of_x]
    }

    /// The weight of X's own error against φ's at `n` revolutions. With this weight X's error may
    /// be as large as φ's.
    pub(super) fn x_weight(&self, n: f64) -> f64 {
        self.allowed / (self.feed_part * pitch(&self.path, n))
    }

    /// The series of φ in the clock's time at element `i` of the last evaluation.
    pub(super) fn phi(&self, i: usize) -> Series {
        let (x, z, slope) = (&self.x[i], &self.z[i], self.slope[i]);
        self.in_time(i, std::array::from_fn(|k| z[k] - slope * x[k]))
    }
}

/// The distance to the next turn, mm; on the path's last turn, the distance to the turn before. The
/// rate is no measure of this distance: a law may come to rest at its ends, and a law that follows
/// the angle moves back and forth. It counts as [`LEAST_PITCH`] feeds on a plane at
/// the least: a law may stay for a turn where it is, and its passes then lie on each other.
pub fn pitch(path: &Path<'_>, n: f64) -> f64 {
    let law = path.law;
    let to = |other: f64| (law.value(other) - law.value(n)).abs();
    let distance = if n + 1.0 <= law.end() {
        to(n + 1.0)
    } else if n >= 1.0 {
        to(n - 1.0)
    } else {
        law.rate(n).abs()
    };
    distance.max(LEAST_PITCH * feed_on_a_plane(path))
}

/// The distance between passes that leaves the residual on a plane, mm.
fn feed_on_a_plane(path: &Path<'_>) -> f64 {
    let nose_radius = path.task.tool.nose_radius;
    (8.0 * nose_radius * path.task.tolerance.residual).sqrt()
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
