//! The B-splines of degree 5 over knots at whole numbers.

/// B-splines that are not zero over a cell.
pub const SPLINES: usize = 6;

/// Splines before the one in whose middle a cell begins.
pub const BEFORE: usize = 2;

/// The value of every spline at the knots of its middle: what a coefficient counts at its own point
/// and at the two to either side.
pub const AT_KNOTS: [f64; 5] = [
    1.0 / 120.0,
    26.0 / 120.0,
    66.0 / 120.0,
    26.0 / 120.0,
    1.0 / 120.0,
];

/// The powers of t in the six splines over a cell, t from 0 to 1, times 120. `POWERS[k][m]` is the
/// coefficient of tᵏ in spline m.
const POWERS: [[f64; SPLINES]; SPLINES] = [
    [1.0, 26.0, 66.0, 26.0, 1.0, 0.0],
    [-5.0, -50.0, 0.0, 50.0, 5.0, 0.0],
    [10.0, 20.0, -60.0, 20.0, 10.0, 0.0],
    [-10.0, 20.0, 0.0, -20.0, 10.0, 0.0],
    [5.0, -20.0, 30.0, -20.0, 5.0, 0.0],
    [-1.0, 5.0, -10.0, 10.0, -5.0, 1.0],
];

/// Places whose numbers go through the registers together: as many as one of 512 bits holds.
pub const GROUP: usize = 8;

/// A number of each place.
pub type Numbers = [f64; GROUP];

/// A number of each of the six splines at each place.
pub type Splines = [Numbers; SPLINES];

/// Splines before they have numbers.
pub const NO_SPLINES: Splines = [[0.0; GROUP]; SPLINES];

/// `WEIGHTS[d][k][m]`: the coefficient of tᵏ in the derivative of order d of spline m, over d!.
const WEIGHTS: [[[f64; SPLINES]; SPLINES]; SPLINES] = weights();

const fn weights() -> [[[f64; SPLINES]; SPLINES]; SPLINES] {
    let mut all = [[[0.0; SPLINES]; SPLINES]; SPLINES];
    let mut order = 0;
    while order < SPLINES {
        let mut power = 0;
        while power + order < SPLINES {
            // (power + order choose order)
            let (mut ways, mut i) = (1.0, 0);
            while i < order {
                ways = ways * (power + order - i) as f64 / (i + 1) as f64;
                i += 1;
            }
            let mut spline = 0;
            while spline < SPLINES {
                all[order][power][spline] = ways * POWERS[power + order][spline] / 120.0;
                spline += 1;
            }
            power += 1;
        }
        order += 1;
    }
    all
}

/// The derivatives of order `ORDER` of the six splines at t, over `ORDER`!.
#[inline(always)]
pub fn derivative<const ORDER: usize>(t: &Numbers) -> Splines {
    // Without a loop over the splines, so that one over the places is left.
    [
        derivative_of::<ORDER, 0>(t),
        derivative_of::<ORDER, 1>(t),
        derivative_of::<ORDER, 2>(t),
        derivative_of::<ORDER, 3>(t),
        derivative_of::<ORDER, 4>(t),
        derivative_of::<ORDER, 5>(t),
    ]
}

/// The same of spline `M`.
#[inline(always)]
fn derivative_of<const ORDER: usize, const M: usize>(t: &Numbers) -> Numbers {
    let powers = const { &WEIGHTS[ORDER] };
    let mut weights = [powers[SPLINES - 1 - ORDER][M]; GROUP];
    for (weight, t) in weights.iter_mut().zip(t) {
        for power in (0..SPLINES - 1 - ORDER).rev() {
            *weight = *weight * t + powers[power][M];
        }
    }
    weights
}

/// The first `N` derivatives of the six splines at t, from order 0 on, each over the factorial of its order.
#[inline(always)]
pub fn derivatives<const N: usize>(t: &Numbers) -> [Splines; N] {
    const { assert!(N <= SPLINES) }
    let all = [
        derivative::<0>(t),
        derivative::<1>(t),
        derivative::<2>(t),
        derivative::<3>(t),
        derivative::<4>(t),
        derivative::<5>(t),
    ];
    std::array::from_fn(|order| all[order])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cox and de Boor's recurrence over whole knots: the spline whose support begins at 0.
    fn spline(degree: usize, u: f64) -> f64 {
        if degree == 0 {
            return if (0.0..1.0).contains(&u) { 1.0 } else { 0.0 };
        }
        let n = degree as f64;
        (u * spline(degree - 1, u) + (n + 1.0 - u) * spline(degree - 1, u - 1.0)) / n
    }

    const T: Numbers = [0.0, 0.05, 0.2, 0.3, 0.55, 0.7, 0.9, 0.999];

    #[test]
    fn the_splines_are_those_of_cox_and_de_boor() {
        for (m, weights) in derivative::<0>(&T).into_iter().enumerate() {
            for (weight, t) in weights.into_iter().zip(T) {
                let wanted = spline(5, t + (5 - m) as f64);
                assert!(
                    (weight - wanted).abs() < 1e-15,
                    "{t} {m}: {weight} {wanted}"
                );
            }
        }
        let at_knot = derivative::<0>(&T).map(|weights| weights[0]);
        assert_eq!(at_knot[..5], AT_KNOTS);
    }

    #[test]
    fn derivatives_are_those_of_the_taylor_series() {
        let step = 0.1;
        let orders: [_; SPLINES] = derivatives(&T);
        let moved = derivative::<0>(&T.map(|t| t + step));
        for (m, wanted) in moved.into_iter().enumerate() {
            for (place, wanted) in wanted.into_iter().enumerate() {
                let orders = orders.iter().rev();
                let found = orders.fold(0.0, |sum, order| sum * step + order[m][place]);
                assert!((found - wanted).abs() < 1e-15, "{m}: {found} {wanted}");
            }
        }
    }
}
