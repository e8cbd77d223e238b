//! Where a line along the part's z axis meets the surface: Newton's method on many points at once.

use turnpath_core::{Gradients, Result, SurfaceModel};

use super::frame::Frame;
use super::rooms::POINTS;

/// Most steps of a point. From a guess of the right order the third is at rounding.
const MOST_STEPS: usize = 12;

/// A step below this share of the coordinates is the last one: the next would be its square over a
/// radius of curvature, far below rounding.
const LAST_STEP: f64 = 1e-13;

/// A step below this share of the coordinates that is hardly smaller than the step before is
/// rounding of the surface, such as that of a sum of large heights.
const ROUNDING: f64 = 1e-10;

/// The smallest share of the step before it that is hardly smaller.
const STANDSTILL: f64 = 0.1;

/// How much smaller than the step before it a last step is at least. The number of right digits then
/// doubles with each step.
const LAST_SHARE: f64 = 1e-3;

/// Largest share of the coordinates by which a height may be off after a step that is the last one
/// for its share.
const HEIGHT_ERROR: f64 = 1e-16;

/// Largest error of a slope that is carried over the last step in a straight line.
const SLOPE_ERROR: f64 = 1e-13;

/// The posed surface near the part's middle, from which the search begins.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Guess {
    pub(super) slope_x: f64,
    pub(super) slope_y: f64,
    /// ∂²z/∂x², ∂²z/∂x∂y, ∂²z/∂y², 1/mm.
    pub(super) bends: [f64; 3],
}

impl Guess {
    /// A height that is exact for a plane and for a level sphere. Farther away than the radius of
    /// curvature, where a bend says nothing, it is that of the plane.
    #[inline(always)]
    fn height(&self, x: f64, y: f64) -> f64 {
        let [xx, xy, yy] = self.bends;
        let (u, v) = (xx * x + xy * y, xy * x + yy * y);
        let rest = 1.0 - (u * u + v * v);
        let bend = (u * x + v * y) / (1.0 + rest.max(0.0).sqrt());
        let bend = if rest > 0.0 { bend } else { 0.0 };
        self.slope_x * x + self.slope_y * y + bend
    }
}

/// Where the lines meet the surface. NaN marks a line for which no point was found.
#[derive(Debug, Clone)]
pub(super) struct Roots {
    /// Height in the part's frame, mm.
    pub(super) z: [f64; POINTS],
    /// ∂z/∂x in the part's frame.
    pub(super) zx: [f64; POINTS],
    /// ∂z/∂y in the part's frame.
    pub(super) zy: [f64; POINTS],
    /// How fast the gap to the surface grows along the part's z axis.
    pub(super) rate: [f64; POINTS],
}

impl Roots {
    pub(super) const BLANK: Self = Self {
        z: [0.0; POINTS],
        zx: [0.0; POINTS],
        zy: [0.0; POINTS],
        rate: [0.0; POINTS],
    };

    /// Marks a line for which no point was found.
    fn lose(&mut self, line: usize) {
        for column in [&mut self.z, &mut self.zx, &mut self.zy, &mut self.rate] {
            column[line] = f64::NAN;
        }
    }
}

/// The search for the roots of at most [`POINTS`] lines.
pub(super) struct Search<'a> {
    surface: &'a dyn SurfaceModel,
    frame: &'a Frame,
    x: &'a [f64],
    y: &'a [f64],
    /// Where each line is looked at next, and what was found there last.
    roots: &'a mut Roots,
    /// The last place on each line that is above or below the surface.
    known: [f64; POINTS],
    /// The step before; NaN if there was none.
    step: [f64; POINTS],
    /// 1 while the line's root is still looked for, else 0. Numbers instead of truth values let the
    /// compiler use vector registers.
    open: [f64; POINTS],
    /// The places in the surface's coordinates.
    places: [[f64; POINTS]; 3],
    /// The surface's height and slopes there.
    answer: [[f64; POINTS]; 3],
}

impl<'a> Search<'a> {
    /// A search along the lines through (x, y) of the part's frame. Both slices have one length of
    /// [`POINTS`] at most.
    pub(super) fn new(
        surface: &'a dyn SurfaceModel,
        frame: &'a Frame,
        guess: &Guess,
        (x, y): (&'a [f64], &'a [f64]),
        roots: &'a mut Roots,
    ) -> Self {
        let mut open = [0.0; POINTS];
        roots.rate = [0.0; POINTS];
        for (i, (x, y)) in x.iter().zip(y).enumerate() {
            roots.z[i] = guess.height(*x, *y);
            if roots.z[i].is_finite() {
                open[i] = 1.0;
            } else {
                roots.lose(i);
            }
        }
        Self {
            surface,
            frame,
            x,
            y,
            roots,
            known: [0.0; POINTS],
            step: [f64::NAN; POINTS],
            open,
            places: [[0.0; POINTS]; 3],
            answer: [[0.0; POINTS]; 3],
        }
    }

