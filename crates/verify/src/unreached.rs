//! What the nose cannot reach: how much higher than the surface the closing stays.
//!
//! As X goes along a radial section, the contact of the nose goes along the surface. Where it jumps,
//! the nose touches on both sides of a seam, and between both contacts its own circle at that X is
//! the lowest that any pass can leave: there the closing is known in closed form.

use std::f64::consts::PI;

use rayon::prelude::*;
use turnpath_core::Result;

use crate::profiles::Profiles;
use crate::touch::{ANYWHERE, FirstTouch, Touch};

/// Steps of X a nose radius that are looked at first; and the least and most on a section.
const STEPS_A_RADIUS: f64 = 64.0;
const STEPS: (f64, f64) = (256.0, 8192.0);
/// Positions of the nose in one batch.
const BATCH: usize = 512;
/// Every so many of these are looked at without knowing of others; a power of two.
const COARSE: usize = 64;
/// The contact may move this many times as far as X on a step before it may be a jump; and how much
/// more on each half of a step. On halves of a jump the factor doubles, on quick but smooth motion
/// it stays. A jump of 0.4 steps is found: on straight flanks one that leaves 5e-6 of the nose radius.
const QUICK: f64 = 1.25;
const QUICKER: f64 = 1.4;
/// Jumps below this part of the nose radius are left out: what stays under a nose of 1 mm is less
/// than 0.1 nm high where the surface bends no more than some times as sharply as the nose.
const SMALLEST_JUMP: f64 = 2.5e-4;
/// Halvings of a step of X around a jump: to 1e-12 of the nose radius.
const HALVINGS: usize = 34;
/// Steps across a seam, for areas and heights.
const ACROSS: usize = 64;
/// Sections of half a turn at first and at most. Their count is doubled until the volume settles
/// twice to this part of itself.
const SECTIONS: (usize, usize) = (96, 6144);
const SETTLED: f64 = 3e-3;
/// Sections of half a turn on which rides are looked for.
const RIDES: u32 = 384;
/// Where the first section lies, as a part of their distance: in step with no symmetry.
const OFFSET: f64 = 0.381_966;
/// Rounds of closing in on the highest place: golden section, from a section's distance to a
/// thousandth of it.
const ROUNDS: usize = 16;
const GOLDEN: f64 = 0.618_033_988_749_895;

/// What stays on the part between the surface and the best that the nose can cut.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct UnreachedFigures {
    /// Largest height along z, mm.
    pub height: f64,
    /// Angle of the place where it is, rad.
    pub at_theta: f64,
    /// Its radius, mm; negative beyond the axis.
    pub at_rho: f64,
    /// Volume, mm³.
    pub volume: f64,
    /// Part of the area on which the height along z exceeds the threshold.
    pub area_fraction: f64,
}

/// Measures what stays; `threshold`, mm along z, is that of the area.
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
        // The sections between those so far: the offset counts in steps of their own distance.
        let offset = OFFSET * count as f64 / SECTIONS.0 as f64;
        sum = sum.and(seams.sections(count, offset + 0.5)?);
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

/// Where the nose rides over a seam: its height over X has a corner there, and so have cusps between
/// passes on both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ride {
    /// Angle of the section, rad; less than half a turn.
    pub theta: f64,
    /// X of the nose, mm; negative beyond the axis.
    pub x: f64,
    /// By how much dZ/dX grows there.
    pub corner: f64,
}

/// The rides of a nose with |X| ≤ `outer`, mm, over seams that reach onto the part, on sections all
/// around.
///
/// # Errors
/// Where the surface fails.
pub fn rides(touch: &FirstTouch, outer: f64) -> Result<Vec<Ride>> {
    if !touch.leaves_seams() {
        return Ok(Vec::new());
    }
    let threshold = 0.0;
    let seams = Seams { touch, threshold };
    let each: Vec<Vec<Ride>> = (0..RIDES)
        .into_par_iter()
        .map(|i| seams.rides((f64::from(i) + OFFSET) * PI / f64::from(RIDES), outer))
        .collect::<Result<_>>()?;
    Ok(each.into_iter().flatten().collect())
}

/// The highest place so far.
#[derive(Debug, Clone, Copy, Default)]
struct Highest {
    height: f64,
    theta: f64,
    rho: f64,
}

