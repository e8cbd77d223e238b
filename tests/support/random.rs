//! Parts for tests on random input. The program that includes this file
//! has `models.rs` as the module `models`.
#![allow(dead_code, reason = "every test program uses its own part")]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::models::model;
use proptest::prelude::{ProptestConfig, Strategy as Generator, prop};
use turnpath_core::{Compensator, ParamValue, Params, SurfaceModel};
use turnpath_nose_radius::{Normal, Uncompensated, ZDirection};
use turnpath_surfaces::{SinusoidalArray, XyPolynomial};

/// The cases of a test whose cases are dear: this part of the usual number, with no file of failures.
pub fn one_case_in(part: u32) -> ProptestConfig {
    ProptestConfig {
        cases: ProptestConfig::default().cases.div_ceil(part),
        failure_persistence: None,
        ..Default::default()
    }
}

/// A sinusoidal array; its form is `sum` or `product`.
pub fn array(amplitude: f64, frequency: f64, form: &str) -> Arc<dyn SurfaceModel> {
    let mut params = Params::new()
        .with("amplitude_x", amplitude)
        .with("frequency_x", frequency);
    params.set("form", ParamValue::Text(form.to_owned()));
    model::<SinusoidalArray>(&params)
}

/// Terms of xy-polynomials of degree 4; those of the n-th degree are at most `largest[n]`.
pub fn terms(largest: [f64; 5]) -> impl Generator<Value = Vec<Vec<f64>>> {
    let powers = (0..5).flat_map(|i| (0..5 - i).map(move |j| (i, j)));
    let powers: Vec<(i32, i32)> = powers.collect();
    prop::collection::vec(-1.0..1.0f64, powers.len()).prop_map(move |c| {
        let rows = powers.iter().zip(c).map(|(&(i, j), c)| {
            let scale = largest[(i + j) as usize];
            vec![f64::from(i), f64::from(j), scale * c]
        });
        rows.collect()
    })
}

/// The polynomial of such terms.
pub fn polynomial(terms: Vec<Vec<f64>>) -> Arc<dyn SurfaceModel> {
    let mut params = Params::new();
    params.set("terms", ParamValue::Rows(terms));
    model::<XyPolynomial>(&params)
}

/// One of the two compensators.
pub fn compensating(which: bool) -> Arc<dyn Compensator> {
    if which {
        Arc::new(ZDirection)
    } else {
        Arc::new(Normal)
    }
}

/// One of the two compensators, or none.
pub fn compensator(which: u8) -> Arc<dyn Compensator> {
    match which % 3 {
        0 => Arc::new(Uncompensated),
        one_of_both => compensating(one_of_both == 1),
    }
}
