//! A frame with its axes: what all kinds of frames have.

use crate::colours::BLACK;
use crate::letters::{Anchor, text, upward_text, width};
use crate::range::{Range, Tick, title};
use crate::shape::{Area, Ink, Place, Shape, Step};

/// Size of the letters of numbers and of titles, mm: 6.5 and 7 points.
pub const NUMBER: f64 = 2.3;
pub const TITLE: f64 = 2.5;
/// Width of frames and ticks, mm.
pub const LINE: f64 = 0.2;
/// Length of a tick, and of one without a number, mm.
pub const TICK: f64 = 0.9;
const SHORT_TICK: f64 = 0.5;
/// Between a tick and its number, mm.
pub const GAP: f64 = 0.8;
/// Between numbers and a title beside them, whose letters may reach below their line, mm.
pub const TITLE_GAP: f64 = 1.4;
/// What stays free at the edges of the sheet, mm.
pub const EDGE: f64 = 1.2;
/// Distance of numbers along x and along y that is aimed at, mm.
const DISTANCE: [f64; 2] = [11.0, 5.5];
/// What stays free between two numbers, mm.
const BETWEEN_NUMBERS: f64 = 0.8;

/// What an axis shows.
#[derive(Debug, Clone, Copy)]
pub struct Axis {
    pub quantity: &'static str,
    /// The quantity where the room is small.
    pub short: &'static str,
    /// Empty for a pure number.
    pub unit: &'static str,
    pub range: Range,
}

/// A rectangle of the sheet, and the values that lie at its edges.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    pub area: Area,
    pub x: Range,
    pub y: Range,
}

impl Frame {
    /// Where a value lies on the sheet; a value beyond the frame lies on its edge.
    pub fn place(&self, x: f64, y: f64) -> Place {
        let share = |range: Range, value: f64| range.share(value).clamp(0.0, 1.0);
        [
            self.area.left + share(self.x, x) * self.area.width,
            self.area.bottom() - share(self.y, y) * self.area.height,
        ]
    }
}

impl Axis {
    /// An axis whose quantity has no shorter name.
    pub fn of(quantity: &'static str, unit: &'static str, range: Range) -> Self {
        Self {
            quantity,
            short: quantity,
            unit,
            range,
        }
    }

    /// The width of its title, mm.
    pub fn width_of_title(&self) -> f64 {
        width(&self.title(), TITLE)
    }

    /// Its title if there is room for it, or else the short one, mm.
    pub fn title_within(&self, room: f64) -> String {
        match self.width_of_title() <= room {
            true => self.title(),
            false => title(self.short, self.unit, self.range.power()),
        }
    }

    /// Its title in letters, which a function places; readers of screens get the long one.
    pub fn written(&self, room: f64, letters: impl FnOnce(&str) -> Shape) -> Shape {
        letters(&self.title_within(room)).labelled(&self.title())
    }

    fn title(&self) -> String {
        title(self.quantity, self.unit, self.range.power())
    }

    /// The width of its numbers beside a frame of this height.
    pub fn width_of_numbers(&self, height: f64) -> f64 {
        let ticks = self.ticks_up(height).into_iter();
        let widths = ticks.map(|tick| width(&tick.text, NUMBER));
        widths.fold(0.0, f64::max)
    }

    /// Its ticks over a width.
    pub fn ticks_across(&self, length: f64) -> Vec<Tick> {
        self.ticks(length, DISTANCE[0], |number| width(number, NUMBER))
    }

    /// Its ticks over a height.
    pub fn ticks_up(&self, length: f64) -> Vec<Tick> {
        self.ticks(length, DISTANCE[1], |_| NUMBER)
    }

    /// Ticks along a length. A number that would touch the one before it is left out.
    fn ticks(&self, length: f64, distance: f64, size: impl Fn(&str) -> f64) -> Vec<Tick> {
        let mut ticks = self.range.ticks((length / distance) as usize);
        let mut free_from = f64::NEG_INFINITY;
        for tick in ticks.iter_mut().filter(|tick| !tick.text.is_empty()) {
            let middle = self.range.share(tick.value) * length;
            let half = size(&tick.text) / 2.0;
            match middle - half < free_from {
                true => tick.text.clear(),
                false => free_from = middle + half + BETWEEN_NUMBERS,
            }
        }
        ticks
    }
}

