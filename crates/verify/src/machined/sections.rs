//! Passes of the nose at a fan of angles.

use std::f64::consts::TAU;
use std::ops::Range;

use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Gradients, Result, Scalar};

use crate::crossings::Sections;
use crate::cusp::Point;
use crate::touch::FirstTouch;

/// Number of sections at the start of a path. 23 is prime, so the sections fall everywhere between
/// the points of any division of the turn. 32 allows every other section to be dropped several
/// times.
const SECTIONS: i64 = 23 * 32;
/// Angle of the first section, in widths of a section after C = 0. At 0, a path that begins there
/// and has steps of whole degrees would have points on all sections.
const FIRST: f64 = 0.37;
/// Sections whose passes are put into their rows together: so many passes of a turn fill two lines of the
/// cache.
const SIDE_BY_SIDE: usize = 8;

/// Sections at equal distances around the axis. Their number is even, so each has an opposite one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fan {
    pub(super) count: i64,
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
    pub(super) fn angle(&self, number: i64) -> f64 {
        self.offset + number.rem_euclid(self.count) as f64 * self.width()
    }
}

/// The nose centres where C passed successive sections.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SectionPasses {
    /// Number of the section of the first pass, counted from C = offset on.
    pub(super) first: i64,
    /// Those of one section after those of another, from the section of the first pass on.
    pub(super) centres: Vec<Point>,
}

impl SectionPasses {
    /// The passes of a block as played, its last point excluded.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn of(touch: &FirstTouch, fan: &Fan, points: &PathBlock) -> Result<Self> {
        let (first, mut centres) = played(fan, points);
        let angles = (first..).map(|number| fan.angle(number));
        to_centres(touch, angles, &mut centres)?;
        Ok(Self::by_section(fan, first, &centres))
    }

    /// The passes of a nose of this radius, mm, whose lowest point is at the played points.
    pub fn of_lowest_point(radius: f64, fan: &Fan, points: &PathBlock) -> Self {
        let (first, mut centres) = played(fan, points);
        let above = Point::new(0.0, radius);
        centres.iter_mut().for_each(|point| *point += above);
        Self::by_section(fan, first, &centres)
    }

    /// Passes in the order of the path, the first of them that of section `first`.
    pub(super) fn by_section(fan: &Fan, first: i64, in_order: &[Point]) -> Self {
        let rows = Rows {
            sections: fan.count as usize,
            passes: in_order.len(),
        };
        let mut centres = vec![Point::default(); in_order.len()];
        for one in (0..rows.sections.min(rows.passes)).step_by(SIDE_BY_SIDE) {
            let last = rows.sections.min(one + SIDE_BY_SIDE);
            for (turn, of_turn) in in_order.chunks(rows.sections).enumerate() {
                let passes = of_turn.get(one..).unwrap_or_default();
                for (row, pass) in (one..last).zip(passes) {
                    centres[rows.begin(row) + turn] = *pass;
                }
            }
        }
        Self { first, centres }
    }
}

/// Passes of successive sections, those of each section in a row of their own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rows {
    /// Sections of a turn.
    pub sections: usize,
    pub passes: usize,
}

impl Rows {
    /// Where a row begins. Row 0 is that of the section of the first pass.
    #[inline(always)]
    pub fn begin(&self, row: usize) -> usize {
        let (each, with_one_more) = (self.passes / self.sections, self.passes % self.sections);
        row * each + row.min(with_one_more)
    }

    /// The places of the passes of a row.
    pub fn places(&self, row: usize) -> Range<usize> {
        self.begin(row)..self.begin(row + 1)
    }
}

/// The number of the first section that a block as played passes, and the points on the sections, in
/// their order.
fn played(fan: &Fan, points: &PathBlock) -> (i64, Vec<Point>) {
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
    (first.unwrap_or_default(), centres)
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
