//! The profile along one line through the axis.

use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Result, Scalar};

use super::envelope::lower_envelope;
use super::lines::Lines;
use super::sections::{Fan, SectionPasses};
use crate::lower_arc::lower_arc;
use crate::touch::FirstTouch;

/// Points per pass. They show the height of a cusp to within one percent.
const POINTS_PER_PASS: usize = 16;
/// Fewest and most points.
const POINTS: (usize, usize) = (1024, 1 << 20);

/// A profile along one line: the passes at one angle and at the opposite one.
#[derive(Debug, Clone)]
pub struct ProfileLine {
    angle: f64,
    lines: Lines,
}

/// A point of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    /// Signed radius, mm: negative on the opposite side.
    pub s: f64,
    /// Machined − wanted along z, mm; NaN where no pass has cut, and in the hole.
    pub error: f64,
    /// Wanted z, mm.
    pub wanted: f64,
}

impl ProfileLine {
    /// An empty profile at an angle, rad.
    pub fn new(angle: f64) -> Self {
        let lines = Lines::new(Fan::line(angle));
        Self { angle, lines }
    }

    /// Appends the next block of the path.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn append(&mut self, touch: &FirstTouch, block: &PathBlock) -> Result<()> {
        let passes = SectionPasses::of(touch, self.lines.fan(), block)?;
        self.lines.append(passes);
        Ok(())
    }

    /// Points at equal distances over the aperture, its edges included.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn points(&self, touch: &FirstTouch) -> Result<Vec<ProfilePoint>> {
        let subject = touch.subject();
        let (tool, part) = (&subject.tool, &subject.part);
        let mut passes = Vec::new();
        if let [line, ..] = self.lines.all()[..] {
            line.sort_into(&mut passes);
        }
        let arcs = lower_envelope(&passes, tool.nose_radius, tool.reach());
        let count = (POINTS_PER_PASS * passes.len()).clamp(POINTS.0, POINTS.1);
        let rim = part.aperture_radius;
        let signed_radius = |i: usize| rim * (2.0 * i as f64 / count as f64 - 1.0);
        let s: Vec<f64> = (0..=count).map(signed_radius).collect();
        let (sin, cos) = Scalar::sin_cos(self.angle);
        let x: Vec<f64> = s.iter().map(|s| s * cos).collect();
        let y: Vec<f64> = s.iter().map(|s| s * sin).collect();
        let mut wanted = vec![f64::NAN; s.len()];
        subject.surface.heights(&x, &y, &mut wanted)?;
        let mut arcs = arcs.iter().peekable();
        let point = |(s, wanted): (&f64, f64)| {
            while arcs.next_if(|arc| arc.to < *s).is_some() {}
            let arc = arcs.peek().filter(|arc| arc.from <= *s);
            let arc = arc.filter(|_| s.abs() >= part.inner_radius);
            let machined = arc.map(|arc| lower_arc(arc.centre, tool.nose_radius, *s));
            ProfilePoint {
                s: *s,
                error: machined.unwrap_or(f64::NAN) - wanted,
                wanted,
            }
        };
        Ok(s.iter().zip(wanted).map(point).collect())
    }
}
