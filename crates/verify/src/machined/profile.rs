//! The profile along one line through the axis.

use turnpath_core::toolpath::PathBlock;
use turnpath_core::{Result, Scalar};

use super::envelope::{lower_arc, lower_envelope};
use super::sections::{Fan, Lines, SectionPasses, sort};
use crate::touch::FirstTouch;

/// Places for each pass: cusps are seen to within a percent of their height.
const PLACES_A_PASS: usize = 16;
/// Fewest and most places.
const PLACES: (usize, usize) = (1024, 1 << 20);

/// A profile in the making: the passes at one angle and at the opposite one.
#[derive(Debug, Clone)]
pub struct ProfileLine {
    angle: f64,
    lines: Lines,
}

/// A place of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePlace {
    /// Signed radius, mm: negative on the opposite side.
    pub s: f64,
    /// Machined − wanted along z, mm; NaN where nothing cut, and in the hole.
    pub error: f64,
    /// Wanted z, mm.
    pub wanted: f64,
}

impl ProfileLine {
    /// At an angle, rad.
    pub fn new(angle: f64) -> Self {
        let lines = Lines::new(Fan::line(angle));
        Self { angle, lines }
    }

    /// Takes the next block of the path.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn append(&mut self, touch: &FirstTouch, block: &PathBlock) -> Result<()> {
        let passes = SectionPasses::of(touch, self.lines.fan(), block)?;
        self.lines.append(&passes);
        Ok(())
    }

    /// Places at equal distances over the aperture, edges included.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn places(&self, touch: &FirstTouch) -> Result<Vec<ProfilePlace>> {
        let subject = touch.subject();
        let (tool, part) = (&subject.tool, &subject.part);
        let mut passes: Vec<_> = self.lines.all().into_iter().flat_map(|(_, p)| p).collect();
        let mut passes: Vec<_> = passes.drain(..).copied().collect();
        sort(&mut passes);
        let mut arcs = Vec::new();
        lower_envelope(&passes, tool.nose_radius, tool.reach(), &mut arcs);
        let count = (PLACES_A_PASS * passes.len()).clamp(PLACES.0, PLACES.1);
        let rim = part.aperture_radius;
        let place = |i: usize| rim * (2.0 * i as f64 / count as f64 - 1.0);
        let s: Vec<f64> = (0..=count).map(place).collect();
        let (sin, cos) = Scalar::sin_cos(self.angle);
        let x: Vec<f64> = s.iter().map(|s| s * cos).collect();
        let y: Vec<f64> = s.iter().map(|s| s * sin).collect();
        let mut wanted = vec![f64::NAN; s.len()];
        subject.surface.heights(&x, &y, &mut wanted)?;
        let mut arcs = arcs.iter().peekable();
        let of_place = |(s, wanted): (&f64, f64)| {
            while arcs.next_if(|arc| arc.to < *s).is_some() {}
            let arc = arcs.peek().filter(|arc| arc.from <= *s);
            let arc = arc.filter(|_| s.abs() >= part.inner_radius);
            let machined = arc.map(|arc| lower_arc(arc.centre, tool.nose_radius, *s));
            ProfilePlace {
                s: *s,
                error: machined.unwrap_or(f64::NAN) - wanted,
                wanted,
            }
        };
        Ok(s.iter().zip(wanted).map(of_place).collect())
    }
}
