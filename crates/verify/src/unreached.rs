//! The material that the nose cannot reach: how far the closing lies above the surface.
//!
//! As X moves along a radial section, the contact of the nose moves along the surface. Where the
//! contact jumps, the nose touches both sides of a seam at once. Between the two contacts no pass
//! can leave less than the circle of the nose at that X, so there the closing is known in closed
//! form.

use std::f64::consts::PI;

use rayon::prelude::*;
use turnpath_core::Result;

use crate::lower_arc::below_centre;
use crate::order::in_order;
use crate::profiles::Profiles;
use crate::touch::{ANYWHERE, FirstTouch, Touch};

/// Steps of X per nose radius before any halving.
const STEPS_PER_RADIUS: f64 = 64.0;
/// Fewest and most of these steps on a section.
const STEPS: (f64, f64) = (256.0, 8192.0);
/// Positions of the nose in one batch.
const BATCH: usize = 512;
/// Distance in steps of the first positions of a section, whose contacts have no bounds; a power of
/// two. The contacts of the positions between them are bounded by their neighbours.
const COARSE: usize = 64;
/// On a step, a contact that moves more than this many times as far as X may be a jump.
const QUICK: f64 = 1.25;
/// Factor of [`QUICK`] with each halving of a step. For a jump the ratio doubles with each halving;
/// for a quick but smooth motion it stays the same. A jump of 0.4 steps is found. On straight
/// flanks such a jump leaves 5e-6 of the nose radius.
const QUICKER: f64 = 1.4;
/// Jumps below this part of the nose radius are left out. Under a nose of 1 mm they leave less than
/// 0.1 nm, unless the surface bends many times as sharply as the nose.
const SMALLEST_JUMP: f64 = 2.5e-4;
/// Halvings of a step of X around a jump: down to 1e-12 of the nose radius.
const HALVINGS: usize = 34;
/// Steps across a seam, for areas and heights.
const ACROSS: usize = 64;
/// First and largest number of sections of half a turn. The number is doubled until the volume has
/// [`SETTLED`] twice.
const SECTIONS: (usize, usize) = (96, 6144);
/// The volume has settled when it changes by less than this part of itself.
const SETTLED: f64 = 3e-3;
/// Sections of half a turn on which rides are searched for.
const RIDES: u32 = 384;
/// Angle of the first section, as a part of the sections' distance. It matches no symmetry of a
/// surface.
const OFFSET: f64 = 0.381_966;
/// Rounds of the golden-section search for the highest point: from the sections' distance to a
/// thousandth of it.
const ROUNDS: usize = 16;
/// Ratio of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The material that stays on the part between the surface and the closing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct UnreachedFigures {
    /// Largest height along z, mm.
    pub height: f64,
    /// Angle of its position, rad.
    pub at_theta: f64,
    /// Radius of its position, mm; negative beyond the axis.
    pub at_rho: f64,
    /// Volume, mm³.
    pub volume: f64,
    /// Part of the area on which the height along z exceeds the threshold.
    pub area_fraction: f64,
}

/// Measures the material that the nose cannot reach. The area counts where the height along z
/// exceeds `threshold`, mm.
///
/// # Errors
/// Where the surface fails.
pub fn unreached(touch: &FirstTouch, threshold: f64) -> Result<UnreachedFigures> {
    if !touch.leaves_seams() {
        return Ok(UnreachedFigures::default());
    }
    let seams = Seams { touch, threshold };
    let mut count = SECTIONS.0;
    let mut sum = seams.sections(count, OFFSET)?;
    let mut settled = 0;
    while settled < 2 && count < SECTIONS.1 {
        let coarse = 2.0 * sum.volume;
        // The new sections lie between the old ones. The offset is a part of the old distance.
        let offset = OFFSET * count as f64 / SECTIONS.0 as f64;
        sum = sum.plus(seams.sections(count, offset + 0.5)?);
        count *= 2;
        let quiet = (sum.volume - coarse).abs() <= SETTLED * sum.volume;
        settled = if quiet { settled + 1 } else { 0 };
    }
    let width = PI / count as f64;
    let highest = seams.close_in(sum.highest, width)?;
    let part = touch.subject().part;
    let whole =
        PI * (part.aperture_radius * part.aperture_radius - part.inner_radius * part.inner_radius);
    Ok(UnreachedFigures {
        height: highest.height,
        at_theta: highest.theta,
        at_rho: highest.rho,
        volume: sum.volume * width,
        area_fraction: sum.area * width / whole,
    })
}

/// A position at which the nose rides over a seam. The height of the nose over X has a corner
/// there, and so has the height of the cusps between passes on both sides of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ride {
    /// Angle of the section, rad; less than half a turn.
    pub theta: f64,
    /// X of the nose, mm; negative beyond the axis.
    pub x: f64,
    /// The jump of dZ/dX at the corner.
    pub corner: f64,
}

