//! Laws about three axes together that are written in Python: asked at samples, they answer with commands about all axes.

use flexsc_core::control::custom::PartError;
use flexsc_core::control::law::{
    Authority as EngineAuthority, Command, DecisionCause, ErrorBand, Law, LawSpec, LawState, Open, Phase,
    Setpoint, ThreeAxisInput, ThreeAxisLaw, ThreeAxisOutput, Tunable,
};
use flexsc_core::control::offers::{LawOffers, LawPlace, Offers};
use flexsc_core::control::part::{Part, ReportContext};
use flexsc_core::control::requirement::Requirements;
use flexsc_core::control::state_estimate::{EstimateNeeds, StateEstimate};
use flexsc_core::numerics::attitude::{Vector, rotation};
use flexsc_core::numerics::time::{Instant as Exact, Span};
use flexsc_core::record::Report;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::hold::{never, phase};
use super::instant::{Instant, span};
use super::law::{Authority, duration_of_part, kept};
use super::object::{Method, Object, numbers, shape};
use super::reading::{Four, Three};
use super::signals::Signals;

/// The input of a law about three axes at a call. Angles are relative to the target.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Clone, Debug)]
pub struct ThreeAxisEvent {
    now: Exact,
    cause: &'static str,
    setpoints: [Setpoint; 3],
    estimates: Vec<StateEstimate>,
    wheel_speeds: Vec<f64>,
}

impl ThreeAxisEvent {
    fn each(&self, of: impl Fn(&StateEstimate) -> f64) -> Three {
        let mut values = [0.0; 3];
        values.iter_mut().zip(&self.estimates).for_each(|(value, estimate)| *value = of(estimate));
        values.into()
    }
}

attributes! { ThreeAxisEvent {
    /// The instant: `event.now - earlier` is the time between (s), without rounding before the
    /// difference.
    now: Instant = |this| Instant(this.now);
    /// The instant in seconds.
    time: f64 = |this| this.now.seconds();
    /// The start of the run, or the time given by the last hold.
    cause: &'static str = |this| this.cause;
    /// Rotation vector from the target to the estimated attitude (rad), in body axes.
    angles: Three = |this| this.each(|estimate| estimate.angle);
    /// Estimated rates (rad/s), in body axes.
    rates: Three = |this| this.each(|estimate| estimate.rate);
    /// The goal of the angles (rad): 0, unless a target drifts.
    goal_angles: Three = |this| this.setpoints.map(|setpoint| setpoint.at(this.now).0).into();
    /// The goal of the rates (rad/s).
    goal_rates: Three = |this| this.setpoints.map(|setpoint| setpoint.rate).into();
    /// The goal of the accelerations (rad/s²), for a target with a reference motion.
    goal_accelerations: Three = |this| this.setpoints.map(|setpoint| setpoint.acceleration).into();
    /// Rates of change of the magnetic field along the body axes (T/s).
    field_rates: Three = |this| this.each(|estimate| estimate.field_rate);
    /// Speeds of the reaction wheels (rad/s), as available to their drives.
    wheel_speeds: Vec<f64> = |this| this.wheel_speeds.clone();
}

    /// Quaternion (w, x, y, z) of the same rotation.
    #[getter]
    fn quaternion(&self) -> Four {
        let (x, y, z) = self.angles();
        let q = rotation(&Vector::new(x, y, z));
        (q.w, q.i, q.j, q.k)
    }

    fn __repr__(&self) -> String {
        let (angles, rates) = (self.angles(), self.rates());
        let (cause, now) = (self.cause, self.now);
        format!("<flexsc.parts.ThreeAxisEvent {cause} at {now} s: angles {angles:?}, rates {rates:?}>")
    }
}

/// Commands about three axes from now on, and the time of the next call of the law.
///
/// `ThreeAxisHold(torques)` holds torques (N m) of shape (3,). Use `accelerations` (rad/s²), which are
/// multiplied by the inertia, or magnetic `moments` (A m²) instead of them. The next call follows `after` a
/// time (s) or at the instant `until`; if no time is given, after the law's `period`. `state` is the name in
/// the log.
///
/// >>> import flexsc
/// >>> flexsc.ThreeAxisHold([0.01, 0.0, -0.02], after=0.5).torques
/// (0.01, 0.0, -0.02)
#[pyclass(frozen, eq, module = "flexsc._native")]
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ThreeAxisHold {
    commands: [Command; 3],
    after: Option<Span>,
    until: Option<Instant>,
    phase: Phase,
}

