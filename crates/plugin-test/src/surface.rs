//! Surfaces: heights on the part, batches, and derivatives against differences.

use turnpath_core::fit::evaluate;
use turnpath_core::{
    GradientSeries, Gradients, ORDER, Part, Result as Answer, Series, SurfaceModel,
};

use crate::batches;
use crate::convergence::{STEPS, ladder, wrong_term};
use crate::fault::FaultKind;
use crate::place::OnPart;
use crate::sections::{cartesian, points_of};

/// Points of the part at which a height is asked for.
const HEIGHTS: usize = 500;
/// Points whose derivatives are compared, and which are asked for in batches.
const CURVES: usize = 60;
/// Length of the curves as a part of the part's radius: wide enough that fourth derivatives show.
const WIDEST: f64 = 0.08;
/// How far the height may differ between calls, as a part of the largest height: rounding.
const ROUNDING: f64 = 1e-12;

/// Checks a surface on a part.
pub fn check(surface: &dyn SurfaceModel, part: &Part) -> Vec<FaultKind> {
    let points = points_of(part, CURVES);
    let checks = [
        heights(surface, part),
        in_batches(surface, &points),
        agreement(surface, &points),
        slopes(surface, part, &points),
        series(surface, part, &points),
    ];
    checks.into_iter().filter_map(Result::err).collect()
}

fn heights(surface: &dyn SurfaceModel, part: &Part) -> Result<(), FaultKind> {
    let points = points_of(part, HEIGHTS);
    let z = heights_at(surface, &points)?;
    match z.iter().position(|z| !z.is_finite()) {
        None => Ok(()),
        Some(i) => Err(FaultKind::NoHeight(points[i])),
    }
}

fn failed(call: &'static str) -> impl Fn(turnpath_core::StrategyError) -> FaultKind {
    move |error| FaultKind::Call { call, error }
}

fn heights_at(surface: &dyn SurfaceModel, points: &[OnPart]) -> Result<Vec<f64>, FaultKind> {
    let (x, y) = cartesian(points);
    let mut z = vec![f64::NAN; x.len()];
    let asked = surface.heights(&x, &y, &mut z);
    asked.map_err(failed("heights"))?;
    Ok(z)
}

/// z, ∂z/∂x and ∂z/∂y.
fn gradient(surface: &dyn SurfaceModel, points: &[OnPart]) -> Answer<Vec<[f64; 3]>> {
    let (x, y) = cartesian(points);
    let blank = vec![f64::NAN; x.len()];
    let (mut z, mut zx, mut zy) = (blank.clone(), blank.clone(), blank);
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.gradient(&x, &y, out)?;
    Ok((0..x.len()).map(|i| [z[i], zx[i], zy[i]]).collect())
}

/// Curves through the points: each bends, and none is straight in x or in y.
struct Curves {
    x: Vec<Series>,
    y: Vec<Series>,
}

impl Curves {
    fn through(points: &[OnPart], part: &Part) -> Self {
        let reach = WIDEST * part.aperture_radius;
        let (x, y) = cartesian(points);
        let bend = |middle: &f64, [first, second, third]: [f64; 3]| {
            let [first, second, third] = [first, second, third].map(|part| part * reach);
            [*middle, first, second, third, 0.2 * third]
        };
        Self {
            x: x.iter().map(|x| bend(x, [0.8, -0.3, 0.1])).collect(),
            y: y.iter().map(|y| bend(y, [0.6, 0.4, -0.2])).collect(),
        }
    }

    /// The points of the curves on the ladder, in x and y.
    fn on_ladder(&self) -> (Vec<f64>, Vec<f64>) {
        let along = |curves: &[Series]| -> Vec<f64> {
            let places = curves
                .iter()
                .flat_map(|curve| ladder().map(|t| evaluate(curve, t)));
            places.collect()
        };
        (along(&self.x), along(&self.y))
    }
}

