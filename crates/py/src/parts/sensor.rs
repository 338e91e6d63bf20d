//! Sensors written in Python: they read at samples.

use flexsc_core::control::custom::PartError;
use flexsc_core::control::part::{Part, ReportContext};
use flexsc_core::control::sensor::{Reading as EngineReading, Sensor, SensorSpec, Truth as EngineTruth};
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::Report;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use super::draws::Draws;
use super::law::duration_of_part;
use super::object::{Method, Object, shape};
use super::reading::{Reading, Truth};
use super::signals::Signals;

/// A sensor as a scenario has it.
#[derive(Debug)]
pub struct PythonSensor {
    object: Object,
    period: Span,
    angle_noise: f64,
    rate_noise: Option<f64>,
    pub signals: Option<Signals>,
}

impl PythonSensor {
    /// Reads what a sensor says of itself; `role` has its place in a list.
    pub fn from_python(part: &Bound<'_, PyAny>, role: &str) -> PyResult<Self> {
        Ok(Self {
            object: Object::new(part),
            period: period(part)?,
            angle_noise: part.getattr("angle_noise")?.extract()?,
            rate_noise: part.getattr("rate_noise")?.extract()?,
            signals: Signals::from_python(part, role, false)?,
        })
    }
}

/// Returns the period of a sensor.
fn period(part: &Bound<'_, PyAny>) -> PyResult<Span> {
    let why = "sensor: period, the time (s) between samples, must be given";
    let found = if part.hasattr("period")? { duration_of_part(part, "period")? } else { None };
    found.ok_or_else(|| PyTypeError::new_err(why))
}

impl SensorSpec for PythonSensor {
    fn start(&self, axes: usize, seed: Seed, _: usize) -> Box<dyn Sensor> {
        let method = Python::attach(|py| {
            let started =
                Py::new(py, Draws(seed)).and_then(|draws| self.object.started_copy(py, (axes, draws)));
            Method::new(started, "read")
        });
        Box::new(Reads(method, self.signals.clone()))
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        Some(self.period)
    }

    fn angle_noise(&self) -> f64 {
        self.angle_noise
    }

    fn rate_noise(&self, _: usize) -> Option<f64> {
        self.rate_noise
    }
}

/// Run-time state of a sensor.
#[derive(Debug)]
struct Reads(Method, Option<Signals>);

impl Part for Reads {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        Signals::report(self.1.as_ref(), &self.0, 0, at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.0.halted()
    }
}

impl Sensor for Reads {
    fn read(
        &mut self,
        now: Instant,
        truth: &EngineTruth,
        _: Option<&EngineReading>,
    ) -> Option<EngineReading> {
        Python::attach(|py| {
            let argument = || Ok(Bound::new(py, Truth { now, truth: *truth })?.into_any());
            self.0.call(py, argument, |returned| {
                if returned.is_none() {
                    return Ok(None);
                }
                let Ok(reading) = returned.cast::<Reading>() else {
                    let found = shape(returned);
                    let why = format!("sensor: read must return a flexsc.Reading or None, got {found}");
                    return Err(PyTypeError::new_err(why));
                };
                reading.get().within(&truth.orientation).map(Some)
            })
        })
        .flatten()
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(Self(self.0.copy("read"), self.1.clone()))
    }
}