/// The rides of the nose with |X| ≤ `outer`, mm, over seams that reach onto the part, on sections
/// at all angles.
///
/// # Errors
/// Where the surface fails.
pub fn rides(touch: &FirstTouch, outer: f64) -> Result<Vec<Ride>> {
    if !touch.leaves_seams() {
        return Ok(Vec::new());
    }
    let threshold = 0.0;
    let seams = Seams { touch, threshold };
    let angle = |i: u32| (f64::from(i) + OFFSET) * PI / f64::from(RIDES);
    let each = in_order(
        (0..RIDES)
            .into_par_iter()
            .map(|i| seams.rides(angle(i), outer)),
    )?;
    Ok(each.into_iter().flatten().collect())
}

/// The highest point so far.
#[derive(Debug, Clone, Copy, Default)]
struct HighestPoint {
    height: f64,
    theta: f64,
    rho: f64,
}

impl HighestPoint {
    fn or(self, other: Self) -> Self {
        if other.height > self.height {
            other
        } else {
            self
        }
    }
}

/// Sums over sections, each from rim to rim.
#[derive(Debug, Clone, Copy, Default)]
struct SectionSum {
    /// ∫ height·|ρ| dρ, mm³/rad.
    volume: f64,
    /// ∫ |ρ| dρ where the height exceeds the threshold, mm²/rad.
    area: f64,
    highest: HighestPoint,
}

impl SectionSum {
    fn plus(self, other: Self) -> Self {
        Self {
            volume: self.volume + other.volume,
            area: self.area + other.area,
            highest: self.highest.or(other.highest),
        }
    }
}

/// A position of the nose that touches both sides of a seam.
#[derive(Debug, Clone, Copy)]
struct Seam {
    x: f64,
    z: f64,
    /// Radius of the inner contact, mm.
    from: f64,
    /// Radius of the outer contact, mm.
    to: f64,
}

/// A step of X: two positions of the nose, and their contacts.
#[derive(Debug, Clone, Copy)]
struct Step {
    x: [f64; 2],
    foot: [f64; 2],
    /// Height of the nose at the second position, mm.
    z: f64,
}

impl Step {
    /// Whether the contact may jump in this step.
    fn may_jump(&self, radius: f64, quick: f64) -> bool {
        let moved = self.foot[1] - self.foot[0];
        moved > SMALLEST_JUMP * radius && moved > quick * (self.x[1] - self.x[0])
    }

    /// The two halves of the step, with the touch at the middle `x`.
    fn halves(&self, x: f64, touch: &Touch) -> [Self; 2] {
        let [left, right] = self.x;
        let [inner, outer] = self.foot;
        [
            Self {
                x: [left, x],
                foot: [inner, touch.foot],
                z: touch.z,
            },
            Self {
                x: [x, right],
                foot: [touch.foot, outer],
                z: self.z,
            },
        ]
    }
}

/// The search for seams.
struct Seams<'a> {
    touch: &'a FirstTouch,
    /// Height from which on an area counts, mm.
    threshold: f64,
}

