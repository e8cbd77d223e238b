//! Frames above each other, with one axis of x below them all.

use crate::frame::{
    Axis, EDGE, Frame, GAP, NUMBER, TICK, TITLE, TITLE_GAP, border, room_below, title_beside,
    x_axis, x_ticks, y_axis,
};
use crate::letters::{Anchor, text, width};
use crate::shape::{Area, Shape};

/// Between frames above each other, mm.
const BETWEEN: f64 = 2.6;
/// What stays free between titles that run upwards, mm.
const BETWEEN_TITLES: f64 = 0.8;
/// The height of the letters of a title, mm.
const LETTERS: f64 = 2.0;
/// Between the base line of a title above a frame and the frame, mm. Letters reach below their line, and
/// half of the highest number stands above the frame.
const FOOT: f64 = 1.6;
/// Between a title above a frame and the tick above it, mm.
const HEAD: f64 = 0.5;

/// Where the titles of y axes stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Titles {
    /// They run upwards to the left of the numbers.
    Beside,
    /// Each stands above its frame, since they would touch each other beside low frames.
    Above,
}

impl Titles {
    /// Where there is room for the titles of stacks, each of which has the whole height of a sheet.
    pub fn of_stacks(height: f64, stacks: impl IntoIterator<Item = Vec<Axis>>) -> Self {
        match stacks.into_iter().all(|axes| fit_beside(height, &axes)) {
            true => Self::Beside,
            false => Self::Above,
        }
    }

    /// What stands above a frame, mm.
    fn height(self) -> f64 {
        match self {
            Self::Beside => 0.0,
            Self::Above => LETTERS + FOOT,
        }
    }
}

/// How a stack lies on its sheet, mm.
struct Rows {
    /// Above the first frame.
    top: f64,
    /// Of each frame.
    height: f64,
    between: f64,
}

impl Rows {
    fn of(height: f64, count: usize, titles: Titles) -> Self {
        let top = EDGE + titles.height();
        let between = match titles {
            Titles::Beside => BETWEEN,
            Titles::Above => TICK + HEAD + titles.height(),
        };
        let count = count.max(1) as f64;
        let free = height - top - room_below() - (count - 1.0) * between;
        Self {
            top,
            height: (free / count).max(1.0),
            between,
        }
    }
}

/// Whether titles that run upwards touch neither each other nor the edges of the sheet.
fn fit_beside(height: f64, axes: &[Axis]) -> bool {
    let rows = Rows::of(height, axes.len(), Titles::Beside);
    let mut free_from = EDGE / 2.0;
    let ends = axes.iter().enumerate().map(|(at, axis)| {
        let top = rows.top + at as f64 * (rows.height + rows.between);
        let middle = top + rows.height / 2.0;
        let half = axis.width_of_title() / 2.0;
        (middle - half, middle + half)
    });
    for (from, to) in ends {
        if from < free_from || to > height - EDGE {
            return false;
        }
        free_from = to + BETWEEN_TITLES;
    }
    true
}

/// Frames above each other in an area, with one axis of x below the last, each with its axis of y.
pub fn stack(area: Area, x: &Axis, all: &[Axis], titles: Titles) -> (Vec<Frame>, Vec<Shape>) {
    let frames = frames(area, x, all, titles);
    let written = match titles {
        Titles::Beside => titles_beside(area, &frames, all),
        Titles::Above => titles_above(area, &frames, all),
    };
    let mut shapes = Vec::new();
    for (at, ((frame, axis), title)) in frames.iter().zip(all).zip(written).enumerate() {
        let is_last = at + 1 == frames.len();
        shapes.push(border(frame.area));
        shapes.push(match is_last {
            true => x_axis(frame, x, area),
            false => x_ticks(frame, x),
        });
        shapes.push(y_axis(frame, axis, title));
    }
    (frames, shapes)
}

fn frames(area: Area, x: &Axis, all: &[Axis], titles: Titles) -> Vec<Frame> {
    let rows = Rows::of(area.height, all.len(), titles);
    let beside = match titles {
        Titles::Beside => TITLE + TITLE_GAP,
        Titles::Above => 0.0,
    };
    let numbers = all.iter().map(|axis| axis.width_of_numbers(rows.height));
    let left = EDGE + beside + numbers.fold(0.0, f64::max) + GAP + TICK;
    // Half of the last number may stand over.
    let right = EDGE + 2.0 * NUMBER;
    let frame = |(at, axis): (usize, &Axis)| Frame {
        area: Area {
            left: area.left + left,
            top: area.top + rows.top + at as f64 * (rows.height + rows.between),
            width: (area.width - left - right).max(1.0),
            height: rows.height,
        },
        x: x.range,
        y: axis.range,
    };
    all.iter().enumerate().map(frame).collect()
}

/// Titles that have been found to fit beside their frames.
fn titles_beside(area: Area, frames: &[Frame], all: &[Axis]) -> Vec<Shape> {
    let x = area.left + EDGE + TITLE;
    let titles = frames.iter().zip(all);
    titles
        .map(|(frame, axis)| title_beside(frame.area, axis, x, f64::MAX))
        .collect()
}

/// Titles above their frames. They begin where the frames do, or all before it where one is long.
fn titles_above(area: Area, frames: &[Frame], all: &[Axis]) -> Vec<Shape> {
    let room = area.width - 2.0 * EDGE;
    let widths = all
        .iter()
        .map(|axis| width(&axis.title_within(room), TITLE));
    let last = area.right() - EDGE - widths.fold(0.0, f64::max);
    let title = |(frame, axis): (&Frame, &Axis)| {
        let left = frame.area.left.min(last).max(area.left + EDGE);
        let foot = frame.area.top - FOOT;
        axis.written(room, |title| {
            let middle = left + width(title, TITLE) / 2.0;
            text(title, [middle, foot], Anchor::Above, TITLE)
        })
    };
    frames.iter().zip(all).map(title).collect()
}
