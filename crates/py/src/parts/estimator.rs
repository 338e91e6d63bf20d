//! Estimators written in Python: at samples they make beliefs of readings.

use flexsc_core::control::custom::PartError;
use flexsc_core::control::estimator::{
    Estimator, EstimatorContext as EngineKnown, EstimatorSpec, SampleContext as EngineTaken,
};
use flexsc_core::control::part::{Occasion, Part, ReportContext};
use flexsc_core::control::sensor::Orientation;
use flexsc_core::control::state_estimate::{DominantMode, EstimateNeeds, StateEstimate};
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::{Instant as Exact, Span};
use flexsc_core::record::{AttitudeEstimate, Report};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::draws::Draws;
use super::instant::Instant;
use super::object::{Method, Object, numbers, overrides, shape};
use super::reading::{Four, Reading, Three, angle, attitude};
use super::signals::Signals;

/// The data of a scenario that an estimator knows before a run.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Clone, Debug)]
pub struct Known {
    inertias: Vec<f64>,
    /// Frequency, damping ratio and gain of each mode about each axis.
    modes: Vec<Vec<(f64, f64, f64)>>,
    period: Option<Span>,
    angle_noise: f64,
    rate_noise: Vec<Option<f64>>,
    reads: Vec<&'static str>,
    seed: Seed,
}

attributes! { Known {
    /// The number of axes: 1 or 3.
    axes: usize = |this| this.inertias.len();
    /// Moment of inertia about each axis (kg m²).
    inertias: Vec<f64> = |this| this.inertias.clone();
    /// Frequency (rad/s), damping ratio and gain of each mode, about each axis.
    modes: Vec<Vec<(f64, f64, f64)>> = |this| this.modes.clone();
    /// Sampling period (s).
    period: Option<f64> = |this| this.period.map(Span::seconds);
    /// Standard deviation of the measured angle (rad).
    angle_noise: f64 = |this| this.angle_noise;
    /// Standard deviation of the measured rate (rad/s) about each axis, if it is measured.
    rate_noise: Vec<Option<f64>> = |this| this.rate_noise.clone();
    /// The quantities that the law about each axis reads.
    reads: Vec<&'static str> = |this| this.reads.clone();
    /// Random numbers of the run.
    draws: Draws = |this| Draws(this.seed);
}

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.clone()
    }
}

/// A sample with its context.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Clone, Debug)]
pub struct Taken {
    now: Exact,
    measured: Option<Vec<(f64, f64)>>,
    readings: Vec<Option<Reading>>,
    origin: Orientation,
    truth: Vec<(f64, f64)>,
    torque: Vec<f64>,
}

attributes! { Taken {
    /// The instant: `taken.now - earlier` is the time between (s), without rounding before the
    /// difference.
    now: Instant = |this| Instant(this.now);
    /// The instant (s).
    time: f64 = |this| this.now.seconds();
    /// Angle relative to the target (rad) and rate (rad/s) about each axis; None if the sensor is
    /// silent.
    measured: Option<Vec<(f64, f64)>> = |this| this.measured.clone();
    /// The measurement of each sensor now, in the order of the scenario; None if it was not due, or
    /// silent.
    readings: Vec<Option<Reading>> = |this| this.readings.clone();
    /// The origin of the angles (rad), for a single-axis body.
    origin_angle: Option<f64> = |this| angle(&this.origin);
    /// The target (w, x, y, z), for a three-axis body.
    origin_attitude: Option<Four> = |this| attitude(&this.origin);
    /// The true rigid angle relative to the target (rad) and rate (rad/s) about each axis, for
    /// observers.
    truth: Vec<(f64, f64)> = |this| this.truth.clone();
    /// The torque that the actuator holds about each axis (N m).
    torque: Vec<f64> = |this| this.torque.clone();
}
}

/// An estimator as a scenario has it.
#[derive(Debug)]
pub struct PythonEstimator {
    object: Object,
    also: Also,
    pub signals: Option<Signals>,
}

/// The methods that its class has beside `take`.
#[derive(Copy, Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "a yes or no for each method")]
struct Also {
    given: bool,
    carry: bool,
    shift: bool,
    attitude: bool,
}

impl PythonEstimator {
    /// Reads what an estimator says of itself.
    pub fn from_python(part: &Bound<'_, PyAny>) -> PyResult<Self> {
        let has = |method| overrides(part, "Estimator", method);
        let also = Also {
            given: has("given")?,
            carry: has("carry")?,
            shift: has("shift")?,
            attitude: has("attitude")?,
        };
        let signals = Signals::from_python(part, "estimator", false)?;
        Ok(Self { object: Object::new(part), also, signals })
    }
}

