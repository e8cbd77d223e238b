//! The scan: it finds all maxima of the section at which the nose may touch first.
//!
//! Over the edge's angle φ, with the foot at ρ + R sin φ, the centre stands at h(φ) = g + R cos φ,
//! whose rate is h′ = R (g_ρ cos φ − sin φ). The scan evaluates the edge in coarse steps. The coarse
//! steps in which h may reach the highest point are evaluated again in fine steps. A maximum lies
//! where h′ falls through zero between two positions, or at an end of the edge towards which h
//! rises.

use turnpath_plugin::prelude::*;

use crate::polar::Evaluation;
use crate::touch::{Nose, Touch};

/// Number of coarse steps along the edge: 4° on a full edge.
const STEPS: usize = 45;
/// Number of fine steps in a coarse one: half a degree each. The scan misses a ripple that is
/// narrower than two fine steps.
const PARTS: usize = 8;
/// Number of parts of a fine step that hides a maximum beside a minimum.
const HIDDEN: usize = 32;
/// Within a coarse step h may rise by this many times the rise that the steeper end gives.
const DOUBT: f64 = 2.0;

/// A maximum of h along the edge.
#[derive(Debug, Clone, Copy)]
pub enum Maximum {
    /// The maximum lies between two offsets: h rises at the lower one and falls at the upper one.
    Between {
        /// Lower offset from the centre's X, mm.
        lower: f64,
        /// Upper offset, mm.
        upper: f64,
    },
    /// h rises towards an end of the edge, so the end touches, at this offset.
    EdgeEnd(f64),
}

/// A maximum for one point, with an upper limit of its height.
#[derive(Debug, Clone, Copy)]
pub struct Candidate {
    /// The number of the point.
    pub point: usize,
    /// The maximum.
    pub maximum: Maximum,
    at_most: f64,
}

/// The maxima of a scan.
#[derive(Debug, Default)]
pub struct Maxima {
    /// The maxima that may be a first touch.
    pub candidates: Vec<Candidate>,
    /// The highest evaluated h of each point, mm.
    pub highest: Vec<f64>,
}

impl Maxima {
    fn include(&mut self, point: usize, here: &Position) {
        if here.height > self.highest[point] {
            self.highest[point] = here.height;
        }
    }

    fn add(&mut self, point: usize, maximum: Option<(Maximum, f64)>) {
        self.candidates
            .extend(maximum.map(|(maximum, at_most)| Candidate {
                point,
                maximum,
                at_most,
            }));
    }
}

/// Scans the edge at each touch's ray and X.
pub fn scan(
    surface: &dyn SurfaceModel,
    nose: Nose,
    touches: &[Touch],
    points: &mut Evaluation<f64>,
) -> Result<Maxima> {
    let mut maxima = Maxima {
        candidates: Vec::new(),
        highest: vec![f64::NEG_INFINITY; touches.len()],
    };
    let edge = Edge::of(nose);
    let coarse = edge.evaluate_coarse(surface, touches, points)?;
    for positions in coarse.chunks(touches.len().max(1)) {
        for (point, here) in positions.iter().enumerate() {
            maxima.include(point, here);
        }
    }
    let mut hidden = Vec::new();
    let mut open = edge.open_steps(&coarse, &maxima.highest);
    for part in 1..PARTS {
        points.set(open.iter().map(|step| {
            let touch = &touches[step.point];
            touch.ray.point(touch.rho + edge.angle(step.from + part).0)
        }));
        points.gradient(surface)?;
        for (i, step) in open.iter_mut().enumerate() {
            let here = edge.position_at(step.from + part, &touches[step.point], points, i);
            maxima.add(step.point, step.last.maximum_until(&here, edge.step));
            maxima.include(step.point, &here);
            hidden.extend(step.hidden_maximum_until(&here, step.from + part - 1));
            step.last = here;
        }
    }
    for step in &open {
        maxima.add(step.point, step.last.maximum_until(&step.right, edge.step));
        hidden.extend(step.hidden_maximum_until(&step.right, step.from + PARTS - 1));
    }
    edge.search_hidden(surface, touches, points, hidden, &mut maxima)?;
    let ends = [0, STEPS].map(|at| coarse.iter().skip(at * touches.len()).take(touches.len()));
    for (maximum, positions) in [Position::falling_from, Position::rising_to]
        .into_iter()
        .zip(ends)
    {
        for (point, position) in positions.enumerate() {
            maxima.add(point, maximum(position));
        }
    }
    let Maxima {
        candidates,
        highest,
    } = &mut maxima;
    candidates.retain(|candidate| candidate.at_most >= highest[candidate.point]);
    Ok(maxima)
}

