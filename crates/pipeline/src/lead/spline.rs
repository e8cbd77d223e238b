//! The cubic spline of a lead. Its acceleration is continuous, and at both ends its position,
//! velocity and acceleration are given.
//!
//! A spline through all nodes can take the velocity at its ends, but not the acceleration. So the
//! positions of the second and of the second-to-last node are left free. With
//! p₁ = p₀ + h₀(2 m₀/3 + m₁/3 + h₀ a₀/6) the first cubic has the given acceleration, and the last
//! cubic likewise; the equations for the slopes m stay tridiagonal.

/// Position, velocity and acceleration of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Position.
    pub position: f64,
    /// Velocity.
    pub velocity: f64,
    /// Acceleration.
    pub acceleration: f64,
}

/// Fewest nodes of such a spline.
pub const FEWEST_NODES: usize = 4;

/// The position of a node, which may depend on the slope m there: q + g·m.
#[derive(Debug, Clone, Copy)]
struct NodePosition {
    q: f64,
    g: f64,
}

/// Lays the spline through nodes at times `t`, which grow and are [`FEWEST_NODES`] or more. Sets the
/// first and the last of `p` to the positions of the ends, and moves the second and the
/// second-to-last of `p` as the ends require. Gives the slopes at all nodes.
pub fn interpolate(t: &[f64], p: &mut [f64], first: Motion, last: Motion) -> Vec<f64> {
    let end = t.len() - 1;
    let h: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let fixed = |q: &f64| NodePosition { q: *q, g: 0.0 };
    let mut nodes: Vec<NodePosition> = p.iter().map(fixed).collect();
    (nodes[0].q, nodes[end].q) = (first.position, last.position);
    nodes[1] = beside(first, h[0]);
    nodes[end - 1] = beside(last, -h[end - 1]);
    let mut slopes = slopes(&h, &nodes, first.velocity, last.velocity);
    clear_rounding(&h, &nodes, &mut slopes);
    for ((p, node), slope) in p.iter_mut().zip(&nodes).zip(&slopes) {
        *p = node.q + node.g * slope;
    }
    slopes
}

/// Sets tiny slopes to zero where nothing moves: there a spline's slopes fall by a quarter a node and
/// never vanish. A slope counts as tiny if rounding of the positions would leave as much.
fn clear_rounding(h: &[f64], nodes: &[NodePosition], slopes: &mut [f64]) {
    let largest = nodes.iter().map(|node| node.q.abs()).fold(0.0, f64::max);
    for k in 1..h.len() {
        let stays = nodes[k - 1].q == nodes[k].q && nodes[k].q == nodes[k + 1].q;
        let rounding = f64::EPSILON * largest / h[k - 1].max(h[k]);
        if stays && slopes[k].abs() <= rounding {
            slopes[k] = 0.0;
        }
    }
}

/// The position of the node beside an end, which is `h` later, or earlier where `h` is negative.
fn beside(end: Motion, h: f64) -> NodePosition {
    NodePosition {
        q: end.position + h * (2.0 * end.velocity / 3.0 + h * end.acceleration / 6.0),
        g: h / 3.0,
    }
}

