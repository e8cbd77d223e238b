//! The tool locus.

use pyo3::prelude::*;
use turnpath_core::{CentreBuffers, CentreSeries, Locus, Radial, Rates, Series};

use crate::arrays::{Column, Rows, array, same_lengths, series, series_array, values};
use crate::failure::not_answered;
use crate::loan::Loan;

/// The locus of the nose centre. It answers in batches: columns of one call have the same length, and
/// a batch of thousands costs little more than one point.
#[pyclass(frozen, name = "Locus", module = "turnpath")]
#[derive(Debug)]
pub struct LocusView(pub Loan<dyn Locus>);

/// Two columns.
type Pair<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);
/// Three columns.
type Triple<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>);

#[pymethods]
impl LocusView {
    /// The nose centre's x and z and the radius of its contact, mm, for angles θ (rad) and radial
    /// parameters ρ (mm): three columns.
    fn centre<'py>(
        &self,
        py: Python<'py>,
        theta: Column<'_>,
        rho: Column<'_>,
    ) -> PyResult<Triple<'py>> {
        let (theta, rho) = (values(&theta), values(&rho));
        same_lengths(&[theta.len(), rho.len()])?;
        let room = self.0.with(py, |locus| {
            let mut room = CentreBuffers::default();
            room.resize(theta.len());
            locus.centre(&theta, &rho, room.as_centres())?;
            Ok(room)
        })?;
        let room = room.map_err(|error| not_answered(&error))?;
        Ok((array(py, room.x), array(py, room.z), array(py, room.foot)))
    }

    /// The series of the nose centre's x and z along curves. A curve is a row of five coefficients, for
    /// θ(t) and for ρ(t); the answers are two arrays of shape (n, 5).
    fn series<'py>(&self, py: Python<'py>, theta: Rows<'_>, rho: Rows<'_>) -> PyResult<Pair<'py>> {
        let (theta, rho) = (series(&theta)?, series(&rho)?);
        same_lengths(&[theta.len(), rho.len()])?;
        let answer = self.0.with(py, |locus| {
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

    /// How the nose centre moves: ∂X/∂θ and ∂X/∂ρ, then ∂Z/∂θ at constant X and ∂Z/∂X at constant θ, in
    /// mm and rad: four columns.
    fn rates<'py>(
        &self,
        py: Python<'py>,
        theta: Column<'_>,
        rho: Column<'_>,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let (theta, rho) = (values(&theta), values(&rho));
        same_lengths(&[theta.len(), rho.len()])?;
        let answer = self.0.with(py, |locus| {
            let [mut a, mut b, mut c, mut d] = [(); 4].map(|()| vec![f64::NAN; theta.len()]);
            let out = Rates {
                x_theta: &mut a,
                x_rho: &mut b,
                z_theta: &mut c,
                z_x: &mut d,
            };
            locus.rates(&theta, &rho, out).map(|()| [a, b, c, d])
        })?;
        let rates = answer.map_err(|error| not_answered(&error))?;
        Ok(rates.into_iter().map(|rate| array(py, rate)).collect())
    }

    /// The feed dρ/dN, mm, that leaves cusps of height `residual` (mm) at each (θ, ρ); NaN where the
    /// surface has no curvature.
    fn residual_feed<'py>(
        &self,
        py: Python<'py>,
        residual: f64,
        theta: Column<'_>,
        rho: Column<'_>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (theta, rho) = (values(&theta), values(&rho));
        same_lengths(&[theta.len(), rho.len()])?;
        let answer = self.0.with(py, |locus| {
            let mut feed = vec![f64::NAN; theta.len()];
            let asked = locus.residual_feed(residual, locus.radial(), &theta, &rho, &mut feed);
            asked.map(|()| feed)
        })?;
        let feed = answer.map_err(|error| not_answered(&error))?;
        Ok(array(py, feed))
    }

    /// Heights of the bare surface, mm, at x and y, mm: a column.
    fn heights<'py>(
        &self,
        py: Python<'py>,
        x: Column<'_>,
        y: Column<'_>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (x, y) = (values(&x), values(&y));
        same_lengths(&[x.len(), y.len()])?;
        let answer = self.0.with(py, |locus| {
            let mut z = vec![f64::NAN; x.len()];
            locus.surface().heights(&x, &y, &mut z).map(|()| z)
        })?;
        let z = answer.map_err(|error| not_answered(&error))?;
        Ok(array(py, z))
    }

    /// What ρ means: `"contact"`, the radius of the contact, or `"centre"`, the nose centre's x.
    #[getter]
    fn radial(&self, py: Python<'_>) -> PyResult<&'static str> {
        let radial = self.0.with(py, |locus| locus.radial())?;
        Ok(match radial {
            Radial::Contact => "contact",
            Radial::Centre => "centre",
        })
    }
}
