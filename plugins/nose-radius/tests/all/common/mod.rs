//! Calls of a tool locus, with buffers for the answers.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]
#![allow(dead_code, reason = "every test program uses its own part")]

use turnpath_core::{CentreBuffers, CentreSeries, Locus, Rates, Series, ToolLocus};

/// Centres and feet at each (θ, ρ).
pub fn centres(locus: &ToolLocus, theta: &[f64], rho: &[f64]) -> CentreBuffers {
    let mut found = CentreBuffers::default();
    found.resize(theta.len());
    locus.centre(theta, rho, found.as_centres()).unwrap();
    found
}

/// X_θ, X_ρ, Z_θ and Z_X at each (θ, ρ).
pub fn rates(locus: &ToolLocus, theta: &[f64], rho: &[f64]) -> [Vec<f64>; 4] {
    let mut found: [Vec<f64>; 4] = std::array::from_fn(|_| vec![f64::NAN; theta.len()]);
    let [x_theta, x_rho, z_theta, z_x] = &mut found;
    let out = Rates {
        x_theta,
        x_rho,
        z_theta,
        z_x,
    };
    locus.rates(theta, rho, out).unwrap();
    found
}

/// X(t) and Z(t) along each curve.
pub fn series(locus: &ToolLocus, theta: &[Series], rho: &[Series]) -> [Vec<Series>; 2] {
    let mut found = [
        vec![[f64::NAN; 5]; theta.len()],
        vec![[f64::NAN; 5]; theta.len()],
    ];
    let [x, z] = &mut found;
    locus.series(theta, rho, CentreSeries { x, z }).unwrap();
    found
}
