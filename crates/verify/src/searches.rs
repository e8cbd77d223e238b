//! Searches for the contact of the nose, many side by side, so that their steps fill the widest vector
//! registers.
//!
//! The height of the nose's centre over a contact s has its maximum where F(s) = g_ρ q − (s − X), with
//! q = sqrt(R² − (s − X)²), falls through zero. Each search closes in on it within a bracket: the first
//! step follows the normal through the contact, later steps the secant. A step beyond the bracket goes
//! to its middle instead. Where the surface has no value, the bracket shrinks towards its start, where
//! the surface has one.

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::{Gradients, Result, SurfaceModel, sines_and_cosines};

use crate::bracket::Bracket;
use crate::profiles::Profiles;
use crate::search_limits::{SURE_FIT, WIDTH};
use crate::small_turns::TurnStarts;
use crate::touches::{Touch, Touches};

/// The secant stops when it moves less than this part of the nose radius. The error of the height
/// is the square of this: 1e-16 of the radius.
const FOOT_TOLERANCE: f64 = 1e-8;
/// A search ends with its first step only if that step is shorter than this part of the tolerance. In a hollow
/// nearly as tight as the nose, a step along the normal is this part of the way to the contact.
const FIRST_STEP: f64 = 1.0 - SURE_FIT;
/// Largest number of steps of a search.
const MOST_STEPS: usize = 80;
/// After this many steps every second one halves the bracket. Halving alone reaches
/// [`FOOT_TOLERANCE`] in 28 steps.
const PATIENCE: usize = 16;
/// Searches that have ended leave when no more than one in so many still goes on. Until then they are
/// carried along, which costs less than moving the others.
const SPARSE: usize = 2;

/// A quantity of all searches.
type Column = [f64; WIDTH];

/// Searches, with a column for each quantity. A search that has ended stays where it is: its bracket
/// is the contact alone.
pub(crate) struct Searches {
    count: usize,
    /// Whether some searches have left, so that the others are not in their first places.
    left_early: bool,
    /// The number of each search's touch among those that are found, once some have left.
    owner: [usize; WIDTH],
    /// X of the nose.
    x: Column,
    /// Sine and cosine of C.
    sine: Column,
    cosine: Column,
    /// A radius at which the surface has a height, and the bracket.
    start: Column,
    low: Column,
    high: Column,
    /// The present s, and how far the last step moved it.
    at: Column,
    step: Column,
    /// The previous s, and F there.
    before: Column,
    fall_before: Column,
    /// The place of the present s, and the surface there.
    place: [Column; 2],
    height: Column,
    slopes: [Column; 2],
    /// The touch at the last s where the surface has a height.
    z: Column,
    foot: Column,
    slope: Column,
}

impl Default for Searches {
    fn default() -> Self {
        let empty = [0.0; WIDTH];
        Self {
            count: 0,
            left_early: false,
            owner: [0; WIDTH],
            x: empty,
            sine: empty,
            cosine: empty,
            start: empty,
            low: empty,
            high: empty,
            at: empty,
            step: empty,
            before: empty,
            fall_before: empty,
            place: [empty; 2],
            height: empty,
            slopes: [empty; 2],
            z: empty,
            foot: empty,
            slope: empty,
        }
    }
}

impl Searches {
    /// Begins a search at each (θ, X), at most [`WIDTH`] of them, over the whole reach of the tool.
    pub fn begin_in_reach(&mut self, theta: &[f64], x: &[f64], reach: f64) {
        let count = x.len();
        sines_and_cosines(theta, &mut self.sine[..count], &mut self.cosine[..count]);
        self.x[..count].copy_from_slice(x);
        self.start[..count].copy_from_slice(x);
        self.at[..count].copy_from_slice(x);
        self.begin(count, Some(reach));
    }

