//! Run-time state of the laws of a run, one about each axis or one about three axes together, with their current outputs.

use flexsc_dynamics::guard::{AxisGuards, Guard};
use flexsc_numerics::time::Instant;
use flexsc_record::Report;

use super::axes_laws::AxesLaws;
use super::mode_laws::ModeLaws;
use super::{
    Authority, Command, ControlOutput, DampingStatus, DecisionCause, Guards, LawKind, LawState, Phase,
    ReferenceNeeds, Setpoint, ThreeAxisInput, ThreeAxisOutput,
};
use crate::custom::PartError;
use crate::part::{Part, ReportContext};
use crate::state_estimate::StateEstimate;

/// Run-time state of the laws of all axes.
#[derive(Clone, Debug, Default)]
pub struct Controllers {
    /// Laws that act.
    laws: AxesLaws,
    /// Laws of all modes of operation; `None` without modes.
    modes: Option<ModeLaws>,
    /// Earliest time of the laws' next decision.
    until: Option<Instant>,
    /// Commands set from outside, which replace the laws' outputs.
    steered: Option<[Command; 3]>,
    /// Decisions about single axes, if they are recorded.
    trace: Option<Vec<AxisDecision>>,
}

/// Decision of the law about an axis, with what it read.
#[derive(Clone, Debug)]
pub struct AxisDecision {
    /// Axis: 0, or 0 to 2 for roll, pitch and yaw.
    pub axis: usize,
    /// Cause of the decision.
    pub cause: DecisionCause,
    /// Setpoint.
    pub goal: Setpoint,
    /// State estimate.
    pub estimate: StateEstimate,
    /// Output.
    pub output: ControlOutput,
}

impl Part for Controllers {
    fn due(&self) -> Option<Instant> {
        self.until
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        self.laws.axes.iter().for_each(|held| held.law.report(at, report));
        self.laws.three_axis.iter().for_each(|(law, _)| law.report(at, report));
    }

    fn failure(&self) -> Option<PartError> {
        let three_axis = self.laws.three_axis.iter().find_map(|(law, _)| law.failure());
        three_axis.or_else(|| self.laws.axes.iter().find_map(|held| held.law.failure()))
    }
}

/// Event to which laws respond.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// Start of the run.
    Start,
    /// Trip of a guard on the angle about an axis.
    Guard {
        /// Axis of the guard: 0, or 0 to 2 for roll, pitch and yaw.
        axis: usize,
        /// Index of the guard among those of the law about that axis.
        guard: usize,
    },
    /// Sample, or time of the next decision.
    Due {
        /// True if a sample was taken, at which guards are tested.
        sampled: bool,
    },
}

impl Controllers {
    /// Creates the laws before a run, about axes with these actuator authorities; `by_stage` has those of each stage
    /// about each axis, or is empty if all stages have the same.
    pub fn new(law: &LawKind, authorities: &[Authority], by_stage: &[Vec<Authority>]) -> Self {
        match law {
            LawKind::Stages(modes) if modes.are_modes() => {
                let modes = ModeLaws::new(modes.as_slice(), authorities, by_stage);
                Self { laws: modes.first(), modes: Some(modes), ..Self::default() }
            }
            law => Self { laws: AxesLaws::new(law, authorities, by_stage), ..Self::default() },
        }
    }

    /// Begins to record the decisions about single axes.
    pub fn begin_trace(&mut self) {
        self.trace = Some(Vec::new());
    }

