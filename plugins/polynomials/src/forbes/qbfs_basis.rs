//! The polynomials Q^bfs by way of others with a plain recurrence.
//!
//! Forbes 2010, Opt. Express 18, 19700: with x = u², Q_n = (P_n − g_{n−1}Q_{n−1} − h_{n−2}Q_{n−2}) /
//! f_n, where P_0 = 2, P_1 = 6 − 8x and P_{n+1} = (2 − 4x)P_n − P_{n−1} (A.4, A.14 to A.16).

use crate::recurrence::{Family, Step};

/// The first `count` polynomials P_n(x).
pub fn family(count: usize) -> Family {
    let first = Step {
        constant: 3.0,
        slope: -4.0,
        ..Step::default()
    };
    let other = Step {
        constant: 2.0,
        slope: -4.0,
        back: 1.0,
        lift: 0.0,
    };
    let steps = std::iter::once(first).chain(std::iter::repeat(other));
    Family::new(2.0, steps.take(count.saturating_sub(1)))
}

/// The coefficients of P_n that give the same sum as these of Q_n (eq. 3.2 to 3.4).
pub fn change(coefficients: &[f64]) -> Vec<f64> {
    let Norms { f, g, h } = Norms::new(coefficients.len());
    let mut changed = vec![0.0; coefficients.len()];
    for n in (0..coefficients.len()).rev() {
        let after = |k: usize| changed.get(n + k).copied().unwrap_or(0.0);
        changed[n] = (coefficients[n] - g[n] * after(1) - h[n] * after(2)) / f[n];
    }
    changed
}

/// f_n, g_n and h_n for n from 0 on.
struct Norms {
    f: Vec<f64>,
    g: Vec<f64>,
    h: Vec<f64>,
}

impl Norms {
    fn new(count: usize) -> Self {
        let (mut f, mut g, mut h) = (Vec::new(), Vec::new(), Vec::<f64>::new());
        for n in 0..count {
            let m = n as f64;
            let back = |list: &[f64], by: usize| {
                let index = n.checked_sub(by);
                index
                    .and_then(|index| list.get(index))
                    .copied()
                    .unwrap_or(0.0)
            };
            let (g_before, h_before) = (back(&g, 1), back(&h, 2));
            let here: f64 = match n {
                0 => 2.0,
                1 => 0.5 * 19.0f64.sqrt(),
                _ => (m * (m + 1.0) + 3.0 - g_before * g_before - h_before * h_before).sqrt(),
            };
            f.push(here);
            g.push(match n {
                0 => -0.5,
                _ => -(1.0 + g_before * back(&h, 1)) / here,
            });
            h.push(-(m + 2.0) * (m + 1.0) / (2.0 * here));
        }
        Self { f, g, h }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forbes 2007, Opt. Express 15, 5218: Q_0 = 1, Q_1 = (13 − 16x)/sqrt 19, Q_2 = sqrt(2/95) (29 −
    /// 4x(25 − 19x)), Q_3 = sqrt(2/2545) (207 − 4x(315 − x(577 − 320x))).
    #[test]
    fn polynomials_are_those_that_forbes_prints() {
        let q = |n: usize, x: f64| {
            let mut coefficients = vec![0.0; n + 1];
            coefficients[n] = 1.0;
            family(n + 1).sum(&change(&coefficients), x)
        };
        for x in [0.0, 0.2, 0.7, 1.0] {
            let printed = [
                1.0,
                (13.0 - 16.0 * x) / 19.0f64.sqrt(),
                (2.0f64 / 95.0).sqrt() * (29.0 - 4.0 * x * (25.0 - 19.0 * x)),
                (2.0f64 / 2545.0).sqrt() * (207.0 - 4.0 * x * (315.0 - x * (577.0 - 320.0 * x))),
            ];
            for (n, printed) in printed.into_iter().enumerate() {
                assert!((q(n, x) - printed).abs() < 1e-13, "Q_{n}({x})");
            }
        }
    }
}
