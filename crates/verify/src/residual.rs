//! The residual: cusps between neighbouring passes along radial sections.
//!
//! The tool centres are at the played X with their true Z, so the figure belongs to the spiral
//! alone and does not mix with the interpolation error. Where the nose may leave seams, cusps are
//! measured from the closing, the lowest surface that the nose can cut ([`crate::closing`]). The
//! innermost turn is left out: the two passes that close it lie on either side of the axis (module
//! `coverage`).

use std::f64::consts::TAU;

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Gradients, Result, SurfaceModel, Tool, sines_and_cosines};

use crate::closing::{self, SectionCusp};
use crate::crossings::Sections;
use crate::cusp::{self, Point};
use crate::subject::Subject;
use crate::touch::{FirstTouch, Touch, TouchBuffers};

/// Radial sections of a revolution. One every degree shows harmonics of the surface up to about the
/// 30th at their worst to within a few hundredths.
pub const SECTIONS: i64 = 360;
/// Steps from a cusp to the nearest point of the profile. Each step leaves (height × curvature) of
/// the distance, which is 1e-4 or less.
const FOOT_STEPS: usize = 5;
/// Passes or cusps that are measured together: their columns take some tens of kilobytes, and stay in
/// the cache.
const BATCH: usize = 512;

/// The residual of a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ResidualFigures {
    /// Height of the highest cusp along the profile's normal, mm; infinite where passes do not
    /// meet.
    pub max: f64,
    /// Angle of its section, rad.
    pub at_theta: f64,
    /// Its radius, mm.
    pub at_rho: f64,
    /// Number of cusps measured.
    pub cusps: u64,
}

impl ResidualFigures {
    /// Height of the highest cusp, mm. `None` if no two passes were neighbours, as on a path of
    /// less than two turns: nothing is known about such a surface, and it need not be smooth.
    pub fn highest(&self) -> Option<f64> {
        (self.cusps > 0).then_some(self.max)
    }

    /// Appends the figures of the path's next block.
    pub fn append(&mut self, next: &Self) {
        self.cusps += next.cusps;
        if next.max > self.max {
            (self.max, self.at_theta, self.at_rho) = (next.max, next.at_theta, next.at_rho);
        }
    }
}

/// The position of the tool when C passed one section.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Pass {
    x: f64,
    pub(crate) centre: Point,
    /// Radius of the contact, mm.
    pub(crate) foot: f64,
}

/// The cusp between two passes.
pub(crate) struct Cusp {
    /// Its tip.
    tip: Point,
    /// Whether the passes meet.
    meet: bool,
    /// X of both passes, the smaller one first, mm.
    ends: [f64; 2],
}

impl Pass {
    /// The pass with the tool at `x`, from its first touch there.
    fn of(subject: &Subject, x: f64, touch: &Touch) -> Self {
        Self {
            x,
            centre: match subject.compensates_nose {
                true => Point::new(x, touch.z),
                false => tangent_centre(touch, subject.tool.nose_radius),
            },
            foot: touch.foot,
        }
    }

    /// The same pass in the coordinates of the opposite half of the section.
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
            tip: tip.unwrap_or(self.centre),
            meet: tip.is_some(),
            ends: [self.x.min(other.x), self.x.max(other.x)],
        }
    }
}

/// Passes of successive sections. Pass i belongs to section number `first` + i, counted from C = 0
/// on, with [`SECTIONS`] sections per revolution.
#[derive(Debug, Clone, Default)]
pub struct Passes {
    pub(crate) first: i64,
    pub(crate) passes: Vec<Pass>,
}

impl Passes {
    /// The passes of a block, its last point excluded.
    pub fn of(touch: &FirstTouch, points: &PathBlock) -> Result<Self> {
        let sections = Sections {
            offset: 0.0,
            width: TAU / SECTIONS as f64,
        };
        let mut passes = Vec::with_capacity(sections.about(&points.c));
        let (mut first, mut theta, mut x) = (None, Vec::new(), Vec::new());
        let mut buffers = TouchBuffers::default();
        for (segment, c) in points.segments().zip(points.c.windows(2)) {
            sections.crossings(&segment, [c[0], c[1]], |number, instant| {
                first.get_or_insert(number);
                theta.push(angle_of(number));
                x.push(segment.x.value(instant));
            });
            if x.len() >= BATCH {
                passes_in(touch, &theta, &x, &mut buffers, &mut passes)?;
                theta.clear();
                x.clear();
            }
        }
        passes_in(touch, &theta, &x, &mut buffers, &mut passes)?;
        let first = first.unwrap_or_default();
        Ok(Self { first, passes })
    }

    /// Calls `take` with each cusp among these passes.
    pub fn for_each_cusp(
        &self,
        touch: &FirstTouch,
        take: impl FnMut(ResidualFigures),
    ) -> Result<()> {
        let (passes, turn) = (&self.passes, SECTIONS as usize);
        for_each_between(touch, passes, passes, self.first, turn, take)
    }