/// Returns three finite numbers, or an error that names them.
fn three(values: &Bound<'_, PyAny>, name: &str) -> PyResult<[f64; 3]> {
    let found = numbers(values).ok().filter(|all| all.iter().all(|value| value.is_finite()));
    found.and_then(|all| all.try_into().ok()).ok_or_else(|| {
        let found = match numbers(values) {
            Ok(all) if all.len() == 3 => format!("{all:?}"),
            _ => shape(values),
        };
        PyValueError::new_err(format!("law: {name} must be finite numbers of shape (3,), got {found}"))
    })
}

#[pymethods]
impl ThreeAxisHold {
    #[new]
    #[pyo3(signature = (torques=None, *, accelerations=None, moments=None, after=None, until=None, state="PD"))]
    fn new(
        torques: Option<&Bound<'_, PyAny>>,
        accelerations: Option<&Bound<'_, PyAny>>,
        moments: Option<&Bound<'_, PyAny>>,
        after: Option<f64>,
        until: Option<Instant>,
        state: &str,
    ) -> PyResult<Self> {
        let commands = match (torques, accelerations, moments) {
            (Some(values), None, None) => three(values, "torques")?.map(Command::Torque),
            (None, Some(values), None) => three(values, "accelerations")?.map(Command::Acceleration),
            (None, None, Some(values)) => three(values, "moments")?.map(Command::Moment),
            _ => {
                let why = "a hold needs exactly one of torques, accelerations and moments";
                return Err(PyValueError::new_err(why));
            }
        };
        if after.is_some() && until.is_some() {
            return Err(PyValueError::new_err("a hold needs exactly one of after and until"));
        }
        let after = after.map(|after| span(after, "after")).transpose()?;
        let phase = if state == "PD" { Phase::Feedback } else { phase(state)? };
        Ok(Self { commands, after, until, phase })
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

    /// State of the law in the log, such as `PD`.
    #[getter]
    fn state(&self) -> &'static str {
        self.phase.label()
    }

    /// Torques about each axis (N m), if they are commanded.
    #[getter]
    fn torques(&self) -> Option<Three> {
        self.values(|command| if let Command::Torque(value) = command { Some(value) } else { None })
    }

    /// Accelerations about each axis (rad/s²), if they are commanded.
    #[getter]
    fn accelerations(&self) -> Option<Three> {
        self.values(|command| if let Command::Acceleration(value) = command { Some(value) } else { None })
    }

    /// Magnetic moments along each axis (A m²), if they are commanded.
    #[getter]
    fn moments(&self) -> Option<Three> {
        self.values(|command| if let Command::Moment(value) = command { Some(value) } else { None })
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        *self
    }
}

impl ThreeAxisHold {
    fn values(&self, of: impl Fn(Command) -> Option<f64>) -> Option<Three> {
        let [x, y, z] = self.commands.map(of);
        Some((x?, y?, z?))
    }

    /// Returns the hold of what a law returns: a hold, or three torques.
    fn from_python(returned: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(hold) = returned.cast::<Self>() {
            return Ok(*hold.get());
        }
        let torques = numbers(returned).ok().filter(|all| all.len() == 3);
        if torques.is_none() {
            let why = format!(
                "law: decide must return torques of shape (3,) or a flexsc.ThreeAxisHold, got {}",
                shape(returned)
            );
            return Err(PyValueError::new_err(why));
        }
        Self::new(Some(returned), None, None, None, None, "PD")
    }
}

