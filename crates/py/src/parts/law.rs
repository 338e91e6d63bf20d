//! Laws written in Python: asked at events, they answer with a hold.

use std::collections::BTreeSet;
use std::sync::{Mutex, OnceLock, PoisonError};

use flexsc_core::control::custom::PartError;
use flexsc_core::control::law::{
    Authority as EngineAuthority, ControlOutput as Held, DecisionCause, ErrorBand, Law, LawSpec, LawState,
    Phase, ReferenceNeeds, Setpoint, Tunable,
};
use flexsc_core::control::offers::LawOffers;
use flexsc_core::control::part::{Part, ReportContext};
use flexsc_core::control::state_estimate::{EstimateNeeds, StateEstimate};
use flexsc_core::formats::document::number_in;
use flexsc_core::numerics::time::{Instant as Exact, Span};
use flexsc_core::record::Report;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use super::hold::Hold;
use super::instant::{Instant, span};
use super::object::{Method, Object, shape};
use super::signals::Signals;

/// The authority of an actuator about an axis, as laws know it.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Copy, Clone, Debug)]
pub struct Authority(pub EngineAuthority);

attributes! { Authority {
    /// The axis: 0, or 0 to 2 for roll, pitch and yaw.
    axis: usize = |this| this.0.axis;
    /// The largest accelerations in the positive and negative direction (rad/s²); infinite without a
    /// limit.
    accelerations: (f64, f64) = |this| this.0.accelerations.into();
    /// Time from a command to its execution (s).
    delay: f64 = |this| this.0.delay;
}

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        *self
    }
}

/// The event at which a law is called, and its input. On three axes angles are relative to the target.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Clone, Debug)]
pub struct Event {
    now: Exact,
    cause: &'static str,
    goal: Setpoint,
    estimate: StateEstimate,
}

attributes! { Event {
    /// The instant: `event.now - earlier` is the time between (s), without rounding before the
    /// difference.
    now: Instant = |this| Instant(this.now);
    /// The instant in seconds.
    time: f64 = |this| this.now.seconds();
    /// The start of the run, the time given by the last hold, or the level that the angle has passed.
    cause: &'static str = |this| this.cause;
    /// Angle (rad).
    angle: f64 = |this| this.estimate.angle;
    /// Rate (rad/s).
    rate: f64 = |this| this.estimate.rate;
    /// The goal of the angle at this time (rad).
    goal_angle: f64 = |this| this.goal.at(this.now).0;
    /// The goal of the rate (rad/s).
    goal_rate: f64 = |this| this.goal.rate;
    /// The goal of the acceleration (rad/s²), for a target with a reference motion.
    goal_acceleration: f64 = |this| this.goal.acceleration;
    /// The instant from which the goal applies: the start, or the end of a manoeuvre.
    goal_from: Instant = |this| Instant(this.goal.from);
    /// Magnitude of the vector of the angles about all axes (rad); 0 for a single-axis body.
    whole: f64 = |this| this.estimate.total_angle;
    /// Rate of change of the magnetic field along the axis (T/s).
    field_rate: f64 = |this| this.estimate.field_rate;
    /// Change of the rate that is commanded but not yet executed (rad/s).
    queued: f64 = |this| this.estimate.queued_rate;
    /// The elastic modes: rate (rad/s), frequency (rad/s) and its jump per jump of the rigid rate.
    elastic: Vec<(f64, f64, f64)> = |this| {
        this.estimate.elastic.iter().map(|mode| (mode.rate, mode.frequency, mode.influence)).collect()
    };
    /// Whether the law may act on the elastic modes.
    trusted: bool = |this| this.estimate.elastic_is_trusted;
}

    /// The dominant mode: displacement (rad), rate (rad/s) and frequency (rad/s).
    #[getter]
    fn dominant(&self) -> (f64, f64, f64) {
        let dominant = self.estimate.dominant;
        (dominant.displacement, dominant.rate, dominant.frequency)
    }

    fn __repr__(&self) -> String {
        let StateEstimate { angle, rate, .. } = self.estimate;
        format!("<flexsc.parts.Event {} at {} s: angle {angle}, rate {rate}>", self.cause, self.now)
    }
}

/// A law as a scenario has it.
#[derive(Debug)]
pub struct PythonLaw {
    object: Object,
    period: Option<Span>,
    reads: EstimateNeeds,
    promise: Option<f64>,
    switches: bool,
    tracks: bool,
    tunable: Vec<(&'static str, f64)>,
    pub signals: Option<Signals>,
}

/// A key for as long as the program runs: laws have few.
pub fn kept(key: &str) -> &'static str {
    static KEYS: OnceLock<Mutex<BTreeSet<&'static str>>> = OnceLock::new();
    let mut keys = KEYS.get_or_init(Mutex::default).lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = keys.get(key) {
        return known;
    }
    let leaked: &'static str = Box::leak(key.to_owned().into_boxed_str());
    keys.insert(leaked);
    leaked
}

