//! The foot: where the nose at a given X touches the radial section from above.
//!
//! With d = the foot's distance from the centre's X, the touching circle has d = R g_ρ/w at the
//! foot, so the root of G(d) = d − R g_ρ(ρ + d)/w is sought. G' = 1 − Rκ: where the nose fits
//! (Rκ < 1 over its reach) G grows, the root is the only one, and G(−R) < 0 < G(R) brackets it.

use turnpath_plugin::prelude::*;

use crate::polar::{Ray, Room};

/// A step below this part of ρ and R is no more than the rounding of the foot itself.
const FINEST: f64 = 4.0 * f64::EPSILON;
/// Trials closer than this part of R tell nothing new of the rate of G: their difference drowns
/// in rounding, and the rate that is known is good to this part.
const CLOSEST: f64 = 1e-7;
/// Steps below this part of R that no longer shrink are noise.
const NOISE: f64 = 1e-12;
/// From this trial on every second one halves the bracket, so that no shape of G stalls.
const PATIENCE: usize = 12;
/// Trials enough to halve any bracket down to rounding.
const MOST_TRIALS: usize = 160;

/// Where the nose touches.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// The ray at the nose's angle.
    pub ray: Ray,
    /// X of the nose centre, mm.
    pub rho: f64,
    /// The foot's radius less the centre's X, mm; NaN where there is none.
    pub offset: f64,
    /// Whether the edge ends there, so that the contact does not lie on its normal.
    pub at_edge_end: bool,
}

impl Touch {
    /// Radius of the foot, mm.
    pub fn foot(&self) -> f64 {
        self.rho + self.offset
    }
}

/// Finds feet in batches; one serves for any count of them.
#[derive(Default)]
pub struct FootFinder {
    active: Vec<Search>,
    room: Room<f64>,
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
        self.active.clear();
        for (point, (theta, rho)) in theta.iter().zip(rho).enumerate() {
            self.touches.push(Touch {
                ray: Ray::at(*theta),
                rho: *rho,
                offset: f64::NAN,
                at_edge_end: false,
            });
            self.active.push(Search::new(point, nose));
        }
        for trial in 0..MOST_TRIALS {
            if self.active.is_empty() {
                break;
            }
            self.try_all(cut.surface, nose, trial)?;
        }
        Ok(&self.touches)
    }

    /// One more trial for every search that goes on; those that are done leave.
    fn try_all(&mut self, surface: &dyn SurfaceModel, nose: Nose, trial: usize) -> Result<()> {
        let (touches, room) = (&mut self.touches, &mut self.room);
        let place = |search: &Search| {
            let touch = &touches[search.point];
            touch.ray.place(touch.rho + search.trial)
        };
        room.hold(self.active.iter().map(place));
        room.gradient(surface)?;
        let mut slopes = room.zx.iter().zip(&room.zy);
        self.active.retain_mut(|search| {
            let touch = &mut touches[search.point];
            let slope = slopes
                .next()
                .map_or(f64::NAN, |(zx, zy)| touch.ray.along(*zx, *zy));
            match search.advance(slope, touch.rho, nose, trial) {
                Progress::Searching => true,
                Progress::Found(offset) => {
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

#[derive(Debug, Clone, Copy)]
struct Nose {
    radius: f64,
    reach: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Progress {
    Searching,
    Found(f64),
    BeyondEdge(f64),
}

/// The search for one foot: a secant method within a bracket.
#[derive(Debug)]
struct Search {
    point: usize,
    /// The d to be tried next.
    trial: f64,
    /// The bracket, and whether its ends have been tried.
    lower: f64,
    upper: f64,
    ends_tried: [bool; 2],
    /// The last d with a value, that value, and the rate of G known there.
    last: f64,
    gap: f64,
    rate: f64,
    step: f64,
}

impl Search {
    fn new(point: usize, nose: Nose) -> Self {
        Self {
            point,
            trial: 0.0,
            lower: -nose.reach,
            upper: nose.reach,
            ends_tried: [false; 2],
            last: f64::NAN,
            gap: f64::NAN,
            rate: 1.0,
            step: f64::INFINITY,
        }
    }

    /// Takes the slope at the trial and chooses the next one.
    fn advance(&mut self, slope: f64, rho: f64, nose: Nose, trial: usize) -> Progress {
        let gap = self.trial - nose.radius * slope / (1.0 + slope * slope).sqrt();
        if gap.is_nan() {
            return self.retreat();
        }
        if let Some(found) = self.narrow(gap, nose) {
            return found;
        }
        self.learn_rate(gap, nose);
        let next = self.choose(gap, trial);
        let step = (next - self.trial).abs();
        let noise = step < NOISE * nose.radius && step > 0.5 * self.step;
        if noise || step <= FINEST * (rho.abs() + nose.radius) {
            return Progress::Found(next);
        }
        (self.last, self.gap, self.step) = (self.trial, gap, step);
        self.trial = next;
        Progress::Searching
    }

    /// Half way back to where the surface has a value, if there is such a place.
    fn retreat(&mut self) -> Progress {
        self.trial = 0.5 * (self.last + self.trial);
        if self.trial.is_nan() || self.trial == self.last {
            Progress::Found(f64::NAN)
        } else {
            Progress::Searching
        }
    }

    fn narrow(&mut self, gap: f64, nose: Nose) -> Option<Progress> {
        if gap == 0.0 {
            return Some(Progress::Found(self.trial));
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

    /// The secant's root; where it leaves the bracket the end that is untried, else the middle.
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
