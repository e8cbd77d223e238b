//! The foot: where the nose at a given X touches the radial section from above.
//!
//! Let d be the foot's distance from the centre's X. The touching circle has d = R g_ρ/w at the
//! foot, so d is a root of G(d) = d − R g_ρ(ρ + d)/w. G′ = 1 − Rκ: where the nose fits (Rκ < 1 over
//! its reach) G grows, the root is the only one, and G(−R) < 0 < G(R) is its bracket. Where the nose
//! need not fit, a scan brackets all roots that may be the highest point.

use turnpath_plugin::prelude::*;

use crate::polar::Evaluation;
use crate::scan::{Maximum, scan};
use crate::touch::{Nose, Touch, rise};

/// A step below this part of ρ and R is within the rounding of the foot itself.
const FINEST: f64 = 4.0 * f64::EPSILON;
/// Trials that are closer than this part of R give no new rate of G: their difference drowns in
/// rounding, and the known rate is good to this part.
const CLOSEST: f64 = 1e-7;
/// Steps below this part of R that no longer shrink are noise.
const NOISE: f64 = 1e-12;
/// From this trial on every second trial halves the bracket, so that no shape of G stalls the
/// search.
const PATIENCE: usize = 12;
/// More trials than it takes to halve any bracket down to rounding.
const MOST_TRIALS: usize = 160;

/// A maximum counts as the highest if it lies below the highest point of a scan by less than this
/// part of R. This is more than rounding, and more than the difference of maxima that are too close
/// for a scan to separate.
const INSEPARABLE: f64 = 1e-11;

/// Finds feet in batches. One finder serves for any number of batches.
#[derive(Default)]
pub struct FootFinder {
    active: Vec<Search>,
    points: Evaluation<f64>,
    touches: Vec<Touch>,
}

impl FootFinder {
    /// The touch at each (θ, ρ).
    pub fn find(&mut self, cut: Cut<'_>, theta: &[f64], rho: &[f64]) -> Result<&[Touch]> {
        let nose = Nose {
            radius: cut.tool.nose_radius,
            reach: cut.tool.reach(),
        };
        self.touches.clear();
        let pairs = theta.iter().zip(rho);
        self.touches
            .extend(pairs.map(|(theta, rho)| Touch::unknown(*theta, *rho)));
        self.active.clear();
        match cut.tool.misfit {
            Misfit::Refuse => {
                let searches = (0..theta.len()).map(|point| Search::new(point, nose));
                self.active.extend(searches);
                self.search(cut.surface, nose)?;
            }
            Misfit::CutWhatFits => self.find_highest(cut.surface, nose)?,
        }
        Ok(&self.touches)
    }

    /// The touch at the highest of all maxima. There is none if the surface rises up to a border of
    /// its own within the reach: nobody knows what the nose would touch there.
    fn find_highest(&mut self, surface: &dyn SurfaceModel, nose: Nose) -> Result<()> {
        let scan = scan(surface, nose, &self.touches, &mut self.points)?;
        let unknown = std::mem::take(&mut self.touches);
        for (rival, candidate) in scan.candidates.iter().enumerate() {
            let mut touch = unknown[candidate.point];
            match candidate.maximum {
                Maximum::Between { lower, upper } => {
                    self.active.push(Search::between(rival, lower, upper));
                }
                Maximum::EdgeEnd(offset) => (touch.offset, touch.at_edge_end) = (offset, true),
            }
            self.touches.push(touch);
        }
        self.search(surface, nose)?;
        let rivals = std::mem::replace(&mut self.touches, unknown);
        let (touches, points) = (&mut self.touches, &mut self.points);
        points.set(rivals.iter().map(|rival| rival.ray.point(rival.foot())));
        points.gradient(surface)?;
        let mut tops: Vec<f64> = scan
            .highest
            .iter()
            .map(|highest| highest - INSEPARABLE * nose.radius)
            .collect();
        for ((rival, candidate), height) in rivals.iter().zip(&scan.candidates).zip(&points.z) {
            let top = height + rise(nose.radius, rival.offset);
            if top > tops[candidate.point] {
                tops[candidate.point] = top;
                touches[candidate.point] = *rival;
            }
        }
        Ok(())
    }

    /// Runs all searches until every one has ended.
    fn search(&mut self, surface: &dyn SurfaceModel, nose: Nose) -> Result<()> {
        for trial in 0..MOST_TRIALS {
            if self.active.is_empty() {
                break;
            }
            self.try_all(surface, nose, trial)?;
        }
        Ok(())
    }

