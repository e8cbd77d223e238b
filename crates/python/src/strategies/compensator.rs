//! Compensators of Python.

use pyo3::prelude::*;
use turnpath_core::{Centres, Compensator, Cut, Radial, Result};

use super::Callable;
use crate::arrays::{array, columns_of};
use crate::failure::asked;
use crate::loan::lend_surface;
use crate::views::cut::CutView;

/// A compensator that Python asks for the nose centres. The host fits their series.
pub struct PyCompensator {
    /// Takes a cut, θ and ρ.
    pub call: Callable,
    /// What ρ means.
    pub radial: Radial,
    /// Whether the path is that of the nose centre.
    pub compensates_nose: bool,
}

impl Compensator for PyCompensator {
    fn radial(&self) -> Radial {
        self.radial
    }

    fn compensates_nose(&self) -> bool {
        self.compensates_nose
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        let [x, z, foot] = lend_surface(cut.surface, |surface| {
            asked(|py| {
                let tool = *cut.tool;
                let (theta, rho) = (array(py, theta.to_vec()), array(py, rho.to_vec()));
                let (call, count) = (self.call.bind(py), out.x.len());
                let given = call.call1((CutView { surface, tool }, theta, rho))?;
                columns_of(&given, count, ["x", "z", "foot"])
            })
        })?;
        out.x.copy_from_slice(&x);
        out.z.copy_from_slice(&z);
        out.foot.copy_from_slice(&foot);
        Ok(())
    }
}
