//! Series and rates against 50-digit references, against each other, and against the numerical fit.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::common::{centres, rates, series};
use crate::models::{model, try_model};
use serde_json::Value;
use turnpath_core::{
    Centres, Compensator, Cut, DEG, Params, Radial, Result, Series, SurfaceModel, Tool, ToolLocus,
};
use turnpath_nose_radius::{Normal, Uncompensated, ZDirection};
use turnpath_surfaces::Toric;

const REFERENCE: &str = include_str!("../../../../tests/reference/compensators.json");

const TOOL: Tool = Tool {
    nose_radius: 1.0,
    included_angle: None,
    clearance_angle: None,
    misfit: turnpath_core::Misfit::Refuse,
};

fn surface(name: &str, params: &Value) -> Arc<dyn SurfaceModel> {
    let params = params
        .as_object()
        .unwrap()
        .iter()
        .fold(Params::new(), |params, (name, value)| {
            params.with(name, value.as_f64().unwrap())
        });
    try_model(name, &params).unwrap()
}

fn compensator(name: &str) -> Arc<dyn Compensator> {
    match name {
        "z-direction" => Arc::new(ZDirection),
        "normal" => Arc::new(Normal),
        "none" => Arc::new(Uncompensated),
        other => panic!("no compensator {other}"),
    }
}

fn coefficients(value: &Value) -> Series {
    std::array::from_fn(|k| value[k].as_f64().unwrap())
}

/// The largest |found − exact| over |exact| of all coefficients.
fn worst(found: &Series, exact: &Series) -> f64 {
    let relative = found.iter().zip(exact).map(|(found, exact)| {
        if found == exact {
            0.0
        } else {
            (found - exact).abs() / exact.abs()
        }
    });
    relative.fold(0.0, f64::max)
}

/// Every coefficient agrees to 1e-12 of itself. In the reference only X's own zeros vanish.
#[test]
fn series_agree_with_the_50_digit_reference() {
    let cases: Value = serde_json::from_str(REFERENCE).unwrap();
    for (i, case) in cases.as_array().unwrap().iter().enumerate() {
        let name = case["compensator"].as_str().unwrap();
        let surface = surface(case["surface"].as_str().unwrap(), &case["params"]);
        let locus = ToolLocus::new(surface, compensator(name), TOOL);
        let (theta, rho) = (coefficients(&case["theta"]), coefficients(&case["rho"]));
        let [x, z] = series(&locus, &[theta], &[rho]);
        for (what, found, exact) in [("X", x[0], &case["x"]), ("Z", z[0], &case["z"])] {
            let exact = coefficients(exact);
            let off = worst(&found, &exact);
            assert!(
                off < 1e-12,
                "case {i}, {name}, {what}: {found:?} for {exact:?}, off {off:e}"
            );
        }
    }
}

/// Another compensator's centre alone, so that the host must fit the rest.
struct CentreOnly(Arc<dyn Compensator>);

impl Compensator for CentreOnly {
    fn radial(&self) -> Radial {
        self.0.radial()
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        self.0.centre(cut, theta, rho, out)
    }
}

const NAMES: [&str; 3] = ["z-direction", "normal", "none"];

fn bent() -> Arc<dyn SurfaceModel> {
    let params = Params::new()
        .with("radius_rotation", 9.0)
        .with("radius_base", -5.0);
    model::<Toric>(&params)
}

fn places() -> (Vec<f64>, Vec<f64>) {
    (0..300)
        .map(|i| {
            (
                f64::from(i) * 0.37,
                -0.2 + 2.5 * (f64::from(i) * 0.618).fract(),
            )
        })
        .unzip()
}

fn lines(start: &[f64], rate: f64) -> Vec<Series> {
    start
        .iter()
        .map(|start| [*start, rate, 0.0, 0.0, 0.0])
        .collect()
}

#[test]
fn rates_are_the_first_coefficients_along_both_coordinates() {
    let (theta, rho) = places();
    for name in NAMES {
        let locus = ToolLocus::new(bent(), compensator(name), TOOL);
        let [x_theta, x_rho, z_theta, z_x] = rates(&locus, &theta, &rho);
        let turned = series(&locus, &lines(&theta, 1.0), &lines(&rho, 0.0));
        let moved = series(&locus, &lines(&theta, 0.0), &lines(&rho, 1.0));
        for i in 0..theta.len() {
            let pairs = [
                (x_theta[i], turned[0][i][1]),
                (x_rho[i], moved[0][i][1]),
                (z_theta[i] + z_x[i] * x_theta[i], turned[1][i][1]),
                (z_x[i] * x_rho[i], moved[1][i][1]),
            ];
            for (rate, coefficient) in pairs {
                assert!(
                    (rate - coefficient).abs() < 1e-14,
                    "{name}: {rate} for {coefficient}"
                );
            }
        }
    }
}