impl EstimatorSpec for PythonEstimator {
    fn start(&self, known: &EngineKnown<'_>, seed: Seed) -> Box<dyn Estimator> {
        let reads = |reads: &EstimateNeeds| match reads {
            EstimateNeeds::Nothing => "nothing",
            EstimateNeeds::Field => "field",
            EstimateNeeds::Motion => "motion",
            EstimateNeeds::DominantMode => "dominant_mode",
            EstimateNeeds::ElasticRates => "elastic_rates",
        };
        let modes = known.axes.iter().map(|axis| {
            let modes = axis.modes.iter();
            modes.map(|mode| (mode.frequency.get(), mode.damping.get(), mode.gain.get())).collect()
        });
        let reported = Known {
            inertias: known.axes.iter().map(|axis| axis.inertia.get()).collect(),
            modes: modes.collect(),
            period: known.sampling,
            angle_noise: known.angle_noise,
            rate_noise: known.rate_noise.clone(),
            reads: known.reads.iter().map(reads).collect(),
            seed,
        };
        let method = Python::attach(|py| {
            Method::new(
                Py::new(py, reported).and_then(|context| self.object.started_copy(py, (context,))),
                "take",
            )
        });
        Box::new(Observing { method, also: self.also, signals: self.signals.clone() })
    }
}

/// Run-time state of an estimator.
#[derive(Debug)]
struct Observing {
    method: Method,
    also: Also,
    signals: Option<Signals>,
}

/// Writes an estimator's state estimate about each axis.
fn write(returned: &Bound<'_, PyAny>, estimates: &mut [StateEstimate]) -> PyResult<()> {
    if returned.is_none() {
        return Ok(());
    }
    let axes = estimates.len();
    let rows = || returned.try_iter()?.map(|row| numbers(&row?)).collect::<PyResult<Vec<_>>>();
    let is_right =
        |rows: &Vec<Vec<f64>>| rows.len() == axes && rows.iter().all(|row| [2, 5].contains(&row.len()));
    let Some(rows) = rows().ok().filter(is_right) else {
        let found = shape(returned);
        return Err(PyValueError::new_err(format!(
            "estimator: an estimate must be of shape ({axes}, 2), angle and rate about each axis, or ({axes}, 5), with \
             displacement, rate and frequency of the dominant mode, or None, got {found}"
        )));
    };
    for (estimate, row) in estimates.iter_mut().zip(rows) {
        [estimate.angle, estimate.rate] = [row[0], row[1]];
        if let [_, _, displacement, rate, frequency] = row[..] {
            estimate.dominant = DominantMode { displacement, rate, frequency };
        }
    }
    Ok(())
}

impl Observing {
    /// Returns the log row of the attitude that the estimator reports, if it reports one.
    fn attitude_row(&self, now: Exact, truth: &Orientation, bias: [f64; 3]) -> Option<AttitudeEstimate> {
        if !self.also.attitude {
            return None;
        }
        let reported = |part: &Bound<'_, PyAny>| {
            super::attitude::from_python(&part.call_method1("attitude", (Instant(now),))?)
        };
        let filter = Python::attach(|py| self.method.other(py, reported))??;
        super::attitude::row(&filter, truth, bias)
    }
}

impl Part for Observing {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Sample {
            let row = self.attitude_row(at.now, &at.truth.orientation(), at.truth.gyro_bias());
            if let Some(row) = row {
                report.add(row);
            }
        }
        Signals::report(self.signals.as_ref(), &self.method, 0, at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.method.halted()
    }
}

impl Estimator for Observing {
    fn input_changed(&mut self, now: Exact, moments: [f64; 3]) {
        if self.also.given {
            let moments: Three = moments.into();
            let with = (Instant(now), moments);
            Python::attach(|py| self.method.other(py, |part| part.call_method1("given", with).map(drop)));
        }
    }

    fn update(&mut self, context: &EngineTaken<'_>, estimates: &mut [StateEstimate]) {
        let axes = 0..estimates.len();
        let truth = |axis| {
            let state = (context.truth)(axis);
            (state.rigid_angle, state.rigid_rate)
        };
        let reported = Taken {
            now: context.now,
            measured: context.measured.map(|all| all.iter().map(|pair| (*pair).into()).collect()),
            readings: context
                .readings
                .iter()
                .map(|reading| reading.as_ref().map(Reading::from_engine))
                .collect(),
            origin: *context.origin,
            truth: axes.clone().map(truth).collect(),
            torque: axes.map(context.held_torque).collect(),
        };
        Python::attach(|py| {
            let argument = || Ok(Bound::new(py, reported)?.into_any());
            self.method.call(py, argument, |returned| write(returned, estimates))
        });
    }

    fn predict(&self, now: Exact, origin: &Orientation, beliefs: &mut [StateEstimate]) {
        if !self.also.carry {
            return;
        }
        let reported = Taken {
            now,
            measured: None,
            readings: Vec::new(),
            origin: *origin,
            truth: Vec::new(),
            torque: Vec::new(),
        };
        Python::attach(|py| {
            self.method.other(py, |part| write(&part.call_method1("carry", (reported,))?, beliefs));
        });
    }

    fn shift_origin(&mut self, by: [f64; 3]) {
        if self.also.shift {
            let by: Three = by.into();
            Python::attach(|py| {
                self.method.other(py, |part| part.call_method1("shift", (by,)).map(drop));
            });
        }
    }

    fn copy(&self) -> Box<dyn Estimator> {
        let (method, signals) = (self.method.copy("take"), self.signals.clone());
        Box::new(Self { method, signals, ..*self })
    }
}
