//! The scan: where the nose may touch when the profile is not known to leave a single maximum.
//!
//! Along the edge, s = X + R sin φ and H(φ) = g(θ, s) + R cos φ, whose slope is dH/dφ = g_ρ R cos φ
//! − R sin φ. Every place where it changes from positive to negative is a hill; those whose top can
//! be the highest are handed on.

use turnpath_core::{Result, Scalar, Tool};

use crate::profiles::Profiles;
use crate::touch::Bracket;

/// Places of the scan: half a degree apart on a full edge. Ripples narrower than two of its steps
/// can be missed.
const PLACES: usize = 361;

/// H and its slope at one place of one scan.
#[derive(Debug, Clone, Copy)]
struct Place {
    s: f64,
    height: f64,
    slope: f64,
}

/// The scan at one (θ, X).
#[derive(Debug, Clone, Copy)]
struct Scan {
    /// Height of the highest place, and what some hill can reach.
    highest: f64,
    reachable: f64,
    /// The place before, where it had a height; and its s.
    before: Option<Place>,
    before_s: f64,
}

impl Scan {
    const BEGIN: Self = Self {
        highest: f64::NEG_INFINITY,
        reachable: f64::NEG_INFINITY,
        before: None,
        before_s: f64::NAN,
    };
}

/// A hill, and how high its top can be.
struct Hill {
    bracket: Bracket,
    at_most: f64,
}

/// Brackets around all hills that may be the highest for each X; at least one where the surface
/// has a height somewhere below the nose.
pub(crate) fn hills(profiles: &mut Profiles<'_>, tool: &Tool, x: &[f64]) -> Result<Vec<Bracket>> {
    let radius = tool.nose_radius;
    let half = Scalar::asin(tool.reach() / radius);
    let step = 2.0 * half / (PLACES - 1) as f64;
    let mut scans = vec![Scan::BEGIN; x.len()];
    let (mut found, mut feet) = (Vec::new(), vec![0.0; x.len()]);
    for place in 0..PLACES {
        let (sin, cos) = Scalar::sin_cos(-half + place as f64 * step);
        for (foot, x) in feet.iter_mut().zip(x) {
            *foot = x + radius * sin;
        }
        profiles.at_all(&feet)?;
        for (point, scan) in scans.iter_mut().enumerate() {
            let here = Place {
                s: feet[point],
                height: profiles.height[point] + radius * cos,
                slope: profiles.slope[point] * radius * cos - radius * sin,
            };
            let at_end = if place == PLACES - 1 {
                here.rising()
            } else {
                None
            };
            for hill in scan.go_on(here, step).into_iter().chain(at_end) {
                scan.reachable = scan.reachable.max(hill.at_most);
                found.push(hill.of(point));
            }
        }
    }
    found.retain(|hill| {
        let scan = &scans[hill.bracket.point];
        hill.at_most >= scan.highest.min(scan.reachable)
    });
    Ok(found.into_iter().map(|hill| hill.bracket).collect())
}

impl Scan {
    /// Takes the next place; gives the hill between it and the one before, if there is one.
    fn go_on(&mut self, here: Place, step: f64) -> Option<Hill> {
        let known = here.height.is_finite() && here.slope.is_finite();
        let before = std::mem::replace(&mut self.before, known.then_some(here));
        let before_s = std::mem::replace(&mut self.before_s, here.s);
        if known {
            self.highest = self.highest.max(here.height);
        }
        match before {
            Some(before) if known => Hill::between(before, here, step),
            Some(before) if before.slope > 0.0 => Some(Hill::at_border(before, here.s)),
            None if known && here.slope <= 0.0 => Some(Hill::at_border(here, before_s)),
            _ => None,
        }
    }
}

impl Place {
    /// The hill at the end of the edge, if H still rises there.
    fn rising(self) -> Option<Hill> {
        (self.slope > 0.0 && self.height.is_finite()).then(|| Hill::at_border(self, self.s))
    }
}

impl Hill {
    /// Where H is concave, the top lies below the tangents on both sides.
    fn between(left: Place, right: Place, step: f64) -> Option<Self> {
        if left.slope <= 0.0 || right.slope > 0.0 {
            return None;
        }
        let from_left = left.height + step * left.slope;
        let from_right = right.height - step * right.slope;
        let start = if left.height > right.height {
            left.s
        } else {
            right.s
        };
        Some(Self {
            bracket: Bracket {
                point: 0,
                low: left.s,
                high: right.s,
                start,
            },
            at_most: from_left.min(from_right).max(left.height).max(right.height),
        })
    }

    /// H rises towards `border`, where the surface ends; no number: where the edge does.
    fn at_border(last: Place, border: f64) -> Self {
        Self {
            bracket: Bracket {
                point: 0,
                low: last.s.min(border),
                high: last.s.max(border),
                start: last.s,
            },
            at_most: f64::INFINITY,
        }
    }

    fn of(mut self, point: usize) -> Self {
        self.bracket.point = point;
        self
    }
}
