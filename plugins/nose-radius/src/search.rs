//! Searches for feet: a secant method within a bracket, for many feet side by side.

use turnpath_plugin::prelude::*;
use turnpath_plugin::registers::{Loop, in_widest};

use crate::touch::{Nose, Touch};

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

/// Number of searches that go on together. Near ridges the last ones take many steps, each of which asks the
/// surface once for all that are left, so that more searches share them. Their state stays in the cache of the
/// second level. There are as many as a byte has numbers.
pub const WIDTH: usize = 256;

/// Flags are numbers too, 0 or 1: the compiler leaves loops over columns of other types in scalar
/// registers.
type Column = [f64; WIDTH];
const NO: f64 = 0.0;
const YES: f64 = 1.0;

/// Where a search begins.
#[derive(Debug, Clone, Copy)]
pub struct Bracket {
    /// The number of its touch.
    point: usize,
    /// The first d to try.
    trial: f64,
    lower: f64,
    upper: f64,
    /// Whether G is known at the ends: below zero at the lower one and above at the upper one.
    ends_tried: bool,
}

impl Bracket {
    /// The whole reach of the nose, where G is not known.
    pub fn whole(point: usize, nose: Nose) -> Self {
        Self {
            point,
            trial: 0.0,
            lower: -nose.reach,
            upper: nose.reach,
            ends_tried: false,
        }
    }

    /// Two offsets with only one root between them. G is below zero at the lower one.
    pub fn between(point: usize, lower: f64, upper: f64) -> Self {
        Self {
            point,
            trial: 0.5 * (lower + upper),
            lower,
            upper,
            ends_tried: true,
        }
    }
}

/// Searches for up to [`WIDTH`] feet. Each column has one element for each search.
#[derive(Debug)]
pub struct Searches {
    nose: Nose,
    count: usize,
    point: [usize; WIDTH],
    rho: Column,
    sin: Column,
    cos: Column,
    /// The next d to try; the result where the search has ended.
    trial: Column,
    /// The bracket, and whether the search has tried its ends.
    lower: Column,
    upper: Column,
    lower_tried: Column,
    upper_tried: Column,
    /// The last d at which G has a value, that value, and the known rate of G there.
    last: Column,
    gap: Column,
    rate: Column,
    step: Column,
    has_ended: Column,
    /// Whether it has ended at an end of the edge.
    at_edge_end: Column,
    /// The foot's place for the next trial.
    place: [Column; 2],
    /// The surface's answer there.
    height: Column,
    slopes: [Column; 2],
}

impl Default for Searches {
    fn default() -> Self {
        let blank = [0.0; WIDTH];
        Self {
            nose: Nose {
                radius: f64::NAN,
                reach: f64::NAN,
            },
            count: 0,
            point: [0; WIDTH],
            rho: blank,
            sin: blank,
            cos: blank,
            trial: blank,
            lower: blank,
            upper: blank,
            lower_tried: blank,
            upper_tried: blank,
            last: blank,
            gap: blank,
            rate: blank,
            step: blank,
            has_ended: blank,
            at_edge_end: blank,
            place: [blank; 2],
            height: blank,
            slopes: [blank; 2],
        }
    }
}

impl Searches {
    /// Begins a search in each bracket, for the touches that they name. There are [`WIDTH`] of them
    /// at the most.
    pub fn begin(&mut self, brackets: &[Bracket], touches: &[Touch], nose: Nose) {
        (self.nose, self.count) = (nose, brackets.len().min(WIDTH));
        for (i, bracket) in brackets.iter().enumerate().take(WIDTH) {
            let touch = &touches[bracket.point];
            self.point[i] = bracket.point;
            self.rho[i] = touch.rho;
            (self.sin[i], self.cos[i]) = touch.ray.sin_cos();
            self.trial[i] = bracket.trial;
            (self.lower[i], self.upper[i]) = (bracket.lower, bracket.upper);
            let tried = flag(bracket.ends_tried);
            (self.lower_tried[i], self.upper_tried[i]) = (tried, tried);
            let (x, y) = touch.ray.point(touch.rho + bracket.trial);
            (self.place[0][i], self.place[1][i]) = (x, y);
        }
        self.last[..self.count].fill(f64::NAN);
        self.gap[..self.count].fill(f64::NAN);
        self.rate[..self.count].fill(1.0);
        self.step[..self.count].fill(f64::INFINITY);
    }

    /// Runs the searches until all have ended, and gives the touches their offsets.
    pub fn run(&mut self, surface: &dyn SurfaceModel, touches: &mut [Touch]) -> Result<()> {
        for trial in 0..MOST_TRIALS {
            if self.count == 0 {
                break;
            }
            self.ask(surface)?;
            let halves = trial > PATIENCE && trial.is_multiple_of(2);
            if in_widest(Trial(self, halves)) > 0 {
                self.deliver(touches);
                self.keep_open();
            }
        }
        Ok(())
    }

    /// Asks the surface for its slopes at the place of each trial.
    fn ask(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        let count = self.count;
        let ([x, y], [zx, zy]) = (&self.place, &mut self.slopes);
        let out = Gradients {
            z: &mut self.height[..count],
            zx: &mut zx[..count],
            zy: &mut zy[..count],
        };
        surface.gradient(&x[..count], &y[..count], out)
    }

