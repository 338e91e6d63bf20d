//! Answers of a law written in Python.

use flexsc_core::control::law::{Command, ControlOutput as Engine, Guards, Phase};
use flexsc_core::dynamics::guard::Guard;
use flexsc_core::numerics::time::Span;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::instant::{Instant, span};

/// A command from now on, and the conditions for the next call of the law.
///
/// `Hold(torque)` holds a torque (N m; rad/s² for a body without inertia; for a wheel, units of its command).
/// Use `acceleration` (rad/s²), `change` of the rigid rate (rad/s) or `moment` (A m²) instead of it. The next
/// call follows `after` a time (s), at the instant `until`, or when the angle is `at_least` or `at_most` a
/// level (rad), whichever is first; if no time is given, after the law's `period`. `state` is the name in the
/// log.
///
/// >>> import flexsc
/// >>> flexsc.Hold(-4e-5, at_most=4e-4, state="RACC").at_most
/// 0.0004
#[pyclass(frozen, eq, from_py_object, module = "flexsc._native")]
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Hold {
    command: Command,
    after: Option<Span>,
    until: Option<Instant>,
    pub at_least: Option<f64>,
    pub at_most: Option<f64>,
    pub phase: Phase,
}

/// The states of laws.
pub const PHASES: [Phase; 12] = [
    Phase::Open,
    Phase::Feedback,
    Phase::Start,
    Phase::PushFromRight,
    Phase::BrakeFromRight,
    Phase::WeakRight,
    Phase::PushFromLeft,
    Phase::BrakeFromLeft,
    Phase::WeakLeft,
    Phase::Coasting,
    Phase::Firing,
    Phase::Detumbling,
];

/// Returns the error of a law that would never be called again.
pub fn never() -> PyErr {
    PyValueError::new_err(
        "law: the law has no period and its hold gives no time: it would never be called again; give the law a `period`, \
         or the hold `after`, `until` or a level",
    )
}

/// Returns the state of a law by its name in the log.
pub fn phase(label: &str) -> PyResult<Phase> {
    PHASES.into_iter().find(|phase| phase.label() == label).ok_or_else(|| {
        let all = PHASES.map(|phase| format!("'{}'", phase.label())).join(", ");
        PyValueError::new_err(format!(
            "state must be one of {all}, got {label:?}; any other word is a signal of the law: signals = {{\"mode\": str}}"
        ))
    })
}

fn finite(name: &str, value: f64) -> PyResult<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(PyValueError::new_err(format!("{name} must be a finite number, got {value}")))
    }
}

impl Hold {
    /// A torque (N m), with no conditions for the next call.
    pub fn from_torque(torque: f64) -> Self {
        let command = Command::Torque(torque);
        Self { command, after: None, until: None, at_least: None, at_most: None, phase: Phase::Feedback }
    }

    /// The engine's answer of a law that is asked again after a period, if it names no time; an error if it would never be.
    pub fn engine_output(
        &self,
        now: flexsc_core::numerics::time::Instant,
        period: Option<Span>,
    ) -> PyResult<Engine> {
        let until = self.until.map(|until| until.0).or_else(|| Some(now + self.after.or(period)?));
        let guards = match (self.at_least, self.at_most) {
            (Some(above), Some(below)) => Guards::two(Guard::at_least(above), Guard::at_most(below)),
            (Some(above), None) => Guards::one(Guard::at_least(above)),
            (None, Some(below)) => Guards::one(Guard::at_most(below)),
            (None, None) => Guards::NONE,
        };
        if until.is_none() && guards.is_empty() {
            return Err(never());
        }
        Ok(Engine { command: self.command, until, guards })
    }
}

