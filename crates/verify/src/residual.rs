//! The residual: cusps between neighbouring passes along radial sections.
//!
//! The tool centres are at the played X with their true Z, so the figure is the spiral's own and
//! does not mix with the interpolation error. Where the nose may leave seams, cusps count from what it
//! can reach at best ([`crate::closing`]). The innermost turn is left out: the pair of passes
//! that would close it lies on both sides of the axis ([`crate::coverage`]).

use std::f64::consts::TAU;

use turnpath_core::toolpath::{PathBlock, Segment};
use turnpath_core::{Gradients, Result, Scalar, SurfaceModel, Tool};

use crate::closing::{self, Raised};
use crate::cusp::{self, Point};
use crate::subject::Subject;
use crate::touch::{FirstTouch, Touch};

/// Radial sections of a revolution: one every degree, so that harmonics of the surface up to the
/// 30th or so are seen at their worst to within a few hundredths.
pub const SECTIONS: i64 = 360;
/// Steps from a cusp to the nearest place of the profile: each leaves (height × curvature) of the
/// distance, which is 1e-4 or less.
const FOOT_STEPS: usize = 5;
/// Steps of Newton's method for the instant at which C passes a section. C is nearly linear.
const CROSSING_STEPS: usize = 8;

/// The residual of a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ResidualFigures {
    /// Highest cusp along the profile's normal, mm; infinite where passes do not meet.
    pub max: f64,
    /// Angle of its section, rad.
    pub at_theta: f64,
    /// Its radius, mm.
    pub at_rho: f64,
    /// How many cusps were looked at.
    pub cusps: u64,
}

impl ResidualFigures {
    /// The highest cusp, mm; `None` where no two passes were neighbours, as on a path of less
    /// than two turns: nothing is known then, least of all that it is smooth.
    pub fn highest(&self) -> Option<f64> {
        (self.cusps > 0).then_some(self.max)
    }

    /// Puts the figures of the path's next stretch behind these.
    pub fn append(&mut self, next: &Self) {
        self.cusps += next.cusps;
        if next.max > self.max {
            (self.max, self.at_theta, self.at_rho) = (next.max, next.at_theta, next.at_rho);
        }
    }
}

/// Where the tool stood when C passed one section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pass {
    x: f64,
    pub(crate) centre: Point,
    /// Radius of the contact, mm.
    pub(crate) foot: f64,
}

/// What two passes leave between them.
pub(crate) struct Cusp {
    /// Its tip.
    place: Point,
    /// Whether they meet at all.
    meet: bool,
    /// X of both, the lower one first.
    ends: [f64; 2],
}

impl Pass {
    /// With the tool at `x`, and its first touch there.
    fn of(subject: &Subject, x: f64, found: &Touch) -> Self {
        Self {
            x,
            centre: match subject.compensates_nose {
                true => Point::new(x, found.z),
                false => tangent_centre(found, subject.tool.nose_radius),
            },
            foot: found.foot,
        }
    }

    /// The same as seen from the opposite half of the section.
    pub(crate) fn mirrored(self) -> Self {
        Self {
            x: -self.x,
            centre: Point::new(-self.centre.x, self.centre.y),
            foot: -self.foot,
        }
    }

    pub(crate) fn cusp(&self, other: &Self, tool: &Tool) -> Cusp {
        let (radius, reach) = (tool.nose_radius, tool.reach());
        let tip = cusp::between_edges(self.centre, other.centre, radius, reach);
        Cusp {
            place: tip.unwrap_or(self.centre),
            meet: tip.is_some(),
            ends: [self.x.min(other.x), self.x.max(other.x)],
        }
    }
}

/// Passes of successive sections: pass i is that of section number `first` + i, counted from
/// C = 0 on, [`SECTIONS`] a revolution.
#[derive(Debug, Clone, Default)]
pub struct Passes {
    pub(crate) first: i64,
    pub(crate) passes: Vec<Pass>,
}

