//! Times of formulas beside those of the native models that say the same: ns a point.
//!
//! Run: `cargo bench -p turnpath-formula --bench times`

use std::hint::black_box;
use std::time::Instant;

use turnpath_core::{
    GradientSeries, Gradients, NamedConstant, ParamValue, Params, Result, Series, Strategy,
    SurfaceModel,
};
use turnpath_formula::Formula;
use turnpath_surfaces::{Conic, SinusoidalArray, Toric};

const POINTS: usize = 4096;
const ROUNDS: usize = 200;

fn main() -> Result<()> {
    let conic = Params::new().with("radius", 40.0).with("conic", -0.7);
    let mut waves = Params::new()
        .with("amplitude_x", 5e-3)
        .with("frequency_x", 0.4);
    waves.set("form", ParamValue::Text("sum".to_owned()));
    let toric = Params::new()
        .with("radius_rotation", 50.0)
        .with("radius_base", 32.0);
    println!("model, formula/native: height ns, gradient ns, height series ns, series ns");
    compare(
        "conic",
        &Conic::new(&conic)?,
        &formula(
            "c*rho^2/(1 + sqrt(1 - (1 + K)*c^2*rho^2))",
            &[("c", 0.025, -1), ("K", -0.7, 0)],
        )?,
    )?;
    compare(
        "sinusoidal-array",
        &SinusoidalArray::new(&waves)?,
        &formula(
            "A*cos(2*pi*f*x) + A*cos(2*pi*f*y)",
            &[("A", 5e-3, 1), ("f", 0.4, -1)],
        )?,
    )?;
    compare(
        "toric",
        &Toric::new(&toric)?,
        &formula(
            "R - sqrt((R - a + sqrt(a^2 - y^2))^2 - x^2)",
            &[("R", 50.0, 1), ("a", 32.0, 1)],
        )?,
    )
}

fn formula(z: &str, constants: &[(&str, f64, i32)]) -> Result<Formula> {
    let constant = |(name, value, length_power): &(&str, f64, i32)| NamedConstant {
        name: (*name).to_owned(),
        value: *value,
        length_power: *length_power,
    };
    let mut params = Params::new();
    params.set("z", ParamValue::Text(z.to_owned()));
    params.set(
        "constants",
        ParamValue::Constants(constants.iter().map(constant).collect()),
    );
    Formula::new(&params)
}

fn compare(name: &str, native: &dyn SurfaceModel, formula: &dyn SurfaceModel) -> Result<()> {
    let (native, formula) = (times(native)?, times(formula)?);
    let pairs = native
        .iter()
        .zip(formula)
        .map(|(native, formula)| format!("{formula:.1}/{native:.1} = {:.2}", formula / native));
    println!("{name}: {}", pairs.collect::<Vec<_>>().join(", "));
    Ok(())
}

fn times(surface: &dyn SurfaceModel) -> Result<[f64; 4]> {
    let at = |step: f64| {
        (0..POINTS).map(move |i| 5.0 * (i as f64 * step - (i as f64 * step).floor()) - 2.5)
    };
    let (x, y): (Vec<f64>, Vec<f64>) = (at(0.618_034).collect(), at(0.414_214).collect());
    let series = |values: &[f64]| values.iter().map(|v| [*v, 0.5, 0.1, 0.0, 0.0]).collect();
    let (xs, ys): (Vec<Series>, Vec<Series>) = (series(&x), series(&y));
    let (mut z, mut zx, mut zy) = (vec![0.0; POINTS], vec![0.0; POINTS], vec![0.0; POINTS]);
    let mut s = [(); 3].map(|()| vec![[0.0; 5]; POINTS]);
    let height = least(|| surface.heights(black_box(&x), &y, &mut z))?;
    let gradient = least(|| {
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.gradient(black_box(&x), &y, out)
    })?;
    let [sz, szx, szy] = &mut s;
    let height_series = least(|| surface.height_series(black_box(&xs), &ys, sz))?;
    let all = least(|| {
        let out = GradientSeries {
            z: sz,
            zx: szx,
            zy: szy,
        };
        surface.series(black_box(&xs), &ys, out)
    })?;
    Ok([height, gradient, height_series, all])
}

/// The least time of some rounds: the one that nothing else disturbed.
fn least(mut call: impl FnMut() -> Result<()>) -> Result<f64> {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        call()?;
        least = least.min(start.elapsed().as_nanos() as f64 / POINTS as f64);
    }
    Ok(least)
}