#[pymethods]
impl Hold {
    #[new]
    #[pyo3(signature = (torque=None, *, after=None, until=None, at_least=None, at_most=None, state="PD", acceleration=None, change=None, moment=None))]
    #[expect(clippy::too_many_arguments, reason = "the arguments of a Python class")]
    fn new(
        torque: Option<f64>,
        after: Option<f64>,
        until: Option<Instant>,
        at_least: Option<f64>,
        at_most: Option<f64>,
        state: &str,
        acceleration: Option<f64>,
        change: Option<f64>,
        moment: Option<f64>,
    ) -> PyResult<Self> {
        let command = match (torque, acceleration, change, moment) {
            (Some(torque), None, None, None) => Command::Torque(finite("torque", torque)?),
            (None, Some(value), None, None) => Command::Acceleration(finite("acceleration", value)?),
            (None, None, Some(value), None) => Command::Change(finite("change", value)?),
            (None, None, None, Some(value)) => Command::Moment(finite("moment", value)?),
            _ => {
                let why = "a hold needs exactly one of torque, acceleration, change and moment";
                return Err(PyValueError::new_err(why));
            }
        };
        if after.is_some() && until.is_some() {
            return Err(PyValueError::new_err("a hold needs exactly one of after and until"));
        }
        Ok(Self {
            command,
            after: after.map(|after| span(after, "after")).transpose()?,
            until,
            at_least: at_least.map(|level| finite("at_least", level)).transpose()?,
            at_most: at_most.map(|level| finite("at_most", level)).transpose()?,
            phase: if state == "PD" { Phase::Feedback } else { phase(state)? },
        })
    }

    /// Torque (N m; rad/s² for a body without inertia; for a wheel, units of its command), if it is
    /// commanded.
    #[getter]
    fn torque(&self) -> Option<f64> {
        if let Command::Torque(value) = self.command { Some(value) } else { None }
    }

    /// Acceleration (rad/s²), if it is commanded.
    #[getter]
    fn acceleration(&self) -> Option<f64> {
        if let Command::Acceleration(value) = self.command { Some(value) } else { None }
    }

    /// Change of the rigid rate (rad/s), if it is commanded.
    #[getter]
    fn change(&self) -> Option<f64> {
        if let Command::Change(value) = self.command { Some(value) } else { None }
    }

    /// Magnetic moment (A m²), if it is commanded.
    #[getter]
    fn moment(&self) -> Option<f64> {
        if let Command::Moment(value) = self.command { Some(value) } else { None }
    }

    /// Time to the next call (s), if it is given.
    #[getter]
    fn after(&self) -> Option<f64> {
        self.after.map(Span::seconds)
    }

    /// The instant of the next call, if it is given.
    #[getter]
    fn until(&self) -> Option<Instant> {
        self.until
    }

    /// Angle (rad) from which on the law is called again, if it is given.
    #[getter]
    fn at_least(&self) -> Option<f64> {
        self.at_least
    }

    /// Angle (rad) down to which the law is called again, if it is given.
    #[getter]
    fn at_most(&self) -> Option<f64> {
        self.at_most
    }

    /// State of the law in the log, such as `PD`.
    #[getter]
    fn state(&self) -> &'static str {
        self.phase.label()
    }

    fn __repr__(&self) -> String {
        let (name, value) = match self.command {
            Command::Torque(value) => ("", value),
            Command::Acceleration(value) => ("acceleration=", value),
            Command::Change(value) => ("change=", value),
            Command::Moment(value) => ("moment=", value),
        };
        let given = [
            ("after", self.after()),
            ("until", self.until.map(|until| until.0.seconds())),
            ("at_least", self.at_least),
            ("at_most", self.at_most),
        ];
        let given = given.into_iter().filter_map(|(name, value)| Some(format!(", {name}={:?}", value?)));
        format!("Hold({name}{value:?}{}, state='{}')", given.collect::<String>(), self.state())
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyDict>)> {
        let reported = PyDict::new(py);
        reported.set_item("torque", self.torque())?;
        reported.set_item("after", self.after())?;
        reported.set_item("until", self.until)?;
        reported.set_item("at_least", self.at_least)?;
        reported.set_item("at_most", self.at_most)?;
        reported.set_item("state", self.state())?;
        reported.set_item("acceleration", self.acceleration())?;
        reported.set_item("change", self.change())?;
        reported.set_item("moment", self.moment())?;
        Ok(((), reported))
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        *self
    }
}