    /// Like [`Self::begin_in_reach`], with the first step from where each contact is expected. A search
    /// whose contact is expected nowhere, or out of reach, begins at its X. C of each search is near its
    /// start. Where the surface has no height at X but has one where the contact is expected, a touch is
    /// found that a search from X would not find.
    pub fn begin_near(
        &mut self,
        starts: &TurnStarts,
        expected: &[f64],
        (theta, x): (&[f64], &[f64]),
        reach: f64,
    ) {
        let count = x.len();
        let (sine, cosine) = (&mut self.sine[..count], &mut self.cosine[..count]);
        starts.turn(theta, sine, cosine);
        self.x[..count].copy_from_slice(x);
        self.start[..count].copy_from_slice(x);
        for ((at, x), expected) in self.at.iter_mut().zip(x).zip(expected) {
            let is_in_reach = (expected - x).abs() <= reach;
            *at = either(is_in_reach, *expected, *x);
        }
        self.begin(count, Some(reach));
    }

    /// Begins a search in each bracket, at most [`WIDTH`] of them.
    pub fn begin_in_brackets(&mut self, brackets: &[Bracket], profiles: &Profiles<'_>, x: &[f64]) {
        for (i, bracket) in brackets.iter().enumerate() {
            self.x[i] = x[bracket.point];
            (self.sine[i], self.cosine[i]) = profiles.turned(bracket.point);
            (self.low[i], self.high[i]) = (bracket.low, bracket.high);
            self.start[i] = bracket.start;
            self.at[i] = bracket.start;
        }
        self.begin(brackets.len(), None);
    }

    fn begin(&mut self, count: usize, reach: Option<f64>) {
        self.count = count;
        self.left_early = false;
        in_widest(Beginning(self, reach));
    }

    /// Closes in on the maximum in every bracket. The touches go to `found`, from number `first` on;
    /// they are NaN where the surface has no height.
    pub fn close_in(
        &mut self,
        surface: &dyn SurfaceModel,
        radius: f64,
        found: &mut Touches,
        first: usize,
    ) -> Result<()> {
        let tolerance = FOOT_TOLERANCE * radius;
        for number in 0..MOST_STEPS {
            self.ask(surface)?;
            let halve = number > PATIENCE && number % 2 == 0;
            let step = StepRule {
                radius,
                tolerance,
                halve,
            };
            let open = match number {
                0 => in_widest(Step::<true>(self, step)),
                _ => in_widest(Step::<false>(self, step)),
            };
            if open == 0 {
                break;
            }
            if open <= self.count / SPARSE {
                self.deliver(found, first);
                self.keep_open(tolerance);
            }
        }
        self.deliver(found, first);
        Ok(())
    }

    /// Asks the surface at the place of each search.
    fn ask(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        let count = self.count;
        let [x, y] = &self.place;
        let [zx, zy] = &mut self.slopes;
        let out = Gradients {
            z: &mut self.height[..count],
            zx: &mut zx[..count],
            zy: &mut zy[..count],
        };
        surface.gradient(&x[..count], &y[..count], out)
    }

    /// Writes down the touches so far.
    fn deliver(&self, found: &mut Touches, first: usize) {
        let count = self.count;
        if !self.left_early {
            let places = first..first + count;
            found.z[places.clone()].copy_from_slice(&self.z[..count]);
            found.foot[places.clone()].copy_from_slice(&self.foot[..count]);
            found.slope[places].copy_from_slice(&self.slope[..count]);
            return;
        }
        for (i, owner) in self.owner[..count].iter().enumerate() {
            let touch = Touch {
                z: self.z[i],
                foot: self.foot[i],
                slope: self.slope[i],
            };
            found.set(first + owner, touch);
        }
    }

    /// Lets the searches leave that have ended.
    fn keep_open(&mut self, tolerance: f64) {
        let mut kept = 0;
        for i in 0..self.count {
            if self.step[i].abs() <= tolerance {
                continue;
            }
            self.owner[kept] = match self.left_early {
                true => self.owner[i],
                false => i,
            };
            let [x, y] = &mut self.place;
            let own = [&mut self.x, &mut self.sine, &mut self.cosine, x, y];
            let bracket = [&mut self.start, &mut self.low, &mut self.high];
            let way = [&mut self.at, &mut self.before, &mut self.fall_before];
            let touch = [&mut self.z, &mut self.foot, &mut self.slope];
            for column in own.into_iter().chain(bracket).chain(way).chain(touch) {
                column[kept] = column[i];
            }
            kept += 1;
        }
        (self.count, self.left_early) = (kept, true);
    }
}

