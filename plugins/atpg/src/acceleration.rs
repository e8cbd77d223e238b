//! How strongly a law accelerates the radial slide: d²ρ/dt² of its pieces.

use turnpath_plugin::prelude::*;

/// The largest |d²ρ/dt²| of a law, mm/s².
///
/// With N(t) the revolutions, d²ρ/dt² = ρ''·(dN/dt)² + ρ'·d²N/dt². At a constant spindle speed ω
/// this is ρ''·(ω/2π)². The function evaluates each piece at its ends and where ρ''' = 0.
pub fn largest_acceleration(law: &[FeedPiece], spindle: &SpindleLaw) -> f64 {
    let (mut largest, mut start) = (0.0f64, 0.0);
    for piece in law {
        let turns = turning_points(piece);
        for n in [Some(0.0), Some(piece.length)].into_iter().chain(turns) {
            let Some(n) = n else { continue };
            let time = spindle.as_time().series(start + n);
            let (rate, slowing) = (time[1].recip(), 2.0 * time[2]);
            let (first, second) = derivatives(piece, n);
            let acceleration = (second - first * slowing * rate) * rate * rate;
            largest = largest.max(acceleration.abs());
        }
        start += piece.length;
    }
    largest
}

/// ρ' and ρ'' at `n` revolutions from the start of a piece.
fn derivatives(piece: &FeedPiece, n: f64) -> (f64, f64) {
    let [_, a, b, c, d, e] = piece.coefficients;
    let first = a + n * (2.0 * b + n * (3.0 * c + n * (4.0 * d + n * 5.0 * e)));
    let second = 2.0 * b + n * (6.0 * c + n * (12.0 * d + n * 20.0 * e));
    (first, second)
}

/// The positions within a piece where ρ''' = 6c + 24dn + 60en² is zero.
fn turning_points(piece: &FeedPiece) -> [Option<f64>; 2] {
    let [_, _, _, c, d, e] = piece.coefficients;
    let within = |n: f64| Some(n).filter(|n| (0.0..=piece.length).contains(n));
    let discriminant = 4.0 * d * d - 10.0 * c * e;
    if discriminant < 0.0 {
        return [None, None];
    }
    // One root without cancellation. The other follows from the product of both, c/(10e).
    let sum = -(2.0 * d + discriminant.sqrt().copysign(d));
    [within(sum / (10.0 * e)), within(c / sum)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(length: f64, coefficients: [f64; 6]) -> FeedPiece {
        FeedPiece {
            length,
            coefficients,
        }
    }

    #[test]
    fn the_largest_acceleration_within_a_piece_is_that_of_a_dense_grid() {
        let spindle = SpindleLaw::constant(50.0);
        let per_time = 50.0 / std::f64::consts::TAU;
        for coefficients in [
            [1.0, 0.1, 0.0, -0.3, 0.2, -0.03],
            [1.0, 0.1, 0.02, 0.3, -0.4, 0.05],
            [0.0, 0.1, -0.02, 0.01, 0.0, 0.0],
            [0.0, 0.1, 0.01, 0.2, -0.1, 0.0],
            [0.0, 0.1, 0.01, 0.0, 0.0, 0.07],
            [0.0, 0.1, 0.0, 0.0, 0.0, 0.0],
        ] {
            let cubic = piece(3.0, coefficients);
            let dense = (0..=30_000).map(|i| derivatives(&cubic, f64::from(i) * 1e-4).1.abs());
            let dense = dense.fold(0.0, f64::max) * per_time * per_time;
            let found = largest_acceleration(&[cubic], &spindle);
            assert!((found - dense).abs() <= 1e-7 * dense, "{found} for {dense}");
        }
    }

    /// t = N + N²/2 and ρ = t, so nothing accelerates. The same holds in the second piece from N =
    /// 1 on.
    #[test]
    fn a_spindle_that_slows_down_accelerates_the_slide_too() {
        let mut time = PiecewisePolynomial::new();
        time.push(9.0, [0.0, 1.0, 0.5, 0.0, 0.0, 0.0]);
        let spindle = SpindleLaw::from_time(time);
        let even = [
            piece(1.0, [0.0, 1.0, 0.5, 0.0, 0.0, 0.0]),
            piece(2.0, [1.5, 2.0, 0.5, 0.0, 0.0, 0.0]),
        ];
        assert!(largest_acceleration(&even, &spindle) < 1e-15);
        // ρ = N: dN/dt = 1/(1 + N), d²N/dt² = −1/(1 + N)³.
        let steady = [piece(3.0, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0])];
        assert!((largest_acceleration(&steady, &spindle) - 1.0).abs() < 1e-15);
    }
}