/// The edge in fine steps, counted from its inner end.
struct Edge {
    nose: Nose,
    half: f64,
    /// A fine step, rad.
    step: f64,
}

/// A coarse step that the scan evaluates in fine steps.
struct OpenStep {
    point: usize,
    /// The number of its first fine step.
    from: usize,
    /// The position evaluated last.
    last: Position,
    right: Position,
}

impl Edge {
    fn of(nose: Nose) -> Self {
        let half = Scalar::asin(nose.reach / nose.radius);
        let step = 2.0 * half / (STEPS * PARTS) as f64;
        Self { nose, half, step }
    }

    /// Offset from the centre's X, sine and cosine of φ.
    fn angle(&self, index: usize) -> (f64, f64, f64) {
        let (offset, sin, cos) = self.within(index, 0);
        match index {
            0 => (-self.nose.reach, sin, cos),
            _ if index == STEPS * PARTS => (self.nose.reach, sin, cos),
            _ => (offset, sin, cos),
        }
    }

    /// The same `part` parts of a fine step further on; [`HIDDEN`] parts make a fine step.
    fn within(&self, index: usize, part: usize) -> (f64, f64, f64) {
        let steps = index as f64 + part as f64 / HIDDEN as f64;
        let (sin, cos) = Scalar::sin_cos(steps * self.step - self.half);
        (self.nose.radius * sin, sin, cos)
    }

    /// The position number `index` of a touch's edge, from element `at` of the evaluation.
    fn position_at(
        &self,
        index: usize,
        touch: &Touch,
        points: &Evaluation<f64>,
        at: usize,
    ) -> Position {
        self.position_from(self.angle(index), touch, points, at)
    }

    fn position_from(
        &self,
        (offset, sin, cos): (f64, f64, f64),
        touch: &Touch,
        points: &Evaluation<f64>,
        at: usize,
    ) -> Position {
        let slope = touch.ray.along(points.zx[at], points.zy[at]);
        Position {
            offset,
            height: points.z[at] + self.nose.radius * cos,
            rate: self.nose.radius * (slope * cos - sin),
        }
    }

    /// Evaluates all points at the first coarse position, then all points at the next.
    fn evaluate_coarse(
        &self,
        surface: &dyn SurfaceModel,
        touches: &[Touch],
        points: &mut Evaluation<f64>,
    ) -> Result<Vec<Position>> {
        let mut positions = Vec::with_capacity((STEPS + 1) * touches.len());
        for index in (0..=STEPS).map(|step| step * PARTS) {
            let offset = self.angle(index).0;
            points.set(touches.iter().map(|at| at.ray.point(at.rho + offset)));
            points.gradient(surface)?;
            let position = |(at, touch)| self.position_at(index, touch, points, at);
            positions.extend(touches.iter().enumerate().map(position));
        }
        Ok(positions)
    }

