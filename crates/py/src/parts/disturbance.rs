//! Disturbances written in Python: torques and forces at points, given the true motion.

use flexsc_core::control::custom::PartError;
use flexsc_core::control::disturbance::{DisturbanceRun, DisturbanceSpec, PointLoad};
use flexsc_core::control::part::{Part, ReportContext};
use flexsc_core::control::sensor::Truth as EngineTruth;
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::Report;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::draws::Draws;
use super::law::{duration_of_part, positive};
use super::object::{Method, Object, numbers, shape};
use super::reading::Truth;
use super::signals::Signals;

/// Torque (N m) and force (N) in body axes, constant until the next call of the disturbance.
///
/// Both have the shape (3,), or (points, 3) for a disturbance with several `points`. The torque on a body
/// with one angle is a number. The next call follows `after` a time (s); if no time is given, after the
/// disturbance's `period`.
///
/// >>> import flexsc
/// >>> flexsc.Load([0.0, 1e-3, 0.0], after=0.1).torque
/// [[0.0, 0.001, 0.0]]
#[pyclass(frozen, eq, module = "flexsc._native")]
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    torque: Option<Vec<Vec<f64>>>,
    force: Option<Vec<Vec<f64>>>,
    after: Option<Span>,
}

/// Returns the numbers of a load: a row for each point.
fn rows(values: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<Vec<f64>>> {
    let found = if let Ok(value) = values.extract::<f64>() {
        Ok(vec![vec![value]])
    } else if let Ok(row) = numbers(values) {
        Ok(vec![row])
    } else {
        values.try_iter().and_then(|rows| rows.map(|row| numbers(&row?)).collect::<PyResult<Vec<_>>>())
    };
    let found = found.map_err(|_| {
        let found = shape(values);
        PyValueError::new_err(format!("{name} must be numbers of shape (3,) or (points, 3), got {found}"))
    })?;
    match found.iter().flatten().find(|value| !value.is_finite()) {
        Some(value) => Err(PyValueError::new_err(format!("{name} must be finite, got {value}"))),
        None => Ok(found),
    }
}

#[pymethods]
impl Load {
    #[new]
    #[pyo3(signature = (torque=None, force=None, *, after=None))]
    fn new(
        torque: Option<&Bound<'_, PyAny>>,
        force: Option<&Bound<'_, PyAny>>,
        after: Option<f64>,
    ) -> PyResult<Self> {
        let each =
            |values: Option<&Bound<'_, PyAny>>, name| values.map(|values| rows(values, name)).transpose();
        let after = after.map(|after| positive(after, "after")).transpose()?;
        Ok(Self { torque: each(torque, "torque")?, force: each(force, "force")?, after })
    }

    /// Torque at each point (N m), of shape (points, 3), if it is given.
    #[getter]
    fn torque(&self) -> Option<Vec<Vec<f64>>> {
        self.torque.clone()
    }

    /// Force at each point (N), of shape (points, 3), if it is given.
    #[getter]
    fn force(&self) -> Option<Vec<Vec<f64>>> {
        self.force.clone()
    }

    /// Time to the next call (s), if it is given.
    #[getter]
    fn after(&self) -> Option<f64> {
        self.after.map(Span::seconds)
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }
}

impl Load {
    /// Writes the loads of a body with `axes` axes.
    fn write(&self, axes: usize, loads: &mut [PointLoad]) -> PyResult<()> {
        let points = loads.len();
        for (name, rows, width) in [("torque", &self.torque, axes), ("force", &self.force, 3)] {
            let Some(rows) = rows else { continue };
            if rows.len() != points || rows.iter().any(|row| row.len() != width) {
                let found = match &rows[..] {
                    [row] => format!("({},)", row.len()),
                    _ => format!("({}, {})", rows.len(), rows[0].len()),
                };
                let wanted = if points == 1 { format!("({width},)") } else { format!("({points}, {width})") };
                return Err(PyValueError::new_err(format!(
                    "disturbance: {name} must be of shape {wanted}, got {found}"
                )));
            }
        }
        if axes == 1 && self.force.is_some() {
            return Err(PyValueError::new_err(
                "disturbance: a force acts on a body with three axes: use a torque for a body with one angle",
            ));
        }
        loads.fill(PointLoad::default());
        for (load, row) in loads.iter_mut().zip(self.torque.iter().flatten()) {
            load.torque[..axes].copy_from_slice(row);
        }
        for (load, row) in loads.iter_mut().zip(self.force.iter().flatten()) {
            load.force.copy_from_slice(row);
        }
        Ok(())
    }
}

/// Returns the error of a disturbance that would never be called again.
pub fn no_next_call() -> PyErr {
    PyValueError::new_err(
        "a disturbance without a period must give the time of its next call: flexsc.Load(..., after=1.0)",
    )
}

/// A disturbance as a scenario has it.
#[derive(Debug)]
pub struct PythonDisturbance {
    object: Object,
    points: Vec<String>,
    period: Option<Span>,
    pub signals: Option<Signals>,
}

/// Returns the points and the period of a disturbance.
pub fn points_and_period(part: &Bound<'_, PyAny>) -> PyResult<(Vec<String>, Option<Span>)> {
    let points = part.getattr("points")?;
    let why = || PyValueError::new_err("disturbance: points must be a sequence of names, such as (\"tip\",)");
    let names = if points.extract::<String>().is_ok() { None } else { points.extract().ok() };
    Ok((names.ok_or_else(why)?, duration_of_part(part, "period")?))
}

impl PythonDisturbance {
    /// Reads what a disturbance says of itself; `role` has its place in a list.
    pub fn from_python(part: &Bound<'_, PyAny>, role: &str) -> PyResult<Self> {
        let (points, period) = points_and_period(part)?;
        Ok(Self {
            object: Object::new(part),
            points,
            period,
            signals: Signals::from_python(part, role, false)?,
        })
    }
}

impl DisturbanceSpec for PythonDisturbance {
    fn points(&self) -> &[String] {
        &self.points
    }

    fn start(&self, axes: usize, seed: Seed) -> Box<dyn DisturbanceRun> {
        let method = Python::attach(|py| {
            let started =
                Py::new(py, Draws(seed)).and_then(|draws| self.object.started_copy(py, (axes, draws)));
            Method::new(started, "act")
        });
        let (period, signals) = (self.period, self.signals.clone());
        Box::new(Acting { method, axes, period, due: None, signals })
    }
}

/// Run-time state of a disturbance.
#[derive(Debug)]
struct Acting {
    method: Method,
    axes: usize,
    period: Option<Span>,
    due: Option<Instant>,
    signals: Option<Signals>,
}

impl Part for Acting {
    fn due(&self) -> Option<Instant> {
        self.due
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        Signals::report(self.signals.as_ref(), &self.method, 0, at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.method.halted()
    }
}

impl DisturbanceRun for Acting {
    fn act(&mut self, now: Instant, truth: &EngineTruth, loads: &mut [PointLoad]) {
        let Self { method, axes, period, .. } = self;
        let after = Python::attach(|py| {
            let argument = || Ok(Bound::new(py, Truth { now, truth: *truth })?.into_any());
            method.call(py, argument, |returned| {
                let load = if let Ok(load) = returned.cast::<Load>() {
                    load.get().clone()
                } else {
                    let torque = rows(returned, "torque").map_err(|_| {
                        let found = shape(returned);
                        PyValueError::new_err(format!(
                            "disturbance: act must return a torque or a flexsc.Load, got {found}"
                        ))
                    })?;
                    Load { torque: Some(torque), force: None, after: None }
                };
                load.write(*axes, loads)?;
                load.after.or(*period).ok_or_else(no_next_call)
            })
        });
        self.due = after.map(|after| now + after);
    }

    fn copy(&self) -> Box<dyn DisturbanceRun> {
        let (method, signals) = (self.method.copy("act"), self.signals.clone());
        Box::new(Self { method, signals, ..*self })
    }
}