    /// Appends the passes of the following sections. Calls `take` with each cusp between the last
    /// revolution so far and the first revolution of `next`, and keeps the last revolution alone.
    pub fn follow(
        &mut self,
        touch: &FirstTouch,
        next: &Passes,
        take: impl FnMut(ResidualFigures),
    ) -> Result<()> {
        let turn = SECTIONS as usize;
        let (begin, rest) = next.passes.split_at(turn.min(next.passes.len()));
        let earlier = self.passes.len();
        if earlier == 0 {
            self.first = next.first;
        }
        self.passes.extend_from_slice(begin);
        let (all, first) = (&self.passes, self.first);
        for_each_between(touch, &all[..earlier], all, first, turn, take)?;
        if rest.len() >= turn {
            self.first += (self.passes.len() + rest.len() - turn) as i64;
            self.passes.clear();
            self.passes.extend_from_slice(&rest[rest.len() - turn..]);
        } else {
            self.passes.extend_from_slice(rest);
            let dropped = self.passes.len().saturating_sub(turn);
            self.first += dropped as i64;
            self.passes.drain(..dropped);
        }
        Ok(())
    }
}

/// The passes with the tool at each angle, rad, and X, mm, from their first touches.
pub(crate) fn passes_at(touch: &FirstTouch, theta: &[f64], x: &[f64]) -> Result<Vec<Pass>> {
    let mut passes = Vec::with_capacity(x.len());
    let mut buffers = TouchBuffers::default();
    for (theta, x) in theta.chunks(BATCH).zip(x.chunks(BATCH)) {
        passes_in(touch, theta, x, &mut buffers, &mut passes)?;
    }
    Ok(passes)
}

/// Appends the passes of one batch.
fn passes_in(
    touch: &FirstTouch,
    theta: &[f64],
    x: &[f64],
    buffers: &mut TouchBuffers,
    passes: &mut Vec<Pass>,
) -> Result<()> {
    touch.find_in(theta, x, buffers)?;
    let found = x.iter().zip(buffers.touches.iter());
    passes.extend(found.map(|(x, found)| Pass::of(touch.subject(), *x, &found)));
    Ok(())
}

/// The angle of a section, rad.
pub(crate) fn angle_of(number: i64) -> f64 {
    TAU * number.rem_euclid(SECTIONS) as f64 / SECTIONS as f64
}

/// The centre of the nose that touches the profile at a contact.
fn tangent_centre(touch: &Touch, radius: f64) -> Point {
    let w = (1.0 + touch.slope * touch.slope).sqrt();
    Point::new(touch.foot - radius * touch.slope / w, touch.z + radius / w)
}

/// Calls `take` with the cusps that stand on the part: each lies between a pass of `earlier` and the pass
/// `turn` entries further on in `all`.
fn for_each_between(
    touch: &FirstTouch,
    earlier: &[Pass],
    all: &[Pass],
    first: i64,
    turn: usize,
    mut take: impl FnMut(ResidualFigures),
) -> Result<()> {
    let tool = &touch.subject().tool;
    // Where a nose may leave seams, the highest of all cusps decides which are measured.
    let batch = match touch.leaves_seams() {
        true => usize::MAX,
        false => BATCH,
    };
    let mut take_if_on_part = |cusp: Option<_>| cusp.into_iter().for_each(&mut take);
    let (mut theta, mut cusps) = (Vec::new(), Vec::new());
    for ((number, one), other) in (first..).zip(earlier).zip(all.iter().skip(turn)) {
        let same_side = one.x * other.x >= 0.0;
        if !same_side || one.centre == other.centre {
            continue;
        }
        theta.push(angle_of(number));
        cusps.push(one.cusp(other, tool));
        if cusps.len() == batch {
            measure_each(touch, &theta, &cusps, &mut take_if_on_part)?;
            theta.clear();
            cusps.clear();
        }
    }
    measure_each(touch, &theta, &cusps, take_if_on_part)
}

/// The residual of those of these cusps that stand on the part, each at its own angle. A cusp stands
/// there if its tip or the foot of its normal does.
pub(crate) fn highest(
    touch: &FirstTouch,
    theta: &[f64],
    cusps: &[Cusp],
) -> Result<ResidualFigures> {
    let mut figures = ResidualFigures::default();
    let append = |cusp: Option<_>| cusp.iter().for_each(|cusp| figures.append(cusp));
    measure_each(touch, theta, cusps, append)?;
    Ok(figures)
}

/// The height, mm, of the cusp that two passes leave at each angle, with the tool touching the
/// surface at both X of a pair, mm; `None` for a cusp that stands off the part.
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
        passes_at(touch, theta, &x)
    };
    let cusps: Vec<Cusp> = (passes(0)?.iter().zip(&passes(1)?))
        .map(|(one, other)| one.cusp(other, &touch.subject().tool))
        .collect();
    let mut heights = Vec::with_capacity(cusps.len());
    let push = |cusp: Option<ResidualFigures>| heights.push(cusp.map(|cusp| cusp.max));
    measure_each(touch, theta, &cusps, push)?;
    Ok(heights)
}