    /// Gives touches the offsets of the searches that have ended.
    fn deliver(&self, touches: &mut [Touch]) {
        for i in 0..self.count {
            if self.has_ended[i] == YES {
                let touch = &mut touches[self.point[i]];
                (touch.offset, touch.at_edge_end) = (self.trial[i], self.at_edge_end[i] == YES);
            }
        }
    }

    /// Lets the searches leave that have ended.
    fn keep_open(&mut self) {
        let mut open = [0; WIDTH];
        let mut kept = 0;
        for (number, has_ended) in (0..=u8::MAX).zip(&self.has_ended[..self.count]) {
            if *has_ended != YES {
                open[kept] = number;
                kept += 1;
            }
        }
        self.count = kept;
        let open = &open[..kept];
        let [x, y] = &mut self.place;
        let own = [&mut self.rho, &mut self.sin, &mut self.cos, x, y];
        let bracket = [&mut self.trial, &mut self.lower, &mut self.upper];
        let way = [
            &mut self.last,
            &mut self.gap,
            &mut self.rate,
            &mut self.step,
        ];
        let tried = [&mut self.lower_tried, &mut self.upper_tried];
        for column in own.into_iter().chain(bracket).chain(tried).chain(way) {
            move_forward(column, open);
        }
        move_forward(&mut self.point, open);
    }
}

/// The loop over one trial of all searches; gives how many end with it. The flag says whether it
/// halves the brackets.
struct Trial<'a>(&'a mut Searches, bool);

impl Loop for Trial<'_> {
    type Output = usize;

    #[inline(always)]
    fn call(self) -> usize {
        let Self(all, halves) = self;
        let Nose { radius, reach } = all.nose;
        let mut ended = 0_u64;
        for i in 0..all.count.min(WIDTH) {
            let (trial, last) = (all.trial[i], all.last[i]);
            let slope = all.slopes[0][i] * all.cos[i] + all.slopes[1][i] * all.sin[i];
            let gap = trial - radius * slope / (1.0 + slope * slope).sqrt();
            // Where the surface has no slope, the search goes half way back to the last d that has.
            let is_nowhere = gap.is_nan();
            let back = 0.5 * (last + trial);
            let is_lost = is_nowhere & (back.is_nan() | (back == last));

            let (is_above, is_below, is_root) = (gap > 0.0, gap < 0.0, gap == 0.0);
            let upper = either(is_above, trial, all.upper[i]);
            let lower = either(is_below, trial, all.lower[i]);
            let upper_tried = either(is_above, YES, all.upper_tried[i]);
            let lower_tried = either(is_below, YES, all.lower_tried[i]);
            let is_outside = (is_above & (trial <= -reach)) | (is_below & (trial >= reach));

            // A new rate, unless rounding drowns the difference.
            let moved = trial - last;
            let is_new = !is_nowhere & (moved.abs() > CLOSEST * radius);
            let rate = either(is_new, (gap - all.gap[i]) / moved, all.rate[i]);

            // The root of the secant. If it leaves the bracket, the end that the search has not
            // tried, or else the middle.
            let middle = 0.5 * (lower + upper);
            let secant = trial - gap / rate;
            let beyond_upper = either(upper_tried == YES, middle, upper);
            let within = either(secant.is_nan(), middle, secant);
            let at_most = either(secant >= upper, beyond_upper, within);
            let beyond_lower = either(lower_tried == YES, middle, lower);
            let inside = either(secant <= lower, beyond_lower, at_most);
            let next = either(halves, middle, inside);

            let step = (next - trial).abs();
            let is_noise = (step < NOISE * radius) & (step > 0.5 * all.step[i]);
            let is_fine = step <= FINEST * (all.rho[i].abs() + radius);
            let is_here = is_root | is_outside;
            let has_ended = is_lost | is_here | (!is_nowhere & (is_noise | is_fine));
            let ahead = either(is_here, trial, next);
            let behind = either(is_lost, f64::NAN, back);
            let at = either(is_nowhere, behind, ahead);

            (all.lower[i], all.upper[i]) = (lower, upper);
            (all.lower_tried[i], all.upper_tried[i]) = (lower_tried, upper_tried);
            all.rate[i] = rate;
            all.last[i] = either(is_nowhere, last, trial);
            all.gap[i] = either(is_nowhere, all.gap[i], gap);
            all.step[i] = either(is_nowhere, all.step[i], step);
            all.trial[i] = at;
            (all.has_ended[i], all.at_edge_end[i]) = (flag(has_ended), flag(is_outside));
            let foot = all.rho[i] + at;
            (all.place[0][i], all.place[1][i]) = (foot * all.cos[i], foot * all.sin[i]);
            ended += u64::from(has_ended);
        }
        ended as usize
    }
}

/// Moves chosen numbers of a column to its beginning, in their order.
fn move_forward<T: Copy>(column: &mut [T; WIDTH], chosen: &[u8]) {
    for (to, from) in chosen.iter().enumerate() {
        column[to] = column[usize::from(*from)];
    }
}

#[inline(always)]
fn flag(is_true: bool) -> f64 {
    either(is_true, YES, NO)
}

/// One of two numbers, without a branch.
#[inline(always)]
fn either(first: bool, yes: f64, no: f64) -> f64 {
    if first { yes } else { no }
}
