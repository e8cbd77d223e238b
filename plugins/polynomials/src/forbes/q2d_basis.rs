//! The polynomials Q_n^m of m > 0 by way of others with a plain recurrence.
//!
//! Forbes 2012, Opt. Express 20, 2483: with x = u², Q_n^m = (P_n^m − g_{n−1}^m Q_{n−1}^m) / f_n^m,
//! appendix A.

use crate::recurrence::{Family, Step};

/// The first `count` polynomials P_n^m(x) of an order m > 0: P_0 = 1/2, and from each two the next
/// (A.1 to A.6). Those of m = 1 begin otherwise.
pub fn family(order: usize, count: usize) -> Family {
    Family::new(0.5, (0..count.saturating_sub(1)).map(|n| step(order, n)))
}

/// The step from P_n to P_{n+1}.
fn step(order: usize, n: usize) -> Step {
    let plain = |constant, slope, back, lift| Step {
        constant,
        slope,
        back,
        lift,
    };
    let m = order as f64;
    match (order, n) {
        // P_1 = 1 − x/2, P_2 = (3 − 12x + 8x²)/6, P_3 = (5 − 60x + 120x² − 64x³)/10
        (1, 0) => plain(2.0, -1.0, 0.0, 0.0),
        (1, 1) => plain(-4.0 / 3.0, -8.0 / 3.0, -11.0 / 3.0, 0.0),
        (1, 2) => plain(9.0 / 5.0, -24.0 / 5.0, 0.0, -2.0 / 5.0),
        // P_1 = m − 1/2 + (1 − m)x
        (_, 0) => plain(2.0 * m - 1.0, 2.0 * (1.0 - m), 0.0, 0.0),
        _ => {
            let n = n as f64;
            let scale = (4.0 * n * n - 1.0) * (m + n - 2.0) * (m + 2.0 * n - 3.0);
            let of_constant = 4.0 * n * (m + n - 2.0) + (m - 3.0) * (2.0 * m - 1.0);
            let constant = (2.0 * n - 1.0) * (m + 2.0 * n - 2.0) * of_constant / scale;
            let of_slope = (m + 2.0 * n - 3.0) * (m + 2.0 * n - 2.0) * (m + 2.0 * n - 1.0);
            let slope = -2.0 * (2.0 * n - 1.0) * of_slope / scale;
            let of_back = (m + 2.0 * n - 1.0) * (2.0 * m + 2.0 * n - 3.0);
            let back = n * (2.0 * n - 3.0) * of_back / scale;
            plain(constant, slope, back, 0.0)
        }
    }
}

/// The coefficients of P_n^m that give the same sum as these of Q_n^m (B.2 to B.4).
pub fn change(order: usize, coefficients: &[f64]) -> Vec<f64> {
    let norms = norms(order, coefficients.len());
    let mut changed = vec![0.0; coefficients.len()];
    for n in (0..coefficients.len()).rev() {
        let after = changed.get(n + 1).copied().unwrap_or(0.0);
        let (f, g) = norms[n];
        changed[n] = (coefficients[n] - g * after) / f;
    }
    changed
}

/// f_n^m and g_n^m for n from 0 on (A.18): f² = F − g² of the n before, g = G/f.
fn norms(order: usize, count: usize) -> Vec<(f64, f64)> {
    let mut norms = Vec::new();
    let mut gamma = gamma_1(order);
    let mut g_before = 0.0;
    for n in 0..count {
        if n >= 2 {
            gamma *= gamma_growth(order, n - 1);
        }
        let (big_f, big_g) = match (n, order) {
            (0, _) => squares_of_first(order),
            (_, 1) => squares_of_order_1(n),
            _ => squares(order, n, gamma),
        };
        let f = (big_f - g_before * g_before).sqrt();
        let g = big_g / f;
        norms.push((f, g));
        g_before = g;
    }
    norms
}

/// F and G of n = 0 (A.13, A.15): m²(2m − 3)!!/(2^(m+1)(m − 1)!) and (2m − 1)!!/(2^(m+1)(m − 1)!).
fn squares_of_first(order: usize) -> (f64, f64) {
    let ratio = (1..order).fold(0.25, |ratio, m| {
        let m = m as f64;
        ratio * (2.0 * m - 1.0) / (2.0 * m)
    });
    let m = order as f64;
    (m * m * ratio, (2.0 * m - 1.0) * ratio)
}

/// F and G of m = 1 and n > 0.
fn squares_of_order_1(number: usize) -> (f64, f64) {
    let n = number as f64;
    let first = |value| if number == 1 { value } else { 0.0 };
    let odd = 2.0 * n - 1.0;
    let big_f = (4.0 * (n - 1.0) * (n - 1.0) * n * n + 1.0) / (8.0 * odd * odd);
    let big_g = -(2.0 * n * n - 1.0) * (n * n - 1.0) / (8.0 * (4.0 * n * n - 1.0));
    (big_f + first(11.0 / 32.0), big_g - first(1.0 / 24.0))
}

/// F and G of m > 1 and n > 0.
fn squares(order: usize, number: usize, gamma: f64) -> (f64, f64) {
    let (m, n) = (order as f64, number as f64);
    let chi = m + n - 2.0;
    let above = 2.0 * n * chi * (3.0 - 5.0 * m + 4.0 * n * chi) + m * m * (3.0 - m + 4.0 * n * chi);
    let below = (m + 2.0 * n - 3.0) * (m + 2.0 * n - 2.0) * (m + 2.0 * n - 1.0) * (2.0 * n - 1.0);
    let big_f = above / below * gamma;
    let above = (2.0 * n * (m + n - 1.0) - m) * (n + 1.0) * (2.0 * m + 2.0 * n - 1.0);
    let below = (m + 2.0 * n - 2.0) * (m + 2.0 * n - 1.0) * (m + 2.0 * n) * (2.0 * n + 1.0);
    (big_f, -above / below * gamma)
}

/// γ of n = 1 (A.14).
fn gamma_1(order: usize) -> f64 {
    (2..order).fold(0.375, |gamma, m| {
        let m = m as f64;
        gamma * (2.0 * m + 1.0) / (2.0 * (m - 1.0))
    })
}

/// γ of n + 1 over γ of n.
fn gamma_growth(order: usize, n: usize) -> f64 {
    let (m, n) = (order as f64, n as f64);
    (n + 1.0) * (2.0 * m + 2.0 * n - 1.0) / ((m + n - 2.0) * (2.0 * n + 1.0))
}