/// The loop over the beginnings of all searches: their brackets, where these are the whole reach of the
/// tool, and the place of their first s.
struct Beginning<'a>(&'a mut Searches, Option<f64>);

impl Loop for Beginning<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(all, reach) = self;
        let count = all.count.min(WIDTH);
        if let Some(reach) = reach {
            for i in 0..count {
                (all.low[i], all.high[i]) = (all.x[i] - reach, all.x[i] + reach);
            }
        }
        for i in 0..count {
            let at = all.at[i];
            (all.place[0][i], all.place[1][i]) = (at * all.cosine[i], at * all.sine[i]);
        }
    }
}

/// How all searches take a step.
#[derive(Clone, Copy)]
struct StepRule {
    /// The nose radius, mm.
    radius: f64,
    /// A search that would move by no more than this has ended, mm.
    tolerance: f64,
    /// Whether the step goes to the middle of the bracket.
    halve: bool,
}

/// The loop over one step of all searches; gives how many go on. `FIRST` is their first step.
struct Step<'a, const FIRST: bool>(&'a mut Searches, StepRule);

impl<const FIRST: bool> Loop for Step<'_, FIRST> {
    type Output = usize;

    #[inline(always)]
    fn call(self) -> usize {
        let Self(all, rule) = self;
        let mut open = 0_u64;
        for i in 0..all.count.min(WIDTH) {
            let (x, at) = (all.x[i], all.at[i]);
            let slope = all.slopes[0][i] * all.cosine[i] + all.slopes[1][i] * all.sine[i];
            let offset = at - x;
            let lift = rule.lift(offset);
            let is_on_surface = all.height[i].abs() < f64::INFINITY;
            // A search that has ended keeps what it found.
            let is_found = is_on_surface & (FIRST | (all.low[i] < all.high[i]));
            // Before the first step there is no touch.
            let so_far = |column: &Column| if FIRST { f64::NAN } else { column[i] };
            all.z[i] = either(is_found, all.height[i] + lift, so_far(&all.z));
            all.slope[i] = either(is_found, slope, so_far(&all.slope));

            let fall = slope * lift - offset;
            let is_nowhere = fall.is_nan();
            let is_below = (fall > 0.0) | (is_nowhere & (at < all.start[i]));
            let is_above = !is_below & ((fall < 0.0) | (is_nowhere & (at > all.start[i])));
            let low = either(is_below, at, all.low[i]);
            let high = either(is_above, at, all.high[i]);
            let proposed = match FIRST {
                true => x + rule.radius * slope / (1.0 + slope * slope).sqrt(),
                false => {
                    let (before, then) = (all.before[i], all.fall_before[i]);
                    let by_secant = at - fall * (at - before) / (fall - then);
                    either(then == fall, at, by_secant)
                }
            };
            let is_within = !rule.halve & (low <= proposed) & (proposed <= high);
            let next = either(is_within, proposed, 0.5 * (low + high));
            let step = next - at;
            let is_closed = step.abs() <= if FIRST { FIRST_STEP } else { 1.0 } * rule.tolerance;
            (all.before[i], all.fall_before[i], all.step[i]) = (at, fall, step);
            all.low[i] = either(is_closed, at, low);
            all.high[i] = either(is_closed, at, high);
            // The first step leads along the normal. It ends nearly at the contact where the nose is much
            // smaller than the surface's radius of curvature.
            let foot = either(FIRST & is_closed, next, at);
            all.foot[i] = either(is_found, foot, so_far(&all.foot));
            let at = either(is_closed, at, next);
            all.at[i] = at;
            (all.place[0][i], all.place[1][i]) = (at * all.cosine[i], at * all.sine[i]);
            open += u64::from(!is_closed);
        }
        open as usize
    }
}

impl StepRule {
    /// How high the nose's centre is above its edge, at this distance to the side of the centre.
    #[inline(always)]
    fn lift(&self, offset: f64) -> f64 {
        let square = self.radius * self.radius - offset * offset;
        either(square > 0.0, square, 0.0).sqrt()
    }
}

/// One of two numbers, without a branch.
#[inline(always)]
fn either(first: bool, yes: f64, no: f64) -> f64 {
    if first { yes } else { no }
}
