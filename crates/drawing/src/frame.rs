//! A frame with its axes, and how frames share a sheet.

use crate::colours::{BLACK, ColourScale};
use crate::letters::{Anchor, text, upward_text, width};
use crate::range::{Range, title};
use crate::shape::{Area, Ink, Place, Shape, Step};

/// Size of the letters of numbers and of titles, mm: 6.5 and 7 points.
pub const NUMBER: f64 = 2.3;
const TITLE: f64 = 2.5;
/// Width of frames and ticks, mm.
const LINE: f64 = 0.2;
/// Length of a tick, and of one without a number, mm.
const TICK: f64 = 0.9;
const SHORT_TICK: f64 = 0.5;
/// Between a tick and its number, mm.
const GAP: f64 = 0.8;
/// Between numbers and a title beside them, whose letters may reach below their line, mm.
const TITLE_GAP: f64 = 1.4;
/// What stays free at the edges of the sheet, mm.
const EDGE: f64 = 1.2;
/// Least distance of numbers along x and along y, mm.
const APART: [f64; 2] = [11.0, 5.5];
/// Between frames above each other, mm.
const BETWEEN: f64 = 2.6;
/// Width of a bar of colours, and its distance, mm.
const BAR: [f64; 2] = [3.0, 2.0];

/// What an axis shows.
#[derive(Debug, Clone, Copy)]
pub struct Axis {
    pub quantity: &'static str,
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
    /// Where a value lies on the sheet.
    pub fn place(&self, x: f64, y: f64) -> Place {
        [
            self.area.left + self.x.share(x) * self.area.width,
            self.area.bottom() - self.y.share(y) * self.area.height,
        ]
    }
}

impl Axis {
    fn title(&self) -> String {
        title(self.quantity, self.unit, self.range.power())
    }

    /// The width of its numbers beside a frame of this height.
    fn width_of_numbers(&self, height: f64) -> f64 {
        let ticks = self.range.ticks(count(height, APART[1])).into_iter();
        let widths = ticks.map(|tick| width(&tick.text, NUMBER));
        widths.fold(0.0, f64::max)
    }

    /// What the axis needs beside a frame of this height.
    fn room(&self, height: f64) -> f64 {
        EDGE + TITLE + TITLE_GAP + self.width_of_numbers(height) + GAP + TICK
    }
}

fn count(length: f64, apart: f64) -> usize {
    (length / apart) as usize
}

/// What an x axis needs below its frame.
fn room_below() -> f64 {
    TICK + GAP + NUMBER + GAP + TITLE + EDGE
}

/// Frames above each other in an area, with one axis of x below the last, each with its axis of y.
pub fn stack(area: Area, x: &Axis, all: &[Axis]) -> (Vec<Frame>, Vec<Shape>) {
    let count = all.len().max(1) as f64;
    let free = area.height - EDGE - room_below() - (count - 1.0) * BETWEEN;
    let height = (free / count).max(1.0);
    let left = all.iter().map(|axis| axis.room(height)).fold(0.0, f64::max);
    // Half of the last number may stand over.
    let right = EDGE + 2.0 * NUMBER;
    let frame = |(at, axis): (usize, &Axis)| Frame {
        area: Area {
            left: area.left + left,
            top: area.top + EDGE + at as f64 * (height + BETWEEN),
            width: (area.width - left - right).max(1.0),
            height,
        },
        x: x.range,
        y: axis.range,
    };
    let frames: Vec<Frame> = all.iter().enumerate().map(frame).collect();
    let mut shapes = Vec::new();
    for (at, (frame, axis)) in frames.iter().zip(all).enumerate() {
        let is_last = at + 1 == frames.len();
        shapes.push(border(frame.area));
        shapes.push(x_axis(frame, x, is_last));
        shapes.push(y_axis(frame, axis, area.left + EDGE + TITLE));
    }
    (frames, shapes)
}