    /// Finds the roots. What a line gets does not depend on the other lines.
    pub(super) fn run(mut self) -> Result<()> {
        for _ in 0..MOST_STEPS {
            if !self.is_open() {
                return Ok(());
            }
            self.look()?;
            self.step();
        }
        for (i, open) in self.open.iter().enumerate().take(self.x.len()) {
            if *open > 0.0 {
                self.roots.lose(i);
            }
        }
        Ok(())
    }

    fn is_open(&self) -> bool {
        self.open.iter().any(|open| *open > 0.0)
    }

    /// Asks for the surface below each place.
    fn look(&mut self) -> Result<()> {
        let count = self.x.len();
        for (axis, place) in self.places.iter_mut().enumerate() {
            let lines = place.iter_mut().zip(self.x).zip(self.y);
            for (((place, x), y), z) in lines.zip(&self.roots.z) {
                *place = self.frame.coordinate(axis, *x, *y, *z);
            }
        }
        let [x, y, _] = &self.places;
        let [z, zx, zy] = &mut self.answer;
        let out = Gradients {
            z: &mut z[..count],
            zx: &mut zx[..count],
            zy: &mut zy[..count],
        };
        self.surface.gradient(&x[..count], &y[..count], out)
    }

    /// Takes one step along each open line. There is no branch, so that lines go side by side.
    fn step(&mut self) {
        let size = self.frame.distance() + 1.0;
        let [height, slope_x, slope_y] = &self.answer;
        let roots = &mut *self.roots;
        for (i, (x, y)) in self.x.iter().zip(self.y).enumerate().take(POINTS) {
            let gap = self.places[2][i] - height[i];
            let [along_x, along_y, rate] = self.frame.rates(slope_x[i], slope_y[i]);
            let over = rate.recip();
            let (zx, zy) = (-along_x * over, -along_y * over);
            let (z, step, before) = (roots.z[i], gap * over, self.step[i]);
            let bend = gap + 0.5 * (rate - roots.rate[i]) * before;
            let ends = is_last(step, before, bend, size + x.abs() + y.abs());
            // A place without a surface, or below an overhang, is too far away.
            let meets = (rate > 0.0) & (step.abs() < f64::INFINITY);
            let next = pick(meets, z - step, 0.5 * (z + self.known[i]));
            let ends = ends & meets;
            let is_open = self.open[i] > 0.0;
            // A line that never took another step has nothing to carry its slopes with.
            let carries = ends & (before.abs() < f64::INFINITY);
            let share = step / before;
            let keep = |kept: &mut f64, now: f64| {
                let now = pick(carries, now + (now - *kept) * share, now);
                *kept = pick(is_open, now, *kept);
            };
            keep(&mut roots.zx[i], zx);
            keep(&mut roots.zy[i], zy);
            keep(&mut roots.rate[i], rate);
            roots.z[i] = pick(is_open, next, z);
            self.known[i] = pick(meets, z, self.known[i]);
            self.step[i] = pick(meets, step, f64::NAN);
            self.open[i] = pick(ends, 0.0, self.open[i]);
        }
    }
}

/// Whether a line needs no step after this one.
///
/// `bend` is what the trapezoidal rule misses of the gap over the step before: a twelfth of the
/// second derivative of the gap's rate times the cube of that step. The slopes bend about as much as
/// the rate does.
#[inline(always)]
fn is_last(step: f64, before: f64, bend: f64, size: f64) -> bool {
    let (long, square) = (step.abs(), before * before);
    let is_short = long <= LAST_STEP * size;
    let doubles =
        (long <= LAST_SHARE * before.abs()) & (long * long * long <= HEIGHT_ERROR * size * square);
    let stands = (long <= ROUNDING * size) & (long >= STANDSTILL * before.abs());
    let is_straight = (6.0 * bend * step).abs() <= SLOPE_ERROR * square;
    is_short | stands | (doubles & is_straight)
}

#[inline(always)]
fn pick(which: bool, yes: f64, no: f64) -> f64 {
    if which { yes } else { no }
}
