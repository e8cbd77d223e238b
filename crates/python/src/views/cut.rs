//! What a compensator works on: a surface and a tool.

use pyo3::prelude::*;
use turnpath_core::{Gradients, SurfaceModel, Tool};

use super::task::ToolView;
use crate::arrays::{Column, array, same_lengths, values};
use crate::failure::not_answered;
use crate::loan::Loan;

/// A surface, in batches. NaN marks a point without a height.
#[pyclass(frozen, name = "Surface", module = "turnpath")]
#[derive(Debug)]
pub struct SurfaceView(pub Loan<dyn SurfaceModel>);

#[pymethods]
impl SurfaceView {
    /// Heights, mm, at x and y, mm: a column.
    fn heights<'py>(
        &self,
        py: Python<'py>,
        x: Column<'_>,
        y: Column<'_>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (x, y) = (values(&x), values(&y));
        same_lengths(&[x.len(), y.len()])?;
        let answer = self.0.with(py, |surface| {
            let mut z = vec![f64::NAN; x.len()];
            surface.heights(&x, &y, &mut z).map(|()| z)
        })?;
        Ok(array(py, answer.map_err(|error| not_answered(&error))?))
    }

    /// Heights, mm, and both slopes at x and y, mm: three columns.
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        x: Column<'_>,
        y: Column<'_>,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let (x, y) = (values(&x), values(&y));
        same_lengths(&[x.len(), y.len()])?;
        let answer = self.0.with(py, |surface| {
            let [mut z, mut zx, mut zy] = [(); 3].map(|()| vec![f64::NAN; x.len()]);
            let out = Gradients {
                z: &mut z,
                zx: &mut zx,
                zy: &mut zy,
            };
            surface.gradient(&x, &y, out).map(|()| [z, zx, zy])
        })?;
        let columns = answer.map_err(|error| not_answered(&error))?;
        Ok(columns
            .into_iter()
            .map(|column| array(py, column))
            .collect())
    }
}

/// What a compensator works on.
#[pyclass(frozen, name = "Cut", module = "turnpath")]
#[derive(Debug)]
pub struct CutView {
    /// The surface.
    pub surface: Loan<dyn SurfaceModel>,
    /// The tool.
    pub tool: Tool,
}

#[pymethods]
impl CutView {
    /// The surface to be cut.
    #[getter]
    fn surface(&self) -> SurfaceView {
        SurfaceView(self.surface.clone())
    }

    /// The tool.
    #[getter]
    fn tool(&self) -> ToolView {
        ToolView(self.tool)
    }
}
