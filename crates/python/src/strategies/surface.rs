//! Surfaces of Python. The path's inner loops never call Python: they ask a formula that was traced,
//! or a spline through the heights that Python gave once.

use pyo3::prelude::*;
use turnpath::OwnSurface;
use turnpath_core::{
    GradientSeries, Gradients, Result, Series, StrategyError, SurfaceData, SurfaceModel,
};
use turnpath_formula::{BuildError, Formula, FormulaBuilder, Value};
use turnpath_grid::GridSag;
use turnpath_maps::Map;

use crate::arrays::{array, column_of};
use crate::failure::{asked, failed};

/// Points along each side of the first grid. It resolves a wave of an eighth of its side.
const FIRST_POINTS: usize = 65;
/// Points along each side of the largest grid: Python is asked for each of them once, and the spline
/// takes 8 bytes for each.
const MOST_POINTS: usize = 1025;

/// What Python made of a surface: the steps of a formula, or a function to fit.
#[derive(FromPyObject)]
enum SurfaceSource {
    /// The steps of a formula, each a name and what it takes, and whether they hold all that the
    /// function does.
    Steps(Vec<Step>, bool),
    /// A function of x and y, the half width of the square that it must cover, mm, and the error that
    /// is small enough, mm.
    Function(Py<PyAny>, f64, f64),
}

/// A step: its name, the numbers of the steps that it takes, and a number of its own.
type Step = (String, Vec<usize>, f64);

/// The surface of what Python made.
pub fn surface(made: &Py<PyAny>) -> Result<OwnSurface> {
    let made: SurfaceSource = asked(|py| made.extract(py))?;
    match made {
        SurfaceSource::Steps(steps, byte_exact) => {
            let formula = formula(&steps);
            let formula = formula.map_err(|error| StrategyError::failed(error.to_string()))?;
            let model = Box::new(formula);
            Ok(OwnSurface { model, byte_exact })
        }
        SurfaceSource::Function(function, half, goal) => Ok(OwnSurface {
            model: Box::new(fitted(&function, half, goal)?),
            byte_exact: false,
        }),
    }
}

/// The formula of steps; the last one is the height.
fn formula(steps: &[Step]) -> std::result::Result<Formula, BuildError> {
    let mut builder = FormulaBuilder::new();
    let mut values: Vec<Value> = Vec::with_capacity(steps.len());
    for (name, operands, number) in steps {
        let taken = operands.iter().map(|operand| values.get(*operand).copied());
        let taken: Vec<Value> = taken.collect::<Option<_>>().unwrap_or_default();
        values.push(step(&mut builder, name, &taken, *number)?);
    }
    let last = match values.last() {
        Some(last) => *last,
        None => builder.number(0.0)?,
    };
    builder.finish(last)
}

fn step(
    builder: &mut FormulaBuilder,
    name: &str,
    taken: &[Value],
    number: f64,
) -> std::result::Result<Value, BuildError> {
    match (name, taken) {
        ("x", []) => builder.x(),
        ("y", []) => builder.y(),
        ("number", []) => builder.number(number),
        ("sum", [a, b]) => builder.sum(*a, *b),
        ("difference", [a, b]) => builder.difference(*a, *b),
        ("product", [a, b]) => builder.product(*a, *b),
        ("quotient", [a, b]) => builder.quotient(*a, *b),
        ("negative", [a]) => builder.negative(*a),
        ("power", [a]) => builder.power(*a, number),
        _ => builder.function(name, taken),
    }
}

/// A spline of degree 5 through heights of a function, with the largest error that was found.
struct FittedSurface {
    spline: GridSag,
    error: f64,
}

/// Fits a function on a square of this half width, mm, on finer and finer grids until its error is at
/// most `goal`, mm, or the grid is the largest one.
fn fitted(function: &Py<PyAny>, half: f64, goal: f64) -> Result<FittedSurface> {
    let mut points = FIRST_POINTS;
    loop {
        let pitch = 2.0 * half / (points - 1) as f64;
        let heights = heights(function, &grid(points, pitch, -half))?;
        if let Some(hole) = heights.iter().position(|z| !z.is_finite()) {
            let at = |index: usize| -half + pitch * index as f64;
            return Err(StrategyError::failed(format!(
                "has no height at x = {:.4} mm, y = {:.4} mm, so no spline can stand for it",
                at(hole % points),
                at(hole / points)
            )));
        }
        let map = Map::new(points, points, pitch, pitch, heights);
        let map = map.map_err(|error| StrategyError::failed(error.to_string()))?;
        let spline = GridSag::of(map, None)?;
        let error = error_between(function, &spline, (points - 1, pitch, 0.5 * pitch - half))?;
        if error <= goal || points >= MOST_POINTS {
            return Ok(FittedSurface { spline, error });
        }
        points = 2 * points - 1;
    }
}

/// The points of a square grid, rows from the bottom.
fn grid(points: usize, pitch: f64, first: f64) -> (Vec<f64>, Vec<f64>) {
    let place = |index: usize| first + pitch * index as f64;
    let all = 0..points * points;
    all.map(|index| (place(index % points), place(index / points)))
        .unzip()
}

/// The largest distance along z between a function and its spline in the middles of all cells.
fn error_between(
    function: &Py<PyAny>,
    spline: &GridSag,
    (cells, pitch, first): (usize, f64, f64),
) -> Result<f64> {
    let (x, y) = grid(cells, pitch, first);
    let mut z = vec![0.0; x.len()];
    spline.heights(&x, &y, &mut z)?;
    let wanted = heights(function, &(x, y))?;
    let errors = z.iter().zip(&wanted).map(|(z, wanted)| (z - wanted).abs());
    // A function may have no height within a cell.
    Ok(errors.fold(0.0, |most, error| {
        if error > most || error.is_nan() {
            error
        } else {
            most
        }
    }))
}

/// The heights of the function, in one call.
fn heights(function: &Py<PyAny>, (x, y): &(Vec<f64>, Vec<f64>)) -> Result<Vec<f64>> {
    Python::attach(|py| {
        let given = function
            .bind(py)
            .call1((array(py, x.clone()), array(py, y.clone())));
        let given = given.map_err(|error| failed(py, &error))?;
        column_of(&given, x.len(), "heights").map_err(|error| failed(py, &error))
    })
}

impl SurfaceModel for FittedSurface {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        self.spline.heights(x, y, z)
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        self.spline.gradient(x, y, out)
    }

    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        self.spline.series(x, y, out)
    }

    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
        self.spline.height_series(x, y, z)
    }

    fn beyond_data(&self, x: &[f64], y: &[f64], distance: &mut [f64]) -> Result<()> {
        self.spline.beyond_data(x, y, distance)
    }

    fn data(&self) -> Result<Option<SurfaceData>> {
        let data = self.spline.data()?;
        Ok(data.map(|data| SurfaceData {
            fit_error: Some(self.error),
            ..data
        }))
    }
}
