//! The path that samplers and spindle strategies look at, its blocks, and what a feed works on.

use pyo3::prelude::*;
use turnpath_core::{
    CentreSeries, Locus, Path, Revolutions, Series, SpindleLaw, SpiralLaw, Task, angle, per_radian,
};

use super::locus::LocusView;
use super::task::TaskView;
use crate::arrays::{Column, array, series_array, values};
use crate::failure::not_answered;
use crate::loan::Loan;

/// What a feed strategy works on: the task and the locus. There is no law yet.
#[pyclass(frozen, name = "Setup", module = "turnpath")]
#[derive(Debug)]
pub struct SetupView {
    /// The task.
    pub task: Task,
    /// The locus.
    pub locus: Loan<dyn Locus>,
}

#[pymethods]
impl SetupView {
    /// Part, tool, tolerances, range, direction, largest speed.
    #[getter]
    fn task(&self) -> TaskView {
        TaskView(self.task.clone())
    }

    /// The locus of the nose centre.
    #[getter]
    fn locus(&self) -> LocusView {
        LocusView(self.locus.clone())
    }
}

/// The path: task, locus, spiral law and spindle law. While one block is asked for, the laws may be
/// only their parts around the block.
#[pyclass(frozen, name = "Path", module = "turnpath")]
#[derive(Debug)]
pub struct PathView {
    task: Task,
    locus: Loan<dyn Locus>,
    law: SpiralLaw,
    spindle: SpindleLaw,
}

impl PathView {
    /// The path whose locus is lent.
    pub fn new(path: &Path<'_>, locus: Loan<dyn Locus>) -> Self {
        Self {
            task: path.task.clone(),
            locus,
            law: path.law.clone(),
            spindle: path.spindle.clone(),
        }
    }
}

#[pymethods]
impl PathView {
    /// Part, tool, tolerances, range, direction, largest speed.
    #[getter]
    fn task(&self) -> TaskView {
        TaskView(self.task.clone())
    }

    /// The locus of the nose centre.
    #[getter]
    fn locus(&self) -> LocusView {
        LocusView(self.locus.clone())
    }

    /// The revolutions of the law's end.
    #[getter]
    fn end(&self) -> f64 {
        self.law.end()
    }

    /// ρ, mm, after each of `n` revolutions: a column.
    fn radius_at<'py>(&self, py: Python<'py>, n: Column<'_>) -> Bound<'py, PyAny> {
        let n = values(&n);
        let radii = py.detach(|| n.into_iter().map(|n| self.law.value(n)).collect());
        array(py, radii)
    }

    /// The time, s, after each of `n` revolutions: a column.
    fn time_at<'py>(&self, py: Python<'py>, n: Column<'_>) -> Bound<'py, PyAny> {
        let n = values(&n);
        let times = py.detach(|| n.into_iter().map(|n| self.spindle.time_at(n)).collect());
        array(py, times)
    }

    /// The speed of the spindle, rad/s, after each of `n` revolutions: a column.
    fn speed_at<'py>(&self, py: Python<'py>, n: Column<'_>) -> Bound<'py, PyAny> {
        let n = values(&n);
        let speeds = py.detach(|| n.into_iter().map(|n| self.spindle.speed_at(n)).collect());
        array(py, speeds)
    }

    /// The revolutions between `start` and `end` at which the law goes from one piece to the next: a
    /// column.
    fn knots<'py>(&self, py: Python<'py>, start: f64, end: f64) -> Bound<'py, PyAny> {
        let knots = py.detach(|| self.law.knots(start, end).collect());
        array(py, knots)
    }

    /// The series in θ of the nose centre's x and z along the spiral at each of `n` revolutions: two
    /// arrays of shape (n, 5), in mm and rad.
    fn series_at<'py>(
        &self,
        py: Python<'py>,
        n: Column<'_>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let n = values(&n);
        let theta: Vec<Series> = n.iter().map(|n| [angle(*n), 1.0, 0.0, 0.0, 0.0]).collect();
        let rho: Vec<Series> = n.iter().map(|n| per_radian(self.law.series(*n))).collect();
        let answer = self.locus.with(py, |locus| {
            let blank: Vec<Series> = vec![[f64::NAN; 5]; theta.len()];
            let (mut x, mut z) = (blank.clone(), blank);
            let out = CentreSeries {
                x: &mut x,
                z: &mut z,
            };
            locus.series(&theta, &rho, out).map(|()| (x, z))
        })?;
        let (x, z) = answer.map_err(|error| not_answered(&error))?;
        Ok((series_array(py, &x)?, series_array(py, &z)?))
    }
}

/// A block of revolutions.
#[pyclass(frozen, name = "Block", module = "turnpath")]
#[derive(Debug)]
pub struct BlockView(pub Revolutions);

#[pymethods]
impl BlockView {
    /// The block's start in revolutions, included.
    #[getter]
    fn start(&self) -> f64 {
        self.0.start
    }

    /// The block's end in revolutions, excluded.
    #[getter]
    fn end(&self) -> f64 {
        self.0.end
    }

    /// Start and end of each revolution. The path's last one may be a part of a revolution.
    fn turns(&self) -> Vec<(f64, f64)> {
        self.0.turns().map(|turn| (turn.start, turn.end)).collect()
    }
}
