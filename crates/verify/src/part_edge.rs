//! What stays uncut at an edge of the part: at the rim, or at the hole.
//!
//! Two heights count at each angle, and the larger one is the figure. One is the distance of the
//! wanted edge from the nearest cut. The other is the height of the machined surface at the edge's
//! radius, along the normal of the wanted surface. On a wall that rises towards the edge, the foot
//! of that normal lies beyond the edge, where the last pass has long risen from the surface. So the
//! second height makes sure that nothing within the part's radii stays higher. Where cusps are all
//! that stands there, both are cusps' heights, and they do not grow with the slope.
//!
//! The nose stands at the played X with its true Z, as for the residual. A pass counts where its
//! edge stands above the point: within the reach of half the included angle. Passes of the opposite
//! half count too. Where the nose leaves a seam at the edge, the first height is measured from the
//! closing, the lowest surface that the nose can cut ([`crate::closing`]), and the second does not
//! count.
//!
//! The heights go up and down with the angle like a saw tooth that jumps where the path ends. So the
//! search goes from section to section first, and then closes in on the largest between sections
//! and on both sides of the path's ends. Between sections all passes count that cut the edge there
//! ([`crate::edge_crossings`]).

use std::f64::consts::TAU;

use turnpath_core::toolpath::{PathBlock, Segment};
use turnpath_core::{Result, Tool};

use crate::closing;
use crate::crossings::crossing;
use crate::cusp::Point;
use crate::edge_crossings::{EdgeCrossings, PassNumber};
use crate::lower_arc::lower_arc;
use crate::profiles::Profiles;
use crate::residual::{self, Pass, Passes, SECTIONS, angle_of};
use crate::touch::FirstTouch;

/// Sections of a revolution.
const TURN: usize = SECTIONS as usize;
/// Width of a section, rad.
const WIDTH: f64 = TAU / SECTIONS as f64;
/// How many of the sections with the largest heights the search closes in on.
const CANDIDATES: usize = 8;
/// Steps of the first search to either side of a section.
const STEPS: i32 = 8;
/// Rounds of the search, each to a quarter of the step: from an eighth of a degree to 1e-5 degrees.
const ROUNDS: usize = 7;
/// Distance of the angles just before and just after an end of the path, rad: some times the
/// rounding of C over ten thousand turns.
const BESIDE_END: f64 = 1e-10;

/// The largest uncut height at one edge of the part, or around the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UncutHeight {
    /// The height, mm; infinite where no pass reaches.
    pub height: f64,
    /// Angle of its section, rad.
    pub at_theta: f64,
}

/// What the passes leave at one edge of the part, on each section.
#[derive(Debug, Clone, Default)]
pub(crate) struct PartEdge {
    radius: f64,
    /// The passes that leave least on each section; empty if nothing was measured.
    sections: Vec<LowestPasses<NearPass>>,
    /// The passes that cut the edge between each section and the next one.
    crossings: Vec<Vec<NearPass>>,
    /// C of both ends of the path so far, rad.
    ends: Option<[f64; 2]>,
}

/// The passes that leave least at the edge on one section.
#[derive(Debug, Clone)]
struct LowestPasses<P> {
    /// The pass that comes nearest to the wanted edge, and its distance from it, mm.
    nearest: Option<(f64, P)>,
    /// The pass that is the lowest at the edge's radius, and its z there, mm.
    lowest: Option<(f64, P)>,
}

/// A pass with the piece of the path around it, up to a section's width to either side.
#[derive(Debug, Clone)]
struct NearPass {
    /// C on the pass's own section, rad.
    c: f64,
    /// Whether the pass belongs to the opposite half.
    mirrored: bool,
    /// Segments of the path, each with its C, rad.
    segments: Vec<([f64; 2], Segment)>,
}

/// An angle of the edge at which a height is measured.
#[derive(Debug, Clone, Copy)]
struct EdgeAngle {
    /// Within the turn, rad.
    theta: f64,
    /// The number of the section at the angle or before it, whose passes count.
    section: usize,
    /// How far the angle lies behind that section, rad.
    off: f64,
}