/// z, ∂z/∂x and ∂z/∂y as series.
fn series_along(surface: &dyn SurfaceModel, curves: &Curves) -> Answer<[Vec<Series>; 3]> {
    let blank = vec![[f64::NAN; ORDER + 1]; curves.x.len()];
    let (mut z, mut zx, mut zy) = (blank.clone(), blank.clone(), blank);
    let out = GradientSeries {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.series(&curves.x, &curves.y, out)?;
    Ok([z, zx, zy])
}

fn in_batches(surface: &dyn SurfaceModel, points: &[OnPart]) -> Result<(), FaultKind> {
    let names = ["the height", "∂z/∂x", "∂z/∂y"];
    batches::check("gradient", names, points, |points| {
        gradient(surface, points)
    })?;
    batches::check("heights", ["the height"], points, |points| {
        let (x, y) = cartesian(points);
        let mut z = vec![f64::NAN; x.len()];
        surface.heights(&x, &y, &mut z)?;
        Ok(z.into_iter().map(|z| [z]).collect())
    })?;
    let part = Part {
        aperture_radius: points.last().map_or(1.0, |point| point.rho),
        inner_radius: 0.0,
    };
    let terms = ["t⁰", "t¹", "t²", "t³", "t⁴"];
    batches::check("series", terms, points, |points| {
        let [z, ..] = series_along(surface, &Curves::through(points, &part))?;
        Ok(z)
    })?;
    batches::check("height_series", terms, points, |points| {
        let curves = Curves::through(points, &part);
        let mut z = vec![[f64::NAN; ORDER + 1]; points.len()];
        surface.height_series(&curves.x, &curves.y, &mut z)?;
        Ok(z)
    })
}

/// All calls give one height.
fn agreement(surface: &dyn SurfaceModel, points: &[OnPart]) -> Result<(), FaultKind> {
    let z = heights_at(surface, points)?;
    let of_gradient = gradient(surface, points).map_err(failed("gradient"))?;
    let part = Part {
        aperture_radius: 1.0,
        inner_radius: 0.0,
    };
    let curves = Curves::through(points, &part);
    let [of_series, ..] = series_along(surface, &curves).map_err(failed("series"))?;
    let mut alone = vec![[f64::NAN; ORDER + 1]; points.len()];
    let asked = surface.height_series(&curves.x, &curves.y, &mut alone);
    asked.map_err(failed("height_series"))?;
    let largest = z.iter().fold(0.0, |m: f64, z| m.max(z.abs()));
    for i in 0..points.len() {
        let others = [
            ("as the height of `gradient`", of_gradient[i][0]),
            ("as the first term of `series`", of_series[i][0]),
            ("as the first term of `height_series`", alone[i][0]),
        ];
        for (when, other) in others {
            if (other - z[i]).abs() > ROUNDING * largest {
                return Err(FaultKind::Repeat {
                    what: format!("the height at {}", points[i]),
                    when,
                    first: z[i],
                    second: other,
                });
            }
        }
    }
    Ok(())
}

/// Slopes against differences of heights, along x and along y.
fn slopes(surface: &dyn SurfaceModel, part: &Part, points: &[OnPart]) -> Result<(), FaultKind> {
    let reach = WIDEST * part.aperture_radius;
    let slopes = gradient(surface, points).map_err(failed("gradient"))?;
    let (x, y) = cartesian(points);
    for (k, axis) in [(1, 'x'), (2, 'y')] {
        let step = |along: bool, t: f64| if along { reach * t } else { 0.0 };
        let along = |middle: &[f64], is_axis: bool| -> Vec<f64> {
            let places = middle
                .iter()
                .flat_map(|m| ladder().map(|t| m + step(is_axis, t)));
            places.collect()
        };
        let (x, y) = (along(&x, axis == 'x'), along(&y, axis == 'y'));
        let mut z = vec![f64::NAN; x.len()];
        let asked = surface.heights(&x, &y, &mut z);
        asked.map_err(failed("heights"))?;
        let lines: Vec<Series> = slopes
            .iter()
            .map(|slope| [slope[0], reach * slope[k], 0.0, 0.0, 0.0])
            .collect();
        if let Some(wrong) = wrong_term(&lines, &z, 1) {
            return Err(FaultKind::Slope {
                axis,
                place: points[wrong.curve],
                found: slopes[wrong.curve][k],
                measured: wrong.measured / reach,
            });
        }
    }
    Ok(())
}

/// Series against heights and slopes along the same curves.
fn series(surface: &dyn SurfaceModel, part: &Part, points: &[OnPart]) -> Result<(), FaultKind> {
    let curves = Curves::through(points, part);
    let [z, zx, zy] = series_along(surface, &curves).map_err(failed("series"))?;
    let mut alone = vec![[f64::NAN; ORDER + 1]; points.len()];
    let asked = surface.height_series(&curves.x, &curves.y, &mut alone);
    asked.map_err(failed("height_series"))?;
    let (x, y) = curves.on_ladder();
    let blank = vec![f64::NAN; STEPS * points.len()];
    let mut values = [blank.clone(), blank.clone(), blank];
    let [height, along_x, along_y] = &mut values;
    let out = Gradients {
        z: height,
        zx: along_x,
        zy: along_y,
    };
    let asked = surface.gradient(&x, &y, out);
    asked.map_err(failed("gradient"))?;
    let [height, along_x, along_y] = &values;
    let all: [(&'static str, &[Series], &[f64]); 4] = [
        ("the height", &z, height),
        ("∂z/∂x", &zx, along_x),
        ("∂z/∂y", &zy, along_y),
        ("the height alone", &alone, height),
    ];
    for (of, series, values) in all {
        if let Some(wrong) = wrong_term(series, values, ORDER) {
            return Err(FaultKind::Series {
                of,
                order: wrong.order,
                place: points[wrong.curve],
                found: wrong.found,
                measured: wrong.measured,
            });
        }
    }
    Ok(())
}
