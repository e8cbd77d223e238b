//! The machined profile along one line, in pieces that a cubic describes.

use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::{Gradients, Part, Result, Scalar, SurfaceModel};

use super::envelope::{Arc, Envelope};
use super::lines::Line;
use super::no_height::no_height;
use super::pieces::Pieces;
use super::samples::Samples;
use crate::cusp::Point;
use crate::subject::Subject;

/// All signed positions on a line.
pub(super) const EVERYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// The machined profile along one line. Its memory is used again for the next line.
#[derive(Default)]
pub(super) struct Strip {
    passes: Vec<Point>,
    envelope: Envelope,
    pieces: Pieces,
}

impl Strip {
    /// Sets the line: divides its envelope over the part into pieces.
    pub fn set_line(&mut self, subject: &Subject, line: &Line<'_>) {
        self.set_line_within(subject, line, &[EVERYWHERE]);
    }

    /// The same where only some intervals of signed positions count, mm.
    pub fn set_line_within(&mut self, subject: &Subject, line: &Line<'_>, spans: &[(f64, f64)]) {
        let tool = &subject.tool;
        line.sort_into(&mut self.passes);
        let Self {
            passes,
            envelope,
            pieces,
        } = self;
        envelope.set(passes, tool.nose_radius, tool.reach());
        pieces.radius = tool.nose_radius;
        pieces.turned = Scalar::sin_cos(line.angle);
        pieces.clear();
        divide_arcs(envelope.arcs(), &subject.part, spans, pieces);
        pieces.place_nodes();
    }

    /// Its pieces.
    pub fn pieces(&self) -> &Pieces {
        &self.pieces
    }

    /// Looks up wanted heights and slopes.
    pub fn look_up(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        let pieces = &mut self.pieces;
        for column in [&mut pieces.z, &mut pieces.zx, &mut pieces.zy] {
            column.resize(pieces.x.len(), 0.0);
        }
        let out = Gradients {
            z: &mut pieces.z,
            zx: &mut pieces.zx,
            zy: &mut pieces.zy,
        };
        surface.gradient(&pieces.x, &pieces.y, out)?;
        self.check_heights()
    }

    /// Looks up wanted heights alone.
    pub fn look_up_heights(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        let pieces = &mut self.pieces;
        pieces.z.resize(pieces.x.len(), 0.0);
        surface.heights(&pieces.x, &pieces.y, &mut pieces.z)?;
        self.check_heights()
    }

    /// Refuses a surface that has no height at one of the nodes.
    fn check_heights(&self) -> Result<()> {
        let Pieces { s, x, y, z, .. } = &self.pieces;
        // Without a way out of the loop it goes through vector registers.
        if z.iter().fold(true, |all, z| all & z.is_finite()) {
            return Ok(());
        }
        let unknown = (0..z.len()).filter(|node| !z[*node].is_finite());
        match unknown.min_by(|one, other| s[*one].total_cmp(&s[*other])) {
            Some(leftmost) => Err(no_height(x[leftmost], y[leftmost])),
            None => Ok(()),
        }
    }

    /// The integral of |error − mean| along the line, weighted by area.
    pub fn amount_about(&self, mean: f64) -> f64 {
        in_widest(Amounts(&self.pieces, mean))
    }
}

/// Divides the arcs on the part and within `spans` into pieces.
fn divide_arcs(mut arcs: &[Arc], part: &Part, spans: &[(f64, f64)], pieces: &mut Pieces) {
    let counts_everywhere = *spans == [EVERYWHERE];
    while let [arc, rest @ ..] = arcs {
        let whole = match counts_everywhere {
            true => whole_arcs(part, arcs, pieces),
            false => 0,
        };
        if whole > 0 {
            let (whole, rest) = arcs.split_at(whole);
            pieces.add_whole(whole);
            arcs = rest;
            continue;
        }
        for (from, to) in on_part(arc, part, spans) {
            pieces.divide(arc.centre, from, to);
        }
        arcs = rest;
    }
}

