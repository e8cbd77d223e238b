//! Samplers of Python.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use turnpath_core::{NodeList, Path, Result, Revolutions, Sampler, SamplerPlan};

use super::Callable;
use crate::arrays::{column, columns_of};
use crate::failure::asked;
use crate::loan::lend_locus;
use crate::views::path::{BlockView, PathView};

/// A sampler that Python asks for the nodes of each block.
#[derive(Clone)]
pub struct PySampler {
    /// Takes a path and a block.
    pub call: Callable,
    /// Whether its nodes hold the tolerance only with exact rates.
    pub needs_exact_rates: bool,
}

impl Sampler for PySampler {
    fn plan(&self, _: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        Ok(Box::new(Plan(self.call.clone())))
    }

    fn needs_exact_rates(&self) -> bool {
        self.needs_exact_rates
    }
}

struct Plan(Callable);

impl SamplerPlan for Plan {
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        let placed = lend_locus(path.locus, |locus| {
            asked(|py| {
                let arguments = (PathView::new(path, locus), BlockView(block));
                node_list(&self.0.bind(py).call1(arguments)?)
            })
        })?;
        nodes.append(placed);
        Ok(())
    }
}

/// Revolutions alone, or revolutions with both offsets.
fn node_list(given: &Bound<'_, PyAny>) -> PyResult<NodeList> {
    let Ok(parts) = given.cast::<PyTuple>() else {
        let mut nodes = NodeList::default();
        nodes.extend(column(given, "revolutions")?);
        return Ok(nodes);
    };
    let first = parts.get_item(0)?;
    let count = column(&first, "revolutions")?.len();
    let [n, dz, dz_dc] = columns_of(given, count, ["revolutions", "dz", "dz_dc"])?;
    let list = NodeList::from_columns(n, dz, dz_dc);
    list.ok_or_else(|| PyValueError::new_err("gave columns of other lengths"))
}
