//! The Jacobi polynomials P_k^(0, β).

use crate::recurrence::{Family, Step};

/// The first `count` polynomials P_k^(0, β)(w), whose value is 1 at w = 1.
pub fn jacobi(beta: f64, count: usize) -> Family {
    Family::new(1.0, (0..count.saturating_sub(1)).map(|k| step(beta, k)))
}

/// The step from P_k to P_{k+1}: Abramowitz and Stegun, *Handbook of Mathematical Functions*, 1964,
/// 22.7.1 with α = 0.
fn step(beta: f64, k: usize) -> Step {
    if k == 0 {
        return Step {
            constant: -0.5 * beta,
            slope: 0.5 * (beta + 2.0),
            ..Step::default()
        };
    }
    let n = k as f64;
    let twice = 2.0 * n + beta;
    let scale = 2.0 * (n + 1.0) * (n + 1.0 + beta) * twice;
    Step {
        constant: -(twice + 1.0) * beta * beta / scale,
        slope: twice * (twice + 1.0) * (twice + 2.0) / scale,
        back: 2.0 * n * (n + beta) * (twice + 2.0) / scale,
        lift: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_low_degree_are_their_closed_forms() {
        let w = 0.3;
        let p = |beta, k: usize| {
            let mut coefficients = vec![0.0; k + 1];
            coefficients[k] = 1.0;
            jacobi(beta, k + 1).sum(&coefficients, w)
        };
        // Legendre, and P_2^(0, β) = 1 + (β + 3)(w − 1) + (β + 3)(β + 4)(w − 1)²/8.
        assert_eq!(p(0.0, 1), w);
        assert!((p(0.0, 2) - 0.5 * (3.0 * w * w - 1.0)).abs() < 1e-15);
        assert!((p(0.0, 3) - 0.5 * (5.0 * w * w * w - 3.0 * w)).abs() < 1e-15);
        let d = w - 1.0;
        assert!((p(4.0, 2) - (1.0 + 7.0 * d + 7.0 * d * d)).abs() < 1e-14);
        assert!((jacobi(4.0, 9).sum(&[1.0; 9], 1.0) - 9.0).abs() < 1e-13);
    }
}
