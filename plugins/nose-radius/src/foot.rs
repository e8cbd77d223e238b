//! The foot: where the nose at a given X touches the radial section from above.
//!
//! With d = the foot's distance from the centre's X, the touching circle has d = R g_ρ/w at the
//! foot, so the root of G(d) = d − R g_ρ(ρ + d)/w is sought. G′ = 1 − Rκ: where the nose fits
//! (Rκ < 1 over its reach) G grows, the root is the only one, and G(−R) < 0 < G(R) brackets it.
//! Where the nose need not fit, a scan brackets all roots that may be the highest place.

use turnpath_plugin::prelude::*;

use crate::polar::{Ray, Room};
use crate::scan::{Hill, scan};

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

/// A top this part of R below the highest place of a scan still counts as that place: more than
/// rounding, and than what hills differ by that lie closer together than a scan can tell.
const UNSEEN: f64 = 1e-11;

/// sqrt(R² − d²): how far the centre lies above the contact.
pub fn rise<S: Scalar>(radius: f64, offset: S) -> S {
    ((-offset + radius) * (offset + radius)).sqrt()
}

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
    fn unknown(theta: f64, rho: f64) -> Self {
        Self {
            ray: Ray::at(theta),
            rho,
            offset: f64::NAN,
            at_edge_end: false,
        }
    }

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
        let places = theta.iter().zip(rho);
        self.touches
            .extend(places.map(|(theta, rho)| Touch::unknown(*theta, *rho)));
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

    /// The touch on the highest of all hills. None where the surface goes on rising towards a
    /// border of its own within the reach: what would be touched there is not known.
    fn find_highest(&mut self, surface: &dyn SurfaceModel, nose: Nose) -> Result<()> {
        let scan = scan(surface, nose, &self.touches, &mut self.room)?;
        let points = std::mem::take(&mut self.touches);
        for (rival, candidate) in scan.candidates.iter().enumerate() {
            let mut touch = points[candidate.point];
            match candidate.hill {
                Hill::Between { lower, upper } => {
                    self.active.push(Search::between(rival, lower, upper));
                }
                Hill::EdgeEnd(offset) => (touch.offset, touch.at_edge_end) = (offset, true),
            }
            self.touches.push(touch);
        }
        self.search(surface, nose)?;
        let rivals = std::mem::replace(&mut self.touches, points);
        let (touches, room) = (&mut self.touches, &mut self.room);
        room.hold(rivals.iter().map(|rival| rival.ray.place(rival.foot())));
        room.gradient(surface)?;
        let mut tops: Vec<f64> = scan
            .highest
            .iter()
            .map(|highest| highest - UNSEEN * nose.radius)
            .collect();
        for ((rival, candidate), height) in rivals.iter().zip(&scan.candidates).zip(&room.z) {
            let top = height + rise(nose.radius, rival.offset);
            if top > tops[candidate.point] {
                tops[candidate.point] = top;
                touches[candidate.point] = *rival;
            }
        }
        Ok(())
    }

    /// Goes on until every search has ended.
    fn search(&mut self, surface: &dyn SurfaceModel, nose: Nose) -> Result<()> {
        for trial in 0..MOST_TRIALS {
            if self.active.is_empty() {
                break;
            }
            self.try_all(surface, nose, trial)?;
        }
        Ok(())
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
pub struct Nose {
    /// Its radius, mm.
    pub radius: f64,
    /// How far from the centre's X the edge reaches, mm.
    pub reach: f64,
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
            lower: -nose.reach,
            upper: nose.reach,
            ..Self::at(point)
        }
    }

    /// Nothing tried yet, no bracket.
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

    /// The search for the one root between two offsets, G below zero at the lower one.
    fn between(point: usize, lower: f64, upper: f64) -> Self {
        Self {
            trial: 0.5 * (lower + upper),
            lower,
            upper,
            ends_tried: [true; 2],
            ..Self::at(point)
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
