//! Laws of a run: when they decide and on what, their guards, external commands, and the objective of an adaptation.

use flexsc_control::custom::PartError;
use flexsc_control::estimator::ObjectiveWindow;
use flexsc_control::law::{AxisDecision, Command, Controllers, DecisionCause, Event, Phase, ReferenceNeeds};
use flexsc_control::part::{Part, ReportContext};
use flexsc_control::state_estimate::{DampingStatus, StateEstimate};
use flexsc_dynamics::guard::GuardCrossing;
use flexsc_flight_precision::Precision;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, earlier};
use flexsc_record::{Record, RecordError, Report};

use super::control_trace::ControlCall;
use super::guidance::Guidance;
use super::loads::Loads;
use super::objective::AdaptationObjective;
use super::plant::Plant;
use flexsc_scenario::Scenario;

/// Laws about all axes, with the events to which they respond.
#[derive(Clone, Debug)]
pub struct ControlLaws {
    laws: Controllers,
    /// Next guard crossing, as long as the inputs do not change before.
    crossing: Option<GuardCrossing>,
    /// Event at the current instant to which the laws have not responded yet, because the run was stopped before.
    pub pending_event: Option<Event>,
    /// True if there are external commands that the actuator does not have yet.
    pub external_command_pending: bool,
    /// Objective of the adaptation that tunes the laws.
    pub objective: AdaptationObjective,
    /// Calls of the control system, if they are recorded.
    pub trace: Option<Vec<ControlCall>>,
    /// Precision of the flight computer.
    pub precision: Precision,
}

/// Decision of the laws at one instant.
#[derive(Copy, Clone, Debug)]
pub struct LawDecision {
    /// State of the first law before and (`after`) after the decision.
    pub before: Phase,
    pub after: Phase,
    /// Cause of the first decision; `None` if no law has decided.
    pub cause: Option<DecisionCause>,
}

impl LawDecision {
    /// Returns true if the first law has changed its state, apart from the start.
    pub fn is_switching(&self) -> bool {
        !matches!(self.cause, Some(DecisionCause::Start) | None) && self.after != self.before
    }
}

