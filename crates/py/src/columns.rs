//! Rows, metrics and outcomes as Python takes them: numbers as arrays that it owns from then on.

use flexsc_core::campaign::Outcome;
use flexsc_core::metrics::{Metrics, Value};
use flexsc_core::record::{Column, Columns};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The columns of a topic. Labels are indices with the labels, rows within rows their counts with their columns.
pub fn of_rows(py: Python<'_>, rows: Columns) -> PyResult<Bound<'_, PyDict>> {
    let columns = PyDict::new(py);
    for (name, column) in rows.columns {
        match column {
            Column::Numbers(values) => columns.set_item(name, values.into_pyarray(py))?,
            Column::Counts(counts) if counts.iter().any(|count| i64::try_from(*count).is_err()) => {
                columns.set_item(name, counts.into_pyarray(py))?;
            }
            Column::Counts(counts) => {
                // Signed, so that differences are what one expects.
                let counts: Vec<i64> = counts.into_iter().map(|count| count as i64).collect();
                columns.set_item(name, counts.into_pyarray(py))?;
            }
            Column::Integers(values) => columns.set_item(name, values.into_pyarray(py))?,
            Column::Texts(texts) => columns.set_item(name, texts)?,
            Column::Labels(indices, labels) => {
                columns.set_item(name, (indices.into_pyarray(py), labels))?;
            }
            Column::Rows(counts, inner) => {
                columns.set_item(name, (counts.into_pyarray(py), of_rows(py, inner)?))?;
            }
        }
    }
    Ok(columns)
}

/// The metrics of a run; `None` where there is no number.
pub fn of_metrics<'py>(py: Python<'py>, metrics: &Metrics) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (meaning, value) in &metrics.0 {
        match value {
            Value::Count(count) => dict.set_item(meaning.name, count)?,
            Value::Number(number) if number.is_nan() => dict.set_item(meaning.name, py.None())?,
            Value::Number(number) => dict.set_item(meaning.name, number)?,
            Value::Numbers(numbers) => dict.set_item(meaning.name, numbers.clone().into_pyarray(py))?,
            Value::Word(word) => dict.set_item(meaning.name, word)?,
        }
    }
    Ok(dict)
}

/// Number of a run, what was drawn, its metrics or none, and why it failed.
pub type Told<'py> = (u64, Vec<Bound<'py, PyAny>>, Option<Bound<'py, PyDict>>, String);

/// What is told of each run.
pub fn of_outcome<'py>(py: Python<'py>, outcome: &Outcome) -> PyResult<Told<'py>> {
    let drawn = outcome.drawn.iter().map(|value| match value {
        toml::Value::Integer(number) => Ok(number.into_pyobject(py)?.into_any()),
        other => Ok(other.as_float().unwrap_or(f64::NAN).into_pyobject(py)?.into_any()),
    });
    let (metrics, error) = match &outcome.metrics {
        Ok(metrics) => (Some(of_metrics(py, metrics)?), String::new()),
        Err(error) => (None, error.to_string()),
    };
    Ok((outcome.number, drawn.collect::<PyResult<_>>()?, metrics, error))
}
