//! A column of a campaign's table, from Python.

use flexsc_core::campaign::ColumnCells;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

/// A column of a table, as the engine has it.
pub fn column(object: &Bound<'_, PyAny>) -> PyResult<ColumnCells> {
    if let Ok(numbers) = object.extract::<PyReadonlyArray1<'_, f64>>() {
        return Ok(ColumnCells::Numbers(numbers.as_array().to_vec()));
    }
    if let Ok(integers) = object.extract::<PyReadonlyArray1<'_, i64>>() {
        return Ok(ColumnCells::Integers(integers.as_array().iter().copied().map(Some).collect()));
    }
    if let Ok(lists) = object.extract::<Vec<PyReadonlyArray1<'_, f64>>>() {
        let cell = |list: PyReadonlyArray1<'_, f64>| Some(list.as_array().to_vec());
        return Ok(ColumnCells::Lists(lists.into_iter().map(cell).collect()));
    }
    Ok(ColumnCells::Text(object.extract::<Vec<String>>()?.into_iter().map(Some).collect()))
}
