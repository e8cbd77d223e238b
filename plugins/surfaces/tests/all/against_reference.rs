//! Every surface against mpmath (tests/reference/surfaces.py): height, slopes, and their series.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::models;
use serde_json::Value;
use turnpath_core::{
    GradientSeries, Gradients, ParamDefault, ParamValue, Params, Series, Strategy, SurfaceModel,
};
use turnpath_surfaces::{
    Astigmatic, Conic, OffAxisParaboloid, SinusoidalArray, Toric, XyPolynomial,
};

/// Bound of each coefficient, relative to the coefficient itself.
const RELATIVE: f64 = 1e-12;

struct Case {
    name: String,
    surface: Arc<dyn SurfaceModel>,
    x: Series,
    y: Series,
    z: Series,
    zx: Series,
    zy: Series,
}

fn cases() -> Vec<Case> {
    let text = include_str!("../../../../tests/reference/surfaces.json");
    let values: Vec<Value> = serde_json::from_str(text).unwrap();
    values.iter().map(case).collect()
}

fn case(value: &Value) -> Case {
    let series = |key: &str| serde_json::from_value(value[key].clone()).unwrap();
    let surface = value["surface"].as_str().unwrap();
    Case {
        name: format!("{surface} {}", value["params"]),
        surface: model(surface, &value["params"]),
        x: series("x"),
        y: series("y"),
        z: series("z"),
        zx: series("zx"),
        zy: series("zy"),
    }
}

fn model(name: &str, params: &Value) -> Arc<dyn SurfaceModel> {
    match name {
        Astigmatic::NAME => make::<Astigmatic>(params),
        Conic::NAME => make::<Conic>(params),
        XyPolynomial::NAME => make::<XyPolynomial>(params),
        Toric::NAME => make::<Toric>(params),
        SinusoidalArray::NAME => make::<SinusoidalArray>(params),
        OffAxisParaboloid::NAME => make::<OffAxisParaboloid>(params),
        other => panic!("the reference has a surface `{other}` that this test does not know"),
    }
}

fn make<T: Strategy>(given: &Value) -> Arc<dyn SurfaceModel> {
    let mut params = Params::new();
    for param in T::PARAMS {
        match param.default {
            ParamDefault::Number(value) => params.set(param.name, ParamValue::Number(value)),
            ParamDefault::Text(word) => params.set(param.name, ParamValue::Text(word.to_owned())),
            _ => {}
        }
    }
    for (name, value) in given.as_object().unwrap() {
        params.set(name, param_value(value));
    }
    models::model::<T>(&params)
}

fn param_value(value: &Value) -> ParamValue {
    match value {
        Value::String(text) => ParamValue::Text(text.clone()),
        Value::Array(_) => ParamValue::Rows(serde_json::from_value(value.clone()).unwrap()),
        _ => ParamValue::Number(value.as_f64().unwrap()),
    }
}

fn assert_close(what: &str, ours: &Series, reference: &Series) {
    for (k, (ours, reference)) in ours.iter().zip(reference).enumerate() {
        let error = (ours - reference).abs();
        assert!(
            error <= RELATIVE * reference.abs(),
            "{what}, coefficient {k}: {ours}, reference {reference}, relative {:e}",
            error / reference.abs()
        );
    }
}

#[test]
fn series_of_height_and_slopes_agree() {
    for case in cases() {
        let (mut z, mut zx, mut zy) = ([[0.0; 5]], [[0.0; 5]], [[0.0; 5]]);
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        case.surface.series(&[case.x], &[case.y], out).unwrap();
        assert_close(&format!("{}: z", case.name), &z[0], &case.z);
        assert_close(&format!("{}: zx", case.name), &zx[0], &case.zx);
        assert_close(&format!("{}: zy", case.name), &zy[0], &case.zy);
        let mut height = [[0.0; 5]];
        case.surface
            .height_series(&[case.x], &[case.y], &mut height)
            .unwrap();
        assert_close(&format!("{}: height", case.name), &height[0], &case.z);
    }
}

#[test]
fn heights_and_slopes_are_the_constant_terms() {
    for case in cases() {
        let (x, y) = ([case.x[0]; 9], [case.y[0]; 9]);
        let (mut z, mut zx, mut zy) = ([0.0; 9], [0.0; 9], [0.0; 9]);
        let mut height = [0.0; 9];
        case.surface.heights(&x, &y, &mut height).unwrap();
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        case.surface.gradient(&x, &y, out).unwrap();
        for i in 0..9 {
            let only =
                |first: f64, series: &Series| [first, series[1], series[2], series[3], series[4]];
            assert_close(&case.name, &only(height[i], &case.z), &case.z);
            assert_close(&case.name, &only(z[i], &case.z), &case.z);
            assert_close(&case.name, &only(zx[i], &case.zx), &case.zx);
            assert_close(&case.name, &only(zy[i], &case.zy), &case.zy);
        }
    }
}

/// The last point of an odd batch goes through the formula alone, and the others go in lanes.
#[test]
fn a_point_alone_is_bit_for_bit_the_same_as_in_a_batch() {
    for case in cases() {
        let x: Vec<f64> = (0..17)
            .map(|i| case.x[0] * (1.0 - 0.05 * f64::from(i)))
            .collect();
        let y: Vec<f64> = (0..17)
            .map(|i| case.y[0] * (1.0 - 0.04 * f64::from(i)))
            .collect();
        let (mut z, mut zx, mut zy) = ([0.0; 17], [0.0; 17], [0.0; 17]);
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        case.surface.gradient(&x, &y, out).unwrap();
        for i in 0..17 {
            let (mut one, mut one_x, mut one_y) = ([0.0], [0.0], [0.0]);
            let out = Gradients {
                z: &mut one,
                zx: &mut one_x,
                zy: &mut one_y,
            };
            case.surface.gradient(&x[i..=i], &y[i..=i], out).unwrap();
            let bits = [one[0], one_x[0], one_y[0]].map(f64::to_bits);
            assert_eq!(
                bits,
                [z[i], zx[i], zy[i]].map(f64::to_bits),
                "{}",
                case.name
            );
            case.surface
                .heights(&x[i..=i], &y[i..=i], &mut one)
                .unwrap();
            assert_eq!(one[0].to_bits(), z[i].to_bits(), "{}", case.name);
        }
    }
}
