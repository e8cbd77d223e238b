//! The scan: where the nose may touch when the profile is not known to leave a single maximum.
//!
//! Along the edge, s = X + R sin φ and H(φ) = g(θ, s) + R cos φ, whose slope is dH/dφ = g_ρ R cos φ
//! − R sin φ. Every place where it changes from positive to negative is a hill; those whose top can
//! be the highest are handed on.

use std::ops::RangeInclusive;

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
/// has a height somewhere below the nose. Of each X only those places are looked at that lie
/// `within` two radii of contact, or just beyond.
pub(crate) fn hills(
    profiles: &mut Profiles<'_>,
    tool: &Tool,
    x: &[f64],
    within: impl Fn(usize) -> (f64, f64),
) -> Result<Vec<Bracket>> {
    let radius = tool.nose_radius;
    let edge = Edge::of(tool);
    let ranges = x.iter().enumerate();
    let ranges = ranges.map(|(point, x)| edge.places(*x, within(point)));
    let ranges: Vec<RangeInclusive<usize>> = ranges.collect();
    let mut scans = vec![Scan::BEGIN; x.len()];
    let (mut found, mut looked_at) = (Vec::new(), Vec::new());
    for place in 0..PLACES {
        let (sin, cos) = edge.direction(place);
        looked_at.clear();
        let here = x.iter().zip(&ranges).enumerate();
        let here = here.filter(|(_, (_, range))| range.contains(&place));
        looked_at.extend(here.map(|(point, (x, _))| (point, x + radius * sin)));
        profiles.at(looked_at.iter().copied())?;
        for (i, (point, s)) in looked_at.iter().copied().enumerate() {
            let here = Place {
                s,
                height: profiles.height[i] + radius * cos,
                slope: profiles.slope[i] * radius * cos - radius * sin,
            };
            let at_end = if place == PLACES - 1 {
                here.rising()
            } else {
                None
            };
            let scan = &mut scans[point];
            for hill in scan.go_on(here, edge.step).into_iter().chain(at_end) {
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

/// The places of the edge, by their angle φ from the nose's lowest.
struct Edge {
    radius: f64,
    half: f64,
    step: f64,
}

impl Edge {
    fn of(tool: &Tool) -> Self {
        let radius = tool.nose_radius;
        let half = Scalar::asin(tool.reach() / radius);
        let step = 2.0 * half / (PLACES - 1) as f64;
        Self { radius, half, step }
    }

    /// sin φ and cos φ.
    fn direction(&self, place: usize) -> (f64, f64) {
        Scalar::sin_cos(-self.half + place as f64 * self.step)
    }

    /// Those between two radii with the nose at `x`, and one on each side; all of them on a side
    /// without a number.
    fn places(&self, x: f64, (low, high): (f64, f64)) -> RangeInclusive<usize> {
        let place = |s: f64| {
            let sine = ((s - x) / self.radius).clamp(-1.0, 1.0);
            (Scalar::asin(sine) + self.half) / self.step
        };
        let last = (PLACES - 1) as f64;
        let first = (place(low).floor() - 1.0).max(0.0);
        let end = (place(high).ceil() + 1.0).min(last);
        first.min(last) as usize..=end.max(0.0) as usize
    }
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