impl PythonLaw {
    /// Reads what a law says of itself.
    pub fn from_python(part: &Bound<'_, PyAny>, role: &str) -> PyResult<Self> {
        let reads: String = part.getattr("reads")?.extract()?;
        let tunable = part.getattr("tunable")?.call_method0("items")?;
        let number = |pair: PyResult<Bound<'_, PyAny>>| -> PyResult<(&'static str, f64)> {
            let (key, value): (String, f64) = pair?.extract()?;
            Ok((kept(&key), value))
        };
        Ok(Self {
            object: Object::new(part),
            period: duration_of_part(part, "period")?,
            reads: match reads.as_str() {
                "nothing" => EstimateNeeds::Nothing,
                "field" => EstimateNeeds::Field,
                "motion" => EstimateNeeds::Motion,
                "dominant_mode" => EstimateNeeds::DominantMode,
                "elastic_rates" => EstimateNeeds::ElasticRates,
                other => {
                    let all = "'nothing', 'field', 'motion', 'dominant_mode' or 'elastic_rates'";
                    return Err(PyValueError::new_err(format!("reads must be {all}, got {other:?}")));
                }
            },
            promise: part.getattr("promise")?.extract()?,
            switches: part.getattr("switches")?.extract()?,
            tracks: part.getattr("tracks")?.extract()?,
            tunable: tunable.try_iter()?.map(number).collect::<PyResult<_>>()?,
            signals: Signals::from_python(part, role, true)?,
        })
    }
}

/// Returns the time that a part has as an attribute: a number (s), a text such as `0.1 s`, or none.
pub fn duration_of_part(part: &Bound<'_, PyAny>, name: &str) -> PyResult<Option<Span>> {
    let given = part.getattr(name)?;
    if given.is_none() {
        return Ok(None);
    }
    let why = |why: String| PyValueError::new_err(format!("{name} {why}"));
    let seconds = match given.extract::<String>() {
        Ok(text) => number_in(&text, "s").map_err(why)?,
        Err(_) => given.extract().map_err(|_| {
            let found = shape(&given);
            PyTypeError::new_err(format!("{name} must be a time (s), such as 0.1 or \"0.1 s\", got {found}"))
        })?,
    };
    positive(seconds, name).map(Some)
}

/// Returns a period of more than 0 s, or an error that names it.
pub fn positive(seconds: f64, name: &str) -> PyResult<Span> {
    match span(seconds, name)? {
        Span::ZERO => Err(PyValueError::new_err(format!("{name} must be longer than 0 s"))),
        period => Ok(period),
    }
}

impl LawSpec for PythonLaw {
    fn start(&self, authority: &EngineAuthority) -> Box<dyn Law> {
        let method = Python::attach(|py| {
            let started =
                Py::new(py, Authority(*authority)).and_then(|with| self.object.started_copy(py, (with,)));
            Method::new(started, "decide")
        });
        Box::new(Deciding {
            method,
            period: self.period,
            tracks: self.tracks,
            tuned: self.tunable.first().copied(),
            above: true,
            phase: Phase::Open,
            axis: authority.axis,
            signals: self.signals.clone(),
        })
    }

    fn offers(&self) -> LawOffers {
        LawOffers { is_switching: self.switches, ..LawOffers::new(self.period, self.reads) }
    }

    fn expected_band(&self) -> ErrorBand {
        self.promise.map_or(ErrorBand::None, ErrorBand::Absolute)
    }

    fn tunable(&self) -> Vec<Tunable> {
        self.tunable.iter().map(|(key, value)| Tunable::unbounded(*key, *value)).collect()
    }
}

/// Run-time state of a law.
#[derive(Debug)]
struct Deciding {
    method: Method,
    period: Option<Span>,
    tracks: bool,
    /// The first number that may be tuned, and its value.
    tuned: Option<(&'static str, f64)>,
    /// Whether the first guard is one of at least an angle.
    above: bool,
    phase: Phase,
    axis: usize,
    signals: Option<Signals>,
}

impl Part for Deciding {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        Signals::report(self.signals.as_ref(), &self.method, self.axis, at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.method.halted()
    }
}

impl Law for Deciding {
    fn decide(
        &mut self,
        now: Exact,
        cause: DecisionCause,
        goal: &Setpoint,
        estimate: &StateEstimate,
    ) -> Held {
        let cause = match cause {
            DecisionCause::Start => "start",
            DecisionCause::Timeout => "timeout",
            DecisionCause::Guard(0) if self.above => "at_least",
            DecisionCause::Guard(_) => "at_most",
        };
        let event = Event { now, cause, goal: *goal, estimate: estimate.clone() };
        let period = self.period;
        let reported = Python::attach(|py| {
            let argument = || Ok(Bound::new(py, event)?.into_any());
            self.method.call(py, argument, |returned| {
                if let Ok(hold) = returned.cast::<Hold>() {
                    let hold = *hold.get();
                    return Ok((hold, hold.engine_output(now, period)?));
                }
                // A number is a torque, as three numbers are of a law about three axes.
                let hold = returned.extract::<f64>().map(Hold::from_torque).map_err(|_| {
                    let found = shape(returned);
                    let why = format!("law: decide must return a flexsc.Hold or a torque, got {found}");
                    PyTypeError::new_err(why)
                })?;
                Ok((hold, hold.engine_output(now, period)?))
            })
        });
        let Some((hold, output)) = reported else { return Held::NONE };
        self.above = hold.at_least.is_some();
        self.phase = hold.phase;
        output
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(self.phase, self.tuned.map_or(f64::NAN, |(_, value)| value))
    }

    fn reference_needs(&self) -> ReferenceNeeds {
        ReferenceNeeds { tracks_manoeuvre: self.tracks, ..ReferenceNeeds::default() }
    }

    fn copy(&self) -> Box<dyn Law> {
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
