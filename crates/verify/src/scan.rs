//! The scan: a search for the maxima of the nose's height along the edge, where there may be more
//! than one.
//!
//! Along the edge, s = X + R sin φ and H(φ) = g(θ, s) + R cos φ, whose slope is dH/dφ = g_ρ R cos φ
//! − R sin φ. H has a maximum wherever its slope changes from positive to negative. The scan
//! returns a bracket around each maximum that can be the highest.

use std::ops::RangeInclusive;

use turnpath_core::{Result, Scalar, Tool};

use crate::bracket::Bracket;
use crate::profiles::Profiles;

/// Stations of the scan, half a degree apart on a full edge. The scan can miss ripples narrower
/// than two of its steps.
const STATIONS: usize = 361;

/// H and its slope at one station of one scan.
#[derive(Debug, Clone, Copy)]
struct Station {
    s: f64,
    height: f64,
    slope: f64,
}

/// The scan at one (θ, X).
#[derive(Debug, Clone, Copy)]
struct Scan {
    /// Height of the highest station.
    highest: f64,
    /// The largest bound of all maxima so far.
    reachable: f64,
    /// The previous station, if the surface has a height there.
    before: Option<Station>,
    /// s of the previous station.
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

/// A maximum of H, and an upper bound of its height.
struct Maximum {
    bracket: Bracket,
    at_most: f64,
}

/// Brackets around all maxima that may be the highest for each X. There is at least one for an X
/// where the surface has a height somewhere below the nose. For each X the scan covers only the
/// stations whose contacts lie `within` two radii, and one more on each side.
pub(crate) fn maxima(
    profiles: &mut Profiles<'_>,
    tool: &Tool,
    x: &[f64],
    within: impl Fn(usize) -> (f64, f64),
) -> Result<Vec<Bracket>> {
    let radius = tool.nose_radius;
    let edge = ToolEdge::of(tool);
    let ranges = x.iter().enumerate();
    let ranges = ranges.map(|(point, x)| edge.stations(*x, within(point)));
    let ranges: Vec<RangeInclusive<usize>> = ranges.collect();
    let mut scans = vec![Scan::BEGIN; x.len()];
    let (mut found, mut contacts): (Vec<Maximum>, Vec<(usize, f64)>) = (Vec::new(), Vec::new());
    for station in 0..STATIONS {
        let (sin, cos) = edge.direction(station);
        contacts.clear();
        let here = x.iter().zip(&ranges).enumerate();
        let here = here.filter(|(_, (_, range))| range.contains(&station));
        contacts.extend(here.map(|(point, (x, _))| (point, x + radius * sin)));
        profiles.at(contacts.iter().copied())?;
        for (i, (point, s)) in contacts.iter().copied().enumerate() {
            let here = Station {
                s,
                height: profiles.height[i] + radius * cos,
                slope: profiles.slope[i] * radius * cos - radius * sin,
            };
            let at_end = if station == STATIONS - 1 {
                here.maximum_at_end()
            } else {
                None
            };
            let scan = &mut scans[point];
            for maximum in scan.advance(here, edge.step).into_iter().chain(at_end) {
                scan.reachable = scan.reachable.max(maximum.at_most);
                found.push(maximum.of_point(point));
            }
        }
    }
    found.retain(|maximum| {
        let scan = &scans[maximum.bracket.point];
        maximum.at_most >= scan.highest.min(scan.reachable)
    });
    Ok(found.into_iter().map(|maximum| maximum.bracket).collect())
}

/// The stations of the tool's edge, by their angle φ from the nose's lowest point.
struct ToolEdge {
    radius: f64,
    half: f64,
    step: f64,
}

impl ToolEdge {
    fn of(tool: &Tool) -> Self {
        let radius = tool.nose_radius;
        let half = Scalar::asin(tool.reach() / radius);
        let step = 2.0 * half / (STATIONS - 1) as f64;
        Self { radius, half, step }
    }

    /// sin φ and cos φ.
    fn direction(&self, station: usize) -> (f64, f64) {
        Scalar::sin_cos(-self.half + station as f64 * self.step)
    }

    /// The stations between two radii with the nose at `x`, and one more on each side; all stations
    /// on a side whose radius is NaN.
    fn stations(&self, x: f64, (low, high): (f64, f64)) -> RangeInclusive<usize> {
        let station = |s: f64| {
            let sine = ((s - x) / self.radius).clamp(-1.0, 1.0);
            (Scalar::asin(sine) + self.half) / self.step
        };
        let last = (STATIONS - 1) as f64;
        let first = (station(low).floor() - 1.0).max(0.0);
        let end = (station(high).ceil() + 1.0).min(last);
        first.min(last) as usize..=end.max(0.0) as usize
    }
}

impl Scan {
    /// Moves on to the next station, and returns the maximum between it and the previous one if
    /// there is one.
    fn advance(&mut self, here: Station, step: f64) -> Option<Maximum> {
        let known = here.height.is_finite() && here.slope.is_finite();
        let before = std::mem::replace(&mut self.before, known.then_some(here));
        let before_s = std::mem::replace(&mut self.before_s, here.s);
        if known {
            self.highest = self.highest.max(here.height);
        }
        match before {
            Some(before) if known => Maximum::between(before, here, step),
            Some(before) if before.slope > 0.0 => Some(Maximum::at_border(before, here.s)),
            None if known && here.slope <= 0.0 => Some(Maximum::at_border(here, before_s)),
            _ => None,
        }
    }
}

impl Station {
    /// The maximum at the end of the edge, if H still rises there.
    fn maximum_at_end(self) -> Option<Maximum> {
        (self.slope > 0.0 && self.height.is_finite()).then(|| Maximum::at_border(self, self.s))
    }
}

impl Maximum {
    /// The maximum between two stations, if there is one. Where H is concave, its top lies below
    /// the tangents at both stations.
    fn between(left: Station, right: Station, step: f64) -> Option<Self> {
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

    /// The maximum between a station and the `border` towards which H rises. There the surface
    /// ends; a NaN means that the edge ends at the station.
    fn at_border(last: Station, border: f64) -> Self {
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

    fn of_point(mut self, point: usize) -> Self {
        self.bracket.point = point;
        self
    }
}