    /// Returns the decisions recorded since the last time.
    pub fn take_trace(&mut self) -> Vec<AxisDecision> {
        self.trace.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Sets commands that replace the laws' outputs from now on; the laws no longer decide.
    pub fn set_external(&mut self, commands: [Command; 3]) {
        if self.steered.replace(commands).is_none() {
            self.until = None;
            self.laws.axes.iter_mut().for_each(|held| held.hold = ControlOutput::NONE);
            self.laws.three_axis.iter_mut().for_each(|(_, output)| *output = ThreeAxisOutput::NONE);
        }
    }

    /// Returns true if commands are set from outside.
    #[inline]
    pub fn is_external(&self) -> bool {
        self.steered.is_some()
    }

    /// Lets the laws that an event concerns decide, on the setpoint about each axis, the state estimates, and the speeds of
    /// wheels (rad/s). Returns the cause of the first decision, if any.
    pub fn decide(
        &mut self,
        now: Instant,
        event: Event,
        goal: impl Fn(usize, ReferenceNeeds) -> Setpoint,
        state_estimates: &[StateEstimate],
        wheel_speeds: &dyn Fn() -> Vec<f64>,
    ) -> Option<DecisionCause> {
        let entered = self.modes.as_mut().and_then(ModeLaws::enter_selected);
        // A law of a mode that begins starts without a past. For the run it is a decision at a set time.
        let (event, is_entry) = match entered {
            Some(laws) => {
                self.laws = laws;
                (Event::Start, true)
            }
            None => (event, false),
        };
        let reported = |cause: DecisionCause| if is_entry { DecisionCause::Timeout } else { cause };
        if let Some((law, output)) = &mut self.laws.three_axis {
            let cause = match event {
                Event::Start => DecisionCause::Start,
                _ if output.until == Some(now) => DecisionCause::Timeout,
                _ => return None,
            };
            let needs = law.reference_needs();
            let setpoints = [0, 1, 2].map(|axis| goal(axis, needs));
            let input = ThreeAxisInput { setpoints, estimates: state_estimates, wheel_speeds };
            *output = law.decide(now, cause, &input);
            self.until = output.until;
            if let Some(trace) = &mut self.trace {
                for (axis, (goal, command)) in setpoints.into_iter().zip(output.commands).enumerate() {
                    let output = ControlOutput { command, until: output.until, guards: Guards::NONE };
                    let estimate = state_estimates[axis].clone();
                    trace.push(AxisDecision { axis, cause, goal, estimate, output });
                }
            }
            return Some(reported(cause));
        }
        let mut first = None;
        for (axis, (held, state_estimate)) in self.laws.axes.iter_mut().zip(state_estimates).enumerate() {
            let timeout = held.hold.until.filter(|until| *until == now).map(|_| DecisionCause::Timeout);
            let cause = match event {
                Event::Start => Some(DecisionCause::Start),
                Event::Guard { axis: tripped, guard } if tripped == axis => Some(DecisionCause::Guard(guard)),
                Event::Due { sampled: true } => {
                    let holds = |guard: &Guard| guard.holds(state_estimate.angle);
                    held.hold.guards.iter().position(holds).map(DecisionCause::Guard).or(timeout)
                }
                Event::Guard { .. } | Event::Due { sampled: false } => timeout,
            };
            if let Some(cause) = cause {
                let goal = goal(axis, held.law.reference_needs());
                held.hold = held.law.decide(now, cause, &goal, state_estimate);
                if let Some(trace) = &mut self.trace {
                    let (estimate, output) = (state_estimate.clone(), held.hold);
                    trace.push(AxisDecision { axis, cause, goal, estimate, output });
                }
                first = first.or(Some(reported(cause)));
            }
        }
        self.until = self.laws.axes.iter().filter_map(|held| held.hold.until).min();
        first
    }

    /// Selects the laws of a mode, which start without a past at the next decision.
    pub fn enter_mode(&mut self, mode: usize) {
        self.modes.iter_mut().for_each(|modes| modes.select(mode));
    }

    /// Sets the state of the single relay law, which starts at `now`, after a push that started at `pushed`.
    pub fn begin(&mut self, phase: Phase, now: Instant, pushed: Instant) {
        let [held] = &mut self.laws.axes[..] else { return };
        if let Some(relay) = held.law.as_relay() {
            held.hold = relay.set_state(phase, now, pushed);
            self.until = held.hold.until;
        }
    }

    /// Returns true if a law must decide at `now`, because of its time or of a sample.
    #[inline]
    pub fn must_decide(&self, now: Instant, sampled: bool, state_estimates: &[StateEstimate]) -> bool {
        self.until == Some(now)
            || sampled
                && self.laws.axes.iter().zip(state_estimates).any(|(held, state_estimate)| {
                    held.hold.guards.iter().any(|guard| guard.holds(state_estimate.angle))
                })
    }

    /// Returns the earliest time of the laws' next decision.
    #[inline]
    pub fn next_timeout(&self) -> Option<Instant> {
        self.until
    }

    /// Returns the guards of the law about each axis.
    #[inline]
    pub fn guards(&self) -> AxisGuards<'_> {
        let mut guards: AxisGuards<'_> = [&[]; 3];
        for (own, held) in guards.iter_mut().zip(&self.laws.axes) {
            *own = &held.hold.guards;
        }
        guards
    }

    /// Returns the command about each axis.
    #[inline]
    pub fn outputs(&self) -> [Command; 3] {
        if let Some(commands) = self.steered {
            return commands;
        }
        if let Some((_, output)) = &self.laws.three_axis {
            return output.commands;
        }
        let mut commands = [Command::Torque(0.0); 3];
        for (held, command) in self.laws.axes.iter().zip(&mut commands) {
            *command = held.hold.command;
        }
        commands
    }

    /// Returns the state of the law about an axis.
    #[inline]
    pub fn state(&self, axis: usize) -> LawState<'_> {
        let state = match &self.laws.three_axis {
            Some((law, _)) => law.state(),
            None => self.laws.axes[axis].law.state(),
        };
        match &self.modes {
            Some(modes) => LawState { tuned: modes.tuned(axis), ..state },
            None => state,
        }
    }

    /// Sets a parameter of all laws, or of the law about one axis or in one mode that the key selects.
    pub fn tune(&mut self, key: &str, value: f64) {
        match &mut self.modes {
            Some(modes) => modes.tune(key, value, &mut self.laws),
            None => self.laws.tune(key, value),
        }
    }

    /// Returns the longest lead time after a sample for which laws read predicted elastic rates (s).
    #[inline]
    pub fn lead_time(&self) -> f64 {
        self.laws.lead_time
    }

    /// Returns the status of active damping in the last cycle about each axis; the default for laws without it.
    pub fn damping_status(&self) -> [DampingStatus; 3] {
        let mut status = [DampingStatus::default(); 3];
        for (held, status) in self.laws.axes.iter().zip(&mut status) {
            *status = held.law.state().damping.copied().unwrap_or_default();
        }
        status
    }
}
