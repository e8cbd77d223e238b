//! Which passes cut an edge of the part between two sections.
//!
//! Where the slope of the surface changes along an edge, so does the X from which the nose touches
//! the edge. Between two sections it may move by many feeds. Then the passes that are the nearest on
//! these two sections are not those that are the nearest between them.

use std::f64::consts::TAU;

use turnpath_core::Result;

use crate::profiles::Profiles;
use crate::residual::{Passes, SECTIONS};
use crate::touch::FirstTouch;

/// Sections of a revolution.
const TURN: usize = SECTIONS as usize;
/// Parts of a section: a wave with 72 periods on a revolution gets 40 of them a period.
const PARTS: usize = 8;
/// A pass counts where it comes as near as this part of its feed. The nearest of all passes is never
/// farther off than half a feed; the rest is for passes that are not even.
const NEAR: f64 = 0.75;

/// A pass on one half of its line through the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PassNumber {
    /// The number of the section on which the path makes it.
    pub number: i64,
    /// Whether it is seen from the opposite half.
    pub mirrored: bool,
}

impl PassNumber {
    /// The section of the turn that it cuts.
    pub fn section(self) -> usize {
        let section = match self.mirrored {
            false => self.number,
            true => self.number + SECTIONS / 2,
        };
        section.rem_euclid(SECTIONS) as usize
    }
}

/// From where the nose touches one edge of the part.
pub(crate) struct EdgeCrossings {
    /// X of the nose centre, mm, on each part of each section; it goes on with the first one.
    touching: Vec<f64>,
}

impl EdgeCrossings {
    /// From where the nose touches the part at this radius, mm.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn new(touch: &FirstTouch, radius: f64) -> Result<Self> {
        let subject = touch.subject();
        let step = TAU / (TURN * PARTS) as f64;
        let theta: Vec<f64> = (0..TURN * PARTS).map(|i| i as f64 * step).collect();
        let mut profiles = Profiles::new(subject.surface.as_ref(), &theta);
        profiles.at_all(&vec![radius; theta.len()])?;
        let (nose, reach) = (subject.tool.nose_radius, subject.tool.reach());
        let touching = profiles.slope.iter().map(|slope| {
            let off = nose * slope / (1.0 + slope * slope).sqrt();
            radius - off.clamp(-reach, reach)
        });
        Ok(Self {
            touching: touching.collect(),
        })
    }

    /// The passes that cut the edge between their own section and the next one. What lies before the
    /// first section of the passes belongs to the section before.
    pub fn of(&self, passes: &Passes) -> Vec<PassNumber> {
        let centres: Vec<f64> = passes.passes.iter().map(|pass| pass.centre.x).collect();
        let Some(first) = centres.first() else {
            return Vec::new();
        };
        let rate = centres.get(1).map_or(0.0, |second| second - first);
        let before = (passes.first - 1, [first - rate, *first], feed(&centres, 0));
        let mut ways = vec![before];
        for ((index, number), x) in (passes.first..).enumerate().zip(&centres) {
            // Behind the last section X goes on as before it.
            let last = index.checked_sub(1).and_then(|before| centres.get(before));
            let next = centres.get(index + 1).copied();
            let next = next.unwrap_or_else(|| last.map_or(*x, |last| 2.0 * x - last));
            ways.push((number, [*x, next], feed(&centres, index)));
        }
        let mut found = Vec::new();
        for (number, [from, to], feed) in ways {
            let near = NEAR * feed;
            let own = PassNumber {
                number,
                mirrored: false,
            };
            let opposite = PassNumber {
                mirrored: true,
                ..own
            };
            if self.crosses(own.section(), [from, to], near) {
                found.push(own);
            }
            if self.crosses(opposite.section(), [-from, -to], near) {
                found.push(opposite);
            }
        }
        found
    }

    /// Whether the way from one X on a section to another on the next comes as near to the edge as
    /// this.
    fn crosses(&self, section: usize, [from, to]: [f64; 2], near: f64) -> bool {
        let off = |part: usize| {
            let at = (section * PARTS + part) % self.touching.len();
            let way = part as f64 / PARTS as f64;
            self.touching
                .get(at)
                .map(|touching| from + way * (to - from) - touching)
        };
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for off in (0..=PARTS).filter_map(off) {
            (least, most) = (least.min(off), most.max(off));
        }
        least <= near && most >= -near
    }
}

/// The larger distance of a pass from those a turn before and a turn behind it; 0 where there are
/// none.
fn feed(centres: &[f64], index: usize) -> f64 {
    let own = centres.get(index);
    let turns = [index.checked_sub(TURN), index.checked_add(TURN)];
    let others = turns.into_iter().flatten().filter_map(|at| centres.get(at));
    let distances = others.filter_map(|other| own.map(|own| (own - other).abs()));
    distances.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// X that touches the edge moves by two and a half feeds within the section 7: of the passes on
    /// it and on the next section, those between count too, and none that is far off.
    #[test]
    fn all_passes_count_that_cut_the_edge_between_two_sections() {
        let mut touching = vec![5.0; TURN * PARTS];
        for part in 0..=PARTS {
            touching[7 * PARTS + part] = 5.0 + 0.25 * part as f64 / PARTS as f64;
        }
        let crossings = EdgeCrossings { touching };
        let counts = |x: f64| crossings.crosses(7, [x, x], 0.0);
        let found: Vec<bool> = (0..7).map(|k| counts(4.9 + 0.1 * f64::from(k))).collect();
        assert_eq!(found, [false, true, true, true, false, false, false]);
        // Half a feed beside the way is near enough.
        assert!(crossings.crosses(7, [4.95; 2], 0.05001) && !crossings.crosses(6, [5.2; 2], 0.1));
        // A pass that moves with the edge cuts it nowhere.
        assert!(!crossings.crosses(7, [5.1, 5.35], 0.0));
    }

    #[test]
    fn a_feed_is_the_distance_to_the_neighbours_at_the_same_angle() {
        let centres: Vec<f64> = (0..3 * TURN).map(|i| -1e-3 * i as f64).collect();
        for index in [0, TURN, 2 * TURN + 5] {
            assert!((feed(&centres, index) - 0.36).abs() < 1e-12);
        }
        assert_eq!(feed(&[1.0, 2.0], 1), 0.0);
    }
}
