//! Cusps as played: the tips that neighbouring arcs of the machined profile leave between them.
//!
//! The residual ([`crate::residual`]) takes the nose at its true Z. Here it stands where it is
//! played. A pass that is played too high may cut nothing, so the tips are those of the envelope of
//! all passes of a line.

use turnpath_core::Result;
use turnpath_core::registers::{Loop, in_widest};

use super::pieces::Pieces;
use crate::closing::{self, SectionCusp};
use crate::cusp::Point;
use crate::lower_arc::lower_arc;
use crate::residual;
use crate::touch::FirstTouch;

/// Where the nose may leave seams, a cusp takes a search of its own. One line of so many is measured
/// there.
const SEAM_STRIDE: usize = 8;

/// The highest cusp of a machined surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighestCusp {
    /// Its height above the wanted surface along the profile's normal, mm; where the nose may leave
    /// seams, above the lowest surface that it can cut.
    pub height: f64,
    /// Angle of its section, rad.
    pub at_theta: f64,
    /// Its radius, mm.
    pub at_rho: f64,
}

/// The tips that the arcs of lines leave between passes that meet within the part. A tip that lies exactly on
/// its rim or on its hole is none.
pub(super) struct Tips<'a> {
    pub touch: &'a FirstTouch,
    /// Whether those between the passes of the two sides of the axis count.
    pub counts_centre: bool,
}

impl Tips<'_> {
    /// The highest cusp of a line by its number, once heights and slopes are looked up; `None` if there is
    /// no cusp.
    ///
    /// # Errors
    /// When the surface fails.
    pub fn highest(
        &self,
        number: usize,
        angle: f64,
        pieces: &Pieces,
    ) -> Result<Option<HighestCusp>> {
        match self.touch.leaves_seams() {
            false => self.highest_over_surface(angle, pieces),
            true if number.is_multiple_of(SEAM_STRIDE) => self.highest_over_closing(angle, pieces),
            true => Ok(None),
        }
    }

    /// The highest tip above the wanted surface. The height above the tangent at the tip's own radius
    /// picks it; its distance from the profile is the figure.
    fn highest_over_surface(&self, angle: f64, pieces: &Pieces) -> Result<Option<HighestCusp>> {
        let heights = self.heights_above_tangents(pieces);
        let counted = heights.iter().enumerate().filter(counts);
        let Some((piece, above_tangent)) = counted.max_by(|(_, a), (_, b)| a.total_cmp(b)) else {
            return Ok(None);
        };
        let (tip, _) = tip(pieces, piece);
        let surface = self.touch.subject().surface.as_ref();
        let (heights, feet) = residual::heights(surface, &[angle], &[tip])?;
        let exact = heights.into_iter().zip(feet).next();
        // Beyond the surface's end there is no foot.
        let (height, foot) = exact
            .filter(|(height, _)| height.is_finite())
            .unwrap_or((*above_tangent, tip.x));
        Ok(Some(HighestCusp::new(height, angle, foot)))
    }

    /// The highest tip above the closing.
    fn highest_over_closing(&self, angle: f64, pieces: &Pieces) -> Result<Option<HighestCusp>> {
        let cusp = |(piece, _): (usize, &f64)| {
            let (tip, [left, right]) = tip(pieces, piece);
            SectionCusp {
                theta: angle,
                tip,
                lower: left.x,
                upper: right.x,
                counts: true,
            }
        };
        let heights = self.heights_above_tangents(pieces);
        let counted = heights.iter().enumerate().filter(counts);
        let cusps: Vec<SectionCusp> = counted.map(cusp).collect();
        let heights = closing::heights(self.touch, &cusps)?;
        let measured = heights.into_iter().zip(&cusps);
        let highest = measured
            .filter(|(height, _)| height.is_finite())
            .max_by(|a, b| a.0.total_cmp(&b.0));
        Ok(highest.map(|(height, cusp)| HighestCusp::new(height, angle, cusp.tip.x)))
    }

    /// The height above its tangent of the tip at the left end of each piece, mm: [`NO_TIP`] where there
    /// is none, and where it does not count.
    fn heights_above_tangents(&self, pieces: &Pieces) -> Vec<f64> {
        let mut heights = vec![NO_TIP; pieces.centre_x.len()];
        in_widest(TipHeights {
            pieces,
            contact_leads: !self.touch.subject().compensates_nose,
            counts_centre: self.counts_centre,
            heights: &mut heights,
        });
        heights
    }
}

