//! Passes of the nose at a fan of angles, combined into lines through the axis.

use std::f64::consts::TAU;

use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Gradients, Result, Scalar};

use crate::crossings::Sections;
use crate::cusp::Point;
use crate::touch::FirstTouch;

/// Number of sections at the start of a path. 23 is prime, so the sections fall everywhere between
/// the points of any division of the turn. 32 allows every other section to be dropped several
/// times.
const SECTIONS: i64 = 23 * 32;
/// Fewest sections. Half of them are lines through the axis.
const FEWEST: i64 = 2 * 23;
/// Angle of the first section, in widths of a section after C = 0. At 0, a path that begins there
/// and has steps of whole degrees would have points on all sections.
const FIRST: f64 = 0.37;
/// Largest number of passes that are kept, 16 bytes each. Beyond it, every other section is
/// dropped.
const MOST_PASSES: usize = 4_000_000;
/// A line that is full grows by its length over this number: doubling would take twice the memory.
const GROWTH: usize = 8;
/// A line that is full grows by so many passes at least, or doubles: all lines together waste little.
const LEAST_GROWTH: usize = 1024;

/// Sections at equal distances around the axis. Their number is even, so each has an opposite one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fan {
    count: i64,
    offset: f64,
}

impl Fan {
    /// The sections on which the figures of a path are measured.
    pub const WHOLE: Self = Self {
        count: SECTIONS,
        offset: FIRST * TAU / SECTIONS as f64,
    };

    /// One line through the axis at an angle, rad.
    pub const fn line(angle: f64) -> Self {
        Self {
            count: 2,
            offset: angle,
        }
    }

    fn width(&self) -> f64 {
        TAU / self.count as f64
    }

    /// The angle of a section within its turn, rad.
    fn angle(&self, number: i64) -> f64 {
        self.offset + number.rem_euclid(self.count) as f64 * self.width()
    }
}

/// The nose centres where C passed successive sections.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SectionPasses {
    /// Number of the section of the first pass, counted from C = offset on.
    first: i64,
    centres: Vec<Point>,
}

impl SectionPasses {
    /// The passes of a block as played, its last point excluded.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn of(touch: &FirstTouch, fan: &Fan, points: &PathBlock) -> Result<Self> {
        let mut passes = Self::played(fan, points);
        let angles = (passes.first..).map(|number| fan.angle(number));
        to_centres(touch, angles, &mut passes.centres)?;
        Ok(passes)
    }

    /// The passes of a nose of this radius, mm, whose lowest point is at the played points.
    pub fn of_lowest_point(radius: f64, fan: &Fan, points: &PathBlock) -> Self {
        let mut passes = Self::played(fan, points);
        let above = Point::new(0.0, radius);
        passes.centres.iter_mut().for_each(|point| *point += above);
        passes
    }

    /// The played points on the sections.
    fn played(fan: &Fan, points: &PathBlock) -> Self {
        let sections = Sections {
            offset: fan.offset,
            width: fan.width(),
        };
        let mut centres = Vec::with_capacity(sections.about(&points.c));
        let mut first = None;
        for (segment, c) in points.segments().zip(points.c.windows(2)) {
            sections.crossings(&segment, [c[0], c[1]], |number, instant| {
                let (x, z) = (segment.x.value(instant), segment.z.value(instant));
                centres.push(Point::new(x, z));
                first.get_or_insert(number);
            });
        }
        let first = first.unwrap_or_default();
        Self { first, centres }
    }
}

/// Turns played points into centres of the nose. If the path is that of the contact, the centre
/// lies on the surface's normal at the point; if not, it is the point itself.
pub(super) fn to_centres(
    touch: &FirstTouch,
    angles: impl Iterator<Item = f64>,
    played: &mut [Point],
) -> Result<()> {
    let subject = touch.subject();
    if subject.compensates_nose {
        return Ok(());
    }
    let turned: Vec<(f64, f64)> = angles
        .zip(played.iter())
        .map(|(angle, _)| Scalar::sin_cos(angle))
        .collect();
    let on_part = |(point, turned): (&Point, &(f64, f64))| (point.x * turned.1, point.x * turned.0);
    let (x, y): (Vec<f64>, Vec<f64>) = played.iter().zip(&turned).map(on_part).unzip();
    let blank = vec![0.0; x.len()];
    let (mut z, mut zx, mut zy) = (blank.clone(), blank.clone(), blank);
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    subject.surface.gradient(&x, &y, out)?;
    let radius = subject.tool.nose_radius;
    for (i, point) in played.iter_mut().enumerate() {
        let (sin, cos) = turned[i];
        let slope = zx[i] * cos + zy[i] * sin;
        let w = (1.0 + slope * slope).sqrt();
        *point += Point::new(-radius * slope, radius) / w;
    }
    Ok(())
}

/// Passes along lines through the axis, each with a signed position: a pass of the section itself
/// at X, a pass of the opposite section at −X.
#[derive(Debug, Clone)]
pub struct Lines {
    fan: Fan,
    /// The number of one kept section to the number of the next.
    stride: i64,
    lines: Vec<Vec<Point>>,
    kept: usize,
}

impl Lines {
    /// Lines without passes.
    pub fn new(fan: Fan) -> Self {
        Self {
            fan,
            stride: 1,
            lines: vec![Vec::new(); (fan.count / 2) as usize],
            kept: 0,
        }
    }

