//! Rows and metrics as Python takes them: numbers as arrays that it owns from then on.

use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::record::{Column, Columns};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The columns of a topic. Labels are indices with the labels, rows within rows their counts with their columns.
pub fn rows_to_dict(py: Python<'_>, rows: Columns) -> PyResult<Bound<'_, PyDict>> {
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
                columns.set_item(name, (counts.into_pyarray(py), rows_to_dict(py, inner)?))?;
            }
        }
    }
    Ok(columns)
}

/// The columns of topics, by their names.
pub fn topics_to_dict(
    py: Python<'_>,
    topics: impl IntoIterator<Item = (String, Columns)>,
) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    for (name, rows) in topics {
        dict.set_item(name, rows_to_dict(py, rows)?)?;
    }
    Ok(dict)
}

/// The metrics of a run; `None` where there is no number.
pub fn metrics_to_dict<'py>(py: Python<'py>, metrics: &Metrics) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (meaning, value) in &metrics.0 {
        match value {
            MetricValue::Count(count) => dict.set_item(meaning.name, count)?,
            MetricValue::Number(number) if number.is_nan() => dict.set_item(meaning.name, py.None())?,
            MetricValue::Number(number) => dict.set_item(meaning.name, number)?,
            MetricValue::Numbers(_) | MetricValue::Quantities(_) => {
                dict.set_item(meaning.name, value.numbers().into_pyarray(py))?;
            }
            MetricValue::Word(word) => dict.set_item(meaning.name, word)?,
            MetricValue::Words(words) => dict.set_item(meaning.name, words)?,
        }
    }
    Ok(dict)
}