/// Calls `take` with the residual of each of these cusps alone; `None` for a cusp off the part.
fn measure_each(
    touch: &FirstTouch,
    theta: &[f64],
    cusps: &[Cusp],
    take: impl FnMut(Option<ResidualFigures>),
) -> Result<()> {
    let subject = touch.subject();
    let part = subject.part.inner_radius..=subject.part.aperture_radius;
    let tips: Vec<Point> = cusps.iter().map(|cusp| cusp.tip).collect();
    let (heights, feet) = match touch.leaves_seams() {
        false => heights(subject.surface.as_ref(), theta, &tips)?,
        true => {
            let of_section = |(theta, cusp): (&f64, &Cusp)| SectionCusp {
                theta: *theta,
                tip: cusp.tip,
                lower: cusp.ends[0],
                upper: cusp.ends[1],
                counts: cusp.meet && part.contains(&cusp.tip.x.abs()),
            };
            let of_sections: Vec<SectionCusp> = theta.iter().zip(cusps).map(of_section).collect();
            let feet = tips.iter().map(|tip| tip.x).collect();
            (closing::heights(touch, &of_sections)?, feet)
        }
    };
    let found = theta.iter().zip(cusps).zip(heights).zip(feet);
    let on_part = found.map(|(((theta, cusp), height), foot)| {
        let cut = cusp.meet && height.is_finite();
        let (max, at_rho) = match cut {
            true => (height, foot),
            false => (f64::INFINITY, 0.5 * (cusp.ends[0] + cusp.ends[1])),
        };
        // On a steep wall the foot of a tip within the part's radii may lie beyond them.
        let tip_on_part = cut && part.contains(&cusp.tip.x.abs());
        let counts = tip_on_part || part.contains(&at_rho.abs());
        counts.then_some(ResidualFigures {
            max,
            at_theta: *theta,
            at_rho,
            cusps: 1,
        })
    });
    on_part.for_each(take);
    Ok(())
}

/// The distance of each cusp from its profile, mm, and the radius of the nearest point of the
/// profile, mm.
pub(crate) fn heights(
    surface: &dyn SurfaceModel,
    theta: &[f64],
    cusps: &[Point],
) -> Result<(Vec<f64>, Vec<f64>)> {
    let blank = vec![0.0; cusps.len()];
    let (mut sine, mut cosine) = (blank.clone(), blank.clone());
    sines_and_cosines(theta, &mut sine, &mut cosine);
    let mut feet: Vec<f64> = cusps.iter().map(|cusp| cusp.x).collect();
    let mut distances = blank.clone();
    let [mut x, mut y] = [blank.clone(), blank.clone()];
    let (mut z, mut zx, mut zy) = (blank.clone(), blank.clone(), blank);
    for _ in 0..FOOT_STEPS {
        in_widest(PlacesOnPart {
            radii: &feet,
            sine: &sine,
            cosine: &cosine,
            x: &mut x,
            y: &mut y,
        });
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.gradient(&x, &y, out)?;
        let moved = in_widest(FootStep {
            cusps,
            turned: [&sine, &cosine],
            wanted: [&z, &zx, &zy],
            feet: &mut feet,
            distances: &mut distances,
        });
        // Further steps would find the same again.
        if !moved {
            break;
        }
    }
    Ok((distances, feet))
}

/// The loop that places radii on the part.
struct PlacesOnPart<'a> {
    radii: &'a [f64],
    sine: &'a [f64],
    cosine: &'a [f64],
    x: &'a mut [f64],
    y: &'a mut [f64],
}

impl Loop for PlacesOnPart<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let turned = self.radii.iter().zip(self.sine.iter().zip(self.cosine));
        for ((x, y), (radius, (s, c))) in self.x.iter_mut().zip(self.y).zip(turned) {
            (*x, *y) = (radius * c, radius * s);
        }
    }
}

/// The loop that steps from each foot to the next one, and says whether any of them moved.
struct FootStep<'a> {
    cusps: &'a [Point],
    /// Sine and cosine of each angle.
    turned: [&'a [f64]; 2],
    /// Height and slopes at each foot.
    wanted: [&'a [f64]; 3],
    feet: &'a mut [f64],
    /// How far each cusp lies above the tangent at its foot, mm.
    distances: &'a mut [f64],
}

impl Loop for FootStep<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let ([sine, cosine], [z, zx, zy]) = (self.turned, self.wanted);
        let slopes = zx.iter().zip(cosine).zip(zy.iter().zip(sine));
        let given = self.cusps.iter().zip(z).zip(slopes);
        let mut moved = false;
        for ((foot, distance), ((cusp, z), ((zx, c), (zy, s)))) in
            self.feet.iter_mut().zip(self.distances).zip(given)
        {
            let slope = zx * c + zy * s;
            let (off_x, off_y) = (cusp.x - *foot, cusp.y - z);
            let w = (1.0 + slope * slope).sqrt();
            *distance = (off_y - slope * off_x) / w;
            let next = *foot + (off_x + slope * off_y) / (w * w);
            moved |= next != *foot;
            *foot = next;
        }
        moved
    }
}
