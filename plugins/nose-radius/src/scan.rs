//! The scan: all places where the nose may touch first when more than one hill of the section can.
//!
//! Over the edge's angle φ, with the foot at ρ + R sin φ, the centre stands at h(φ) = g + R cos φ,
//! whose rate is h′ = R (g_ρ cos φ − sin φ). The edge is looked at in coarse steps; of these the
//! ones that may come up to the highest place are looked at in fine ones. A hill lies where h′
//! falls through zero between two places, or at an end of the edge towards which h rises.

use turnpath_plugin::prelude::*;

use crate::foot::{Nose, Touch};
use crate::polar::Room;

/// Coarse steps along the edge: 4° on a full one.
const STEPS: usize = 45;
/// Fine steps in a coarse one: half a degree. A ripple narrower than two of them is not seen.
const PARTS: usize = 8;
/// Parts of a fine step in which a hill hides beside a valley.
const HIDDEN: usize = 32;
/// A coarse step may rise by so many times what its steeper end says.
const DOUBT: f64 = 2.0;

/// A stretch of the edge that holds one hill.
#[derive(Debug, Clone, Copy)]
pub enum Hill {
    /// h rises at the lower offset and falls at the upper one.
    Between {
        /// Lower offset from the centre's X, mm.
        lower: f64,
        /// Upper offset, mm.
        upper: f64,
    },
    /// h rises towards an end of the edge: the end touches, at this offset.
    EdgeEnd(f64),
}

/// A hill of one point, and how high its top can be.
#[derive(Debug, Clone, Copy)]
pub struct Candidate {
    /// Which point it belongs to.
    pub point: usize,
    /// Where it is.
    pub hill: Hill,
    at_most: f64,
}

/// What a scan found.
#[derive(Debug, Default)]
pub struct Found {
    /// The hills that may be a first touch.
    pub candidates: Vec<Candidate>,
    /// The highest place seen of each point, mm.
    pub highest: Vec<f64>,
}

impl Found {
    fn see(&mut self, point: usize, here: &Place) {
        if here.height > self.highest[point] {
            self.highest[point] = here.height;
        }
    }

    fn add(&mut self, point: usize, hill: Option<(Hill, f64)>) {
        self.candidates
            .extend(hill.map(|(hill, at_most)| Candidate {
                point,
                hill,
                at_most,
            }));
    }
}

/// Scans the edge at each touch's ray and X.
pub fn scan(
    surface: &dyn SurfaceModel,
    nose: Nose,
    touches: &[Touch],
    room: &mut Room<f64>,
) -> Result<Found> {
    let mut found = Found {
        candidates: Vec::new(),
        highest: vec![f64::NEG_INFINITY; touches.len()],
    };
    let edge = Edge::of(nose);
    let coarse = edge.look_everywhere(surface, touches, room)?;
    for places in coarse.chunks(touches.len().max(1)) {
        for (point, here) in places.iter().enumerate() {
            found.see(point, here);
        }
    }
    let mut hidden = Vec::new();
    let mut open = edge.open_steps(&coarse, &found.highest);
    for part in 1..PARTS {
        room.hold(open.iter().map(|step| {
            let touch = &touches[step.point];
            touch.ray.place(touch.rho + edge.place(step.from + part).0)
        }));
        room.gradient(surface)?;
        for (i, step) in open.iter_mut().enumerate() {
            let here = edge.seen(step.from + part, &touches[step.point], room, i);
            found.add(step.point, step.last.hill_until(&here, edge.step));
            found.see(step.point, &here);
            hidden.extend(step.hidden_until(&here, step.from + part - 1));
            step.last = here;
        }
    }
    for step in &open {
        found.add(step.point, step.last.hill_until(&step.right, edge.step));
        hidden.extend(step.hidden_until(&step.right, step.from + PARTS - 1));
    }
    edge.look_closely(surface, touches, room, hidden, &mut found)?;
    let ends = [0, STEPS].map(|at| coarse.iter().skip(at * touches.len()).take(touches.len()));
    for (hill, places) in [Place::falling_from, Place::rising_to]
        .into_iter()
        .zip(ends)
    {
        for (point, place) in places.enumerate() {
            found.add(point, hill(place));
        }
    }
    let Found {
        candidates,
        highest,
    } = &mut found;
    candidates.retain(|candidate| candidate.at_most >= highest[candidate.point]);
    Ok(found)
}

/// The edge in fine steps, counted from its inner end.
struct Edge {
    nose: Nose,
    half: f64,
    /// A fine step, rad.
    step: f64,
}

/// A coarse step that is looked at in fine ones.
struct OpenStep {
    point: usize,
    /// The fine step that it begins with.
    from: usize,
    /// The place last looked at.
    last: Place,
    right: Place,
}

impl Edge {
    fn of(nose: Nose) -> Self {
        let half = Scalar::asin(nose.reach / nose.radius);
        let step = 2.0 * half / (STEPS * PARTS) as f64;
        Self { nose, half, step }
    }