/// How many of these arcs, from the first on, meet each other, lie on one side of the part, and are one
/// piece each. Nearly all arcs do. An arc of the envelope is never empty.
fn whole_arcs(part: &Part, arcs: &[Arc], pieces: &Pieces) -> usize {
    let (rim, hole) = (part.aperture_radius, part.inner_radius);
    let mut end = arcs.first().map(|arc| arc.from);
    let is_whole = |arc: &&Arc| {
        let on_right = hole <= arc.from && arc.to <= rim;
        let on_left = -rim <= arc.from && arc.to <= -hole;
        let meets = end.replace(arc.to) == Some(arc.from);
        meets && (on_left || on_right) && pieces.takes_whole(arc)
    };
    arcs.iter().take_while(is_whole).count()
}

/// The loop that sums up the amounts of a line's pieces.
struct Amounts<'a>(&'a Pieces, f64);

impl Loop for Amounts<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self(pieces, mean) = self;
        let mut sum = 0.0;
        let mut samples = Samples::blank();
        for group in pieces.groups() {
            group.sample(&mut samples);
            let amounts = samples.amounts_about(mean);
            for amount in amounts.iter().take(samples.count) {
                sum += amount;
            }
        }
        sum
    }
}

/// The intervals of an arc that lie on the part, on either side of the hole or of the axis, and
/// within `spans`.
pub(super) fn on_part<'a>(
    arc: &Arc,
    part: &Part,
    spans: &'a [(f64, f64)],
) -> impl Iterator<Item = (f64, f64)> + use<'a> {
    let (rim, hole) = (part.aperture_radius, part.inner_radius);
    let (from, to) = (arc.from, arc.to);
    let sides = [(-rim, -hole), (hole, rim)].into_iter();
    let within = move |(left, right): (f64, f64)| {
        let spans = spans.iter();
        spans.map(move |span| (left.max(span.0), right.min(span.1)))
    };
    sides
        .flat_map(within)
        .map(move |(left, right)| (from.max(left), to.min(right)))
        .filter(|(from, to)| from < to)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use turnpath_core::{Misfit, Surface, Tool};

    use super::*;
    use crate::machined::lines::Lines;

    struct Flat;

    impl Surface for Flat {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, _: S) -> S {
            x * 0.0
        }
    }

    /// An arc on one side of the part goes a shorter way, if all of the line counts.
    #[test]
    fn a_line_has_the_same_pieces_whether_or_not_its_arcs_are_cut_at_borders() {
        let tool = Tool {
            nose_radius: 2.0,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        };
        // Passes on both sides, from beyond the rim to the axis, some of them without a neighbour.
        let passes = |step: f64| -> Vec<Point> {
            let places = (-80..=80).filter(|k| k % 13 != 0);
            let pass = |k: i32| Point::new(step * f64::from(k), 2.0 + 1e-4 * f64::from(k % 5));
            places.map(pass).collect()
        };
        for (inner_radius, step) in [(0.0, 0.1), (0.0, 0.0625), (1.5, 0.1), (0.31, 0.07)] {
            let subject = Subject {
                surface: Arc::new(Flat),
                part: Part {
                    aperture_radius: 5.0,
                    inner_radius,
                },
                tool,
                compensates_nose: true,
            };
            let of_line = |span: (f64, f64)| {
                let mut strip = Strip::default();
                let lines = Lines::of_line(0.7, &passes(step));
                strip.set_line_within(&subject, &lines.all()[0], &[span]);
                let pieces = &strip.pieces;
                let bits = |column: &[f64]| -> Vec<u64> {
                    column.iter().map(|number| number.to_bits()).collect()
                };
                let ends = (0..pieces.centre_x.len()).map(|piece| pieces.left_end(piece));
                let columns = [&pieces.s, &pieces.centre_x, &pieces.centre_y].map(|c| bits(c));
                (columns, ends.collect::<Vec<_>>())
            };
            let whole = of_line(EVERYWHERE);
            assert!(whole.1.len() > 100);
            assert_eq!(whole, of_line((-1e300, 1e300)), "{inner_radius} {step}");
        }
    }
}