impl Seams<'_> {
    /// The sums over `count` sections of half a turn.
    fn sections(&self, count: usize, offset: f64) -> Result<SectionSum> {
        let width = PI / count as f64;
        let angle = |i: usize| (i as f64 + offset) * width;
        let each = in_order((0..count).into_par_iter().map(|i| self.section(angle(i))))?;
        Ok(each
            .into_iter()
            .fold(SectionSum::default(), SectionSum::plus))
    }

    fn section(&self, theta: f64) -> Result<SectionSum> {
        let subject = self.touch.subject();
        let reach = subject.part.aperture_radius + subject.tool.reach();
        self.between(theta, -reach, reach)
    }

    /// The sums over the seams of one section that the nose meets at X from `low` to `high`.
    fn between(&self, theta: f64, low: f64, high: f64) -> Result<SectionSum> {
        let mut profiles = Profiles::new(self.touch.subject().surface.as_ref(), &[theta]);
        let mut sum = SectionSum::default();
        for seam in self.seams(theta, low, high)? {
            sum = sum.plus(self.across(&mut profiles, theta, &seam)?);
        }
        Ok(sum)
    }

    /// The rides on one section.
    fn rides(&self, theta: f64, outer: f64) -> Result<Vec<Ride>> {
        let radius = self.touch.subject().tool.nose_radius;
        let slope = |offset: f64| offset / below_centre(radius, offset);
        let ride = |seam: &Seam| Ride {
            theta,
            x: seam.x,
            corner: slope(seam.to - seam.x) - slope(seam.from - seam.x),
        };
        let seams = self.seams(theta, -outer, outer)?;
        let on_part = seams.iter().filter(|seam| self.on_part(seam).any(|_| true));
        Ok(on_part.map(ride).collect())
    }

    /// The intervals of a seam that lie on the part, on either side of the axis.
    fn on_part(&self, seam: &Seam) -> impl Iterator<Item = (f64, f64)> {
        let part = self.touch.subject().part;
        let (rim, hole) = (part.aperture_radius, part.inner_radius);
        let (from, to) = (seam.from, seam.to);
        let sides = [(-rim, -hole), (hole, rim)].into_iter();
        sides
            .map(move |(low, high)| (from.max(low), to.min(high)))
            .filter(|(from, to)| from < to)
    }

    /// The seams of one section that the nose meets at X from `low` to `high`.
    fn seams(&self, theta: f64, low: f64, high: f64) -> Result<Vec<Seam>> {
        let radius = self.touch.subject().tool.nose_radius;
        let mut steps = self.steps(theta, low, high)?;
        let mut quick = QUICK;
        for _ in 0..HALVINGS {
            steps.retain(|step| step.may_jump(radius, quick));
            quick *= QUICKER;
            let middle: Vec<f64> = steps
                .iter()
                .map(|step| 0.5 * (step.x[0] + step.x[1]))
                .collect();
            let feet: Vec<(f64, f64)> = steps
                .iter()
                .map(|step| (step.foot[0], step.foot[1]))
                .collect();
            let touches = self.touches(theta, &middle, &feet)?;
            let halves = steps.iter().zip(&middle).zip(&touches);
            steps = halves
                .flat_map(|((step, x), touch)| step.halves(*x, touch))
                .collect();
        }
        steps.retain(|step| step.may_jump(radius, quick));
        let seam = |step: &Step| Seam {
            x: step.x[1],
            z: step.z,
            from: step.foot[0],
            to: step.foot[1],
        };
        Ok(steps.iter().map(seam).collect())
    }

    /// The steps of X before any halving.
    fn steps(&self, theta: f64, low: f64, high: f64) -> Result<Vec<Step>> {
        let radius = self.touch.subject().tool.nose_radius;
        let count = (STEPS_PER_RADIUS * (high - low) / radius)
            .ceil()
            .clamp(STEPS.0, STEPS.1);
        let x: Vec<f64> = (0..=count as usize)
            .map(|i| low + (high - low) * (i as f64 / count))
            .collect();
        let touches = self.touches_in_rounds(theta, &x)?;
        let pairs = x.windows(2).zip(touches.windows(2));
        Ok(pairs
            .map(|(x, touches)| Step {
                x: [x[0], x[1]],
                foot: [touches[0].foot, touches[1].foot],
                z: touches[1].z,
            })
            .collect())
    }

    /// The touches at growing X. A few are found first; the contacts of those between are then
    /// bounded by their neighbours.
    fn touches_in_rounds(&self, theta: f64, x: &[f64]) -> Result<Vec<Touch>> {
        let mut found = vec![Touch::NOWHERE; x.len()];
        let mut apart = COARSE;
        let mut chosen: Vec<usize> = (0..x.len()).step_by(apart).collect();
        let mut feet = vec![ANYWHERE; chosen.len()];
        loop {
            let positions: Vec<f64> = chosen.iter().map(|i| x[*i]).collect();
            let touches = self.touches(theta, &positions, &feet)?;
            for (i, touch) in chosen.iter().zip(touches) {
                found[*i] = touch;
            }
            if apart == 1 {
                return Ok(found);
            }
            apart /= 2;
            chosen = (apart..x.len()).step_by(2 * apart).collect();
            let foot = |i: usize| found.get(i).map_or(f64::INFINITY, |touch| touch.foot);
            feet = (chosen.iter().map(|i| (foot(i - apart), foot(i + apart)))).collect();
        }
    }

    /// The touches at each X, with each contact within the bounds of `feet`.
    fn touches(&self, theta: f64, x: &[f64], feet: &[(f64, f64)]) -> Result<Vec<Touch>> {
        let mut all = Vec::with_capacity(x.len());
        let mut found = Vec::new();
        for (x, feet) in x.chunks(BATCH).zip(feet.chunks(BATCH)) {
            let theta = vec![theta; x.len()];
            self.touch.find_within(&theta, x, |i| feet[i], &mut found)?;
            all.extend_from_slice(&found);
        }
        Ok(all)
    }

    /// The sums over both sides of the axis, as far as the seam lies on the part.
    fn across(&self, profiles: &mut Profiles<'_>, theta: f64, seam: &Seam) -> Result<SectionSum> {
        let mut sum = SectionSum::default();
        for interval in self.on_part(seam) {
            sum = sum.plus(self.interval(profiles, theta, seam, interval)?);
        }
        Ok(sum)
    }

    /// The sums over one interval of a seam, by Simpson's rule.
    fn interval(
        &self,
        profiles: &mut Profiles<'_>,
        theta: f64,
        seam: &Seam,
        (from, to): (f64, f64),
    ) -> Result<SectionSum> {
        let step = (to - from) / ACROSS as f64;
        let radii: Vec<f64> = (0..=ACROSS).map(|i| from + i as f64 * step).collect();
        let heights = self.heights(profiles, seam, &radii)?;
        let mut sum = SectionSum::default();
        for (i, (rho, height)) in radii.iter().zip(&heights).enumerate() {
            let weight = match i {
                0 | ACROSS => 1.0,
                _ if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            sum.volume += weight * step / 3.0 * rho.abs() * height;
            sum.highest = sum.highest.or(HighestPoint {
                height: *height,
                theta,
                rho: *rho,
            });
        }
        for (rho, height) in radii.windows(2).zip(heights.windows(2)) {
            let share = share_above(height[0], height[1], self.threshold);
            sum.area += share * step * 0.5 * (rho[0] + rho[1]).abs();
        }
        Ok(sum)
    }

    /// The height along z of the nose in a seam above the surface, at each radius.
    fn heights(&self, profiles: &mut Profiles<'_>, seam: &Seam, radii: &[f64]) -> Result<Vec<f64>> {
        let radius = self.touch.subject().tool.nose_radius;
        profiles.at(radii.iter().map(|rho| (0, *rho)))?;
        let over = |(rho, surface): (&f64, &f64)| {
            let lower_side = seam.z - below_centre(radius, rho - seam.x);
            (lower_side - surface).max(0.0)
        };
        Ok(radii.iter().zip(&profiles.height).map(over).collect())
    }

    /// The highest point near a known one: over angles within a section's distance, `width`, and
    /// along the seam.
    fn close_in(&self, known: HighestPoint, width: f64) -> Result<HighestPoint> {
        if known.height <= 0.0 {
            return Ok(known);
        }
        let (mut low, mut high) = (known.theta - width, known.theta + width);
        let mut best = self.near(known.theta, known.rho)?.or(known);
        let mut angles = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let mut found = [
            self.near(angles[0], known.rho)?,
            self.near(angles[1], known.rho)?,
        ];
        for _ in 0..ROUNDS {
            best = best.or(found[0]).or(found[1]);
            if found[0].height > found[1].height {
                high = angles[1];
                angles = [high - GOLDEN * (high - low), angles[0]];
                found = [self.near(angles[0], known.rho)?, found[0]];
            } else {
                low = angles[0];
                angles = [angles[1], low + GOLDEN * (high - low)];
                found = [found[1], self.near(angles[1], known.rho)?];
            }
        }
        Ok(best.or(found[0]).or(found[1]))
    }

    /// The highest point of the seams that the nose meets within its reach of `rho`.
    fn near(&self, theta: f64, rho: f64) -> Result<HighestPoint> {
        let subject = self.touch.subject();
        let (reach, part) = (subject.tool.reach(), subject.part);
        let mut profiles = Profiles::new(subject.surface.as_ref(), &[theta]);
        let mut best = HighestPoint::default();
        for seam in self.seams(theta, rho - reach, rho + reach)? {
            let top = self.across(&mut profiles, theta, &seam)?.highest;
            let step = (seam.to - seam.from) / ACROSS as f64;
            let (mut low, mut high) = (top.rho - step, top.rho + step);
            let mut finest = top;
            while high - low > f64::EPSILON.sqrt() * subject.tool.nose_radius {
                let width = (high - low) / 8.0;
                let radii: Vec<f64> = (0..=8).map(|i| low + f64::from(i) * width).collect();
                let heights = self.heights(&mut profiles, &seam, &radii)?;
                for (rho, height) in radii.into_iter().zip(heights) {
                    let inside = (part.inner_radius..=part.aperture_radius).contains(&rho.abs());
                    if inside && (seam.from..=seam.to).contains(&rho) {
                        finest = finest.or(HighestPoint { height, theta, rho });
                    }
                }
                (low, high) = (finest.rho - width, finest.rho + width);
            }
            best = best.or(finest);
        }
        Ok(best)
    }
}

/// The part of a step that lies above a threshold, for a height that is linear between the two
/// ends.
fn share_above(first: f64, second: f64, threshold: f64) -> f64 {
    let (low, high) = (first.min(second), first.max(second));
    if low > threshold {
        1.0
    } else if high > threshold {
        (high - threshold) / (high - low)
    } else {
        0.0
    }
}
