//! Actuators written in Python: they make torques of what is demanded, about each axis.

use flexsc_core::control::actuator::{
    Actuator, ActuatorEvent, ActuatorPlacement, ActuatorSpec, AxisActuatorContext as EngineSetting,
    AxisEffort, Demand,
};
use flexsc_core::control::custom::PartError;
use flexsc_core::control::part::{Part, ReportContext};
use flexsc_core::dynamics::wrench::Wrench;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::time::{Instant as Exact, Span};
use flexsc_core::record::Report;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::instant::{Instant, span};
use super::object::{Method, Object, numbers, shape};
use super::reading::Three;
use super::signals::Signals;

/// The data about an axis that an actuator knows.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Copy, Clone, Debug)]
pub struct Setting {
    /// The axis: 0, or 0 to 2 for roll, pitch and yaw.
    #[pyo3(get)]
    axis: usize,
    /// The inertia that the torque accelerates (kg m²).
    #[pyo3(get)]
    inertia: f64,
    /// Rate at the start (rad/s).
    #[pyo3(get)]
    rate: f64,
    /// The law's period (s), if it has one.
    #[pyo3(get)]
    period: Option<f64>,
}

#[pymethods]
impl Setting {
    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        *self
    }
}

/// The demands of the laws from now on.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Clone, Debug)]
pub struct Demanded {
    now: Exact,
    demands: Vec<Demand>,
    rigid: [f64; 3],
    field: Option<Vector>,
}

attributes! { Demanded {
    /// The instant: `demanded.now - earlier` is the time between (s), without rounding before the
    /// difference.
    now: Instant = |this| Instant(this.now);
    /// The instant (s).
    time: f64 = |this| this.now.seconds();
    /// The demand about each axis.
    values: Vec<f64> = |this| this.demands.iter().map(value).collect();
    /// The rigid rates of the body (rad/s).
    rigid: Three = |this| this.rigid.into();
    /// The measured magnetic field in the body frame (T).
    field: Option<Three> = |this| this.field.map(|field| <[f64; 3]>::from(field).into());
}

    /// The kind of each demand: a torque (N m), a change of the rigid rate (rad/s), or a magnetic moment
    /// (A m²).
    #[getter]
    fn kinds(&self) -> Vec<&'static str> {
        let kind = |demand: &Demand| match demand {
            Demand::Torque(_) => "torque",
            Demand::Change(_) => "change",
            Demand::Moment(_) => "moment",
        };
        self.demands.iter().map(kind).collect()
    }
}

fn value(demand: &Demand) -> f64 {
    match *demand {
        Demand::Torque(value) | Demand::Change(value) | Demand::Moment(value) => value,
    }
}

/// Torques about each axis (N m), and the time (s) after which the actuator is called again.
///
/// >>> import flexsc
/// >>> flexsc.Effort([0.01], after=0.05).torques
/// [0.01]
#[pyclass(frozen, eq, module = "flexsc._native")]
#[derive(Clone, Debug, PartialEq)]
pub struct Effort {
    torques: Vec<f64>,
    after: Option<Span>,
}

#[pymethods]
impl Effort {
    #[new]
    #[pyo3(signature = (torques, *, after=None))]
    fn new(torques: &Bound<'_, PyAny>, after: Option<f64>) -> PyResult<Self> {
        let after = after.map(|after| super::law::positive(after, "after")).transpose()?;
        Ok(Self { torques: numbers(torques)?, after })
    }

    /// Torques about each axis (N m).
    #[getter]
    fn torques(&self) -> Vec<f64> {
        self.torques.clone()
    }

    /// Time to the next call (s), if it is given.
    #[getter]
    fn after(&self) -> Option<f64> {
        self.after.map(Span::seconds)
    }
}

/// An actuator as a scenario has it.
#[derive(Debug)]
pub struct PythonActuator {
    object: Object,
    limits: Vec<f64>,
    pub signals: Option<Signals>,
}

impl PythonActuator {
    /// Reads what an actuator says of itself; `role` has its place in a list.
    pub fn from_python(part: &Bound<'_, PyAny>, role: &str) -> PyResult<Self> {
        let limit = part.getattr("limit")?;
        let limits = if limit.is_none() {
            Vec::new()
        } else if let Ok(limit) = limit.extract::<f64>() {
            vec![limit; 3]
        } else {
            numbers(&limit)?
        };
        for limit in &limits {
            span(*limit, "").map_err(|_| {
                PyValueError::new_err(format!("limit must be a torque of 0 N m or more, got {limit}"))
            })?;
        }
        let signals = Signals::from_python(part, role, false)?;
        Ok(Self { object: Object::new(part), limits, signals })
    }
}