impl PartEdge {
    /// What the passes of a block leave at one radius, mm.
    pub fn of(
        touch: &FirstTouch,
        radius: f64,
        points: &PathBlock,
        passes: &Passes,
    ) -> Result<Self> {
        let tool = touch.subject().tool;
        let mut sections = vec![LowestPasses::NONE; TURN];
        let mut crossings = Vec::new();
        let comes_near = |pass: &Pass| (pass.centre.x.abs() - radius).abs() < tool.reach();
        if passes.passes.iter().any(comes_near) {
            let theta: Vec<f64> = (0..SECTIONS).map(angle_of).collect();
            let ring = ring(touch, &theta, radius)?;
            for (number, pass) in (passes.first..).zip(&passes.passes) {
                for (mirrored, centre) in [(false, pass.centre), (true, pass.mirrored().centre)] {
                    let pass = PassNumber { number, mirrored };
                    let section = pass.section();
                    sections[section].offer(centre, &ring[section], &tool, pass);
                }
            }
            crossings = EdgeCrossings::new(touch, radius)?.of(passes);
        }
        let track = Track(points);
        let near = |pass: PassNumber| track.around(pass.number as f64 * WIDTH, pass.mirrored);
        let sections = sections.into_iter().map(|passes| passes.map(near));
        let sections = sections.collect();
        let mut between = vec![Vec::new(); TURN];
        for pass in crossings {
            between[pass.section()].push(near(pass));
        }
        let ends = points.c.first().zip(points.c.last());
        let ends = ends.map(|(first, last)| [*first, *last]);
        Ok(Self {
            radius,
            sections,
            crossings: between,
            ends,
        })
    }

    /// Appends what the path's next block leaves.
    pub fn append(&mut self, next: &Self) {
        if self.sections.is_empty() {
            self.clone_from(next);
            return;
        }
        for (own, next) in self.sections.iter_mut().zip(&next.sections) {
            own.append(next);
        }
        for (own, next) in self.crossings.iter_mut().zip(&next.crossings) {
            own.extend_from_slice(next);
        }
        self.ends = match (self.ends, next.ends) {
            (Some([first, _]), Some([_, last])) => Some([first, last]),
            (own, next) => own.or(next),
        };
    }

    /// The height on each section; empty if nothing was measured.
    pub fn on_sections(&self, touch: &FirstTouch) -> Result<Vec<UncutHeight>> {
        let on_section = |section: usize| EdgeAngle {
            theta: angle_of(section as i64),
            section,
            off: 0.0,
        };
        let sections: Vec<EdgeAngle> = (0..self.sections.len()).map(on_section).collect();
        self.heights(touch, &sections)
    }

    /// The largest height over all angles; infinite if nothing was measured.
    pub fn uncut(&self, touch: &FirstTouch) -> Result<UncutHeight> {
        let mut heights = self.on_sections(touch)?;
        heights.sort_by(|a, b| b.height.total_cmp(&a.height));
        let Some(mut largest) = heights.first().copied() else {
            return Ok(UncutHeight {
                height: f64::INFINITY,
                at_theta: 0.0,
            });
        };
        if largest.height.is_infinite() {
            return Ok(largest);
        }
        let step = WIDTH / f64::from(STEPS);
        let around =
            |theta: f64, step: f64| (-STEPS..=STEPS).map(move |i| theta + step * f64::from(i));
        let candidates = heights.iter().take(CANDIDATES);
        let mut angles: Vec<f64> = candidates
            .flat_map(|candidate| around(candidate.at_theta, step))
            .collect();
        for end in self.ends.into_iter().flatten() {
            let beside = BESIDE_END.max(8.0 * f64::EPSILON * end.abs());
            angles.extend([end - beside, end + beside]);
        }
        let mut step = step;
        for _ in 0..ROUNDS {
            for found in self.heights(touch, &edge_angles(&angles))? {
                if found.height > largest.height {
                    largest = found;
                }
            }
            step *= 0.25;
            angles = around(largest.at_theta, step).collect();
        }
        Ok(largest)
    }

    /// The height at each angle. Between sections, the passes of both sections around it count, and
    /// those that cut the edge between them.
    fn heights(&self, touch: &FirstTouch, angles: &[EdgeAngle]) -> Result<Vec<UncutHeight>> {
        let mut theta: Vec<f64> = angles.iter().map(|angle| angle.theta).collect();
        let ring = ring(touch, &theta, self.radius)?;
        let tool = touch.subject().tool;
        let mut found = vec![Least::NOTHING; angles.len()];
        for (index, centre) in self.centres(touch, angles)? {
            found[index].include(centre, &ring[index], &tool);
        }
        let machined = found.iter().zip(&ring).map(|(least, wanted)| {
            let reached = least.lowest.is_finite();
            let z = if reached {
                least.lowest
            } else {
                wanted.point.y
            };
            Point::new(self.radius, z)
        });
        let machined: Vec<Point> = machined.collect();
        let surface = touch.subject().surface.as_ref();
        let (along_normal, _) = residual::heights(surface, &theta, &machined)?;
        let measured = theta.drain(..).zip(ring).zip(found).zip(along_normal);
        let height = |(((at_theta, wanted), least), exact): (((f64, WantedPoint), Least), f64)| {
            UncutHeight {
                height: least.height(&wanted, exact),
                at_theta,
            }
        };
        Ok(measured.map(height).collect())
    }

