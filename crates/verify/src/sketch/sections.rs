//! The highest cusp on each radial section.

use std::f64::consts::TAU;

use crate::residual::{ResidualFigures, SECTIONS};

/// The highest cusp on each section of the residual.
#[derive(Debug, Clone, Default)]
pub struct SectionHeights {
    /// Empty before the first cusp; not a number on a section without one.
    heights: Vec<f64>,
}

impl SectionHeights {
    /// Includes one cusp.
    pub(crate) fn include(&mut self, cusp: &ResidualFigures) {
        let number = (cusp.at_theta / TAU * SECTIONS as f64).round() as i64;
        self.include_height(number.rem_euclid(SECTIONS) as usize, cusp.max);
    }

    fn include_height(&mut self, section: usize, height: f64) {
        if self.heights.is_empty() {
            self.heights.resize(SECTIONS as usize, f64::NAN);
        }
        if let Some(highest) = self.heights.get_mut(section) {
            *highest = highest.max(height);
        }
    }

    /// Appends those of the path's next block.
    pub(crate) fn append(&mut self, next: &Self) {
        for (section, height) in next.heights.iter().enumerate() {
            self.include_height(section, *height);
        }
    }

    /// The height on each section, mm, from C = 0 on; empty where there is no cusp.
    pub fn heights(&self) -> Vec<f64> {
        self.heights.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cusp(degrees: f64, max: f64) -> ResidualFigures {
        ResidualFigures {
            max,
            at_theta: degrees.to_radians(),
            cusps: 1,
            ..ResidualFigures::default()
        }
    }

    fn of(cusps: &[ResidualFigures]) -> SectionHeights {
        let mut sections = SectionHeights::default();
        cusps.iter().for_each(|cusp| sections.include(cusp));
        sections
    }

    #[test]
    fn each_section_keeps_its_highest_cusp_and_the_others_have_none() {
        let mut sections = of(&[cusp(0.0, 2.0), cusp(359.0, 1.0)]);
        sections.append(&of(&[cusp(359.0, 3.0), cusp(0.0, 1.0)]));
        sections.append(&SectionHeights::default());
        let heights = sections.heights();
        assert_eq!((heights[0], heights[359]), (2.0, 3.0));
        assert_eq!(heights.iter().filter(|height| height.is_nan()).count(), 358);
        assert!(SectionHeights::default().heights().is_empty());
    }
}