    /// Looks for the maxima in fine steps that hide one.
    fn search_hidden(
        &self,
        surface: &dyn SurfaceModel,
        touches: &[Touch],
        points: &mut Evaluation<f64>,
        mut hidden: Vec<OpenStep>,
        maxima: &mut Maxima,
    ) -> Result<()> {
        let step = self.step / HIDDEN as f64;
        hidden.retain(|one| one.reaches(maxima.highest[one.point], self.step));
        for part in 1..HIDDEN {
            points.set(hidden.iter().map(|one| {
                let touch = &touches[one.point];
                touch.ray.point(touch.rho + self.within(one.from, part).0)
            }));
            points.gradient(surface)?;
            for (i, one) in hidden.iter_mut().enumerate() {
                let angle = self.within(one.from, part);
                let here = self.position_from(angle, &touches[one.point], points, i);
                maxima.add(one.point, one.last.maximum_until(&here, step));
                one.last = here;
            }
        }
        for one in &hidden {
            maxima.add(one.point, one.last.maximum_until(&one.right, step));
        }
        Ok(())
    }

    /// The coarse steps in which h may reach the highest h of their point.
    fn open_steps(&self, coarse: &[Position], highest: &[f64]) -> Vec<OpenStep> {
        let points = highest.len();
        let pairs = coarse.iter().zip(coarse.iter().skip(points)).enumerate();
        pairs
            .filter(|(at, (left, right))| {
                may_reach(left, right, highest[at % points], PARTS as f64 * self.step)
            })
            .map(|(at, (left, right))| OpenStep {
                point: at % points,
                from: at / points * PARTS,
                last: *left,
                right: *right,
            })
            .collect()
    }
}

impl OpenStep {
    /// Whether h may reach `highest` between the step's ends.
    fn reaches(&self, highest: f64, step: f64) -> bool {
        may_reach(&self.last, &self.right, highest, step)
    }

    /// The fine step from the last position to the next, if it hides a maximum beside a minimum: h
    /// falls at both and yet is higher at the next, or rises at both and yet is lower.
    fn hidden_maximum_until(&self, next: &Position, from: usize) -> Option<Self> {
        let last = self.last;
        let falls = last.rate <= 0.0 && next.rate <= 0.0 && next.height > last.height;
        let rises = last.rate > 0.0 && next.rate > 0.0 && next.height < last.height;
        (falls || rises).then_some(Self {
            point: self.point,
            from,
            last,
            right: *next,
        })
    }
}

/// Whether h may reach `highest` between two positions that are `step` rad apart.
fn may_reach(left: &Position, right: &Position, highest: f64, step: f64) -> bool {
    let rise = DOUBT * step * left.rate.abs().max(right.rate.abs());
    let top = left.height.max(right.height) + rise;
    let known = (left.height + right.height + top).is_finite();
    !known || top >= highest
}

/// h and h′ at one position on the edge; NaN if the surface has no height.
#[derive(Debug, Clone, Copy)]
struct Position {
    offset: f64,
    height: f64,
    rate: f64,
}

impl Position {
    /// The maximum between this position and the next, which is `step` rad further. Where h is
    /// concave, the maximum lies below the higher one of the tangents at both positions.
    fn maximum_until(&self, next: &Self, step: f64) -> Option<(Maximum, f64)> {
        let turns = self.rate > 0.0 && next.rate <= 0.0;
        let (lower, upper) = (self.offset, next.offset);
        let top = (self.height + step * self.rate).max(next.height - step * next.rate);
        turns.then_some((Maximum::Between { lower, upper }, top))
    }

    /// The maximum at the edge's inner end, if h falls from there.
    fn falling_from(&self) -> Option<(Maximum, f64)> {
        self.end_maximum(self.rate <= 0.0)
    }

    /// The maximum at the edge's outer end, if h rises towards it.
    fn rising_to(&self) -> Option<(Maximum, f64)> {
        self.end_maximum(self.rate > 0.0)
    }

    fn end_maximum(&self, is_maximum: bool) -> Option<(Maximum, f64)> {
        let known = is_maximum && self.height.is_finite();
        known.then_some((Maximum::EdgeEnd(self.offset), self.height))
    }
}