#[test]
fn the_constant_coefficient_is_the_centre() {
    let (theta, rho) = places();
    for name in NAMES {
        let locus = ToolLocus::new(bent(), compensator(name), TOOL);
        let at = centres(&locus, &theta, &rho);
        let [x, z] = series(&locus, &lines(&theta, 1.0), &lines(&rho, 0.1));
        for i in 0..theta.len() {
            assert!((x[i][0] - at.x[i]).abs() < 1e-15);
            assert!((z[i][0] - at.z[i]).abs() < 1e-15);
        }
    }
}

/// The accuracy of the numerical fit from centres alone, in mm and mm/rad^k. A tolerance of 1 nm at
/// steps of 45 degrees needs c_4 to about 1e-5.
#[test]
fn fitted_series_and_rates_come_close_to_the_exact_ones() {
    let (theta, rho) = places();
    let allowed = [1e-15, 1e-12, 1e-10, 1e-8, 1e-7];
    for name in NAMES {
        let exact = ToolLocus::new(bent(), compensator(name), TOOL);
        let fitted = ToolLocus::new(bent(), Arc::new(CentreOnly(compensator(name))), TOOL);
        let curves = (lines(&theta, 1.0), lines(&rho, -0.01));
        let exact_series = series(&exact, &curves.0, &curves.1);
        let fitted_series = series(&fitted, &curves.0, &curves.1);
        for axis in 0..2 {
            for k in 0..5 {
                let off = exact_series[axis].iter().zip(&fitted_series[axis]);
                let off = off.map(|(e, f)| (e[k] - f[k]).abs()).fold(0.0, f64::max);
                assert!(off <= allowed[k], "{name}, axis {axis}, c_{k}: {off:e}");
            }
        }
        let (exact, fitted) = (rates(&exact, &theta, &rho), rates(&fitted, &theta, &rho));
        for (which, (exact, fitted)) in exact.iter().zip(&fitted).enumerate() {
            let off = exact.iter().zip(fitted).map(|(e, f)| (e - f).abs());
            let off = off.fold(0.0, f64::max);
            assert!(off < 1e-12, "{name}, rate {which}: {off:e}");
        }
    }
}

/// At 1.5 to 2 mm the section rises by more than 8 degrees, and the edge ends at 5 degrees.
#[test]
fn where_the_edge_ends_series_and_rates_are_those_of_its_end() {
    let blunt = Tool {
        included_angle: Some(10.0 * DEG),
        ..TOOL
    };
    let (theta, rho) = ([0.1, 0.2, 0.3, 0.4], [1.5, 2.0, 1.7, 1.9]);
    let exact = ToolLocus::new(bent(), Arc::new(ZDirection), blunt);
    let feet = centres(&exact, &theta, &rho).foot;
    assert!(
        feet.iter()
            .zip(&rho)
            .all(|(foot, rho)| *foot == rho + blunt.reach())
    );
    let fitted = CentreOnly(Arc::new(ZDirection));
    let fitted = ToolLocus::new(bent(), Arc::new(fitted), blunt);
    let curves = (lines(&theta, 1.0), lines(&rho, -0.01));
    let [_, exact_z] = series(&exact, &curves.0, &curves.1);
    let [_, fitted_z] = series(&fitted, &curves.0, &curves.1);
    for (exact, fitted) in exact_z.iter().zip(&fitted_z) {
        for (k, allowed) in [1e-15, 1e-12, 1e-10, 1e-8, 1e-7].into_iter().enumerate() {
            assert!(
                (exact[k] - fitted[k]).abs() <= allowed,
                "{exact:?}, {fitted:?}"
            );
        }
    }
    let (exact, fitted) = (rates(&exact, &theta, &rho), rates(&fitted, &theta, &rho));
    for (exact, fitted) in exact.iter().flatten().zip(fitted.iter().flatten()) {
        assert!((exact - fitted).abs() < 1e-12, "{exact} for {fitted}");
    }
}
