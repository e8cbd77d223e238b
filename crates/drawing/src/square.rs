//! A frame in which a millimetre of x is as long as one of y, with a bar of colours beside it.

use crate::colours::{BLACK, ColourScale};
use crate::frame::{
    Axis, EDGE, Frame, GAP, LINE, NUMBER, TICK, TITLE, TITLE_GAP, border, group, room_below,
    title_beside, x_axis, y_axis,
};
use crate::letters::{Anchor, text};
use crate::shape::{Area, Shape};

/// Width of a bar of colours, and its distance, mm.
const BAR: [f64; 2] = [3.0, 2.0];

/// The frame and its axes in the middle of a sheet.
pub fn square(
    sheet: Area,
    (x, y): (&Axis, &Axis),
    (bar, scale): (&Axis, ColourScale),
) -> (Frame, Vec<Shape>) {
    let high = sheet.height - EDGE - NUMBER - room_below();
    let left = room(y, high);
    let right = BAR[1] + BAR[0] + room(bar, high);
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
    let up = room_around(area.top + side / 2.0, sheet);
    let shapes = vec![
        border(area),
        x_axis(&frame, x, sheet),
        y_axis(&frame, y, title_beside(area, y, title_at, up)),
        colour_bar(area, (bar, scale), up),
    ];
    (frame, shapes)
}

/// How long a title around a height may be, mm.
fn room_around(height: f64, sheet: Area) -> f64 {
    2.0 * ((height - sheet.top).min(sheet.bottom() - height) - EDGE)
}

/// What an axis needs beside a frame of this height.
fn room(axis: &Axis, height: f64) -> f64 {
    EDGE + TITLE + TITLE_GAP + axis.width_of_numbers(height) + GAP + TICK
}

/// The bar to the right of a frame, with its numbers and its title.
fn colour_bar(beside: Area, (axis, scale): (&Axis, ColourScale), room: f64) -> Shape {
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
    for tick in axis.ticks_up(area.height) {
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
    shapes.push(title_beside(area, axis, numbers + GAP + TITLE, room));
    group("bar", axis, shapes)
}
