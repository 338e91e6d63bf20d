//! Designs of sweeps for Python: blocks of points, and how `[uncertain]` keys are drawn.

use flexsc_core::campaign::{Design as Points, DesignBlock, KeyRange, Sampling};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use toml::{Table, Value};

/// Points of a campaign: all combinations of those of its blocks.
#[pyclass(module = "flexsc._native")]
#[derive(Clone, Default)]
pub struct Design(pub Points);

fn sampling(name: &str) -> PyResult<Sampling> {
    let known = Sampling::ALL.into_iter().find(|(known, _)| *known == name);
    let names = Sampling::ALL.map(|(name, _)| format!("'{name}'")).join(", ");
    let unknown = || PyValueError::new_err(format!("sample must be one of {names}, got {name:?}"));
    known.map(|(_, sampling)| sampling).ok_or_else(unknown)
}

/// Returns the value of a text in TOML.
fn value(text: &str) -> PyResult<Value> {
    let table = format!("value = {text}").parse::<Table>();
    let value = table.ok().and_then(|mut table| table.remove("value"));
    value.ok_or_else(|| PyValueError::new_err(format!("{text} is not a value of a scenario")))
}

#[pymethods]
impl Design {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    #[staticmethod]
    fn parse(text: &str) -> PyResult<Self> {
        toml::from_str(text).map(Self).map_err(|error| PyValueError::new_err(error.message().to_owned()))
    }

    #[getter]
    fn text(&self) -> PyResult<String> {
        toml::to_string(&self.0).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// The number of runs.
    #[getter]
    fn runs(&self) -> Option<u64> {
        self.0.runs()
    }

    /// Adds the values of one key.
    fn add_list(&mut self, key: String, values: Vec<f64>) {
        self.0.blocks.push(DesignBlock::List { key, values });
    }

    /// Adds points of numbers, of shape (points, keys).
    fn add_table(&mut self, keys: Vec<String>, points: PyReadonlyArray2<'_, f64>) {
        let points = points.as_array().rows().into_iter().map(|row| row.to_vec()).collect();
        self.0.blocks.push(DesignBlock::Table { keys, points });
    }

    /// Adds points of any values, each as a text in TOML.
    fn add_values(&mut self, keys: Vec<String>, points: Vec<Vec<String>>) -> PyResult<()> {
        let point =
            |texts: Vec<String>| texts.iter().map(|text| value(text)).collect::<PyResult<Vec<Value>>>();
        let points = points.into_iter().map(point).collect::<PyResult<_>>()?;
        self.0.blocks.push(DesignBlock::Values { keys, points });
        Ok(())
    }

    /// Adds points that are spread over ranges of keys.
    fn add_sample(&mut self, method: &str, count: u64, ranges: Vec<(String, f64, f64)>) -> PyResult<()> {
        let range = |(key, from, to)| KeyRange { key, from, to };
        let (sampling, ranges) = (sampling(method)?, ranges.into_iter().map(range).collect());
        self.0.blocks.push(DesignBlock::Sample { sampling, count, ranges });
        Ok(())
    }

    /// Sets how `[uncertain]` keys are drawn; `points` is the number of points of a Latin hypercube.
    fn draw(&mut self, method: &str, points: u64) -> PyResult<()> {
        self.0.draws = sampling(method)?;
        self.0.hypercube = if self.0.draws == Sampling::LatinHypercube { points } else { 0 };
        Ok(())
    }

    /// Sets the number of runs of each point.
    fn repeat(&mut self, replicas: u64) {
        self.0.replicas = replicas;
    }

    /// Gives every run the noise of one.
    fn share_noise(&mut self, run: u64) {
        self.0.noise_run = Some(run);
    }
}
