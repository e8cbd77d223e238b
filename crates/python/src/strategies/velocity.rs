//! Velocity solvers of Python.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use turnpath_core::toolpath::SegmentShape;
use turnpath_core::{Dependence, Nodes, Result, Velocities, VelocitySolver};

use super::Callable;
use crate::arrays::{array, columns_of};
use crate::failure::asked;

/// A solver that Python asks for the velocities of a block's nodes.
pub struct PyVelocity {
    /// Takes the nodes, as a table of columns.
    pub call: Callable,
    /// How many nodes before and after a block it wants; 0 for none.
    pub overlap: usize,
    /// What the controller plays.
    pub segments: SegmentShape,
    /// Whether its velocities are those of the path itself.
    pub exact_rates: bool,
}

impl VelocitySolver for PyVelocity {
    fn dependence(&self) -> Dependence {
        match self.overlap {
            0 => Dependence::Local,
            nodes => Dependence::Overlap(nodes),
        }
    }

    fn segments(&self) -> SegmentShape {
        self.segments
    }

    fn gives_exact_rates(&self) -> bool {
        self.exact_rates
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        let [c, x, z] = asked(|py| {
            let given = self.call.bind(py).call1((table(py, &nodes)?,))?;
            columns_of(&given, nodes.len(), ["vc", "vx", "vz"])
        })?;
        out.c.copy_from_slice(&c);
        out.x.copy_from_slice(&x);
        out.z.copy_from_slice(&z);
        Ok(())
    }
}

/// The columns by their names.
fn table<'py>(py: Python<'py>, nodes: &Nodes<'_>) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    let columns = [
        ("t", nodes.t),
        ("c", nodes.c),
        ("x", nodes.x),
        ("z", nodes.z),
        ("c_rate", nodes.c_rate),
        ("x_rate", nodes.x_rate),
        ("z_theta", nodes.z_theta),
        ("z_x", nodes.z_x),
    ];
    for (name, column) in columns {
        table.set_item(name, array(py, column.to_vec()))?;
    }
    let rates: Vec<f64> = (0..nodes.len()).map(|k| nodes.z_rate(k)).collect();
    table.set_item("z_rate", array(py, rates))?;
    table.set_item("at_start", nodes.at_start)?;
    table.set_item("at_end", nodes.at_end)?;
    Ok(table)
}
