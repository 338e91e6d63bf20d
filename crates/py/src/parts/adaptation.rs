//! Adaptations written in Python: after each window they tune a number of the law.

use std::any::Any;

use flexsc_core::adaptation::{Adapt, Decision, Learn, Step};
use flexsc_core::own::Halt;
use flexsc_core::random::Seed;
use flexsc_core::time::Instant;
use pyo3::prelude::*;

use super::draws::Draws;
use super::object::{Method, Object};

/// An adaptation as a scenario has it.
#[derive(Debug)]
pub struct Brought {
    object: Object,
    tunes: String,
}

impl Brought {
    /// Reads what an adaptation says of itself.
    pub fn of(part: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self { object: Object::new(part), tunes: part.getattr("tunes")?.extract()? })
    }
}

impl Adapt for Brought {
    fn tunes(&self) -> &str {
        &self.tunes
    }

    fn start(&self, value: f64, seed: Seed) -> Box<dyn Learn> {
        let method = Python::attach(|py| {
            let begun = Py::new(py, Draws(seed)).and_then(|draws| self.object.begun(py, (value, draws)));
            Method::new(begun, "learn")
        });
        Box::new(Learning { method, value, last: f64::NAN })
    }

    fn any(&self) -> Option<&dyn Any> {
        Some(&self.object)
    }
}

/// An adaptation at work.
#[derive(Debug)]
struct Learning {
    method: Method,
    value: f64,
    /// The mean of the last window (rad).
    last: f64,
}

impl Learn for Learning {
    fn learn(&mut self, now: Instant, mean: f64) -> Option<Step> {
        let before = std::mem::replace(&mut self.last, mean);
        let told = Python::attach(|py| {
            self.method.other(py, |part| {
                let told = part.call_method1(pyo3::intern!(py, "learn"), (now.seconds(), mean))?;
                told.extract::<Option<f64>>()
            })
        });
        self.value = told.flatten()?;
        let change = ((mean - before) / mean).abs();
        let decision = if before.is_nan() { Decision::Begin } else { Decision::Keep };
        Some(Step { decision, change, draw: 0.0, gain: self.value, settled: 0 })
    }

    fn halted(&self) -> Option<Halt> {
        self.method.halted()
    }

    fn copy(&self) -> Box<dyn Learn> {
        Box::new(Self { method: self.method.copy("learn"), ..*self })
    }
}
