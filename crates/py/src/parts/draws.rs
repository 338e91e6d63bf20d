//! Random numbers of a run for Python: streams that depend on the scenario's seed and the number of the run alone.

use flexsc_core::numerics::random::{Seed, Stream as Engine};
use pyo3::prelude::*;

/// The source of the random numbers of a run.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Copy, Clone, Debug)]
pub struct Draws(pub Seed);

attributes! { Draws {
    /// The scenario's seed.
    seed: u64 = |this| this.0.scenario;
    /// The number of the run.
    run: u64 = |this| this.0.run;
}

    /// The stream with this name. It is independent of streams with other names.
    fn stream(&self, name: &str) -> Stream {
        Stream(self.0.stream(name))
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        *self
    }
}

/// A stream of random numbers of a run, the same on every machine. A copy continues in the same way.
#[pyclass(module = "flexsc._native")]
#[derive(Clone, Debug)]
pub struct Stream(Engine);

#[pymethods]
impl Stream {
    /// A uniformly distributed number in [0, 1).
    fn uniform(&mut self) -> f64 {
        self.0.uniform()
    }

    /// A normally distributed number with mean 0 and standard deviation 1.
    fn normal(&mut self) -> f64 {
        self.0.normal()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }
}
