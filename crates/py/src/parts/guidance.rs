//! Guidance written in Python: the reference motion of a three-axis body, given the time and the sky.

use flexsc_core::control::custom::PartError;
use flexsc_core::control::guidance::{GuidanceRun, GuidanceSpec};
use flexsc_core::control::part::{Part, ReportContext};
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::Instant as Exact;
use flexsc_core::record::Report;
use flexsc_core::spacecraft::environment::EnvironmentObservation;
use flexsc_core::spacecraft::manoeuvre::AttitudeMotion;
use nalgebra::Quaternion;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::draws::Draws;
use super::instant::Instant;
use super::object::{Method, Object, exactly, shape};
use super::reading::{Four, Three, four, triple, unit_quaternion};
use super::signals::Signals;

/// The sky at an instant, in inertial axes.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Copy, Clone, Debug)]
pub struct Sky {
    now: Exact,
    sky: EnvironmentObservation,
}

attributes! { Sky {
    /// The instant: `sky.now - earlier` is the time between (s), without rounding before the difference.
    now: Instant = |this| Instant(this.now);
    /// The instant (s).
    time: f64 = |this| this.now.seconds();
    /// The position from the planet's centre (m), on an orbit.
    position: Option<Three> = |this| triple(this.sky.position);
    /// The velocity (m/s), on an orbit.
    velocity: Option<Three> = |this| triple(this.sky.velocity);
    /// The direction to the Sun, when in sunlight.
    sun: Option<Three> = |this| triple(this.sky.sun);
    /// The magnetic field (T), if there is one.
    field: Option<Three> = |this| triple(this.sky.field);
}
}

/// The attitude (w, x, y, z) of a target, its rate (rad/s) and its acceleration (rad/s²), both in the axes
/// of that attitude.
///
/// >>> import flexsc
/// >>> flexsc.Aim((1.0, 0.0, 0.0, 0.0), rate=(0.0, 1e-3, 0.0)).rate
/// (0.0, 0.001, 0.0)
#[pyclass(frozen, eq, module = "flexsc._native")]
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Aim(AttitudeMotion);

#[pymethods]
impl Aim {
    #[new]
    #[pyo3(signature = (attitude, rate, acceleration=None))]
    fn new(
        attitude: &Bound<'_, PyAny>,
        rate: &Bound<'_, PyAny>,
        acceleration: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let acceleration = acceleration.map(|values| vector(values, "acceleration")).transpose()?;
        Ok(Self(AttitudeMotion {
            attitude: unit_quaternion(attitude)?,
            rate: vector(rate, "rate")?,
            acceleration: acceleration.unwrap_or_default(),
        }))
    }

    /// Attitude (w, x, y, z), which rotates vectors from the axes of the target to the inertial frame.
    #[getter]
    fn attitude(&self) -> Four {
        four(&self.0.attitude)
    }

    /// Rate in the axes of the target (rad/s).
    #[getter]
    fn rate(&self) -> Three {
        <[f64; 3]>::from(self.0.rate).into()
    }

    /// Acceleration in the axes of the target (rad/s²).
    #[getter]
    fn acceleration(&self) -> Three {
        <[f64; 3]>::from(self.0.acceleration).into()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        *self
    }
}

/// Returns three finite numbers.
fn vector(values: &Bound<'_, PyAny>, name: &str) -> PyResult<Vector> {
    let found = exactly::<3>(values, name)?;
    if found.iter().all(|value| value.is_finite()) {
        return Ok(Vector::from(found));
    }
    Err(PyValueError::new_err(format!("{name} must be finite numbers, got {found:?}")))
}

/// A guidance as a scenario has it.
#[derive(Debug)]
pub struct PythonGuidance {
    object: Object,
    pub signals: Option<Signals>,
}

impl PythonGuidance {
    /// Reads what a guidance says of itself; `role` has the name of its mode of operation.
    pub fn from_python(part: &Bound<'_, PyAny>, role: &str) -> PyResult<Self> {
        Ok(Self { object: Object::new(part), signals: Signals::from_python(part, role, false)? })
    }
}

impl GuidanceSpec for PythonGuidance {
    fn start(&self, seed: Seed) -> Box<dyn GuidanceRun> {
        let method = Python::attach(|py| {
            let started = Py::new(py, Draws(seed)).and_then(|draws| self.object.started_copy(py, (draws,)));
            Method::new(started, "aim")
        });
        Box::new(Aiming { method, signals: self.signals.clone() })
    }
}

/// Run-time state of a guidance.
#[derive(Debug)]
struct Aiming {
    method: Method,
    signals: Option<Signals>,
}

impl Part for Aiming {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        Signals::report(self.signals.as_ref(), &self.method, 0, at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.method.halted()
    }
}

impl GuidanceRun for Aiming {
    fn aim(&self, now: Exact, sky: &EnvironmentObservation) -> AttitudeMotion {
        let aim = Python::attach(|py| {
            let argument = || Ok(Bound::new(py, Sky { now, sky: *sky })?.into_any());
            self.method.call(py, argument, |returned| {
                let aim = returned.cast::<Aim>().map(|aim| aim.get().0);
                aim.map_err(|_| {
                    let found = shape(returned);
                    PyValueError::new_err(format!("guidance: aim must return a flexsc.Aim, got {found}"))
                })
            })
        });
        aim.unwrap_or_else(|| AttitudeMotion::at_rest(Quaternion::identity()))
    }

    fn copy(&self) -> Box<dyn GuidanceRun> {
        Box::new(Self { method: self.method.copy("aim"), signals: self.signals.clone() })
    }
}
