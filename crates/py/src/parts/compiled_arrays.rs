//! Compiled parts about three axes: functions with arrays of numbers, called by their address.

use std::sync::OnceLock;

use flexsc_core::control::custom::PartError;
use flexsc_core::control::disturbance::{DisturbanceRun, DisturbanceSpec, PointLoad};
use flexsc_core::control::guidance::{GuidanceRun, GuidanceSpec};
use flexsc_core::control::law::{
    Authority, Command, DecisionCause, ErrorBand, Law, LawSpec, LawState, Open, Phase, ThreeAxisInput,
    ThreeAxisLaw, ThreeAxisOutput,
};
use flexsc_core::control::offers::{LawOffers, LawPlace, Offers};
use flexsc_core::control::part::Part;
use flexsc_core::control::requirement::Requirements;
use flexsc_core::control::sensor::{Orientation, Truth};
use flexsc_core::control::state_estimate::EstimateNeeds;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::spacecraft::environment::EnvironmentObservation;
use flexsc_core::spacecraft::manoeuvre::AttitudeMotion;
use nalgebra::Quaternion;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use super::disturbance::{no_next_call, points_and_period};
use super::hold::{PHASES, never};
use super::law::duration_of_part;

/// The function: now and the time since its last call (s), its input, its states, its output.
type Function = unsafe extern "C" fn(f64, f64, *const f64, *mut f64, *mut f64);

/// A compiled function with its states.
#[derive(Clone, Debug)]
struct Compiled {
    function: Function,
    states: Vec<f64>,
    last: Option<Instant>,
    halted: Option<PartError>,
}

/// Returns the address of a compiled part.
pub fn address(part: &Bound<'_, PyAny>, role: &str) -> PyResult<usize> {
    let address: usize = part.getattr("address")?.extract()?;
    if address == 0 {
        return Err(PyValueError::new_err("address must be the address of a function, got 0"));
    }
    if part.getattr("signals")?.len()? > 0 {
        let why = format!("{role}: a compiled {role} has no signals: it has no attributes during a run");
        return Err(PyValueError::new_err(why));
    }
    Ok(address)
}

impl Compiled {
    #[expect(unsafe_code, reason = "whoever gives the address says that it is that of such a function")]
    fn from_python(part: &Bound<'_, PyAny>, role: &str) -> PyResult<Self> {
        let address = address(part, role)?;
        // SAFETY: `flexsc.CompiledThreeAxisLaw` documents the signature, and keeps the function's owner alive.
        let function = unsafe { std::mem::transmute::<*const (), Function>(address as *const ()) };
        Ok(Self { function, states: part.getattr("states")?.extract()?, last: None, halted: None })
    }

    /// Calls the function.
    fn call(&mut self, now: Instant, input: &[f64], output: &mut [f64]) {
        let since = self.last.replace(now).map_or(0.0, |last| now.since(last).seconds());
        invoke(self.function, [now.seconds(), since], input, &mut self.states, output);
    }

    /// Keeps an error, which ends the run.
    fn halt(&mut self, why: String) {
        self.halted.get_or_insert_with(|| PartError::new(PyRuntimeError::new_err(why)));
    }
}

#[expect(unsafe_code, reason = "the function is foreign")]
fn invoke(function: Function, [now, since]: [f64; 2], input: &[f64], states: &mut [f64], output: &mut [f64]) {
    // SAFETY: the lengths are those that the documentation of the class gives, and all outlive the call.
    unsafe { function(now, since, input.as_ptr(), states.as_mut_ptr(), output.as_mut_ptr()) }
}

/// Returns the time of the next call, from the last number of an output or from a period.
fn next(now: Instant, after: f64, period: Option<Span>) -> Option<Instant> {
    let after = if after.is_nan() { period } else { Some(Span::from_seconds(after)) };
    after.map(|after| now + after)
}

/// Returns true if a time (s) to the next call is left out, or is at least half a femtosecond: a shorter one would be a call at
/// the same instant, without end.
fn is_time(after: f64) -> bool {
    after.is_nan() || after.is_finite() && Span::from_seconds(after) > Span::ZERO
}

/// A law about three axes as a scenario has it.
#[derive(Debug)]
pub struct CompiledThreeAxisLaw {
    compiled: Compiled,
    command: fn(f64) -> Command,
    period: Option<Span>,
    promise: Option<f64>,
}