impl Passes {
    /// The passes of a stretch of control points, its last point excluded.
    pub fn of(touch: &FirstTouch, points: &PathBlock) -> Result<Self> {
        let width = TAU / SECTIONS as f64;
        let (mut numbers, mut x) = (Vec::new(), Vec::new());
        for (segment, c) in points.segments().zip(points.c.windows(2)) {
            let (from, to) = (c[0] / width, c[1] / width);
            let mut number = from.ceil();
            while number < to {
                let instant = crossing(&segment, number * width);
                numbers.push(number as i64);
                x.push(segment.x.value(instant));
                number += 1.0;
            }
        }
        let first = numbers.first().copied().unwrap_or_default();
        let theta: Vec<f64> = numbers.iter().map(|number| angle_of(*number)).collect();
        let mut touches = Vec::new();
        touch.find(&theta, &x, &mut touches)?;
        let pass = |(x, found): (&f64, &Touch)| Pass::of(touch.subject(), *x, found);
        Ok(Self {
            first,
            passes: x.iter().zip(&touches).map(pass).collect(),
        })
    }

    /// The residual between these passes and one another.
    pub fn residual(&self, touch: &FirstTouch) -> Result<ResidualFigures> {
        residual_between(
            touch,
            &self.passes,
            &self.passes,
            self.first,
            SECTIONS as usize,
        )
    }

    /// Takes on the passes that follow: gives the residual between the last revolution so far and
    /// the first of `next`, and keeps what the next call needs.
    pub fn follow(&mut self, touch: &FirstTouch, next: &Passes) -> Result<ResidualFigures> {
        let kept = self.passes.len();
        let turn = SECTIONS as usize;
        self.extend(next);
        let start = kept.saturating_sub(turn);
        let seam = &self.passes[start..(kept + turn).min(self.passes.len())];
        let earlier = &self.passes[start..kept];
        let figures = residual_between(touch, earlier, seam, self.first + start as i64, turn)?;
        *self = self.last_few(turn);
        Ok(figures)
    }

    /// Puts the passes of the sections that follow behind these.
    pub(crate) fn extend(&mut self, next: &Passes) {
        if self.passes.is_empty() {
            self.first = next.first;
        }
        self.passes.extend_from_slice(&next.passes);
    }

    /// The last so many of them.
    pub(crate) fn last_few(&self, count: usize) -> Self {
        let dropped = self.passes.len().saturating_sub(count);
        Self {
            first: self.first + dropped as i64,
            passes: self.passes.iter().skip(dropped).copied().collect(),
        }
    }
}

pub(crate) fn angle_of(number: i64) -> f64 {
    TAU * number.rem_euclid(SECTIONS) as f64 / SECTIONS as f64
}

/// When C passes `angle`, as a part of the segment.
pub(crate) fn crossing(segment: &Segment, angle: f64) -> f64 {
    let (from, to) = (segment.c.value(0.0), segment.c.value(1.0));
    let mut s = (angle - from) / (to - from);
    for _ in 0..CROSSING_STEPS {
        let step = (segment.c.value(s) - angle) / segment.c.slope(s);
        if !step.is_finite() {
            break;
        }
        let next = (s - step).clamp(0.0, 1.0);
        if next == s {
            break;
        }
        s = next;
    }
    s
}

/// Where the nose stands that touches the profile at a contact.
fn tangent_centre(touch: &Touch, radius: f64) -> Point {
    let w = (1.0 + touch.slope * touch.slope).sqrt();
    Point::new(touch.foot - radius * touch.slope / w, touch.z + radius / w)
}

/// The residual between each of `earlier` and the pass `turn` places on in `all`.
fn residual_between(
    touch: &FirstTouch,
    earlier: &[Pass],
    all: &[Pass],
    first: i64,
    turn: usize,
) -> Result<ResidualFigures> {
    let subject = touch.subject();
    let (mut theta, mut cusps) = (Vec::new(), Vec::new());
    for ((number, one), other) in (first..).zip(earlier).zip(all.iter().skip(turn)) {
        let same_side = one.x * other.x >= 0.0;
        if !same_side || one.centre == other.centre {
            continue;
        }
        theta.push(angle_of(number));
        cusps.push(one.cusp(other, &subject.tool));
    }
    highest(touch, &theta, &cusps)
}

/// The highest of these cusps that stand on the part, each at its angle.
pub(crate) fn highest(
    touch: &FirstTouch,
    theta: &[f64],
    cusps: &[Cusp],
) -> Result<ResidualFigures> {
    let mut figures = ResidualFigures::default();
    for here in each(touch, theta, cusps)?.into_iter().flatten() {
        figures.append(&here);
    }
    Ok(figures)
}