/// A frame in which a millimetre of x is as long as one of y, with a bar of colours beside it.
pub fn square(
    sheet: Area,
    (x, y): (&Axis, &Axis),
    bar: (&Axis, ColourScale),
) -> (Frame, Vec<Shape>) {
    let high = sheet.height - EDGE - NUMBER - room_below();
    let left = y.room(high);
    let right = BAR[1] + BAR[0] + bar.0.room(high);
    let side = high.min(sheet.width - left - right).max(1.0);
    let beside = (sheet.width - left - right - side) / 2.0;
    let area = Area {
        left: sheet.left + left + beside,
        top: sheet.top + EDGE + NUMBER + (high - side) / 2.0,
        width: side,
        height: side,
    };
    let frame = Frame {
        area,
        x: x.range,
        y: y.range,
    };
    let title_at = area.left - left + EDGE + TITLE;
    let mut shapes = vec![
        border(area),
        x_axis(&frame, x, true),
        y_axis(&frame, y, title_at),
    ];
    shapes.push(colour_bar(area, bar));
    (frame, shapes)
}

fn border(area: Area) -> Shape {
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

fn x_axis(frame: &Frame, axis: &Axis, with_numbers: bool) -> Shape {
    let foot = frame.area.bottom();
    let mut shapes = Vec::new();
    for tick in axis.range.ticks(count(frame.area.width, APART[0])) {
        let [x, _] = frame.place(tick.value, frame.y.from);
        let end = foot + tick_length(&tick.text);
        let line = Shape::line(&[[x, foot], [x, end]], LINE, BLACK);
        shapes.push(line.labelled(&tick.text));
        if with_numbers {
            shapes.push(text(
                &tick.text,
                [x, foot + TICK + GAP],
                Anchor::Below,
                NUMBER,
            ));
        }
    }
    if with_numbers {
        let middle = frame.area.left + frame.area.width / 2.0;
        let top = foot + TICK + GAP + NUMBER + GAP;
        shapes.push(text(&axis.title(), [middle, top], Anchor::Below, TITLE));
    }
    group("x", axis, shapes)
}

/// The axis on the left of a frame; its title stands with its base line at `title_at`.
fn y_axis(frame: &Frame, axis: &Axis, title_at: f64) -> Shape {
    let left = frame.area.left;
    let mut shapes = Vec::new();
    for tick in axis.range.ticks(count(frame.area.height, APART[1])) {
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
    let middle = frame.area.top + frame.area.height / 2.0;
    shapes.push(upward_text(&axis.title(), [title_at, middle], TITLE));
    group("y", axis, shapes)
}

/// The bar to the right of a frame, with its numbers and its title.
fn colour_bar(beside: Area, (axis, scale): (&Axis, ColourScale)) -> Shape {
    let area = Area {
        left: beside.right() + BAR[1],
        width: BAR[0],
        ..beside
    };
    let picture = Shape::Picture {
        pixels: scale.bar(),
        area,
    };
    let mut shapes = vec![picture, border(area)];
    let right = area.right();
    for tick in axis.range.ticks(count(area.height, APART[1])) {
        let y = area.bottom() - axis.range.share(tick.value) * area.height;
        let line = Shape::line(&[[right, y], [right + TICK, y]], LINE, BLACK);
        shapes.push(line.labelled(&tick.text));
        shapes.push(text(
            &tick.text,
            [right + TICK + GAP, y],
            Anchor::Left,
            NUMBER,
        ));
    }
    let numbers = right + TICK + GAP + axis.width_of_numbers(area.height);
    let middle = area.top + area.height / 2.0;
    let title = upward_text(&axis.title(), [numbers + GAP + TITLE, middle], TITLE);
    shapes.push(title);
    group("bar", axis, shapes)
}

fn group(which: &str, axis: &Axis, shapes: Vec<Shape>) -> Shape {
    let quantity = axis.quantity.replace(' ', "-");
    Shape::Group {
        name: format!("{which}-{quantity}"),
        shapes,
    }
}
