//! The cusp that two neighbouring passes of a round nose leave between them.

use crate::lower_arc::lower_arc;
use nalgebra::Vector2;

/// A point in a radial section: (ρ, z), mm.
pub type Point = Vector2<f64>;

/// The lower intersection of two circles of radius `radius`; `None` where they do not meet.
pub fn between(first: Point, second: Point, radius: f64) -> Option<Point> {
    let tip = crossing(first, second, radius);
    let is_known = !tip.x.is_nan() && !tip.y.is_nan();
    is_known.then_some(tip)
}

/// The lower intersection of two circles of radius `radius`; not a number where they do not meet.
#[inline(always)]
pub(crate) fn crossing(first: Point, second: Point, radius: f64) -> Point {
    let apart = second - first;
    let half = 0.5 * (apart.x * apart.x + apart.y * apart.y).sqrt();
    let across = Vector2::new(-apart.y, apart.x) / (2.0 * half);
    let down = if across.y > 0.0 { -across } else { across };
    let depth = (radius * radius - half * half).sqrt();
    0.5 * (first + second) + depth * down
}

/// The tip of the cusp that two neighbouring passes leave when the tool's edge reaches no further
/// than `reach` to either side. The tip is the crossing of their circles. If one edge ends before
/// the crossing, the tip lies there, on the circle of the other pass.
pub fn between_edges(first: Point, second: Point, radius: f64, reach: f64) -> Option<Point> {
    let crossing = between(first, second, radius)?;
    let (lower, upper) = (first.x.min(second.x) + reach, first.x.max(second.x) - reach);
    if (upper..=lower).contains(&crossing.x) {
        return Some(crossing);
    }
    let x = if crossing.x > lower { lower } else { upper };
    let under = |centre: Point| lower_arc(centre, radius, x);
    (upper <= lower).then(|| Point::new(x, under(first).max(under(second))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_flat_part_the_cusp_is_that_of_the_closed_form() {
        let (radius, feed) = (1.0, 0.02);
        let cusp = between(
            Point::new(1.0, radius),
            Point::new(1.0 + feed, radius),
            radius,
        );
        let height = radius - (radius * radius - 0.25 * feed * feed).sqrt();
        let cusp = cusp.unwrap();
        assert!((cusp.y - height).abs() < 1e-15);
        assert!((cusp.x - 1.01).abs() < 1e-15);
    }

    #[test]
    fn circles_that_do_not_meet_leave_no_cusp() {
        assert!(between(Point::new(0.0, 1.0), Point::new(2.5, 1.0), 1.0).is_none());
    }
}