/// The height of what is no tip.
const NO_TIP: f64 = f64::NEG_INFINITY;

/// Whether a piece has a tip that counts at its left end. A height that is no number is that of a tip.
fn counts((_, height): &(usize, &f64)) -> bool {
    **height != NO_TIP
}

/// The loop that finds the heights of tips above tangents.
struct TipHeights<'a> {
    pieces: &'a Pieces,
    contact_leads: bool,
    counts_centre: bool,
    heights: &'a mut [f64],
}

impl Loop for TipHeights<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Pieces {
            radius,
            turned: (sin, cos),
            ..
        } = *self.pieces;
        for run in &self.pieces.runs {
            let joints = run.joints();
            let [s, z, zx, zy] = [
                &self.pieces.s[joints.clone()],
                &self.pieces.z[joints.clone()],
                &self.pieces.zx[joints.clone()],
                &self.pieces.zy[joints.clone()],
            ];
            let [x, y] = [
                &self.pieces.centre_x[run.first..run.first + run.pieces],
                &self.pieces.centre_y[run.first..run.first + run.pieces],
            ];
            let (next_x, next_y) = (&x[1..], &y[1..]);
            let heights = &mut self.heights[run.first + 1..run.first + run.pieces];
            for i in 0..heights.len() {
                let slope = zx[i] * cos + zy[i] * sin;
                let stretch = (1.0 + slope * slope).sqrt();
                let centres = [Point::new(x[i], y[i]), Point::new(next_x[i], next_y[i])];
                let above = (tip_height(centres, radius, s[i]) - z[i]) / stretch;
                // X of the path lies outward of the centre's, where it is that of the contact.
                let offset = match self.contact_leads {
                    true => radius * slope / stretch,
                    false => 0.0,
                };
                let spans_axis = (x[i] + offset < 0.0) & (next_x[i] + offset > 0.0);
                let is_tip = (x[i] != next_x[i]) | (y[i] != next_y[i]);
                let counts = is_tip & (self.counts_centre | !spans_axis);
                // What is no number comes last in the order of doubles, if its sign is positive.
                let above = if above.is_nan() { f64::NAN } else { above };
                heights[i] = if counts { above } else { NO_TIP };
            }
        }
    }
}

/// The height at `s` of the tip between two passes. Where the edge of one ends before their circles
/// cross, it is on the higher of both.
#[inline(always)]
fn tip_height(centres: [Point; 2], radius: f64, s: f64) -> f64 {
    let [left, right] = centres.map(|centre| lower_arc(centre, radius, s));
    left.max(right)
}

/// The tip at the left end of a piece, and the centres of the two passes that leave it.
fn tip(pieces: &Pieces, piece: usize) -> (Point, [Point; 2]) {
    let centres = [piece - 1, piece].map(|i| Point::new(pieces.centre_x[i], pieces.centre_y[i]));
    let s = pieces.s[pieces.left_end(piece)];
    let height = tip_height(centres, pieces.radius, s);
    (Point::new(s, height), centres)
}

impl HighestCusp {
    /// The highest of these; the first of several that are equally high.
    pub(super) fn of(each: Vec<Option<Self>>) -> Option<Self> {
        let higher = |one: Self, other: Self| match other.height > one.height {
            true => other,
            false => one,
        };
        each.into_iter().flatten().reduce(higher)
    }