    /// Offset from the centre's X, sine and cosine of φ.
    fn place(&self, index: usize) -> (f64, f64, f64) {
        let (offset, sin, cos) = self.within(index, 0);
        match index {
            0 => (-self.nose.reach, sin, cos),
            _ if index == STEPS * PARTS => (self.nose.reach, sin, cos),
            _ => (offset, sin, cos),
        }
    }

    /// The same so many parts of [`HIDDEN`] further on.
    fn within(&self, index: usize, part: usize) -> (f64, f64, f64) {
        let steps = index as f64 + part as f64 / HIDDEN as f64;
        let (sin, cos) = Scalar::sin_cos(steps * self.step - self.half);
        (self.nose.radius * sin, sin, cos)
    }

    /// What the room has of a place.
    fn seen(&self, index: usize, touch: &Touch, room: &Room<f64>, at: usize) -> Place {
        self.of_room(self.place(index), touch, room, at)
    }

    fn of_room(
        &self,
        (offset, sin, cos): (f64, f64, f64),
        touch: &Touch,
        room: &Room<f64>,
        at: usize,
    ) -> Place {
        let slope = touch.ray.along(room.zx[at], room.zy[at]);
        Place {
            offset,
            height: room.z[at] + self.nose.radius * cos,
            rate: self.nose.radius * (slope * cos - sin),
        }
    }

    /// All points at the first coarse place, then all at the next.
    fn look_everywhere(
        &self,
        surface: &dyn SurfaceModel,
        touches: &[Touch],
        room: &mut Room<f64>,
    ) -> Result<Vec<Place>> {
        let mut places = Vec::with_capacity((STEPS + 1) * touches.len());
        for index in (0..=STEPS).map(|step| step * PARTS) {
            let offset = self.place(index).0;
            room.hold(touches.iter().map(|at| at.ray.place(at.rho + offset)));
            room.gradient(surface)?;
            let seen = |(at, touch)| self.seen(index, touch, room, at);
            places.extend(touches.iter().enumerate().map(seen));
        }
        Ok(places)
    }

    /// Looks for the hills in fine steps that hide one.
    fn look_closely(
        &self,
        surface: &dyn SurfaceModel,
        touches: &[Touch],
        room: &mut Room<f64>,
        mut hidden: Vec<OpenStep>,
        found: &mut Found,
    ) -> Result<()> {
        let step = self.step / HIDDEN as f64;
        hidden.retain(|one| one.reaches(found.highest[one.point], self.step));
        for part in 1..HIDDEN {
            room.hold(hidden.iter().map(|one| {
                let touch = &touches[one.point];
                touch.ray.place(touch.rho + self.within(one.from, part).0)
            }));
            room.gradient(surface)?;
            for (i, one) in hidden.iter_mut().enumerate() {
                let place = self.within(one.from, part);
                let here = self.of_room(place, &touches[one.point], room, i);
                found.add(one.point, one.last.hill_until(&here, step));
                one.last = here;
            }
        }
        for one in &hidden {
            found.add(one.point, one.last.hill_until(&one.right, step));
        }
        Ok(())
    }

    /// The coarse steps that may come up to the highest place of their point.
    fn open_steps(&self, coarse: &[Place], highest: &[f64]) -> Vec<OpenStep> {
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
    /// Whether its ends let it come up to the highest place.
    fn reaches(&self, highest: f64, step: f64) -> bool {
        may_reach(&self.last, &self.right, highest, step)
    }

    /// The fine step from the last place to the next, if it hides a hill beside a valley: h falls
    /// at both and yet has risen, or rises at both and yet has fallen.
    fn hidden_until(&self, next: &Place, from: usize) -> Option<Self> {
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

/// Whether h may come up to `highest` between two places `step` rad apart.
fn may_reach(left: &Place, right: &Place, highest: f64, step: f64) -> bool {
    let rise = DOUBT * step * left.rate.abs().max(right.rate.abs());
    let top = left.height.max(right.height) + rise;
    let known = (left.height + right.height + top).is_finite();
    !known || top >= highest
}

/// h and h′ at one place of the edge; NaN where the surface has no height.
#[derive(Debug, Clone, Copy)]
struct Place {
    offset: f64,
    height: f64,
    rate: f64,
}

impl Place {
    /// The hill between this place and the next, `step` rad on. Its top lies below the higher one
    /// of the tangents at both places where h is concave.
    fn hill_until(&self, next: &Self, step: f64) -> Option<(Hill, f64)> {
        let turns = self.rate > 0.0 && next.rate <= 0.0;
        let (lower, upper) = (self.offset, next.offset);
        let top = (self.height + step * self.rate).max(next.height - step * next.rate);
        turns.then_some((Hill::Between { lower, upper }, top))
    }

    /// The hill at the edge's inner end, if h falls from there.
    fn falling_from(&self) -> Option<(Hill, f64)> {
        self.end_if(self.rate <= 0.0)
    }

    /// The hill at the edge's outer end, if h rises up to it.
    fn rising_to(&self) -> Option<(Hill, f64)> {
        self.end_if(self.rate > 0.0)
    }

    fn end_if(&self, is_hill: bool) -> Option<(Hill, f64)> {
        let known = is_hill && self.height.is_finite();
        known.then_some((Hill::EdgeEnd(self.offset), self.height))
    }
}
