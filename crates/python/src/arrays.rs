//! Arrays of numpy on their way in and out. They are copied: a batch belongs to one side at a time.

use numpy::{AllowTypeChange, PyArray1, PyArrayLike1, PyArrayLike2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use turnpath_core::{ORDER, Series};

/// Coefficients of a series.
const TERMS: usize = ORDER + 1;

/// A column of numbers of any type.
pub type Column<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;
/// Rows of numbers of any type.
pub type Rows<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;

/// A column as a new array.
pub fn array(py: Python<'_>, values: Vec<f64>) -> Bound<'_, PyAny> {
    PyArray1::from_vec(py, values).into_any()
}

/// Series as a new array of shape (n, 5).
pub fn series_array<'py>(py: Python<'py>, series: &[Series]) -> PyResult<Bound<'py, PyAny>> {
    let flat = PyArray1::from_vec(py, series.concat());
    Ok(flat.reshape([series.len(), TERMS])?.into_any())
}

/// The numbers of a column.
pub fn values(column: &Column<'_>) -> Vec<f64> {
    column.as_array().to_vec()
}

/// Kinds of numpy's types that are real numbers. Others would be made numbers without a word: the
/// imaginary part is dropped, a text is read.
const REAL: [&str; 3] = ["f", "i", "u"];

/// What Python gave as an array of numbers; the kind of what it gave where that is none.
fn numbers<'py>(given: &Bound<'py, PyAny>) -> Result<Bound<'py, PyAny>, String> {
    let read = || -> PyResult<(Bound<'py, PyAny>, String, String)> {
        let array = given
            .py()
            .import("numpy")?
            .call_method1("asarray", (given,))?;
        let dtype = array.getattr("dtype")?;
        let kind = dtype.getattr("kind")?.extract()?;
        let name = dtype.str()?.to_string();
        Ok((array, kind, name))
    };
    let of_type = || {
        let name = given.get_type().name();
        name.map_or_else(|_| String::new(), |name| name.to_string())
    };
    match read() {
        Ok((array, kind, _)) if REAL.contains(&kind.as_str()) => Ok(array),
        Ok((_, _, name)) => Err(format!("{} of {name}", of_type())),
        Err(_) => Err(of_type()),
    }
}

/// The numbers that Python gave, as a column of any length.
pub fn column(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<f64>> {
    let no_column = |kind: String| {
        PyValueError::new_err(format!(
            "gave {kind} as {what}, which is no column of numbers"
        ))
    };
    let array = numbers(given).map_err(no_column)?;
    let column: Result<Column<'_>, _> = array.extract();
    let dimensions = || {
        array
            .getattr("ndim")
            .and_then(|count| count.extract::<usize>())
    };
    column.map(|column| values(&column)).map_err(|_| {
        let count = dimensions().map_or_else(|_| String::new(), |count| count.to_string());
        no_column(format!("an array of {count} dimensions"))
    })
}

/// The numbers that Python gave, as a column of this length.
pub fn column_of(given: &Bound<'_, PyAny>, length: usize, what: &str) -> PyResult<Vec<f64>> {
    let column = column(given, what)?;
    match column.len() == length {
        true => Ok(column),
        false => Err(PyValueError::new_err(format!(
            "gave {} numbers as {what}, and {length} belong there",
            column.len()
        ))),
    }
}

/// Rows of `N` numbers that Python gave.
pub fn rows<const N: usize>(given: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[f64; N]>> {
    let wrong = |found: &str| {
        PyValueError::new_err(format!(
            "gave {found} as {what}, and rows of {N} numbers belong there"
        ))
    };
    let array = numbers(given).map_err(|kind| wrong(&kind))?;
    let rows: Rows<'_> = array
        .extract()
        .map_err(|_| wrong("no array of two dimensions"))?;
    let rows = rows.as_array();
    let row = |row: numpy::ndarray::ArrayView1<'_, f64>| <[f64; N]>::try_from(row.to_vec());
    let rows: Result<Vec<_>, _> = rows.rows().into_iter().map(row).collect();
    rows.map_err(|row| wrong(&format!("rows of {} numbers", row.len())))
}

/// Rows of numbers as series.
pub fn series(rows: &Rows<'_>) -> PyResult<Vec<Series>> {
    let rows = rows.as_array();
    let row = |row: numpy::ndarray::ArrayView1<'_, f64>| Series::try_from(row.to_vec());
    let all: Result<Vec<_>, _> = rows.rows().into_iter().map(row).collect();
    all.map_err(|_| PyValueError::new_err(format!("a series has {TERMS} coefficients")))
}

/// Several columns that Python gave as a tuple, each of this length.
pub fn columns_of<const N: usize>(
    given: &Bound<'_, PyAny>,
    length: usize,
    names: [&str; N],
) -> PyResult<[Vec<f64>; N]> {
    let parts: Vec<Bound<'_, PyAny>> = match given.try_iter() {
        Ok(parts) => parts.collect::<PyResult<_>>()?,
        Err(_) => Vec::new(),
    };
    if parts.len() != N {
        let wanted = names.join(", ");
        let message = format!("gave {} columns, and {wanted} belong there", parts.len());
        return Err(PyValueError::new_err(message));
    }
    let mut columns: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    for ((column, part), name) in columns.iter_mut().zip(&parts).zip(names) {
        *column = column_of(part, length, name)?;
    }
    Ok(columns)
}

/// Fails where columns of one call have other lengths.
pub fn same_lengths(lengths: &[usize]) -> PyResult<()> {
    let first = lengths.first();
    match lengths.iter().all(|length| Some(length) == first) {
        true => Ok(()),
        false => Err(PyValueError::new_err(format!(
            "columns of one call have the same length, not {lengths:?}"
        ))),
    }
}