/// Slopes with which the second derivatives of both sides agree at every inner node.
fn slopes(h: &[f64], nodes: &[NodePosition], first: f64, last: f64) -> Vec<f64> {
    let end = h.len();
    let mut slopes = vec![0.0; end + 1];
    let mut above = vec![0.0; end + 1];
    (slopes[0], slopes[end]) = (first, last);
    for k in 1..end {
        let (left, right) = (h[k - 1], h[k]);
        let (before, here, after) = (nodes[k - 1], nodes[k], nodes[k + 1]);
        let (left_squared, right_squared) = (left * left, right * right);
        let low = 1.0 / left + 3.0 * before.g / left_squared;
        let up = 1.0 / right - 3.0 * after.g / right_squared;
        let middle =
            2.0 / left + 2.0 / right - 3.0 * here.g / left_squared + 3.0 * here.g / right_squared;
        let right_side =
            3.0 * ((here.q - before.q) / left_squared + (after.q - here.q) / right_squared);
        // Gaussian elimination downwards: the slope of the first node is known.
        let pivot = middle - low * above[k - 1];
        above[k] = up / pivot;
        slopes[k] = (right_side - low * slopes[k - 1]) / pivot;
    }
    for k in (1..end).rev() {
        slopes[k] -= above[k] * slopes[k + 1];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;
    use turnpath_core::toolpath::Cubic;

    const T: [f64; 8] = [0.0, 0.1, 0.35, 0.4, 0.7, 0.75, 0.9, 1.3];

    fn cubics(t: &[f64], p: &[f64], m: &[f64]) -> Vec<(Cubic, f64)> {
        (1..t.len())
            .map(|k| {
                let h = t[k] - t[k - 1];
                (Cubic::hermite(p[k - 1], m[k - 1], p[k], m[k], h), h)
            })
            .collect()
    }

    fn bend(cubic: &(Cubic, f64), s: f64) -> f64 {
        cubic.0.bend(s) / (cubic.1 * cubic.1)
    }

    #[test]
    fn a_cubic_is_reproduced_also_at_the_free_nodes() {
        let p = |t: f64| 2.0 + t * (-1.0 + t * (0.5 + t * 3.0));
        let motion = |t: f64| Motion {
            position: p(t),
            velocity: -1.0 + t * (1.0 + t * 9.0),
            acceleration: 1.0 + 18.0 * t,
        };
        for end in FEWEST_NODES - 1..T.len() {
            let t = &T[..=end];
            let mut nodes: Vec<f64> = t.iter().map(|t| p(*t)).collect();
            (nodes[1], nodes[end - 1]) = (f64::NAN, f64::NAN);
            let slopes = interpolate(t, &mut nodes, motion(t[0]), motion(t[end]));
            for (k, t) in t.iter().enumerate() {
                assert!((nodes[k] - p(*t)).abs() < 1e-13, "{k} of {end}");
                assert!((slopes[k] - motion(*t).velocity).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn ends_are_as_given_and_acceleration_is_continuous() {
        let first = Motion {
            position: 1.0,
            velocity: -2.0,
            acceleration: 30.0,
        };
        let last = Motion {
            position: 5.0,
            ..Motion::default()
        };
        for end in FEWEST_NODES - 1..T.len() {
            let t = &T[..=end];
            let mut p: Vec<f64> = t.iter().map(|t| t * t * (3.0 - t)).collect();
            let kept = p.clone();
            let slopes = interpolate(t, &mut p, first, last);
            assert_eq!((p[0], p[end]), (1.0, 5.0));
            assert_eq!((slopes[0], slopes[end]), (-2.0, 0.0));
            assert_eq!(p[2..end - 1], kept[2..end - 1]);
            let cubics = cubics(t, &p, &slopes);
            assert!((bend(&cubics[0], 0.0) - 30.0).abs() < 1e-10);
            assert!(bend(&cubics[end - 1], 1.0).abs() < 1e-10);
            for pair in cubics.windows(2) {
                let (before, after) = (bend(&pair[0], 1.0), bend(&pair[1], 0.0));
                assert!((before - after).abs() < 1e-9, "{before} {after}");
            }
        }
    }

    #[test]
    fn where_nothing_moves_slopes_are_zero_and_nowhere_else() {
        let first = Motion {
            position: 1.0,
            velocity: 1.0,
            acceleration: 0.0,
        };
        let last = Motion {
            position: 3.0,
            ..Motion::default()
        };
        let t: Vec<f64> = (0..100).map(|k| 0.1 * f64::from(k)).collect();
        let mut p: Vec<f64> = t.iter().map(|t| 1.0 + t.min(2.0)).collect();
        let slopes = interpolate(&t, &mut p, first, last);
        assert!(slopes[..40].iter().all(|slope| *slope != 0.0));
        assert!(slopes[60..].iter().all(|slope| *slope == 0.0));
    }

    #[test]
    fn the_error_falls_with_the_fourth_power_of_the_step() {
        use turnpath_core::Scalar;
        let motion = |t: f64| {
            let (sin, cos) = Scalar::sin_cos(t);
            Motion {
                position: sin,
                velocity: cos,
                acceleration: -sin,
            }
        };
        let error = |count: usize| {
            let t: Vec<f64> = (0..=count).map(|k| 2.0 * k as f64 / count as f64).collect();
            let mut p: Vec<f64> = t.iter().map(|t| motion(*t).position).collect();
            let slopes = interpolate(&t, &mut p, motion(0.0), motion(2.0));
            let cubics = cubics(&t, &p, &slopes);
            let each = cubics
                .iter()
                .enumerate()
                .map(|(k, (cubic, h))| (cubic.value(0.5) - motion(t[k] + 0.5 * h).position).abs());
            each.fold(0.0, f64::max)
        };
        let ratio = error(20) / error(40);
        assert!((14.0..18.0).contains(&ratio), "{ratio}");
    }
}
