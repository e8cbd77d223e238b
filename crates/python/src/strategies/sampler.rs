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
pub struct PySampler {
    /// Takes a path, a block, and the plan where there is one.
    pub place: Callable,
    /// Takes the whole path, and gives the plan.
    pub plan: Option<Callable>,
    /// Whether its nodes hold the tolerance only with exact rates.
    pub needs_exact_rates: bool,
}

impl Sampler for PySampler {
    fn plan(&self, path: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        let make = |plan: &Callable| {
            lend_locus(path.locus, |locus| {
                asked(|py| plan.call1(py, (PathView::new(path, locus),)))
            })
        };
        Ok(Box::new(Plan {
            place: self.place.clone(),
            plan: self.plan.as_ref().map(make).transpose()?,
        }))
    }

    fn needs_exact_rates(&self) -> bool {
        self.needs_exact_rates
    }
}

struct Plan {
    place: Callable,
    /// What the sampler found on the whole path.
    plan: Option<Py<PyAny>>,
}

impl SamplerPlan for Plan {
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        let placed = lend_locus(path.locus, |locus| {
            asked(|py| {
                let (path, block) = (PathView::new(path, locus), BlockView(block));
                let place = self.place.bind(py);
                let given = match &self.plan {
                    Some(plan) => place.call1((path, block, plan)),
                    None => place.call1((path, block)),
                };
                node_list(&given?)
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