impl Highest {
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
struct Sum {
    /// ∫ height·|ρ| dρ, mm³ a rad.
    volume: f64,
    /// ∫ |ρ| dρ where the height exceeds the threshold, mm² a rad.
    area: f64,
    highest: Highest,
}

impl Sum {
    fn and(self, other: Self) -> Self {
        Self {
            volume: self.volume + other.volume,
            area: self.area + other.area,
            highest: self.highest.or(other.highest),
        }
    }
}

/// A position of the nose that touches on both sides of a seam.
#[derive(Debug, Clone, Copy)]
struct Seam {
    x: f64,
    z: f64,
    from: f64,
    to: f64,
}

/// Two positions of the nose, and their contacts.
#[derive(Debug, Clone, Copy)]
struct Step {
    x: [f64; 2],
    foot: [f64; 2],
    /// Height of the nose at the second.
    z: f64,
}

impl Step {
    /// Whether the contact may jump on it.
    fn may_jump(&self, radius: f64, quick: f64) -> bool {
        let moved = self.foot[1] - self.foot[0];
        moved > SMALLEST_JUMP * radius && moved > quick * (self.x[1] - self.x[0])
    }

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

struct Seams<'a> {
    touch: &'a FirstTouch,
    threshold: f64,
}

impl Seams<'_> {
    /// The sums over `count` sections of half a turn.
    fn sections(&self, count: usize, offset: f64) -> Result<Sum> {
        let width = PI / count as f64;
        let each: Vec<Sum> = (0..count)
            .into_par_iter()
            .map(|i| self.section((i as f64 + offset) * width))
            .collect::<Result<_>>()?;
        Ok(each.into_iter().fold(Sum::default(), Sum::and))
    }

    fn section(&self, theta: f64) -> Result<Sum> {
        let subject = self.touch.subject();
        let reach = subject.part.aperture_radius + subject.tool.reach();
        self.between(theta, -reach, reach)
    }

    /// The sums over the seams of one section that the nose meets at X from `low` to `high`.
    fn between(&self, theta: f64, low: f64, high: f64) -> Result<Sum> {
        let mut profiles = Profiles::new(self.touch.subject().surface.as_ref(), &[theta]);
        let mut sum = Sum::default();
        for seam in self.seams(theta, low, high)? {
            sum = sum.and(self.across(&mut profiles, theta, &seam)?);
        }
        Ok(sum)
    }

    /// The rides on one section.
    fn rides(&self, theta: f64, outer: f64) -> Result<Vec<Ride>> {
        let radius = self.touch.subject().tool.nose_radius;
        let slope = |offset: f64| offset / (radius * radius - offset * offset).max(0.0).sqrt();
        let ride = |seam: &Seam| Ride {
            theta,
            x: seam.x,
            corner: slope(seam.to - seam.x) - slope(seam.from - seam.x),
        };
        let seams = self.seams(theta, -outer, outer)?;
        let on_part = seams.iter().filter(|seam| self.on_part(seam).any(|_| true));
        Ok(on_part.map(ride).collect())
    }

    /// What of a seam lies on the part, on either side of the axis.
    fn on_part(&self, seam: &Seam) -> impl Iterator<Item = (f64, f64)> {
        let part = self.touch.subject().part;
        let (rim, hole) = (part.aperture_radius, part.inner_radius);
        let (from, to) = (seam.from, seam.to);
        let sides = [(-rim, -hole), (hole, rim)].into_iter();
        sides
            .map(move |(low, high)| (from.max(low), to.min(high)))
            .filter(|(from, to)| from < to)
    }

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

