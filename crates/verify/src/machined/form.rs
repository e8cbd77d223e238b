//! The form of the machined surface: how far it lies above and below what the tool can cut.
//!
//! The form is machined − wanted along z, with two exceptions. Where the nose does not fit, the
//! closing takes the place of the wanted surface. Where the path does not cover the part, only what
//! lies between the contacts of its outermost passes counts: beyond them stands the flank of the
//! last pass.
//!
//! Over the closing the extremes follow from the passes alone. Let pass k leave an arc of the
//! machined profile, and let e be the height of its nose above its first touch. The closing is the
//! lower envelope of all noses at their first touch. So the arc lies e above the closing where the
//! nose touches, and the distance grows to both sides, since noses further away are steeper there.
//! The highest points are therefore the ends of the arcs, and the lowest are the errors of the
//! passes.

use rayon::prelude::*;
use turnpath_core::registers::{Loop, in_widest};
use turnpath_core::{Result, Scalar};

use super::envelope::{Arc, lower_envelope};
use super::extremes::{LineExtremes, PartPoint, SurfaceExtremes};
use super::lines::{Line, Lines};
use super::no_height::no_height;
use super::pieces::Pieces;
use super::samples::Samples;
use super::strip::{EVERYWHERE, Strip, on_part};
use crate::closing;
use crate::lower_arc::lower_arc;
use crate::order::in_order;
use crate::touch::FirstTouch;

/// Ends of arcs that are held against the closing in one batch.
const BATCH: usize = 64;
/// Batches in one go: enough for every thread. The highest point so far ends the search between two
/// goes.
const GO: usize = 16;

/// Which part of the machined surface counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormScope {
    /// Whether the path covers the part up to its edges.
    pub covers_part: bool,
    /// Whether the path covers the axis.
    pub covers_centre: bool,
}

/// An end of an arc.
#[derive(Debug, Clone, Copy)]
struct ArcEnd {
    angle: f64,
    s: f64,
    z: f64,
    /// Height above the wanted surface, mm. It is at least that above the closing.
    above: f64,
}

impl Lines {
    /// The form of the part; `None` if nothing of the part was cut, or where it is no number.
    ///
    /// # Errors
    /// When the surface fails or has no height at a place that was cut.
    pub fn form(&self, touch: &FirstTouch, scope: FormScope) -> Result<Option<SurfaceExtremes>> {
        // A nose that no compensator fits to the surface is held to the surface itself.
        let form = match touch.leaves_seams() && touch.subject().compensates_nose {
            false => self.over_surface(touch, scope),
            true => self.over_closing(touch, scope),
        };
        Ok(form?.filter(|form| form.pv().is_finite()))
    }

    fn over_surface(
        &self,
        touch: &FirstTouch,
        scope: FormScope,
    ) -> Result<Option<SurfaceExtremes>> {
        let subject = touch.subject();
        let of_line = |strip: &mut Strip, line: &Line<'_>| {
            let spans = spans(touch, scope, line)?;
            strip.set_line_within(subject, line, &spans);
            strip.look_up_heights(subject.surface.as_ref())?;
            Ok(in_widest(ErrorExtremes(strip.pieces())))
        };
        let lines = self.all();
        let each = in_order(lines.par_iter().map_init(Strip::default, of_line))?;
        let angles = lines.iter().map(|line| line.angle);
        Ok(SurfaceExtremes::over(angles.zip(&each)))
    }

    fn over_closing(
        &self,
        touch: &FirstTouch,
        scope: FormScope,
    ) -> Result<Option<SurfaceExtremes>> {
        let lines = self.all();
        let of_line = |line: &Line<'_>| ends_and_errors(touch, scope, line);
        let each = in_order(lines.par_iter().map(of_line))?;
        let angles = lines.iter().map(|line| line.angle);
        let errors = each.iter().map(|(_, errors)| errors);
        let Some(form) = SurfaceExtremes::over(angles.zip(errors)) else {
            return Ok(None);
        };
        let ends = each.into_iter().flat_map(|(ends, _)| ends).collect();
        let highest = highest_over_closing(touch, ends, form.highest)?;
        Ok(Some(SurfaceExtremes { highest, ..form }))
    }
}

/// The loop that looks for the extremes of a line.
struct ErrorExtremes<'a>(&'a Pieces);

impl Loop for ErrorExtremes<'_> {
    type Output = LineExtremes;

    #[inline(always)]
    fn call(self) -> LineExtremes {
        let Self(pieces) = self;
        let mut found = LineExtremes::default();
        let mut samples = Samples::blank();
        for group in pieces.groups() {
            group.sample(&mut samples);
            found.include_samples(&samples);
        }
        found
    }
}

