//! Adaptations written in Python: after each window they tune a number of the law.

use flexsc_core::control::adaptation::{Adaptation, AdaptationSpec, Decision, Objective, SearchStep};
use flexsc_core::control::custom::PartError;
use flexsc_core::control::part::{Part, ReportContext};
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::Report;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::draws::Draws;
use super::law::duration_of_part;
use super::object::{Method, Object};
use super::signals::Signals;

/// An adaptation as a scenario has it.
#[derive(Debug)]
pub struct PythonAdaptation {
    object: Object,
    tunes: String,
    objective: Objective,
    window: Option<Span>,
    pub signals: Option<Signals>,
}

impl PythonAdaptation {
    /// Reads what an adaptation says of itself.
    pub fn from_python(part: &Bound<'_, PyAny>) -> PyResult<Self> {
        let word: String = part.getattr("objective")?.extract()?;
        let objective = Objective::from_key(&word).ok_or_else(|| {
            let all = Objective::ALL.map(|objective| format!("'{}'", objective.key())).join(", ");
            PyValueError::new_err(format!("objective must be one of {all}, got {word:?}"))
        })?;
        Ok(Self {
            object: Object::new(part),
            tunes: part.getattr("tunes")?.extract()?,
            objective,
            window: duration_of_part(part, "window")?,
            signals: Signals::from_python(part, "adaptation", false)?,
        })
    }
}

impl AdaptationSpec for PythonAdaptation {
    fn tunes(&self) -> &str {
        &self.tunes
    }

    fn objective(&self) -> Objective {
        self.objective
    }

    fn window(&self) -> Option<Span> {
        self.window
    }

    fn start(&self, value: f64, seed: Seed) -> Box<dyn Adaptation> {
        let method = Python::attach(|py| {
            let started =
                Py::new(py, Draws(seed)).and_then(|draws| self.object.started_copy(py, (value, draws)));
            Method::new(started, "learn")
        });
        Box::new(Learning { method, value, last: f64::NAN, signals: self.signals.clone() })
    }
}

/// Run-time state of an adaptation.
#[derive(Debug)]
struct Learning {
    method: Method,
    value: f64,
    /// The objective over the last window.
    last: f64,
    signals: Option<Signals>,
}

impl Part for Learning {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        Signals::report(self.signals.as_ref(), &self.method, 0, at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.method.halted()
    }
}

impl Adaptation for Learning {
    fn learn(&mut self, now: Instant, measured: f64) -> Option<SearchStep> {
        let before = std::mem::replace(&mut self.last, measured);
        let reported = Python::attach(|py| {
            self.method.other(py, |part| {
                let reported = part.call_method1(pyo3::intern!(py, "learn"), (now.seconds(), measured))?;
                reported.extract::<Option<f64>>()
            })
        });
        self.value = reported.flatten()?;
        let change = ((measured - before) / measured).abs();
        let decision = if before.is_nan() { Decision::Begin } else { Decision::Keep };
        Some(SearchStep { decision, change, draw: 0.0, gain: self.value, settled: 0 })
    }

    fn copy(&self) -> Box<dyn Adaptation> {
        let (method, signals) = (self.method.copy("learn"), self.signals.clone());
        Box::new(Self { method, signals, ..*self })
    }
}
