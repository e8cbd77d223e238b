//! Which spline counts at the edges of a map: its own, or that of the map as it is carried on.
//!
//! Both go through all points of the map. Its own spline takes all from the points, and is exact up to
//! the edge if the map is smooth. But its outermost coefficients carry the noise of the outermost
//! points nearly two hundredfold. The spline of the wider map depends on how the map was carried on,
//! within some points from the edge, and it carries no noise outwards. So the map's own spline counts
//! where it differs from the other one by something smooth, and the other one where they differ by
//! noise.

use crate::sheet::Sheet;

/// What of the difference of the outermost coefficients is left in the next ones, from the edge on:
/// without these the spline would turn back at once.
const FADE: [f64; 2] = [0.65, 0.25];

/// The largest roughness of a difference that is smooth. White noise has a roughness of 2, and a wave
/// of nine points has 0.5.
const ROUGH: f64 = 0.5;

/// Puts the coefficients of a map's own spline into the middle of those of the wider one, unless they
/// differ by noise.
pub fn join(own: &Sheet, outer: &mut Sheet, margin: usize) {
    let mut off = own.clone();
    for (row, line) in off.lines_mut().enumerate() {
        let start = (row + margin) * outer.columns + margin;
        for (off, value) in line.iter_mut().zip(&outer.values[start..]) {
            *off -= value;
        }
    }
    if roughness(&off) > ROUGH {
        return;
    }
    let fade = FADE.len().min(margin);
    let apart = |at: usize, count: usize| -> (usize, usize) {
        let inside = at.clamp(fade, fade + count - 1) - fade;
        (inside, at.abs_diff(inside + fade))
    };
    for row in 0..own.rows + 2 * fade {
        let (inner_row, down) = apart(row, own.rows);
        let line = &mut outer.values[(row + margin - fade) * outer.columns..];
        for column in 0..own.columns + 2 * fade {
            let (inner_column, right) = apart(column, own.columns);
            let share = match down.max(right) {
                0 => 1.0,
                ring => FADE[ring - 1],
            };
            line[column + margin - fade] +=
                share * off.values[inner_row * own.columns + inner_column];
        }
    }
}

/// The mean square of the steps from one outermost number to the next, over the mean square of the
/// numbers.
fn roughness(off: &Sheet) -> f64 {
    let last = off.columns - 1;
    let sides =
        [0, last].map(|column| -> Vec<f64> { off.lines().map(|line| line[column]).collect() });
    let ends = [off.lines().next(), off.lines().next_back()];
    let edges = sides
        .iter()
        .map(Vec::as_slice)
        .chain(ends.into_iter().flatten());
    let (mut steps, mut squares) = (0.0, 0.0);
    for edge in edges {
        // The corners belong to two edges, and are the largest of all.
        let edge = edge.get(2..edge.len() - 2).unwrap_or_default();
        squares += edge.iter().map(|value| value * value).sum::<f64>();
        steps += edge
            .iter()
            .zip(edge.iter().skip(1))
            .map(|(a, b)| (a - b) * (a - b))
            .sum::<f64>();
    }
    if squares > 0.0 { steps / squares } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The wider coefficients are zero: what is there afterwards is what was put there.
    fn joined(value: impl Fn(usize, usize) -> f64) -> (Sheet, Sheet) {
        let mut own = Sheet::of(30, 20, 0.0);
        for (row, line) in own.lines_mut().enumerate() {
            for (column, place) in line.iter_mut().enumerate() {
                *place = value(column, row);
            }
        }
        let mut outer = Sheet::of(46, 36, 0.0);
        join(&own, &mut outer, 8);
        (own, outer)
    }

    #[test]
    fn smooth_coefficients_are_taken_over_and_fade() {
        let (own, outer) = joined(|u, v| 1.0 + 0.1 * u as f64 - 0.05 * v as f64);
        let at = |column: usize, row: usize| outer.values[row * 46 + column];
        for row in 0..20 {
            for column in 0..30 {
                assert_eq!(at(column + 8, row + 8), own.values[row * 30 + column]);
            }
        }
        let last = own.values[4 * 30 + 29];
        assert_eq!(
            [at(38, 12), at(39, 12), at(40, 12)],
            [0.65 * last, 0.25 * last, 0.0]
        );
        assert_eq!(at(6, 6), 0.25 * own.values[0]);
    }

    #[test]
    fn coefficients_that_differ_by_noise_are_left_alone() {
        let (_, outer) = joined(|u, v| ((u * 7919 + v * 104_729) % 13) as f64 - 6.0);
        assert!(outer.values.iter().all(|value| *value == 0.0));
    }
}