/// The cusp that passes at each angle leave with the tool at both X of a pair, mm, touching the
/// surface; `None` where it stands off the part.
///
/// # Errors
/// When the surface fails.
pub fn cusp_heights(
    touch: &FirstTouch,
    theta: &[f64],
    pairs: &[[f64; 2]],
) -> Result<Vec<Option<f64>>> {
    let passes = |which: usize| -> Result<Vec<Pass>> {
        let x: Vec<f64> = pairs.iter().map(|pair| pair[which]).collect();
        let mut touches = Vec::new();
        touch.find(theta, &x, &mut touches)?;
        let pass = |(x, found): (&f64, &Touch)| Pass::of(touch.subject(), *x, found);
        Ok(x.iter().zip(&touches).map(pass).collect())
    };
    let cusps: Vec<Cusp> = (passes(0)?.iter().zip(&passes(1)?))
        .map(|(one, other)| one.cusp(other, &touch.subject().tool))
        .collect();
    let found = each(touch, theta, &cusps)?.into_iter();
    Ok(found.map(|cusp| cusp.map(|cusp| cusp.max)).collect())
}

/// Each of these cusps by itself; `None` for those off the part.
fn each(touch: &FirstTouch, theta: &[f64], cusps: &[Cusp]) -> Result<Vec<Option<ResidualFigures>>> {
    let subject = touch.subject();
    let part = subject.part.inner_radius..=subject.part.aperture_radius;
    let places: Vec<Point> = cusps.iter().map(|cusp| cusp.place).collect();
    let (heights, feet) = match touch.leaves_seams() {
        false => heights(subject.surface.as_ref(), theta, &places)?,
        true => {
            let raised = |(theta, cusp): (&f64, &Cusp)| Raised {
                theta: *theta,
                place: cusp.place,
                lower: cusp.ends[0],
                upper: cusp.ends[1],
                counts: cusp.meet && part.contains(&cusp.place.x.abs()),
            };
            let raised: Vec<Raised> = theta.iter().zip(cusps).map(raised).collect();
            let feet = places.iter().map(|place| place.x).collect();
            (closing::heights(touch, &raised)?, feet)
        }
    };
    let found = theta.iter().zip(cusps).zip(heights).zip(feet);
    let on_part = found.map(|(((theta, cusp), height), foot)| {
        let cut = cusp.meet && height.is_finite();
        let (max, at_rho) = match cut {
            true => (height, foot),
            false => (f64::INFINITY, 0.5 * (cusp.ends[0] + cusp.ends[1])),
        };
        part.contains(&at_rho.abs()).then_some(ResidualFigures {
            max,
            at_theta: *theta,
            at_rho,
            cusps: 1,
        })
    });
    Ok(on_part.collect())
}

/// How far each cusp stands from its profile, and the radius of the place nearest to it.
fn heights(
    surface: &dyn SurfaceModel,
    theta: &[f64],
    cusps: &[Point],
) -> Result<(Vec<f64>, Vec<f64>)> {
    let turned: Vec<(f64, f64)> = theta.iter().map(|theta| Scalar::sin_cos(*theta)).collect();
    let mut feet: Vec<f64> = cusps.iter().map(|cusp| cusp.x).collect();
    let mut distances = vec![0.0; cusps.len()];
    let blank = vec![0.0; cusps.len()];
    let (mut z, mut zx, mut zy) = (blank.clone(), blank.clone(), blank);
    for _ in 0..FOOT_STEPS {
        let x: Vec<f64> = feet
            .iter()
            .zip(&turned)
            .map(|(foot, (_, c))| foot * c)
            .collect();
        let y: Vec<f64> = feet
            .iter()
            .zip(&turned)
            .map(|(foot, (s, _))| foot * s)
            .collect();
        surface.gradient(
            &x,
            &y,
            Gradients {
                z: &mut z,
                zx: &mut zx,
                zy: &mut zy,
            },
        )?;
        for i in 0..cusps.len() {
            let (s, c) = turned[i];
            let slope = zx[i] * c + zy[i] * s;
            let off = cusps[i] - Point::new(feet[i], z[i]);
            let w = (1.0 + slope * slope).sqrt();
            distances[i] = (off.y - slope * off.x) / w;
            feet[i] += (off.x + slope * off.y) / (w * w);
        }
    }
    Ok((distances, feet))
}
