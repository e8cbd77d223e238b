//! Tips and edges: places to which the curvature grows without bound.

use super::figures::{FigureRoom, Figures};
use crate::extreme::Extreme;
use crate::{RadialRange, Scalar, SurfaceModel};

/// The ring around a place that may be a tip, over the outer radius: far above the rounding of positions.
const CLOSE_RING: f64 = 4e-12;
/// The ring that it is compared with, over the same.
const WIDE_RING: f64 = 256.0 * CLOSE_RING;
/// A curvature that is larger by this factor on the close ring, in one direction, has no bound. Around the tip of a
/// cone the factor is 256. Where the curvature follows the logarithm of the distance, the factor is 1.3. At a smooth
/// place both curvatures are the same to less than 10⁻⁶.
const NO_BOUND: f64 = 1.05;
/// A curvature below this part of the other one at its place, or of one over the outer radius, is rounding.
const ROUNDING: f64 = 1e-9;

/// Directions from the closest place to a tip, and lengths of steps there: (1, 0) to (−1, −1).
const AROUND: [(f64, f64); 8] = [
    (1.0, 0.0),
    (1.0, 1.0),
    (0.0, 1.0),
    (-1.0, 1.0),
    (-1.0, 0.0),
    (-1.0, -1.0),
    (0.0, -1.0),
    (1.0, -1.0),
];

/// Looks for tips of a surface on a part.
pub struct TipSearch<'a> {
    surface: &'a dyn SurfaceModel,
    region: RadialRange,
    room: FigureRoom,
}

impl<'a> TipSearch<'a> {
    /// A search within `region`.
    pub fn new(surface: &'a dyn SurfaceModel, region: RadialRange) -> Self {
        Self {
            surface,
            region,
            room: FigureRoom::default(),
        }
    }

    /// Whether a curvature grows without bound around its largest value. `which` is its number among the
    /// [`Figures`], and `other` that of the curvature across.
    pub fn has_tip(&mut self, [which, other]: [usize; 2], found: Extreme) -> bool {
        // A place that is not hollow at all, or not domed, is no tip.
        found.value > 0.0 && {
            let closest = self.close_in(which, found);
            (AROUND.into_iter())
                .any(|direction| self.grows_from(closest, direction, [which, other]))
        }
    }

    /// Goes from the largest curvature that was found to larger ones. Each step has half the length of the one
    /// before. Gives x and y of the last place.
    fn close_in(&mut self, which: usize, found: Extreme) -> (f64, f64) {
        let RadialRange { inner, outer } = self.region;
        let position = found.position();
        let (mut at, mut best) = ((position.x, position.y), found.value);
        // A tip is no farther than a radius of curvature.
        let mut step = best.recip().min(outer - inner);
        while step > 0.25 * CLOSE_RING * outer {
            if let Some((place, figure)) = self.largest_around(which, at, step)
                && figure > best
            {
                (at, best) = (place, figure);
            }
            step *= 0.5;
        }
        at
    }

    /// The largest of a figure in eight directions from a place, on the part, where the surface has it.
    fn largest_around(
        &mut self,
        which: usize,
        at: (f64, f64),
        step: f64,
    ) -> Option<((f64, f64), f64)> {
        let around = AROUND.map(|direction| moved(at, direction, step));
        let figures = around.into_iter().filter_map(|place| {
            let figures = self.figures_at(place)?;
            Some((place, figures[which]))
        });
        figures.max_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Whether a curvature is so much larger on the close ring around a place than on the wide one, in one
    /// direction, that it has no bound.
    fn grows_from(
        &mut self,
        at: (f64, f64),
        direction: (f64, f64),
        [which, other]: [usize; 2],
    ) -> bool {
        let outer = self.region.outer;
        let mut figures = |ring: f64| self.figures_at(moved(at, direction, ring * outer));
        let pair = figures(CLOSE_RING).zip(figures(WIDE_RING));
        pair.is_some_and(|(close, wide)| {
            let rounding = ROUNDING * (outer.recip() + close[other].abs());
            close[which] > rounding && close[which] > NO_BOUND * wide[which]
        })
    }

    /// The figures at a place; `None` outside the part, and where the surface has none, as on a tip itself.
    fn figures_at(&mut self, (x, y): (f64, f64)) -> Option<Figures> {
        let (theta, rho) = (Scalar::atan2(y, x), Scalar::hypot(x, y));
        if !(self.region.inner..=self.region.outer).contains(&rho) {
            return None;
        }
        let mut figures = [Figures::default()];
        let measured = (self.room).measure(self.surface, &[theta], &[rho], &mut figures);
        measured.ok().map(|()| figures[0])
    }
}

/// A place, moved by some length in a direction of [`AROUND`].
fn moved(at: (f64, f64), direction: (f64, f64), length: f64) -> (f64, f64) {
    (at.0 + length * direction.0, at.1 + length * direction.1)
}