impl CompiledThreeAxisLaw {
    pub fn from_python(part: &Bound<'_, PyAny>) -> PyResult<Self> {
        let command: String = part.getattr("command")?.extract()?;
        let command = match &*command {
            "torque" => Command::Torque,
            "acceleration" => Command::Acceleration,
            "moment" => Command::Moment,
            _ => {
                let why = format!("command must be one of torque, acceleration, moment, got `{command}`");
                return Err(PyValueError::new_err(why));
            }
        };
        Ok(Self {
            compiled: Compiled::from_python(part, "law")?,
            command,
            period: duration_of_part(part, "period")?,
            promise: part.getattr("promise")?.extract()?,
        })
    }
}

impl LawSpec for CompiledThreeAxisLaw {
    fn start(&self, _: &Authority) -> Box<dyn Law> {
        // A law about three axes has no state about one of them.
        Box::new(Open::default())
    }

    fn start_three_axis(&self, _: &[Authority]) -> Option<Box<dyn ThreeAxisLaw>> {
        let Self { compiled, command, period, .. } = self;
        Some(Box::new(Deciding {
            compiled: compiled.clone(),
            command: *command,
            period: *period,
            phase: Phase::Open,
        }))
    }

    fn offers(&self) -> LawOffers {
        LawOffers { is_three_axis: true, ..LawOffers::new(self.period, EstimateNeeds::Motion) }
    }

    fn requires(&self, _: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        offers.require_three_axes(needs, "", ": use a flexsc.CompiledLaw");
    }

    fn expected_band(&self) -> ErrorBand {
        self.promise.map_or(ErrorBand::None, ErrorBand::Absolute)
    }
}

/// Run-time state of a law about three axes.
#[derive(Clone, Debug)]
struct Deciding {
    compiled: Compiled,
    command: fn(f64) -> Command,
    period: Option<Span>,
    phase: Phase,
}

impl Part for Deciding {
    fn failure(&self) -> Option<PartError> {
        self.compiled.halted.clone()
    }
}

impl ThreeAxisLaw for Deciding {
    fn decide(&mut self, now: Instant, _: DecisionCause, input: &ThreeAxisInput<'_>) -> ThreeAxisOutput {
        let mut values = [0.0; 18];
        for axis in 0..3 {
            let setpoint = &input.setpoints[axis];
            let (angle, rate) = setpoint.at(now);
            let Some(estimate) = input.estimates.get(axis) else { continue };
            let own =
                [estimate.angle, estimate.rate, angle, rate, setpoint.acceleration, estimate.field_rate];
            own.into_iter().enumerate().for_each(|(place, value)| values[3 * place + axis] = value);
        }
        // Three commands, time, state.
        let mut hold = [0.0, 0.0, 0.0, f64::NAN, f64::NAN];
        self.compiled.call(now, &values, &mut hold);
        let [x, y, z, after, state] = hold;
        if !(x + y + z).is_finite() || !is_time(after) {
            let why = format!("a compiled law gave commands of {:?} and a time of {after} s", [x, y, z]);
            self.compiled.halt(why);
            return ThreeAxisOutput::NONE;
        }
        let until = next(now, after, self.period);
        if until.is_none() {
            self.compiled.halted = Some(PartError::new(never()));
            return ThreeAxisOutput::NONE;
        }
        let phase = if state.is_nan() { None } else { PHASES.get(state as usize).copied() };
        self.phase = phase.unwrap_or(Phase::Feedback);
        ThreeAxisOutput { commands: [x, y, z].map(self.command), until }
    }

    fn state(&self) -> LawState<'_> {
        LawState::new(self.phase)
    }

    fn copy(&self) -> Box<dyn ThreeAxisLaw> {
        Box::new(self.clone())
    }
}

/// Returns the sky as numbers: position, velocity, direction to the Sun and field, NaN where there is none.
fn sky_numbers(sky: &EnvironmentObservation) -> [f64; 12] {
    let mut numbers = [f64::NAN; 12];
    let all = [sky.position, sky.velocity, sky.sun, sky.field];
    for (place, vector) in numbers.chunks_exact_mut(3).zip(all) {
        if let Some(vector) = vector {
            place.copy_from_slice(vector.as_slice());
        }
    }
    numbers
}

/// A disturbance as a scenario has it.
#[derive(Debug)]
pub struct CompiledDisturbance {
    compiled: Compiled,
    points: Vec<String>,
    period: Option<Span>,
}

impl CompiledDisturbance {
    pub fn from_python(part: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (points, period) = points_and_period(part)?;
        Ok(Self { compiled: Compiled::from_python(part, "disturbance")?, points, period })
    }
}

impl DisturbanceSpec for CompiledDisturbance {
    fn points(&self) -> &[String] {
        &self.points
    }

