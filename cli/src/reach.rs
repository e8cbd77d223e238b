//! Whether a path covers the part, from its hole or its axis to its rim.

use serde::Serialize;
use turnpath_core::{Part, Radial, RadialRange};

use crate::figures::{self, millimetres};

/// By how much a path may end short of the part's edges, mm. A file's digits cost 1e-7 mm and the
/// search for the contact less; a turn that is missing costs a feed, some micrometres at least.
const SHORT: f64 = 1e-3;

/// From where to where a path runs.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Reach {
    inner: f64,
    outer: f64,
}

impl Reach {
    /// What was measured, in mm.
    pub fn new(range: RadialRange) -> Self {
        let RadialRange { inner, outer } = range;
        Self { inner, outer }
    }

    /// Whether it reaches both edges of the part.
    pub fn covers(&self, part: &Part) -> bool {
        self.outer >= part.aperture_radius - SHORT && self.inner <= part.inner_radius + SHORT
    }

    /// The line for a person.
    pub fn line(&self, radial: Radial, part: &Part) -> String {
        let what = match radial {
            Radial::Centre => "X or contact",
            Radial::Contact => "contact",
        };
        let verdict = if self.covers(part) {
            "holds".to_owned()
        } else {
            let whole = from_to(part.inner_radius, part.aperture_radius);
            format!("EXCEEDED: the part reaches {whole}")
        };
        let reach = from_to(self.inner, self.outer);
        figures::line("reach", format!("{what} {reach}; {verdict}"))
    }
}

fn from_to(inner: f64, outer: f64) -> String {
    let (inner, outer) = (millimetres(inner, 3), millimetres(outer, 3));
    format!("from {inner} to {outer}")
}

#[cfg(test)]
mod tests {
    use super::*;

    const RING: Part = Part {
        aperture_radius: 10.0,
        inner_radius: 2.0,
    };

    fn reach(inner: f64, outer: f64) -> Reach {
        Reach::new(RadialRange { inner, outer })
    }

    #[test]
    fn a_path_covers_a_part_whose_both_edges_it_reaches() {
        assert!(reach(2.0, 10.0).covers(&RING));
        assert!(reach(0.0, 11.0).covers(&RING));
        assert!(reach(2.000_000_1, 9.999_999_9).covers(&RING));
        assert!(!reach(2.0, 9.99).covers(&RING));
        assert!(!reach(2.01, 10.0).covers(&RING));
        assert!(!reach(f64::NAN, 10.0).covers(&RING));
    }

    #[test]
    fn a_person_is_told_what_is_missing() {
        assert_eq!(
            reach(2.0, 2.5).line(Radial::Centre, &RING),
            "  reach           X or contact from 2.000 mm to 2.500 mm; EXCEEDED: the part reaches from \
             2.000 mm to 10.000 mm\n"
        );
        assert_eq!(
            reach(2.0, 10.0).line(Radial::Contact, &RING),
            "  reach           contact from 2.000 mm to 10.000 mm; holds\n"
        );
    }
}
