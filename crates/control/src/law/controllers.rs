//! Run-time state of the laws of a run, one about each axis or one about three axes together, with their current outputs.

use flexsc_dynamics::guard::{AxisGuards, Guard};
use flexsc_numerics::time::Instant;
use flexsc_record::Report;

use super::{
    Authority, Command, ControlOutput, DampingStatus, DecisionCause, Law, LawKind, LawState, Phase,
    ReferenceNeeds, Setpoint, ThreeAxisInput, ThreeAxisLaw, ThreeAxisOutput,
};
use crate::custom::PartError;
use crate::part::{Part, ReportContext};
use crate::state_estimate::StateEstimate;

/// Run-time state of the laws of all axes.
#[derive(Clone, Debug, Default)]
pub struct Controllers {
    /// Law about each axis; empty if one law acts about three axes together.
    axes: Vec<ControllerState>,
    /// Law about three axes together, with its current output.
    three_axis: Option<(Box<dyn ThreeAxisLaw>, ThreeAxisOutput)>,
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
        self.axes.iter().for_each(|held| held.law.report(at, report));
        self.three_axis.iter().for_each(|(law, _)| law.report(at, report));
    }

    fn failure(&self) -> Option<PartError> {
        let three_axis = self.three_axis.iter().find_map(|(law, _)| law.failure());
        three_axis.or_else(|| self.axes.iter().find_map(|held| held.law.failure()))
    }
}

/// Law with its current output.
#[derive(Clone, Debug)]
struct ControllerState {
    law: Box<dyn Law>,
    hold: ControlOutput,
    /// Key prefix of the law within a law `per_axis`; else empty.
    place: String,
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
        let axis = |(axis, authority)| {
            let place = if let LawKind::PerAxis(laws) = law { laws.key_prefix(axis) } else { String::new() };
            let law = match (law.about(axis), by_stage.get(axis)) {
                (LawKind::Stages(stages), Some(authorities)) => stages.start_with(authorities),
                (law, _) => law.start(authority),
            };
            ControllerState { law, hold: ControlOutput::NONE, place }
        };
        match law.start_three_axis(authorities) {
            Some(law) => Self { three_axis: Some((law, ThreeAxisOutput::NONE)), ..Self::default() },
            None => Self { axes: authorities.iter().enumerate().map(axis).collect(), ..Self::default() },
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
            self.axes.iter_mut().for_each(|held| held.hold = ControlOutput::NONE);
            self.three_axis.iter_mut().for_each(|(_, output)| *output = ThreeAxisOutput::NONE);
        }
    }

    /// Returns true if commands are set from outside.
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
        if let Some((law, output)) = &mut self.three_axis {
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
            return Some(cause);
        }
        let mut first = None;
        for (axis, (held, state_estimate)) in self.axes.iter_mut().zip(state_estimates).enumerate() {
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
                first = first.or(Some(cause));
            }
        }
        self.until = self.axes.iter().filter_map(|held| held.hold.until).min();
        first
    }

    /// Selects the laws of a mode, which decide at `now`.
    pub fn enter_mode(&mut self, now: Instant, mode: usize) {
        for held in &mut self.axes {
            held.law.enter_mode(mode);
            held.hold.until = Some(now);
        }
    }

    /// Sets the state of the single relay law, which starts at `now`, after a push that started at `pushed`.
    pub fn begin(&mut self, phase: Phase, now: Instant, pushed: Instant) {
        let [held] = &mut self.axes[..] else { return };
        if let Some(relay) = held.law.as_relay() {
            held.hold = relay.set_state(phase, now, pushed);
            self.until = held.hold.until;
        }
    }

    /// Returns true if a law must decide at `now`, because of its time or of a sample.
    pub fn must_decide(&self, now: Instant, sampled: bool, state_estimates: &[StateEstimate]) -> bool {
        self.until == Some(now)
            || sampled
                && self.axes.iter().zip(state_estimates).any(|(held, state_estimate)| {
                    held.hold.guards.iter().any(|guard| guard.holds(state_estimate.angle))
                })
    }

    /// Returns the earliest time of the laws' next decision.
    pub fn next_timeout(&self) -> Option<Instant> {
        self.until
    }

    /// Returns the guards of the law about each axis.
    pub fn guards(&self) -> AxisGuards<'_> {
        let mut guards: AxisGuards<'_> = [&[]; 3];
        for (own, held) in guards.iter_mut().zip(&self.axes) {
            *own = &held.hold.guards;
        }
        guards
    }

    /// Returns the command about each axis.
    pub fn outputs(&self) -> [Command; 3] {
        if let Some(commands) = self.steered {
            return commands;
        }
        if let Some((_, output)) = &self.three_axis {
            return output.commands;
        }
        let mut commands = [Command::Torque(0.0); 3];
        for (held, command) in self.axes.iter().zip(&mut commands) {
            *command = held.hold.command;
        }
        commands
    }

    /// Returns the state of the law about an axis.
    pub fn state(&self, axis: usize) -> LawState<'_> {
        match &self.three_axis {
            Some((law, _)) => law.state(),
            None => self.axes[axis].law.state(),
        }
    }

    /// Sets a parameter of all laws, or of the law about one axis that the key selects.
    pub fn tune(&mut self, key: &str, value: f64) {
        self.three_axis.iter_mut().for_each(|(law, _)| law.tune(key, value));
        for held in &mut self.axes {
            if let Some(key) = key.strip_prefix(held.place.as_str()) {
                held.law.tune(key, value);
            }
        }
    }

    /// Returns the longest lead time after a sample for which laws read predicted elastic rates (s).
    pub fn lead_time(&self) -> f64 {
        let one_axis = self.axes.iter().map(|held| held.law.reference_needs());
        let three_axis = self.three_axis.iter().map(|(law, _)| law.reference_needs());
        one_axis.chain(three_axis).map(|needs| needs.lead_time).fold(0.0, f64::max)
    }

    /// Returns the status of active damping in the last cycle about each axis; the default for laws without it.
    pub fn damping_status(&self) -> [DampingStatus; 3] {
        let mut status = [DampingStatus::default(); 3];
        for (held, status) in self.axes.iter().zip(&mut status) {
            *status = held.law.state().damping.copied().unwrap_or_default();
        }
        status
    }
}
