//! The scan: all places where the nose may touch first when more than one hill of the section can.
//!
//! Over the edge's angle φ, with the foot at ρ + R sin φ, the centre stands at h(φ) = g + R cos φ,
//! whose rate is h' = R (g_ρ cos φ − sin φ). A hill lies where h' falls through zero between two
//! places, or at an end of the edge towards which h rises. A hill whose top cannot come up to the
//! highest place seen is dropped.

use turnpath_plugin::prelude::*;

use crate::foot::{Nose, Touch};
use crate::polar::Room;

/// Places on the edge: half a degree apart on a full one. A ripple narrower than that is not seen.
const PLACES: usize = 361;

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

/// The highest place seen so far of one point, and the place before.
#[derive(Debug, Clone, Copy)]
struct Seen {
    highest: f64,
    before: Place,
}

/// h and h' at one place of the edge; NaN where the surface has no height.
#[derive(Debug, Clone, Copy)]
struct Place {
    offset: f64,
    height: f64,
    rate: f64,
}

/// What a scan found.
#[derive(Debug, Default)]
pub struct Scan {
    /// The hills that may be a first touch.
    pub candidates: Vec<Candidate>,
    /// The highest place seen of each point, mm.
    pub highest: Vec<f64>,
}

/// Scans the edge at each touch's ray and X.
pub fn scan(
    surface: &dyn SurfaceModel,
    nose: Nose,
    touches: &[Touch],
    room: &mut Room<f64>,
) -> Result<Scan> {
    let mut found = Vec::new();
    let mut seen = vec![Seen::NOTHING; touches.len()];
    let half = Scalar::asin(nose.reach / nose.radius);
    let step = 2.0 * half / (PLACES - 1) as f64;
    for index in 0..PLACES {
        let (sin, cos) = Scalar::sin_cos(index as f64 * step - half);
        let offset = match index {
            0 => -nose.reach,
            _ if index == PLACES - 1 => nose.reach,
            _ => nose.radius * sin,
        };
        room.hold(touches.iter().map(|at| at.ray.place(at.rho + offset)));
        room.gradient(surface)?;
        for (point, (touch, seen)) in touches.iter().zip(&mut seen).enumerate() {
            let slope = touch.ray.along(room.zx[point], room.zy[point]);
            let here = Place {
                offset,
                height: room.z[point] + nose.radius * cos,
                rate: nose.radius * (slope * cos - sin),
            };
            let hills = [seen.before.hill_until(&here, step), here.hill_at_end(index)];
            for (hill, at_most) in hills.into_iter().flatten() {
                found.push(Candidate {
                    point,
                    hill,
                    at_most,
                });
            }
            seen.take(here);
        }
    }
    let highest: Vec<f64> = seen.iter().map(|seen| seen.highest).collect();
    found.retain(|candidate| candidate.at_most >= highest[candidate.point]);
    Ok(Scan {
        candidates: found,
        highest,
    })
}

impl Seen {
    const NOTHING: Self = Self {
        highest: f64::NEG_INFINITY,
        before: Place {
            offset: f64::NAN,
            height: f64::NAN,
            rate: f64::NAN,
        },
    };

    fn take(&mut self, here: Place) {
        if here.height > self.highest {
            self.highest = here.height;
        }
        self.before = here;
    }
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

    /// The hill at an end of the edge, if this is one and h rises towards it.
    fn hill_at_end(&self, index: usize) -> Option<(Hill, f64)> {
        let rises = match index {
            0 => self.rate <= 0.0,
            _ => index == PLACES - 1 && self.rate > 0.0,
        };
        let known = rises && self.height.is_finite();
        known.then_some((Hill::EdgeEnd(self.offset), self.height))
    }
}