    fn start(&self, axes: usize, _: Seed) -> Box<dyn DisturbanceRun> {
        let output = vec![0.0; 6 * self.points.len().max(1) + 1];
        let Self { compiled, period, .. } = self;
        Box::new(Acting { compiled: compiled.clone(), period: *period, due: None, axes, output })
    }
}

/// Run-time state of a disturbance.
#[derive(Clone, Debug)]
struct Acting {
    compiled: Compiled,
    period: Option<Span>,
    due: Option<Instant>,
    axes: usize,
    output: Vec<f64>,
}

impl Part for Acting {
    fn due(&self) -> Option<Instant> {
        self.due
    }

    fn failure(&self) -> Option<PartError> {
        self.compiled.halted.clone()
    }
}

impl DisturbanceRun for Acting {
    fn act(&mut self, now: Instant, truth: &Truth, loads: &mut [PointLoad]) {
        let orientation = match truth.orientation {
            Orientation::Angle(angle) => [angle, 0.0, 0.0, 0.0],
            Orientation::Attitude(q) => [q.w, q.i, q.j, q.k],
        };
        let mut input = [0.0; 22];
        input[..4].copy_from_slice(&orientation);
        input[4..7].copy_from_slice(&truth.rate);
        input[7..10].copy_from_slice(&truth.rigid_rate);
        input[10..].copy_from_slice(&sky_numbers(&truth.environment));
        self.output.fill(0.0);
        if let Some(after) = self.output.last_mut() {
            *after = f64::NAN;
        }
        self.compiled.call(now, &input, &mut self.output);
        let Some((&after, values)) = self.output.split_last() else { return };
        let is_pushed = self.axes == 1 && values[1..].iter().any(|value| *value != 0.0);
        self.due = None;
        if !is_time(after) || is_pushed || values.iter().any(|value| !value.is_finite()) {
            let why = format!(
                "a compiled disturbance gave {values:?} and a time of {after} s{}",
                if is_pushed { ", and a body with one angle has a torque alone" } else { "" }
            );
            self.compiled.halt(why);
            return;
        }
        self.due = next(now, after, self.period);
        if self.due.is_none() {
            self.compiled.halted = Some(PartError::new(no_next_call()));
        }
        for (load, numbers) in loads.iter_mut().zip(values.chunks_exact(6)) {
            load.torque.copy_from_slice(&numbers[..3]);
            load.force.copy_from_slice(&numbers[3..]);
        }
    }

    fn copy(&self) -> Box<dyn DisturbanceRun> {
        Box::new(self.clone())
    }
}

/// A guidance as a scenario has it, and during a run.
#[derive(Clone, Debug)]
pub struct CompiledGuidance {
    function: Function,
    states: Vec<f64>,
    halted: OnceLock<PartError>,
}

impl CompiledGuidance {
    pub fn from_python(part: &Bound<'_, PyAny>) -> PyResult<Self> {
        let Compiled { function, states, .. } = Compiled::from_python(part, "guidance")?;
        Ok(Self { function, states, halted: OnceLock::new() })
    }
}

impl GuidanceSpec for CompiledGuidance {
    fn start(&self, _: Seed) -> Box<dyn GuidanceRun> {
        self.copy()
    }
}

impl Part for CompiledGuidance {
    fn failure(&self) -> Option<PartError> {
        self.halted.get().cloned()
    }
}

impl GuidanceRun for CompiledGuidance {
    fn aim(&self, now: Instant, sky: &EnvironmentObservation) -> AttitudeMotion {
        let mut aim = [0.0; 10];
        // A function of time has constants in place of states.
        invoke(self.function, [now.seconds(), 0.0], &sky_numbers(sky), &mut self.states.clone(), &mut aim);
        let [w, x, y, z, rates @ ..] = aim;
        let attitude = Quaternion::new(w, x, y, z);
        let is_unit = (attitude.norm() - 1.0).abs() < 1e-6;
        if !is_unit || rates.iter().any(|value| !value.is_finite()) {
            let why = format!(
                "a compiled guidance gave {aim:?}, and must give a unit quaternion, a rate and an acceleration"
            );
            self.halted.get_or_init(|| PartError::new(PyRuntimeError::new_err(why)));
            return AttitudeMotion::at_rest(Quaternion::identity());
        }
        let [rate, acceleration] = [0, 3].map(|first| Vector::from_column_slice(&rates[first..first + 3]));
        AttitudeMotion { attitude, rate, acceleration }
    }

    fn copy(&self) -> Box<dyn GuidanceRun> {
        Box::new(self.clone())
    }
}
