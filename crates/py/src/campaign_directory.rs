//! A campaign's directory as Python takes it.

use std::path::PathBuf;

use flexsc_core::campaign::{Column, Directory, DirectoryError, RUN, SECONDS, Summary as Came};
use numpy::IntoPyArray;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::aside::aside;
use super::error::scenario_error;
use super::{Scenario, Summary, summary};

fn raised(error: DirectoryError) -> PyErr {
    match error {
        DirectoryError::Scenario(error) => scenario_error(error),
        DirectoryError::Io { .. } => PyOSError::new_err(error.to_string()),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// Scenario, keys, columns and statistics of the rows that are there.
#[pyfunction]
pub fn read_campaign(
    py: Python<'_>,
    path: PathBuf,
) -> PyResult<(Scenario, Vec<String>, Bound<'_, PyDict>, Vec<Summary>)> {
    type Read = (Directory, Vec<Option<Column>>, Came);
    let read = aside(py, move |_| -> Result<Read, DirectoryError> {
        let directory = Directory::open(&path)?;
        let names: Vec<&str> = directory.work().fields().iter().map(|field| field.name.as_str()).collect();
        let columns = directory.columns(&names)?;
        let summary = directory.summary()?;
        Ok((directory, columns, summary))
    })?;
    let (directory, columns, came) = read.map_err(raised)?;
    let campaign = &directory.work().campaign;
    let keys: Vec<String> = campaign.keys().map(str::to_owned).collect();
    let told = PyDict::new(py);
    for (field, column) in directory.work().fields().iter().zip(columns) {
        let (name, whole) = (&field.name, field.name == RUN || keys.contains(&field.name));
        match column {
            _ if name == SECONDS => {}
            Some(Column::Integers(cells)) if whole => {
                let cells: Vec<i64> = cells.into_iter().map(Option::unwrap_or_default).collect();
                told.set_item(name, cells.into_pyarray(py))?;
            }
            Some(Column::Words(words)) => {
                let words: Vec<String> = words.into_iter().map(Option::unwrap_or_default).collect();
                told.set_item(name, words)?;
            }
            Some(Column::Lists(lists)) => {
                let arrays = lists.into_iter().map(|list| list.unwrap_or_default().into_pyarray(py));
                told.set_item(name, arrays.collect::<Vec<_>>())?;
            }
            Some(column) => told.set_item(name, column.numbers().into_pyarray(py))?,
            None => {}
        }
    }
    let scenario = Scenario { inner: campaign.scenario().clone(), origin: campaign.scenario().name.clone() };
    Ok((scenario, keys, told, came.statistics.into_iter().map(summary).collect()))
}