    /// The nose centres of the passes that count at each angle, with the index of the angle.
    fn centres(&self, touch: &FirstTouch, angles: &[EdgeAngle]) -> Result<Vec<(usize, Point)>> {
        let (mut of, mut theta, mut x) = (Vec::new(), Vec::new(), Vec::new());
        let ends = self.ends.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        for (index, angle) in angles.iter().enumerate() {
            let EdgeAngle {
                theta: at,
                section,
                off,
            } = *angle;
            for (pass, off) in self.passes(section, off) {
                let Some(played) = pass.x(off, ends) else {
                    continue;
                };
                let turned = match pass.mirrored {
                    true => at + 0.5 * TAU,
                    false => at,
                };
                of.push((index, pass.mirrored));
                theta.push(turned.rem_euclid(TAU));
                x.push(played);
            }
        }
        let passes = residual::passes_at(touch, &theta, &x)?;
        let centre = |((index, mirrored), pass): ((usize, bool), Pass)| match mirrored {
            true => (index, pass.mirrored().centre),
            false => (index, pass.centre),
        };
        Ok(of.into_iter().zip(passes).map(centre).collect())
    }

    /// The passes that count so far behind a section, each with how far that is off its own section.
    fn passes(&self, section: usize, off: f64) -> impl Iterator<Item = (&NearPass, f64)> {
        let lowest = |section: usize, off: f64| {
            let passes = self.sections.get(section).into_iter();
            let passes = passes.flat_map(LowestPasses::all);
            passes.map(move |pass| (pass, off))
        };
        let between = (off != 0.0).then(|| {
            let crossings = self.crossings.get(section).into_iter().flatten();
            let crossings = crossings.map(move |pass| (pass, off));
            lowest((section + 1) % TURN, off - WIDTH).chain(crossings)
        });
        lowest(section, off).chain(between.into_iter().flatten())
    }
}

/// The angles of the edge, each with the section before it.
fn edge_angles(angles: &[f64]) -> Vec<EdgeAngle> {
    let of = |angle: &f64| {
        let theta = angle.rem_euclid(TAU);
        let section = (theta / WIDTH).floor();
        EdgeAngle {
            theta,
            section: section as usize % TURN,
            off: theta - section * WIDTH,
        }
    };
    angles.iter().map(of).collect()
}

impl<P: Clone> LowestPasses<P> {
    const NONE: Self = Self {
        nearest: None,
        lowest: None,
    };

    fn all(&self) -> impl Iterator<Item = &P> {
        let both = [&self.nearest, &self.lowest].into_iter().flatten();
        both.map(|(_, pass)| pass)
    }

    /// Keeps a pass with its centre here if it leaves less than those so far.
    fn offer(&mut self, centre: Point, wanted: &WantedPoint, tool: &Tool, pass: P) {
        let mut least = Least::NOTHING;
        least.include(centre, wanted, tool);
        keep(&mut self.nearest, least.nearest, &pass);
        keep(&mut self.lowest, least.lowest, &pass);
    }

    fn append(&mut self, next: &Self) {
        for (own, next) in [
            (&mut self.nearest, &next.nearest),
            (&mut self.lowest, &next.lowest),
        ] {
            if let Some((value, pass)) = next {
                keep(own, *value, pass);
            }
        }
    }

    fn map<Q>(self, of: impl Fn(P) -> Q) -> LowestPasses<Q> {
        let of = |(value, pass)| (value, of(pass));
        LowestPasses {
            nearest: self.nearest.map(of),
            lowest: self.lowest.map(of),
        }
    }
}

/// Keeps a pass if its value is finite and below the one so far.
fn keep<P: Clone>(own: &mut Option<(f64, P)>, value: f64, pass: &P) {
    let least = own.as_ref().map_or(f64::INFINITY, |(least, _)| *least);
    if value < least {
        *own = Some((value, pass.clone()));
    }
}

