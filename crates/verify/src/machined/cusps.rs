//! Cusps as played: the tips that neighbouring arcs of the machined profile leave between them.
//!
//! The residual ([`crate::residual`]) takes the nose at its true Z. Here it stands where it is
//! played. A pass that is played too high may cut nothing, so the tips are those of the envelope of
//! all passes of a line.

use turnpath_core::{Result, Scalar, Tool};

use super::envelope::{Arc, lower_arc};
use crate::closing::{self, SectionCusp};
use crate::cusp::Point;
use crate::profiles::Profiles;
use crate::residual;
use crate::touch::FirstTouch;

/// Where the nose may leave seams, a cusp takes a search of its own. One line of so many is measured
/// there.
const SEAM_STRIDE: usize = 8;

/// The highest cusp of a machined surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighestCusp {
    /// Its height above the wanted surface along the profile's normal, mm; where the nose may leave
    /// seams, above the lowest surface that it can cut.
    pub height: f64,
    /// Angle of its section, rad.
    pub at_theta: f64,
    /// Its radius, mm.
    pub at_rho: f64,
}

/// A tip of the machined profile, and the two centres of the nose that leave it.
#[derive(Debug, Clone, Copy)]
struct Tip {
    at: Point,
    centres: [Point; 2],
}

/// The tips that the arcs of lines leave between passes that meet on the part.
pub(super) struct Tips<'a> {
    pub touch: &'a FirstTouch,
    /// Whether those between the passes of the two sides of the axis count.
    pub counts_centre: bool,
}

impl Tips<'_> {
    /// The highest cusp of a line by its number, with its arcs from left to right; `None` without
    /// one.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn highest(&self, number: usize, angle: f64, arcs: &[Arc]) -> Result<Option<HighestCusp>> {
        let touch = self.touch;
        match touch.leaves_seams() {
            false => highest_over_surface(touch, angle, &self.on_line(angle, arcs)?),
            true if number.is_multiple_of(SEAM_STRIDE) => {
                highest_over_closing(touch, angle, &self.on_line(angle, arcs)?)
            }
            true => Ok(None),
        }
    }

    /// The tips of one line on the part, each with the profile's height and slope there.
    fn on_line(&self, angle: f64, arcs: &[Arc]) -> Result<Vec<(Tip, [f64; 2])>> {
        let subject = self.touch.subject();
        let (tool, part) = (&subject.tool, &subject.part);
        let on_part = part.inner_radius..=part.aperture_radius;
        let pairs = arcs.windows(2).filter(|pair| {
            let meet = pair[0].to == pair[1].from;
            meet && on_part.contains(&pair[0].to.abs())
        });
        let tips: Vec<Tip> = pairs
            .map(|pair| tip([pair[0].centre, pair[1].centre], pair[0].to, tool))
            .collect();
        let mut profile = Profiles::new(subject.surface.as_ref(), &[angle]);
        profile.at(tips.iter().map(|tip| (0, tip.at.x)))?;
        let wanted = profile.height.iter().zip(&profile.slope);
        let wanted = wanted.map(|(height, slope)| [*height, *slope]);
        let all = tips.into_iter().zip(wanted);
        let contact_leads = !subject.compensates_nose;
        let counts = |(tip, [_, slope]): &(Tip, [f64; 2])| {
            let offset = match contact_leads {
                true => tool.nose_radius * slope / Scalar::sqrt(1.0 + slope * slope),
                false => 0.0,
            };
            self.counts_centre || !tip.spans_axis(offset)
        };
        Ok(all.filter(counts).collect())
    }
}

/// The tip at `s` between two passes. Where the edge of one ends before their circles cross, it is
/// on the higher of both.
fn tip(centres: [Point; 2], s: f64, tool: &Tool) -> Tip {
    let [left, right] = centres.map(|centre| lower_arc(centre, tool.nose_radius, s));
    Tip {
        at: Point::new(s, left.max(right)),
        centres,
    }
}

impl Tip {
    /// Whether its two passes belong to the two sides of the axis: X of the path, which lies
    /// `offset` outward of the centre's, changes its sign between them.
    fn spans_axis(&self, offset: f64) -> bool {
        let [left, right] = self.centres.map(|centre| centre.x + offset);
        left < 0.0 && right > 0.0
    }
}

/// The highest of these tips above the wanted surface. The height above the tangent at the tip's own
/// radius picks it; its distance from the profile is the figure.
fn highest_over_surface(
    touch: &FirstTouch,
    angle: f64,
    tips: &[(Tip, [f64; 2])],
) -> Result<Option<HighestCusp>> {
    let height =
        |(tip, [z, slope]): &(Tip, [f64; 2])| (tip.at.y - z) / Scalar::sqrt(1.0 + slope * slope);
    let highest = tips.iter().max_by(|a, b| height(a).total_cmp(&height(b)));
    let Some(highest) = highest else {
        return Ok(None);
    };
    let surface = touch.subject().surface.as_ref();
    let (heights, feet) = residual::heights(surface, &[angle], &[highest.0.at])?;
    let exact = heights.into_iter().zip(feet).next();
    // Beyond the surface's end there is no foot.
    let (height, foot) = exact
        .filter(|(height, _)| height.is_finite())
        .unwrap_or((height(highest), highest.0.at.x));
    Ok(Some(HighestCusp::new(height, angle, foot)))
}

/// The highest of these tips above the closing.
fn highest_over_closing(
    touch: &FirstTouch,
    angle: f64,
    tips: &[(Tip, [f64; 2])],
) -> Result<Option<HighestCusp>> {
    let cusp = |(tip, _): &(Tip, [f64; 2])| SectionCusp {
        theta: angle,
        tip: tip.at,
        lower: tip.centres[0].x,
        upper: tip.centres[1].x,
        counts: true,
    };
    let cusps: Vec<SectionCusp> = tips.iter().map(cusp).collect();
    let heights = closing::heights(touch, &cusps)?;
    let measured = heights.into_iter().zip(&cusps);
    let highest = measured
        .filter(|(height, _)| height.is_finite())
        .max_by(|a, b| a.0.total_cmp(&b.0));
    Ok(highest.map(|(height, cusp)| HighestCusp::new(height, angle, cusp.tip.x)))
}

impl HighestCusp {
    /// The highest of these; the first of several that are equally high.
    pub(super) fn of(each: Vec<Option<Self>>) -> Option<Self> {
        let higher = |one: Self, other: Self| match other.height > one.height {
            true => other,
            false => one,
        };
        each.into_iter().flatten().reduce(higher)
    }

    /// The cusp at a signed radius of a line.
    fn new(height: f64, angle: f64, s: f64) -> Self {
        let turned = match s < 0.0 {
            true => angle + std::f64::consts::PI,
            false => angle,
        };
        Self {
            height,
            at_theta: turned.rem_euclid(std::f64::consts::TAU),
            at_rho: s.abs(),
        }
    }
}