/// A law about three axes as a scenario has it.
#[derive(Debug)]
pub struct PythonThreeAxisLaw {
    object: Object,
    period: Option<Span>,
    promise: Option<f64>,
    tunable: Vec<(&'static str, f64)>,
    pub signals: Option<Signals>,
}

impl PythonThreeAxisLaw {
    /// Reads what a law says of itself.
    pub fn from_python(part: &Bound<'_, PyAny>, role: &str) -> PyResult<Self> {
        let tunable = part.getattr("tunable")?.call_method0("items")?;
        let number = |pair: PyResult<Bound<'_, PyAny>>| -> PyResult<(&'static str, f64)> {
            let (key, value): (String, f64) = pair?.extract()?;
            Ok((kept(&key), value))
        };
        Ok(Self {
            object: Object::new(part),
            period: duration_of_part(part, "period")?,
            promise: part.getattr("promise")?.extract()?,
            tunable: tunable.try_iter()?.map(number).collect::<PyResult<_>>()?,
            signals: Signals::from_python(part, role, false)?,
        })
    }
}

impl LawSpec for PythonThreeAxisLaw {
    fn start(&self, _: &EngineAuthority) -> Box<dyn Law> {
        // A law about three axes has no state about one of them.
        Box::new(Open::default())
    }

    fn start_three_axis(&self, authorities: &[EngineAuthority]) -> Option<Box<dyn ThreeAxisLaw>> {
        let method = Python::attach(|py| {
            let all = authorities.iter().map(|authority| Py::new(py, Authority(*authority)));
            let started = all.collect::<PyResult<Vec<_>>>();
            Method::new(started.and_then(|with| self.object.started_copy(py, (with,))), "decide")
        });
        Some(Box::new(Deciding {
            method,
            period: self.period,
            tuned: self.tunable.first().copied(),
            phase: Phase::Open,
            signals: self.signals.clone(),
        }))
    }

    fn offers(&self) -> LawOffers {
        LawOffers { is_three_axis: true, ..LawOffers::new(self.period, EstimateNeeds::Motion) }
    }

    fn requires(&self, _: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        offers.require_three_axes(needs, "", ": use a flexsc.Law");
    }

    fn expected_band(&self) -> ErrorBand {
        self.promise.map_or(ErrorBand::None, ErrorBand::Absolute)
    }

    fn tunable(&self) -> Vec<Tunable> {
        self.tunable.iter().map(|(key, value)| Tunable::unbounded(*key, *value)).collect()
    }
}

/// Run-time state of a law about three axes.
#[derive(Debug)]
struct Deciding {
    method: Method,
    period: Option<Span>,
    /// The first number that may be tuned, and its value.
    tuned: Option<(&'static str, f64)>,
    phase: Phase,
    signals: Option<Signals>,
}

impl Part for Deciding {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        Signals::report(self.signals.as_ref(), &self.method, 0, at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.method.halted()
    }
}

impl ThreeAxisLaw for Deciding {
    fn decide(&mut self, now: Exact, cause: DecisionCause, input: &ThreeAxisInput<'_>) -> ThreeAxisOutput {
        let event = ThreeAxisEvent {
            now,
            cause: if cause == DecisionCause::Start { "start" } else { "timeout" },
            setpoints: input.setpoints,
            estimates: input.estimates.to_vec(),
            wheel_speeds: (input.wheel_speeds)(),
        };
        let period = self.period;
        let reported = Python::attach(|py| {
            let argument = || Ok(Bound::new(py, event)?.into_any());
            self.method.call(py, argument, |returned| {
                let hold = ThreeAxisHold::from_python(returned)?;
                let until = hold.until.map(|until| until.0);
                let until = until.or_else(|| Some(now + hold.after.or(period)?)).ok_or_else(never)?;
                Ok((hold, until))
            })
        });
        let Some((hold, until)) = reported else { return ThreeAxisOutput::NONE };
        self.phase = hold.phase;
        ThreeAxisOutput { commands: hold.commands, until: Some(until) }
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(self.phase, self.tuned.map_or(f64::NAN, |(_, value)| value))
    }

    fn copy(&self) -> Box<dyn ThreeAxisLaw> {
        let (method, signals) = (self.method.copy("decide"), self.signals.clone());
        Box::new(Self { method, signals, ..*self })
    }

    fn tune(&mut self, key: &str, value: f64) {
        if let Some((first, own)) = &mut self.tuned
            && *first == key
        {
            *own = value;
        }
        Python::attach(|py| {
            self.method.other(py, |part| part.call_method1(pyo3::intern!(py, "tune"), (key, value)).map(drop))
        });
    }
}
