//! Axes of a figure that shows the part from above.

use crate::frame::Axis;
use crate::range::Range;

/// The axes of x and y over a square around the axis of the part; `half` of a side, mm.
pub fn axes(half: f64) -> (Axis, Axis) {
    let axis = |quantity| Axis::of(quantity, "mm", Range::even(-half, half));
    (axis("x"), axis("y"))
}