    /// The sections of the lines.
    pub fn fan(&self) -> &Fan {
        &self.fan
    }

    /// Appends the passes of the path's next block.
    pub fn append(&mut self, next: &SectionPasses) {
        let half = self.fan.count / 2;
        let mut section = next.first.rem_euclid(self.fan.count);
        let mut after_kept = next.first.rem_euclid(self.stride);
        for centre in &next.centres {
            if after_kept == 0 {
                let (number, sign) = match section < half {
                    true => (section, 1.0),
                    false => (section - half, -1.0),
                };
                if let Some(line) = self.lines.get_mut((number / self.stride) as usize) {
                    if line.len() == line.capacity() {
                        let doubled = line.len().clamp(FEWEST as usize, LEAST_GROWTH);
                        line.reserve_exact(doubled.max(line.len() / GROWTH));
                    }
                    line.push(Point::new(sign * centre.x, centre.y));
                    self.kept += 1;
                }
            }
            section = following(section, self.fan.count);
            after_kept = following(after_kept, self.stride);
        }
        while self.kept > MOST_PASSES && self.fan.count / self.stride > FEWEST {
            self.thin_out();
        }
    }

    /// Drops every other section.
    fn thin_out(&mut self) {
        let mut index = 0;
        self.lines.retain(|_| {
            index += 1;
            index % 2 == 1
        });
        self.stride *= 2;
        self.kept = self.lines.iter().map(Vec::len).sum();
    }

    /// Angle and passes of each line.
    pub(super) fn all(&self) -> Vec<(f64, &[Point])> {
        let angle = |index: usize| self.fan.angle(index as i64 * self.stride);
        let lines = self.lines.iter().enumerate();
        lines
            .map(|(index, line)| (angle(index).rem_euclid(TAU), line.as_slice()))
            .collect()
    }
}

/// The number after this one where numbers come round after `count`.
fn following(number: i64, count: i64) -> i64 {
    match number + 1 == count {
        true => 0,
        false => number + 1,
    }
}

/// Sorts passes into `sorted` from left to right, and those at the same position from the lowest up. On
/// a line the passes of its two halves take turns, and each half is in order or nearly so, forward or
/// backward.
pub(super) fn sort_into(passes: &[Point], sorted: &mut Vec<Point>) {
    // As the order below has it, also for what is no number.
    let is_left = |pass: &Point| pass.x.is_sign_negative();
    let count = passes.iter().filter(|pass| is_left(pass)).count();
    sorted.resize(passes.len(), Point::default());
    let (left, right) = sorted.split_at_mut(count);
    let (mut left_places, mut right_places) = (left.iter_mut(), right.iter_mut());
    for pass in passes {
        let places = match is_left(pass) {
            true => &mut left_places,
            false => &mut right_places,
        };
        if let Some(place) = places.next() {
            *place = *pass;
        }
    }
    let order = |a: &Point, b: &Point| a.x.total_cmp(&b.x).then_with(|| a.y.total_cmp(&b.y));
    for half in [left, right] {
        let runs_backward = matches!(&*half, [first, .., last] if first.x > last.x);
        match runs_backward {
            true => {
                half.sort_by(|a, b| order(b, a));
                half.reverse();
            }
            false => half.sort_by(order),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dropping_sections_keeps_what_would_have_been_kept_from_the_start() {
        let passes = SectionPasses {
            first: -5,
            centres: (0..3000).map(|i| Point::new(f64::from(i), 0.5)).collect(),
        };
        let mut late = Lines::new(Fan::WHOLE);
        late.append(&passes);
        late.thin_out();
        let mut early = Lines::new(Fan::WHOLE);
        early.thin_out();
        early.append(&passes);
        assert_eq!(late.lines, early.lines);
        assert_eq!((late.kept, late.stride), (early.kept, 2));
        assert_eq!(late.all()[3].0, Fan::WHOLE.angle(6));
    }

    /// Inward and outward, over the axis, with passes on each other: as one sort of all of them.
    #[test]
    fn passes_come_sort_into_and_from_the_lowest_up() {
        let pass = |i: i32| Point::new(0.1 * f64::from(i), f64::from(i % 3));
        let both_ways = |i: i32| [pass(i), Point::new(-0.1 * f64::from(i) - 0.05, 1.0)];
        let inward: Vec<Point> = (-4..100).rev().flat_map(both_ways).collect();
        let outward: Vec<Point> = (0..100).flat_map(both_ways).collect();
        let twice = [inward.clone(), outward.clone()].concat();
        let at_axis = [0.0, -0.0, 0.0].map(|x| Point::new(x, -x)).to_vec();
        let no_number = [f64::NAN, -f64::NAN].map(|x| Point::new(x, 0.0));
        let unknown = vec![pass(3), no_number[0], pass(-2), no_number[1], pass(1)];
        for passes in [inward, outward, twice, at_axis, unknown, Vec::new()] {
            let mut found = vec![pass(7)];
            sort_into(&passes, &mut found);
            let mut expected = passes;
            expected.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            let bits = |passes: &[Point]| -> Vec<[u64; 2]> {
                passes
                    .iter()
                    .map(|pass| [pass.x, pass.y].map(f64::to_bits))
                    .collect()
            };
            assert_eq!(bits(&found), bits(&expected));
        }
    }
}