impl ControlLaws {
    /// Creates the laws of a scenario, before its start.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        Self {
            laws: Controllers::new(
                &scenario.law,
                &scenario.study.authorities,
                &scenario.study.stage_authorities,
            ),
            crossing: None,
            pending_event: None,
            external_command_pending: false,
            objective: AdaptationObjective::new(scenario, seed),
            trace: None,
            precision: scenario.flight_precision,
        }
    }

    /// Begins to record the calls of the control system.
    pub fn begin_trace(&mut self) {
        self.trace = Some(Vec::new());
        self.laws.begin_trace();
    }

    /// Returns the decisions about each axis since the last time, if they are recorded.
    pub fn take_decisions(&mut self) -> Vec<AxisDecision> {
        self.laws.take_trace()
    }

    /// Returns the next instant at which a law decides by itself, a guard trips, or a window of the objective closes.
    #[inline]
    pub fn next_event(&self) -> Option<Instant> {
        let crossing = self.crossing.map(|crossing| crossing.at);
        earlier(earlier(crossing, self.laws.next_timeout()), self.objective.closes())
    }

    /// Returns the event at `now` for the laws.
    #[inline]
    pub fn event(&self, now: Instant, sample_is_due: bool) -> Event {
        match self.crossing {
            _ if sample_is_due => Event::Due { sampled: true },
            Some(GuardCrossing { at, axis, guard }) if at == now => Event::Guard { axis, guard },
            _ => Event::Due { sampled: false },
        }
    }

    /// Returns true if the laws have to decide on `event`.
    #[inline]
    pub fn must_decide(&self, now: Instant, event: Event, estimates: &[StateEstimate]) -> bool {
        let sampled = event == Event::Due { sampled: true };
        matches!(event, Event::Guard { .. }) || self.laws.must_decide(now, sampled, estimates)
    }

    /// Lets the laws that an event concerns decide, without a count of switchings; returns the cause of the first decision.
    pub fn decide_uncounted(
        &mut self,
        now: Instant,
        event: Event,
        guidance: &Guidance,
        estimates: &mut [StateEstimate],
        wheel_speeds: &dyn Fn() -> Vec<f64>,
    ) -> Option<DecisionCause> {
        self.external_command_pending = false;
        if self.laws.is_external() {
            return None;
        }
        if let [roll, pitch, yaw] = estimates {
            let total = self.precision.total_angle([roll.angle, pitch.angle, yaw.angle]);
            for estimate in &mut *estimates {
                estimate.total_angle = total;
            }
        }
        let led = guidance.reference_motion(now, estimates);
        let setpoint =
            |axis: usize, needs: ReferenceNeeds| guidance.setpoint_for(needs, now, led.map(|led| led[axis]));
        self.laws.decide(now, event, setpoint, estimates, wheel_speeds)
    }

    /// Lets the laws decide on `event`, and counts their switchings for the objective.
    #[inline]
    pub fn decide(
        &mut self,
        now: Instant,
        event: Event,
        guidance: &Guidance,
        estimates: &mut [StateEstimate],
        wheel_speeds: &dyn Fn() -> Vec<f64>,
    ) -> LawDecision {
        let before = self.phase();
        let counted =
            if self.objective.counts_switchings() { self.phases(estimates.len()) } else { Vec::new() };
        let cause = self.decide_uncounted(now, event, guidance, estimates, wheel_speeds);
        if !counted.is_empty() {
            let after = self.phases(estimates.len());
            let switched = counted.iter().zip(&after).filter(|(before, after)| before != after).count();
            self.objective.count_switchings(now, switched);
        }
        LawDecision { before, after: self.phase(), cause }
    }

    /// Finds the first guard crossing of the segment that begins now and whose inputs hold up to `end`.
    pub fn find_crossing(
        &mut self,
        [now, end]: [Instant; 2],
        plant: &mut Plant,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let guards = self.laws.guards();
        if guards.iter().any(|guards| !guards.is_empty()) {
            let end = self.laws.next_timeout().into_iter().fold(end, Instant::min);
            self.crossing = plant.crossing(guards, end.since(now), record)?;
        }
        Ok(())
    }

    /// Discards the crossing of the segment that has ended.
    pub fn discard_crossing(&mut self) {
        self.crossing = None;
    }

    /// Closes the objective's window, if it ends now, and sets the law's parameter to the value that the adaptation
    /// chose.
    #[inline]
    pub fn close_objective_window(
        &mut self,
        now: Instant,
        plant: &Plant,
        loads: &Loads,
    ) -> Option<ObjectiveWindow> {
        let measured = self.objective.close_window(now, plant, loads)?;
        if let (Some((row, _)), Some(search)) = (&measured.step, self.objective.search()) {
            self.laws.tune(search.parameter().0, row.gain);
        }
        Some(measured)
    }

    /// Sets commands that replace the laws' outputs from now on.
    pub fn set_external(&mut self, commands: [Command; 3]) {
        self.laws.set_external(commands);
        self.external_command_pending = true;
    }

    /// Returns true if commands are set from outside.
    pub fn is_external(&self) -> bool {
        self.laws.is_external()
    }

    /// Sets a tunable parameter of the laws.
    pub fn tune(&mut self, key: &str, value: f64) {
        self.laws.tune(key, value);
    }

    /// Sets the state of the single relay law, which starts at `now`, after a push that started at `pushed`.
    pub fn begin(&mut self, phase: Phase, now: Instant, pushed: Instant) {
        self.laws.begin(phase, now, pushed);
    }

    /// Selects the laws of a mode, which start without a past at the next decision.
    pub fn enter_mode(&mut self, mode: usize) {
        self.laws.enter_mode(mode);
    }

    /// Returns the command about each axis.
    #[inline]
    pub fn outputs(&self) -> [Command; 3] {
        self.laws.outputs()
    }

    /// Returns the phase of the first law.
    #[inline]
    pub fn phase(&self) -> Phase {
        self.laws.state(0).phase
    }

    /// Returns the phases of the laws about the first `axes` axes.
    pub fn phases(&self, axes: usize) -> Vec<Phase> {
        (0..axes).map(|axis| self.laws.state(axis).phase).collect()
    }

    /// Returns the value of the first law's tuned parameter.
    pub fn tuned_value(&self) -> f64 {
        self.laws.state(0).tuned
    }

    /// Returns the longest lead time after a sample for which laws read predicted elastic rates (s).
    #[inline]
    pub fn lead_time(&self) -> f64 {
        self.laws.lead_time()
    }

    /// Returns the status of active damping in the last cycle about each axis.
    pub fn damping_status(&self) -> [DampingStatus; 3] {
        self.laws.damping_status()
    }
}

impl Part for ControlLaws {
    fn due(&self) -> Option<Instant> {
        self.laws.due()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        self.laws.report(at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.laws.failure()
    }
}