impl ActuatorSpec for PythonActuator {
    fn start(&self, settings: &[EngineSetting], _: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        let reported: Vec<Setting> = settings
            .iter()
            .map(|setting| Setting {
                axis: setting.axis,
                inertia: setting.inertia,
                rate: setting.rate,
                period: setting.cycle.map(Span::seconds),
            })
            .collect();
        let method = Python::attach(|py| Method::new(self.object.started_copy(py, (reported,)), "command"));
        Box::new(Acting {
            method,
            demanded: [0.0; 3],
            torques: [0.0; 3],
            inertias: settings.iter().map(|setting| setting.inertia).collect(),
            demands: vec![Demand::Torque(0.0); settings.len()],
            due: None,
            field: None,
            signals: self.signals.clone(),
        })
    }

    fn limit(&self, axis: usize) -> Option<f64> {
        self.limits.get(axis).copied()
    }
}

/// Run-time state of an actuator.
#[derive(Debug)]
struct Acting {
    method: Method,
    demanded: [f64; 3],
    torques: [f64; 3],
    inertias: Vec<f64>,
    demands: Vec<Demand>,
    due: Option<Exact>,
    field: Option<Vector>,
    signals: Option<Signals>,
}

impl Acting {
    /// Takes over what the actuator answers.
    fn act(&mut self, now: Exact, rigid: [f64; 3]) {
        let Self { method, demands, field, .. } = self;
        let (demanded, axes) =
            (Demanded { now, demands: demands.clone(), rigid, field: *field }, demands.len());
        let reported = Python::attach(|py| {
            let argument = || Ok(Bound::new(py, demanded)?.into_any());
            method.call(py, argument, |returned| {
                let effort = match returned.cast::<Effort>() {
                    Ok(effort) => effort.get().clone(),
                    // A wrong type has no numbers.
                    Err(_) => Effort { torques: numbers(returned).unwrap_or_default(), after: None },
                };
                let count = effort.torques.len();
                if count == axes && effort.torques.iter().all(|torque| torque.is_finite()) {
                    return Ok(effort);
                }
                let found = match returned.cast::<Effort>() {
                    _ if count == axes => format!("{:?}", effort.torques),
                    Ok(_) => format!("shape ({count},)"),
                    Err(_) => shape(returned),
                };
                Err(PyValueError::new_err(format!(
                    "actuator: command must return finite torques of shape ({axes},) or a flexsc.Effort, got {found}"
                )))
            })
        });
        let effort = reported.unwrap_or(Effort { torques: vec![0.0; axes], after: None });
        self.torques[..axes].copy_from_slice(&effort.torques);
        self.due = effort.after.map(|after| now + after);
    }
}

impl Part for Acting {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        Signals::report(self.signals.as_ref(), &self.method, 0, at, report);
    }

    fn due(&self) -> Option<Exact> {
        self.due
    }

    fn failure(&self) -> Option<PartError> {
        self.method.halted()
    }
}

impl Actuator for Acting {
    fn command(&mut self, now: Exact, demands: &[Demand], rigid: [f64; 3]) {
        self.demands = demands.iter().take(self.inertias.len()).copied().collect();
        for (value, demand) in self.demanded.iter_mut().zip(&self.demands) {
            *value = if let Demand::Torque(torque) = *demand { torque } else { 0.0 };
        }
        self.act(now, rigid);
    }

    fn apply(&self, _: Exact, onto: &mut Wrench) {
        onto.hub.iter_mut().zip(&self.torques).for_each(|(hub, torque)| *hub += torque);
    }

    fn update(&mut self, now: Exact, event: ActuatorEvent<'_>) {
        match event {
            ActuatorEvent::MagneticField(field) => self.field = Some(field),
            ActuatorEvent::Due(rigid) if self.due == Some(now) => self.act(now, rigid),
            _ => {}
        }
    }

    fn effort(&self, axis: usize) -> AxisEffort {
        AxisEffort {
            demanded: self.demanded[axis],
            held: self.torques[axis],
            firing: 0.0,
            reduced_moment: self.torques[axis] / self.inertias[axis],
        }
    }

    fn ignores(&self, _: Exact, _: usize, _: &[Demand]) -> bool {
        false
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(Self {
            method: self.method.copy("command"),
            inertias: self.inertias.clone(),
            demands: self.demands.clone(),
            signals: self.signals.clone(),
            ..*self
        })
    }
}
