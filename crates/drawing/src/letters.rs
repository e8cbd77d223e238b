//! Text as outlines of the font that is part of this crate.

use std::sync::LazyLock;

use ttf_parser::{Face, OutlineBuilder};

use crate::colours::BLACK;
use crate::shape::{Ink, Place, Shape, Step};

/// A part of DejaVu Sans, see `assets/text.LICENSE`; `assets/subset.py` makes it.
const FONT: &[u8] = include_bytes!("../assets/text.ttf");
/// The height of capitals, as a share of the size.
const CAPITALS: f64 = 0.729;
/// What stands for a character that the font does not have.
const UNKNOWN: char = '?';

static FACE: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(FONT, 0).ok());

/// Where a text stands about its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// To the right of it, with the middle of its capitals there.
    Left,
    /// To the left of it, likewise.
    Right,
    /// Around it, on its base line.
    Above,
    /// Around it, with the tops of its capitals there.
    Below,
}

/// A text about a place, in letters of a size in mm.
pub fn text(text: &str, place: Place, anchor: Anchor, size: f64) -> Shape {
    let width = width(text, size);
    let capitals = CAPITALS * size;
    let [x, y] = place;
    let [x, y] = match anchor {
        Anchor::Left => [x, y + capitals / 2.0],
        Anchor::Right => [x - width, y + capitals / 2.0],
        Anchor::Above => [x - width / 2.0, y],
        Anchor::Below => [x - width / 2.0, y + capitals],
    };
    letters(text, size, |[right, up]| [x + right, y - up])
}

/// A text that runs upwards, with its middle and its base line at a place.
pub fn upward_text(text: &str, place: Place, size: f64) -> Shape {
    let half = width(text, size) / 2.0;
    let [x, y] = place;
    letters(text, size, |[right, up]| [x - up, y + half - right])
}

/// The width of a text, mm.
pub fn width(text: &str, size: f64) -> f64 {
    let advances = glyphs(text).map(|glyph| glyph.advance);
    size * advances.sum::<f64>()
}

/// A glyph, with its advance as a share of the size.
struct Glyph {
    id: ttf_parser::GlyphId,
    advance: f64,
    per_em: f64,
}

fn glyphs(text: &str) -> impl Iterator<Item = Glyph> {
    let face = FACE.as_ref();
    text.chars().filter_map(move |c| {
        let face = face?;
        let id = face.glyph_index(c).or_else(|| face.glyph_index(UNKNOWN))?;
        let per_em = f64::from(face.units_per_em());
        let advance = f64::from(face.glyph_hor_advance(id)?) / per_em;
        Some(Glyph {
            id,
            advance,
            per_em,
        })
    })
}

/// The outlines of a text whose base line begins at the origin, brought to their place.
fn letters(text: &str, size: f64, to_place: impl Fn(Place) -> Place) -> Shape {
    let mut steps = Vec::new();
    let mut at = 0.0;
    for glyph in glyphs(text) {
        let mut pen = Pen {
            steps: &mut steps,
            to_place: |[right, up]: Place| {
                to_place([at + right * size / glyph.per_em, up * size / glyph.per_em])
            },
        };
        if let Some(face) = FACE.as_ref() {
            face.outline_glyph(glyph.id, &mut pen);
        }
        at += glyph.advance * size;
    }
    let letters = Shape::Outline {
        steps,
        ink: Ink::Fill,
        colour: BLACK,
        label: None,
    };
    letters.labelled(text)
}

/// Draws a glyph as steps of an outline.
struct Pen<'a, F> {
    steps: &'a mut Vec<Step>,
    to_place: F,
}

impl<F: Fn(Place) -> Place> Pen<'_, F> {
    fn place(&self, x: f32, y: f32) -> Place {
        (self.to_place)([f64::from(x), f64::from(y)])
    }
}

impl<F: Fn(Place) -> Place> OutlineBuilder for Pen<'_, F> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.steps.push(Step::Move(self.place(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.steps.push(Step::Line(self.place(x, y)));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let step = Step::Curve(self.place(x1, y1), self.place(x, y));
        self.steps.push(step);
    }

    fn curve_to(&mut self, _: f32, _: f32, _: f32, _: f32, x: f32, y: f32) {
        // The outlines of a font of this kind are quadratic.
        self.line_to(x, y);
    }

    fn close(&mut self) {
        self.steps.push(Step::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(shape: &Shape) -> Vec<Place> {
        let Shape::Outline { steps, .. } = shape else {
            panic!("no outline");
        };
        let place = |step: &Step| match step {
            Step::Move(place) | Step::Line(place) | Step::Curve(_, place) => Some(*place),
            Step::Close => None,
        };
        steps.iter().filter_map(place).collect()
    }

    #[test]
    fn the_font_has_all_signs_of_titles() {
        let face = FACE.as_ref().unwrap();
        for c in "|played − true| / 10⁻³ µm·mm/s² …°ρ≤".chars() {
            assert!(face.glyph_index(c).is_some(), "{c}");
        }
        assert_eq!(FACE.as_ref().unwrap().glyph_index('漢'), None);
        assert!(width("漢", 1.0) > 0.0, "a question mark stands for it");
    }

    #[test]
    fn capitals_are_as_high_as_said_and_lie_where_they_are_placed() {
        // The letter H has no round parts that stand over.
        for (anchor, top) in [
            (Anchor::Left, 10.0 - 0.3645 * 4.0),
            (Anchor::Below, 10.0),
            (Anchor::Above, 10.0 - 0.729 * 4.0),
        ] {
            let places = places(&text("H", [5.0, 10.0], anchor, 4.0));
            let highest = places.iter().map(|[_, y]| *y).fold(f64::MAX, f64::min);
            assert!((highest - top).abs() < 1e-3 * 4.0, "{anchor:?}: {highest}");
        }
    }

    #[test]
    fn an_upward_text_goes_up() {
        let places = places(&upward_text("HHHH", [5.0, 10.0], 4.0));
        let range = |axis: usize| {
            let all = places.iter().map(|place| place[axis]);
            all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
        };
        assert!(range(1) > 3.0 * range(0));
    }
}