/// What an x axis needs below its frame.
pub fn room_below() -> f64 {
    TICK + GAP + NUMBER + GAP + TITLE + EDGE
}

pub fn border(area: Area) -> Shape {
    let (left, right) = (area.left, area.right());
    Shape::Outline {
        steps: vec![
            Step::Move([left, area.top]),
            Step::Line([right, area.top]),
            Step::Line([right, area.bottom()]),
            Step::Line([left, area.bottom()]),
            Step::Close,
        ],
        ink: Ink::Line {
            width: LINE,
            dash: None,
        },
        colour: BLACK,
        label: None,
    }
}

fn tick_length(number: &str) -> f64 {
    if number.is_empty() { SHORT_TICK } else { TICK }
}

/// The axis below a frame, with its numbers and its title within an area.
pub fn x_axis(frame: &Frame, axis: &Axis, within: Area) -> Shape {
    let foot = frame.area.bottom();
    let mut shapes = Vec::new();
    for tick in axis.ticks_across(frame.area.width) {
        shapes.push(x_tick(frame, &tick));
        let [x, _] = frame.place(tick.value, frame.y.from);
        let below = [x, foot + TICK + GAP];
        shapes.push(text(&tick.text, below, Anchor::Below, NUMBER));
    }
    shapes.push(title_below(frame.area, axis, within));
    group("x", axis, shapes)
}

/// A title below the middle of a frame, or beside the middle where it would leave an area.
fn title_below(frame: Area, axis: &Axis, within: Area) -> Shape {
    let top = frame.bottom() + TICK + GAP + NUMBER + GAP;
    axis.written(within.width - 2.0 * EDGE, |title| {
        let room = width(title, TITLE) / 2.0 + EDGE;
        let middle = frame.left + frame.width / 2.0;
        let middle = middle.min(within.right() - room).max(within.left + room);
        text(title, [middle, top], Anchor::Below, TITLE)
    })
}

/// The ticks of an axis below a frame, without numbers.
pub fn x_ticks(frame: &Frame, axis: &Axis) -> Shape {
    let ticks = axis.ticks_across(frame.area.width).into_iter();
    group("x", axis, ticks.map(|tick| x_tick(frame, &tick)).collect())
}

fn x_tick(frame: &Frame, tick: &Tick) -> Shape {
    let foot = frame.area.bottom();
    let [x, _] = frame.place(tick.value, frame.y.from);
    let end = foot + tick_length(&tick.text);
    Shape::line(&[[x, foot], [x, end]], LINE, BLACK).labelled(&tick.text)
}

/// The axis on the left of a frame.
pub fn y_axis(frame: &Frame, axis: &Axis, title: Shape) -> Shape {
    let left = frame.area.left;
    let mut shapes = Vec::new();
    for tick in axis.ticks_up(frame.area.height) {
        let [_, y] = frame.place(frame.x.from, tick.value);
        let end = left - tick_length(&tick.text);
        let line = Shape::line(&[[left, y], [end, y]], LINE, BLACK);
        shapes.push(line.labelled(&tick.text));
        shapes.push(text(
            &tick.text,
            [left - TICK - GAP, y],
            Anchor::Right,
            NUMBER,
        ));
    }
    shapes.push(title);
    group("y", axis, shapes)
}

/// A title that runs upwards beside the middle of an area, with its base line at `x`.
pub fn title_beside(area: Area, axis: &Axis, x: f64, room: f64) -> Shape {
    let middle = area.top + area.height / 2.0;
    axis.written(room, |title| upward_text(title, [x, middle], TITLE))
}

pub fn group(which: &str, axis: &Axis, shapes: Vec<Shape>) -> Shape {
    let quantity = axis.quantity.replace(' ', "-");
    Shape::Group {
        name: format!("{which}-{quantity}"),
        shapes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_beyond_a_frame_lies_on_its_edge() {
        let frame = Frame {
            area: Area {
                left: 10.0,
                top: 5.0,
                width: 20.0,
                height: 10.0,
            },
            x: Range::logarithmic(1.0, 100.0),
            y: Range::even(0.0, 1.0),
        };
        assert_eq!(frame.place(0.0, -3.0), [10.0, 15.0]);
        assert_eq!(frame.place(1e9, 1e300), [30.0, 5.0]);
    }
}