    /// The positions that are looked at first.
    fn steps(&self, theta: f64, low: f64, high: f64) -> Result<Vec<Step>> {
        let radius = self.touch.subject().tool.nose_radius;
        let count = (STEPS_A_RADIUS * (high - low) / radius)
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

    /// The touches at growing X: a few first, then those between, whose contacts are bounded.
    fn touches_in_rounds(&self, theta: f64, x: &[f64]) -> Result<Vec<Touch>> {
        let mut found = vec![Touch::NOWHERE; x.len()];
        let mut apart = COARSE;
        let mut chosen: Vec<usize> = (0..x.len()).step_by(apart).collect();
        let mut feet = vec![ANYWHERE; chosen.len()];
        loop {
            let places: Vec<f64> = chosen.iter().map(|i| x[*i]).collect();
            let touches = self.touches(theta, &places, &feet)?;
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

    /// The touches at X, the contact of each within the bounds of `feet`.
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
    fn across(&self, profiles: &mut Profiles<'_>, theta: f64, seam: &Seam) -> Result<Sum> {
        let mut sum = Sum::default();
        for stretch in self.on_part(seam) {
            sum = sum.and(self.stretch(profiles, theta, seam, stretch)?);
        }
        Ok(sum)
    }

    /// Simpson's rule over one stretch of a seam.
    fn stretch(
        &self,
        profiles: &mut Profiles<'_>,
        theta: f64,
        seam: &Seam,
        (from, to): (f64, f64),
    ) -> Result<Sum> {
        let step = (to - from) / ACROSS as f64;
        let places: Vec<f64> = (0..=ACROSS).map(|i| from + i as f64 * step).collect();
        let heights = self.heights(profiles, seam, &places)?;
        let mut sum = Sum::default();
        for (i, (rho, height)) in places.iter().zip(&heights).enumerate() {
            let weight = match i {
                0 | ACROSS => 1.0,
                _ if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            sum.volume += weight * step / 3.0 * rho.abs() * height;
            sum.highest = sum.highest.or(Highest {
                height: *height,
                theta,
                rho: *rho,
            });
        }
        for (rho, height) in places.windows(2).zip(heights.windows(2)) {
            let share = share_above(height[0], height[1], self.threshold);
            sum.area += share * step * 0.5 * (rho[0] + rho[1]).abs();
        }
        Ok(sum)
    }

    /// How far the nose in a seam stands above the surface, along z.
    fn heights(
        &self,
        profiles: &mut Profiles<'_>,
        seam: &Seam,
        places: &[f64],
    ) -> Result<Vec<f64>> {
        let radius = self.touch.subject().tool.nose_radius;
        profiles.at(places.iter().map(|rho| (0, *rho)))?;
        let over = |(rho, surface): (&f64, &f64)| {
            let offset = rho - seam.x;
            let lift = (radius * radius - offset * offset).max(0.0).sqrt();
            (seam.z - lift - surface).max(0.0)
        };
        Ok(places.iter().zip(&profiles.height).map(over).collect())
    }

    /// The highest place near the one that is known: over angles a section apart, and within the
    /// seam.
    fn close_in(&self, known: Highest, width: f64) -> Result<Highest> {
        if known.height <= 0.0 {
            return Ok(known);
        }
        let (mut low, mut high) = (known.theta - width, known.theta + width);
        let mut best = self.near(known.theta, known.rho)?.or(known);
        let mut tried = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let mut found = [
            self.near(tried[0], known.rho)?,
            self.near(tried[1], known.rho)?,
        ];
        for _ in 0..ROUNDS {
            best = best.or(found[0]).or(found[1]);
            if found[0].height > found[1].height {
                high = tried[1];
                tried = [high - GOLDEN * (high - low), tried[0]];
                found = [self.near(tried[0], known.rho)?, found[0]];
            } else {
                low = tried[0];
                tried = [tried[1], low + GOLDEN * (high - low)];
                found = [found[1], self.near(tried[1], known.rho)?];
            }
        }
        Ok(best.or(found[0]).or(found[1]))
    }

    /// The highest place of the seams that the nose meets within its reach of `rho`.
    fn near(&self, theta: f64, rho: f64) -> Result<Highest> {
        let subject = self.touch.subject();
        let (reach, part) = (subject.tool.reach(), subject.part);
        let mut profiles = Profiles::new(subject.surface.as_ref(), &[theta]);
        let mut best = Highest::default();
        for seam in self.seams(theta, rho - reach, rho + reach)? {
            let top = self.across(&mut profiles, theta, &seam)?.highest;
            let step = (seam.to - seam.from) / ACROSS as f64;
            let (mut low, mut high) = (top.rho - step, top.rho + step);
            let mut finest = top;
            while high - low > f64::EPSILON.sqrt() * subject.tool.nose_radius {
                let width = (high - low) / 8.0;
                let places: Vec<f64> = (0..=8).map(|i| low + f64::from(i) * width).collect();
                let heights = self.heights(&mut profiles, &seam, &places)?;
                for (rho, height) in places.into_iter().zip(heights) {
                    let inside = (part.inner_radius..=part.aperture_radius).contains(&rho.abs());
                    if inside && (seam.from..=seam.to).contains(&rho) {
                        finest = finest.or(Highest { height, theta, rho });
                    }
                }
                (low, high) = (finest.rho - width, finest.rho + width);
            }
            best = best.or(finest);
        }
        Ok(best)
    }
}

/// Which part of a step lies above a threshold when the height goes straight from one end to the
/// other.
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