    /// The cusp at a signed radius of a line.
    fn new(height: f64, angle: f64, s: f64) -> Self {
        let turned = match s < 0.0 {
            true => angle + std::f64::consts::PI,
            false => angle,
        };
        Self {
            height,
            at_theta: turned.rem_euclid(std::f64::consts::TAU),
            at_rho: s.abs(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Passes of a nose of 2 mm on a flat: from −1 on, with a gap before the last two. Their arcs are longer
    /// than a piece.
    fn pieces(slope: f64) -> Pieces {
        let mut pieces = Pieces {
            radius: 2.0,
            turned: (0.0, 1.0),
            ..Pieces::default()
        };
        for k in [-5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 20, 21] {
            let [from, to] = [k, k + 1].map(|k| 0.2 * f64::from(k));
            pieces.divide(Point::new(0.5 * (from + to), 2.0), from, to);
        }
        pieces.place_nodes();
        let of_nodes = |value: f64| vec![value; pieces.s.len()];
        (pieces.z, pieces.zx, pieces.zy) = (of_nodes(0.0), of_nodes(slope), of_nodes(0.0));
        pieces
    }

    /// Where tips are, with their heights.
    fn tips(pieces: &Pieces, contact_leads: bool, counts_centre: bool) -> Vec<(f64, f64)> {
        let mut heights = vec![NO_TIP; pieces.centre_x.len()];
        in_widest(TipHeights {
            pieces,
            contact_leads,
            counts_centre,
            heights: &mut heights,
        });
        let counted = heights.iter().enumerate().filter(counts);
        let tip_of = |(piece, height): (usize, &f64)| (tip(pieces, piece).0.x, *height);
        counted.map(tip_of).collect()
    }

    /// Not where an arc is divided, nor beside a gap.
    #[test]
    fn tips_are_where_two_passes_meet() {
        let pieces = pieces(0.0);
        assert!(pieces.centre_x.len() > 40 && pieces.runs.len() == 2);
        let found = tips(&pieces, false, true);
        let places = [-0.8, -0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6, 0.8, 4.2];
        assert_eq!(found.len(), places.len());
        let height = 2.0 - (4.0_f64 - 0.01).sqrt();
        for ((s, found), place) in found.iter().zip(places) {
            assert!(
                (s - place).abs() < 1e-12 && (found - height).abs() < 1e-12,
                "{s} {found}"
            );
        }
    }

    /// On a slope of 0.075 the path of the contact lies 0.15 mm outward of the centres, so that its two
    /// sides meet at another tip.
    #[test]
    fn the_tip_between_the_two_sides_is_where_x_of_the_path_changes_its_sign() {
        let missing = |slope: f64, contact_leads: bool| -> Vec<f64> {
            let pieces = pieces(slope);
            let (all, counted) = (
                tips(&pieces, contact_leads, true),
                tips(&pieces, contact_leads, false),
            );
            let left_out = all.iter().filter(|tip| !counted.contains(tip));
            left_out
                .map(|(s, _)| (s * 1e6).round() / 1e6 + 0.0)
                .collect()
        };
        assert_eq!(missing(0.0, false), [0.0]);
        assert_eq!(missing(0.075, false), [0.0]);
        assert_eq!(missing(0.075, true), [-0.2]);
        assert_eq!(missing(-0.075, true), [0.2]);
    }

    /// Nothing is known about such a cusp, whatever the sign of what is no number.
    #[test]
    fn a_tip_without_a_slope_counts_as_the_highest() {
        for unknown in [f64::NAN, -f64::NAN] {
            let mut pieces = pieces(0.0);
            let joint = pieces.runs[0]
                .joints()
                .find(|end| (pieces.s[*end] - 0.4).abs() < 1e-9);
            pieces.zx[joint.unwrap()] = unknown;
            let found = tips(&pieces, false, false);
            assert_eq!(found.len(), 9);
            let highest = found.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
            assert!(highest.1.is_nan() && (highest.0 - 0.4).abs() < 1e-12);
        }
    }
}