/// The least that passes leave at a place.
#[derive(Debug, Clone, Copy)]
struct Least {
    /// Distance of the wanted edge from the nearest cut, mm; infinite where no pass reaches.
    nearest: f64,
    /// z of the machined surface at the edge's radius, mm; infinite where no pass reaches.
    lowest: f64,
}

impl Least {
    const NOTHING: Self = Self {
        nearest: f64::INFINITY,
        lowest: f64::INFINITY,
    };

    /// Counts a pass with its nose centre here.
    fn include(&mut self, centre: Point, wanted: &WantedPoint, tool: &Tool) {
        let off = wanted.point - centre;
        if off.x.abs() < tool.reach() {
            let radius = tool.nose_radius;
            let uncut = off.norm() - radius;
            self.nearest = self.nearest.min(uncut.max(0.0));
            let under = lower_arc(centre, radius, wanted.point.x);
            self.lowest = self.lowest.min(under);
        }
    }

    /// The height that counts; `exact` is the distance of the machined surface from the profile.
    /// Where the profile ends before the normal's foot it is no such distance, and the distance from
    /// the profile's tangent takes its place.
    fn height(&self, wanted: &WantedPoint, exact: f64) -> f64 {
        match wanted.slope {
            Some(slope) if self.nearest.is_finite() => {
                let above = self.lowest - wanted.point.y;
                let machined = match exact <= above {
                    true => exact,
                    false => above / (1.0 + slope * slope).sqrt(),
                };
                self.nearest.max(machined)
            }
            _ => self.nearest,
        }
    }
}

/// A point of the wanted edge.
#[derive(Debug, Clone, Copy)]
struct WantedPoint {
    /// The point; where the nose leaves a seam, that of the closing.
    point: Point,
    /// Slope of the profile there; `None` where the nose leaves a seam.
    slope: Option<f64>,
}

/// The points of the wanted surface at one radius, one for each angle.
fn ring(touch: &FirstTouch, theta: &[f64], radius: f64) -> Result<Vec<WantedPoint>> {
    let radii = vec![radius; theta.len()];
    let mut profiles = Profiles::new(touch.subject().surface.as_ref(), theta);
    profiles.at_all(&radii)?;
    let closing = match touch.leaves_seams() {
        true => closing::at(touch, theta, &radii)?,
        false => profiles.height.clone(),
    };
    let surface = profiles.height.iter().zip(&profiles.slope);
    let point = |(z, (height, slope)): (f64, (&f64, &f64))| WantedPoint {
        point: Point::new(radius, z),
        slope: (z == *height).then_some(*slope),
    };
    Ok(closing.into_iter().zip(surface).map(point).collect())
}

/// The segments of a block, found by C.
struct Track<'a>(&'a PathBlock);

impl Track<'_> {
    /// The pass at `c`, rad, with what the block has of the path around it.
    fn around(&self, c: f64, mirrored: bool) -> NearPass {
        let ends = &self.0.c;
        let first = ends.partition_point(|end| *end <= c - WIDTH);
        let last = ends.partition_point(|end| *end < c + WIDTH);
        let range = first.saturating_sub(1)..last.min(ends.len().saturating_sub(1));
        let segments = range.clone().map(|number| self.0.segment(number));
        let ends = ends.windows(2).skip(range.start);
        NearPass {
            c,
            mirrored,
            segments: ends
                .zip(segments)
                .filter_map(|(c, segment)| Some(([c[0], c[1]], segment?)))
                .collect(),
        }
    }
}

impl NearPass {
    /// X as played at an angle off the pass's own section, mm; `None` before and behind the path's
    /// ends. A block may end nearer than that: X then goes on at its last rate.
    fn x(&self, off: f64, [begin, end]: [f64; 2]) -> Option<f64> {
        let c = self.c + off;
        if !(begin..=end).contains(&c) {
            return None;
        }
        let after = self.segments.partition_point(|(ends, _)| ends[1] < c);
        let last = self.segments.len().checked_sub(1)?;
        let (ends, segment) = self.segments.get(after.min(last))?;
        let known = c.clamp(ends[0], ends[1]);
        let instant = crossing(segment, known);
        let rate = segment.x.slope(instant) / segment.c.slope(instant);
        let beyond = if c == known { 0.0 } else { rate * (c - known) };
        Some(segment.x.value(instant) + beyond)
    }
}
