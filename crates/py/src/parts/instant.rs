//! Instants of simulated time, which are counted in femtoseconds, for Python.

use flexsc_core::numerics::time::{Instant as Exact, Span};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyAny;

/// An instant of a run with femtosecond resolution: `Instant(whole, femtoseconds)`.
///
/// >>> from flexsc.parts import Instant
/// >>> Instant(20000, 1) - Instant(20000, 0)
/// 1e-15
#[pyclass(frozen, eq, ord, hash, from_py_object, module = "flexsc._native")]
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Instant(pub Exact);

/// Returns a span of `seconds` seconds, which must not be negative.
pub fn span(seconds: f64, name: &str) -> PyResult<Span> {
    if seconds >= 0.0 && seconds.is_finite() {
        Ok(Span::from_seconds(seconds))
    } else {
        Err(PyValueError::new_err(format!("{name} must be a time of 0 s or more, got {seconds}")))
    }
}

#[pymethods]
impl Instant {
    #[new]
    fn new(whole: u64, femtoseconds: u64) -> PyResult<Self> {
        if whole > 10_u64.pow(16) || femtoseconds >= 10_u64.pow(15) {
            return Err(PyValueError::new_err("must be at most 1e16 s and less than 1e15 femtoseconds"));
        }
        let (whole, part) = (Span::from_seconds(whole as f64), Span::from_femtoseconds(femtoseconds as i64));
        Ok(Self(Exact::START + whole + part))
    }

    /// The instant (s), rounded to a float.
    #[getter]
    fn seconds(&self) -> f64 {
        self.0.seconds()
    }

    fn __float__(&self) -> f64 {
        self.0.seconds()
    }

    fn __sub__(&self, earlier: &Self) -> f64 {
        self.0.since(earlier.0).seconds()
    }

    fn __add__(&self, seconds: f64) -> PyResult<Self> {
        Ok(Self(self.0 + span(seconds, "what is added")?))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyAny>, (u64, u64)) {
        (py.get_type::<Self>().into_any(), self.0.parts())
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        *self
    }

    fn __repr__(&self) -> String {
        format!("<flexsc.parts.Instant {} s>", self.0)
    }
}