    /// Makes one more trial for every search, and removes the searches that have ended.
    fn try_all(&mut self, surface: &dyn SurfaceModel, nose: Nose, trial: usize) -> Result<()> {
        let (touches, points) = (&mut self.touches, &mut self.points);
        let point = |search: &Search| {
            let touch = &touches[search.point];
            touch.ray.point(touch.rho + search.trial)
        };
        points.set(self.active.iter().map(point));
        points.gradient(surface)?;
        let mut slopes = points.zx.iter().zip(&points.zy);
        self.active.retain_mut(|search| {
            let touch = &mut touches[search.point];
            let slope = slopes
                .next()
                .map_or(f64::NAN, |(zx, zy)| touch.ray.along(*zx, *zy));
            match search.advance(slope, touch.rho, nose, trial) {
                Progress::Searching => true,
                Progress::Root(offset) => {
                    touch.offset = offset;
                    false
                }
                Progress::BeyondEdge(offset) => {
                    (touch.offset, touch.at_edge_end) = (offset, true);
                    false
                }
            }
        });
        Ok(())
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Progress {
    Searching,
    Root(f64),
    BeyondEdge(f64),
}

/// The search for one foot: a secant method within a bracket.
#[derive(Debug)]
struct Search {
    point: usize,
    /// The next d to try.
    trial: f64,
    /// The bracket, and whether the search has tried its ends.
    lower: f64,
    upper: f64,
    ends_tried: [bool; 2],
    /// The last d at which G has a value, that value, and the known rate of G there.
    last: f64,
    gap: f64,
    rate: f64,
    step: f64,
}

impl Search {
    fn new(point: usize, nose: Nose) -> Self {
        Self {
            lower: -nose.reach,
            upper: nose.reach,
            ..Self::at(point)
        }
    }

    /// A search that has tried nothing and has no bracket.
    fn at(point: usize) -> Self {
        Self {
            point,
            trial: 0.0,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            ends_tried: [false; 2],
            last: f64::NAN,
            gap: f64::NAN,
            rate: 1.0,
            step: f64::INFINITY,
        }
    }

    /// The search for the only root between two offsets. G is below zero at the lower one.
    fn between(point: usize, lower: f64, upper: f64) -> Self {
        Self {
            trial: 0.5 * (lower + upper),
            lower,
            upper,
            ends_tried: [true; 2],
            ..Self::at(point)
        }
    }

    /// Takes the slope at the trial and chooses the next trial.
    fn advance(&mut self, slope: f64, rho: f64, nose: Nose, trial: usize) -> Progress {
        let gap = self.trial - nose.radius * slope / (1.0 + slope * slope).sqrt();
        if gap.is_nan() {
            return self.retreat();
        }
        if let Some(end) = self.narrow(gap, nose) {
            return end;
        }
        self.learn_rate(gap, nose);
        let next = self.choose(gap, trial);
        let step = (next - self.trial).abs();
        let noise = step < NOISE * nose.radius && step > 0.5 * self.step;
        if noise || step <= FINEST * (rho.abs() + nose.radius) {
            return Progress::Root(next);
        }
        (self.last, self.gap, self.step) = (self.trial, gap, step);
        self.trial = next;
        Progress::Searching
    }

    /// Goes half way back to the last d at which the surface has a value, if there is one.
    fn retreat(&mut self) -> Progress {
        self.trial = 0.5 * (self.last + self.trial);
        if self.trial.is_nan() || self.trial == self.last {
            Progress::Root(f64::NAN)
        } else {
            Progress::Searching
        }
    }

    fn narrow(&mut self, gap: f64, nose: Nose) -> Option<Progress> {
        if gap == 0.0 {
            return Some(Progress::Root(self.trial));
        }
        let outside = if gap > 0.0 {
            (self.upper, self.ends_tried[1]) = (self.trial, true);
            self.trial <= -nose.reach
        } else {
            (self.lower, self.ends_tried[0]) = (self.trial, true);
            self.trial >= nose.reach
        };
        outside.then_some(Progress::BeyondEdge(self.trial))
    }

    fn learn_rate(&mut self, gap: f64, nose: Nose) {
        let moved = self.trial - self.last;
        if moved.abs() > CLOSEST * nose.radius {
            self.rate = (gap - self.gap) / moved;
        }
    }

    /// The root of the secant. If it leaves the bracket, the end that the search has not tried, or
    /// else the middle.
    fn choose(&self, gap: f64, trial: usize) -> f64 {
        let middle = 0.5 * (self.lower + self.upper);
        if trial > PATIENCE && trial.is_multiple_of(2) {
            return middle;
        }
        let next = self.trial - gap / self.rate;
        let [lower_tried, upper_tried] = self.ends_tried;
        if next <= self.lower {
            if lower_tried { middle } else { self.lower }
        } else if next >= self.upper {
            if upper_tried { middle } else { self.upper }
        } else if next.is_nan() {
            middle
        } else {
            next
        }
    }
}
