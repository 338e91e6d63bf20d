//! Scenarios with parts written in Python.

use flexsc_core::Document;
use pyo3::prelude::*;

use super::{Named, named, own_parts};
use crate::Scenario;
use crate::error::scenario_error;

/// The scenario with parts written in Python in place of its own, each with its role.
#[pyfunction]
pub fn with_parts(py: Python<'_>, scenario: &Scenario, parts: Vec<Named>) -> PyResult<Scenario> {
    Scenario::new(&scenario.origin, scenario.inner.with_custom_parts(own_parts(py, parts)?))
}

/// A scenario of a text beside which parts stand that are written in Python.
#[pyfunction]
pub fn beside_parts(py: Python<'_>, text: &str, name: &str, parts: Vec<Named>) -> PyResult<Scenario> {
    let document = Document::parse(name, text.to_owned()).map_err(scenario_error)?;
    let own = own_parts(py, parts)?;
    Scenario::new(name, flexsc_core::Scenario::from_document_with(&document, &own))
}

/// Returns the parts of a scenario that are written in Python, each with its role.
#[pyfunction]
pub fn parts_of(py: Python<'_>, scenario: &Scenario) -> Vec<Named> {
    named(py, &scenario.inner.custom_parts())
}

/// The text of what is not written in Python.
#[pyfunction]
pub fn text_beside_parts(scenario: &Scenario) -> String {
    toml::to_string(&scenario.inner.table_without_custom_parts()).unwrap_or_default()
}