/// The ends of a line's arcs, and the errors of the passes that leave them.
fn ends_and_errors(
    touch: &FirstTouch,
    scope: FormScope,
    line: &Line<'_>,
) -> Result<(Vec<ArcEnd>, LineExtremes)> {
    let subject = touch.subject();
    let (tool, part) = (&subject.tool, &subject.part);
    let angle = line.angle;
    let spans = spans(touch, scope, line)?;
    let mut sorted = Vec::new();
    line.sort_into(&mut sorted);
    let arcs = lower_envelope(&sorted, tool.nose_radius, tool.reach());
    let counts = |s: f64| {
        let on_part = (part.inner_radius..=part.aperture_radius).contains(&s.abs());
        on_part && spans.iter().any(|(from, to)| (*from..=*to).contains(&s))
    };
    let (at, x): (Vec<f64>, Vec<f64>) = arcs.iter().map(|arc| (angle, arc.centre.x)).unzip();
    let mut touches = Vec::new();
    touch.find(&at, &x, &mut touches)?;
    let mut errors = LineExtremes::default();
    for (arc, touch) in arcs.iter().zip(&touches) {
        // What is cut by a nose that touches nothing has no known error.
        let on_part = on_part(arc, part, &spans).next();
        match on_part.filter(|_| touch.foot.is_nan()) {
            Some((from, _)) => errors.include(f64::NAN, from),
            None if counts(touch.foot) => errors.include(arc.centre.y - touch.z, touch.foot),
            None => {}
        }
    }
    Ok((ends(touch, angle, &arcs, &spans)?, errors))
}

/// The ends of a line's arcs on the part and within the spans.
fn ends(touch: &FirstTouch, angle: f64, arcs: &[Arc], spans: &[(f64, f64)]) -> Result<Vec<ArcEnd>> {
    let subject = touch.subject();
    let radius = subject.tool.nose_radius;
    let mut ends: Vec<ArcEnd> = Vec::new();
    for arc in arcs {
        for (from, to) in on_part(arc, &subject.part, spans) {
            ends.extend([from, to].map(|s| ArcEnd {
                angle,
                s,
                z: lower_arc(arc.centre, radius, s),
                above: f64::NAN,
            }));
        }
    }
    let (sin, cos) = Scalar::sin_cos(angle);
    let x: Vec<f64> = ends.iter().map(|end| end.s * cos).collect();
    let y: Vec<f64> = ends.iter().map(|end| end.s * sin).collect();
    let mut wanted = vec![f64::NAN; ends.len()];
    subject.surface.heights(&x, &y, &mut wanted)?;
    for (i, (end, wanted)) in ends.iter_mut().zip(wanted).enumerate() {
        if !wanted.is_finite() {
            return Err(no_height(x[i], y[i]));
        }
        end.above = end.z - wanted;
    }
    Ok(ends)
}

/// The highest end over the closing, or `known` where that is higher. Ends are looked at from the
/// highest above the surface on; none of the rest can be higher over the closing.
fn highest_over_closing(
    touch: &FirstTouch,
    mut ends: Vec<ArcEnd>,
    known: PartPoint,
) -> Result<PartPoint> {
    ends.sort_by(|a, b| b.above.total_cmp(&a.above));
    let mut highest = known;
    for go in ends.chunks(GO * BATCH) {
        if go.first().is_none_or(|first| first.above <= highest.error) {
            break;
        }
        let heights = in_order(go.par_chunks(BATCH).map(|batch| {
            let angles: Vec<f64> = batch.iter().map(|end| end.angle).collect();
            let places: Vec<f64> = batch.iter().map(|end| end.s).collect();
            closing::at(touch, &angles, &places)
        }))?;
        for (end, closing) in go.iter().zip(heights.iter().flatten()) {
            // At the surface's end the closing may be unknown, and is no lower than the surface.
            let above = match closing.is_finite() {
                true => end.z - closing,
                false => end.above,
            };
            if above > highest.error {
                highest = PartPoint::on_line(end.angle, end.s, above);
            }
        }
    }
    Ok(highest)
}

/// Between which signed positions a line counts, mm: everywhere if the path covers the part, else
/// between the contacts of its outermost passes. If the path does not cover the axis, what lies
/// between the innermost contacts of both sides does not count either.
fn spans(touch: &FirstTouch, scope: FormScope, line: &Line<'_>) -> Result<Vec<(f64, f64)>> {
    if scope.covers_part {
        return Ok(vec![EVERYWHERE]);
    }
    let in_two = !scope.covers_centre || touch.subject().part.inner_radius > 0.0;
    let mut sorted = Vec::new();
    line.sort_into(&mut sorted);
    let is_left = |s: &f64| *s < 0.0;
    let (left, right): (Vec<f64>, Vec<f64>) = sorted.iter().map(|pass| pass.x).partition(is_left);
    let sides = match in_two {
        true => vec![left, right],
        false => vec![[left, right].concat()],
    };
    let mut spans = Vec::new();
    for side in &sides {
        let from = first_contact(touch, line.angle, side.iter())?;
        let to = first_contact(touch, line.angle, side.iter().rev())?;
        spans.extend(from.zip(to));
    }
    Ok(spans)
}

/// The contact of the first of these passes that has one, mm; `None` where none has. Beyond the
/// surface a nose may touch nothing.
fn first_contact<'a>(
    touch: &FirstTouch,
    angle: f64,
    passes: impl Iterator<Item = &'a f64>,
) -> Result<Option<f64>> {
    for pass in passes {
        let mut touches = Vec::new();
        touch.find(&[angle], &[*pass], &mut touches)?;
        let foot = touches.first().map(|touch| touch.foot);
        if let Some(foot) = foot.filter(|foot| foot.is_finite()) {
            return Ok(Some(foot));
        }
    }
    Ok(None)
}
