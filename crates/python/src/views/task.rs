//! The task: part, tool, tolerances, range, direction, speed and limits.

use pyo3::prelude::*;
use turnpath_core::{Axis, Derivative, Direction, Task, Tool};

/// All that a strategy may know of the task, apart from the locus. Lengths are in mm, angles in rad,
/// speeds in rad/s.
#[pyclass(frozen, name = "Task", module = "turnpath")]
#[derive(Debug)]
pub struct TaskView(pub Task);

#[pymethods]
impl TaskView {
    /// Radius of the aperture, mm.
    #[getter]
    fn aperture_radius(&self) -> f64 {
        self.0.part.aperture_radius
    }

    /// Radius of the hole, mm; 0 without one.
    #[getter]
    fn inner_radius(&self) -> f64 {
        self.0.part.inner_radius
    }

    /// Nose radius, mm.
    #[getter]
    fn nose_radius(&self) -> f64 {
        self.0.tool.nose_radius
    }

    /// The tool.
    #[getter]
    fn tool(&self) -> ToolView {
        ToolView(self.0.tool)
    }

    /// Largest distance between the played and the true tool centre along z, mm.
    #[getter]
    fn interpolation(&self) -> f64 {
        self.0.tolerance.interpolation
    }

    /// Largest cusp, mm.
    #[getter]
    fn residual(&self) -> f64 {
        self.0.tolerance.residual
    }

    /// Smallest and largest ρ that the path covers, mm, overrun included.
    #[getter]
    fn range(&self) -> (f64, f64) {
        (self.0.range.inner, self.0.range.outer)
    }

    /// Whether the tool feeds from the rim to the centre.
    #[getter]
    fn inward(&self) -> bool {
        self.0.direction == Direction::Inward
    }

    /// The largest speed of the spindle, rad/s.
    #[getter]
    fn spindle_speed(&self) -> f64 {
        self.0.spindle_speed
    }

    /// The machine's limit of an axis, `"X"`, `"Z"` or `"C"`, in mm (rad for C) and s: its
    /// `"velocity"`, `"acceleration"` or `"jerk"`; `None` without a limit.
    fn limit(&self, axis: &str, derivative: &str) -> Option<f64> {
        let axis = Axis::ALL.into_iter().find(|one| one.letter() == axis)?;
        let derivative = Derivative::ALL
            .into_iter()
            .find(|one| one.name() == derivative)?;
        let mut limits = self.0.machine.limits();
        let limit = limits.find(|limit| limit.axis == axis && limit.derivative == derivative);
        limit.map(|limit| limit.value)
    }
}

/// The tool: a round nose in the XZ plane with zero rake.
#[pyclass(frozen, name = "Tool", module = "turnpath")]
#[derive(Debug)]
pub struct ToolView(pub Tool);

#[pymethods]
impl ToolView {
    /// Nose radius, mm.
    #[getter]
    fn nose_radius(&self) -> f64 {
        self.0.nose_radius
    }

    /// Included angle of the edge, rad; `None` for a full nose.
    #[getter]
    fn included_angle(&self) -> Option<f64> {
        self.0.included_angle
    }

    /// Clearance angle below the edge, rad; `None` where the recipe gives none.
    #[getter]
    fn clearance_angle(&self) -> Option<f64> {
        self.0.clearance_angle
    }
}
