//! Laws that are compiled functions, called by their address: what numba's `cfunc` and C compilers make.

use flexsc_core::control::custom::PartError;
use flexsc_core::control::law::{
    Authority, Command, ControlOutput, DecisionCause, ErrorBand, Guards, Law, LawSpec, LawState, Phase,
    Setpoint,
};
use flexsc_core::control::offers::LawOffers;
use flexsc_core::control::part::Part;
use flexsc_core::control::state_estimate::{EstimateNeeds, StateEstimate};
use flexsc_core::dynamics::guard::Guard;
use flexsc_core::numerics::time::{Instant, Span};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use super::compiled_arrays::address;
use super::hold::{PHASES, never};
use super::law::duration_of_part;

/// The function: now and the time since its last call (s), the cause, angle and rate, those of the goal, its states, its hold.
type Function = unsafe extern "C" fn(f64, f64, f64, f64, f64, f64, f64, *mut f64, *mut f64);

/// A law as a scenario has it.
#[derive(Debug)]
pub struct CompiledLaw {
    function: Function,
    period: Option<Span>,
    promise: Option<f64>,
    switches: bool,
    states: Vec<f64>,
}

impl CompiledLaw {
    /// Reads what a compiled law says of itself.
    pub fn from_python(part: &Bound<'_, PyAny>) -> PyResult<Self> {
        let address = address(part, "law")?;
        Ok(Self {
            function: from_address(address),
            period: duration_of_part(part, "period")?,
            promise: part.getattr("promise")?.extract()?,
            switches: part.getattr("switches")?.extract()?,
            states: part.getattr("states")?.extract()?,
        })
    }
}

#[expect(unsafe_code, reason = "whoever gives the address says that it is that of such a function")]
fn from_address(address: usize) -> Function {
    // SAFETY: `flexsc.CompiledLaw` documents the signature, and keeps the function's owner alive.
    unsafe { std::mem::transmute::<*const (), Function>(address as *const ()) }
}

impl LawSpec for CompiledLaw {
    fn start(&self, _: &Authority) -> Box<dyn Law> {
        Box::new(Deciding {
            function: self.function,
            period: self.period,
            states: self.states.clone(),
            last: None,
            above: true,
            phase: Phase::Open,
            halted: None,
        })
    }

    fn offers(&self) -> LawOffers {
        let is_switching = self.switches;
        LawOffers { is_switching, ..LawOffers::new(self.period, EstimateNeeds::Motion) }
    }

    fn expected_band(&self) -> ErrorBand {
        self.promise.map_or(ErrorBand::None, ErrorBand::Absolute)
    }
}

/// Run-time state of a compiled law.
#[derive(Clone, Debug)]
struct Deciding {
    function: Function,
    period: Option<Span>,
    states: Vec<f64>,
    last: Option<Instant>,
    /// Whether the first guard is one of at least an angle.
    above: bool,
    phase: Phase,
    halted: Option<PartError>,
}

impl Part for Deciding {
    fn failure(&self) -> Option<PartError> {
        self.halted.clone()
    }
}

impl Law for Deciding {
    #[expect(unsafe_code, reason = "the function is foreign")]
    fn decide(
        &mut self,
        now: Instant,
        cause: DecisionCause,
        goal: &Setpoint,
        estimate: &StateEstimate,
    ) -> ControlOutput {
        let cause = match cause {
            DecisionCause::Start => 0.0,
            DecisionCause::Timeout => 1.0,
            DecisionCause::Guard(0) if self.above => 2.0,
            DecisionCause::Guard(_) => 3.0,
        };
        let since = self.last.replace(now).map_or(0.0, |last| now.since(last).seconds());
        let (angle, rate) = goal.at(now);
        // Torque, time, least and most angle, state.
        let mut hold = [0.0, f64::NAN, f64::NAN, f64::NAN, f64::NAN];
        // SAFETY: the states are as many as the law said, the hold has five numbers, and both outlive the call.
        unsafe {
            let (states, hold) = (self.states.as_mut_ptr(), hold.as_mut_ptr());
            (self.function)(
                now.seconds(),
                since,
                cause,
                estimate.angle,
                estimate.rate,
                angle,
                rate,
                states,
                hold,
            );
        }
        let [torque, after, above, below, state] = hold;
        if !torque.is_finite() || after < 0.0 || after.is_infinite() {
            let why = format!("a compiled law gave a torque of {torque} and a time of {after} s");
            self.halted = Some(PartError::new(PyRuntimeError::new_err(why)));
            return ControlOutput::NONE;
        }
        if after.is_nan() && self.period.is_none() && above.is_nan() && below.is_nan() {
            self.halted = Some(PartError::new(never()));
            return ControlOutput::NONE;
        }
        self.phase = if state.is_nan() {
            Phase::Feedback
        } else {
            PHASES.get(state as usize).copied().unwrap_or(Phase::Feedback)
        };
        self.above = !above.is_nan();
        let guards = match (above.is_nan(), below.is_nan()) {
            (false, false) => Guards::two(Guard::at_least(above), Guard::at_most(below)),
            (false, true) => Guards::one(Guard::at_least(above)),
            (true, false) => Guards::one(Guard::at_most(below)),
            (true, true) => Guards::NONE,
        };
        let after = if after.is_nan() { self.period } else { Some(Span::from_seconds(after)) };
        ControlOutput { command: Command::Torque(torque), until: after.map(|after| now + after), guards }
    }

    fn state(&self) -> LawState<'_> {
        LawState::new(self.phase)
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }
}
