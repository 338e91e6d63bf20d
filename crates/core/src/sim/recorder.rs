//! Rows of a run: when they are due, and their content.

use flexsc_control::actuator::Saturation;
use flexsc_control::law::{DecisionCause, LawState, Phase};
use flexsc_dynamics::three_axis::SlipDirection;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{self, Command, LoggedRevisions, Record, RecordError, Sample, Tracking, Trigger};

use super::accelerometers::Accelerometers;
use super::failures::Failures;
use super::guidance::Guidance;
use super::journal_events::JournalEvents;
use super::manoeuvre_end::ManoeuvreEnd;
use super::plant::Plant;
use super::reports::record_report;
use super::{Simulation, SimulationError};
use crate::scenario::Scenario;
use crate::scene::Scene;

/// Schedule and memory of everything that a run writes to its record.
#[derive(Clone, Debug)]
pub struct Recorder {
    /// Detector of state changes for the journal.
    pub events: JournalEvents,
    /// Scene of the run; `None` if it is not drawn.
    pub scene: Option<Box<Scene>>,
    /// Instant at which the frames of the scene are due next.
    pub next_frames: Option<Instant>,
    /// Period of the rows of a dense record.
    pub log_period: Span,
    next_dense: Option<Instant>,
    /// Torques of the pulses of thrusters that were on at the last row (N m).
    firing: [f64; 3],
    next_law: Instant,
    /// Period of the cycle rows of a three-axis body.
    cycle_period: Option<Span>,
    /// Slip states of the wheels as last recorded.
    pub recorded_slips: Vec<SlipDirection>,
    /// Revisions of the rows that are logged only when they change.
    logged_revisions: LoggedRevisions,
    next_cycle: Option<Instant>,
    /// How wheels and magnetorquers reach their limits.
    saturation: Saturation,
    /// Pending end of the manoeuvre, if any.
    arrival: Option<ManoeuvreEnd>,
    /// Accelerometers of the run, which only the record reads.
    pub accelerometers: Accelerometers,
    /// Pending beginnings and ends of failures.
    pub failures: Failures,
    /// True if the torque consists of more than the switchings of a law.
    has_torque_rows: bool,
    /// True if jets are the only actuator.
    jets_only: bool,
    stage: JournalStage,
}

/// Stage of the journal: not yet opened, open, or closed.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum JournalStage {
    Before,
    Within,
    After,
}

impl Recorder {
    /// Creates the schedule of a scenario's run, before its start.
    pub fn new(scenario: &Scenario, reference: &Guidance, run: u64) -> Self {
        Self {
            events: JournalEvents::new(scenario, run),
            scene: None,
            next_frames: None,
            log_period: scenario.log_period(),
            next_dense: None,
            firing: [0.0; 3],
            next_law: Instant::START,
            cycle_period: scenario.model.spatial().map(|_| scenario.study.assessment_period),
            recorded_slips: Vec::new(),
            logged_revisions: LoggedRevisions::default(),
            next_cycle: None,
            saturation: Saturation::new(&scenario.actuator, scenario.duration.seconds()),
            arrival: ManoeuvreEnd::new(scenario, &reference.setpoint),
            accelerometers: Accelerometers::new(scenario, run),
            failures: Failures::new(scenario),
            has_torque_rows: scenario.has_torque_rows(),
            jets_only: scenario.study.jets_alone,
            stage: JournalStage::Before,
        }
    }

    /// Enables drawing of the scenario's scene.
    pub fn draw(&mut self, scenario: &Scenario) {
        self.scene = Some(Box::new(Scene::new(scenario)));
    }

    /// Opens the journal once; returns true if this call opened it.
    pub fn open(&mut self, now: Instant, record: &mut dyn Record) -> Result<bool, RecordError> {
        if self.stage != JournalStage::Before {
            return Ok(false);
        }
        self.stage = JournalStage::Within;
        self.events.begin(now, record)?;
        Ok(true)
    }

    /// Returns true if the torque consists of more than the switchings of a law.
    pub fn has_torque_rows(&self) -> bool {
        self.has_torque_rows
    }

    /// Returns true if jets are the only actuator.
    pub fn is_jets_only(&self) -> bool {
        self.jets_only
    }

    /// Marks the journal as closed; returns true the first time.
    pub fn close(&mut self) -> bool {
        std::mem::replace(&mut self.stage, JournalStage::After) != JournalStage::After
    }

    /// Records the last lines of the run's journal.
    pub fn journal_end(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        if let Some(line) = self.saturation.warning() {
            self.events.warned(now, "actuators", line, record)?;
        }
        self.events.end(now, record)
    }

    /// Returns the instant at which the next row or journal line is due.
    pub fn due(&self) -> Option<Instant> {
        let arrives = self.arrival.as_ref().map(|arrival| arrival.at);
        let reported = earlier(earlier(arrives, self.next_dense), earlier(self.next_frames, self.next_cycle));
        earlier(reported, earlier(self.failures.due(), self.accelerometers.due()))
    }
}

/// Returns the earlier of two optional instants.
fn earlier(a: Option<Instant>, b: Option<Instant>) -> Option<Instant> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        _ => a.or(b),
    }
}

impl Simulation {
    /// Records the rows of the start.
    pub(super) fn record_start(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if let Plant::OneAxis(_) = self.plant {
            record.record(now, Sample::Begin(&self.law_row()))?;
        }
        if record.wants_motion() {
            self.recorder.next_dense = Some(now);
            self.recorder.next_law = now + Span::from_seconds(1.0);
        }
        self.recorder.next_cycle = self.recorder.cycle_period.map(|_| now);
        self.record_scene(record)
    }

    /// Records the rows that are due at the current instant, after all parts have acted.
    pub(super) fn record_due(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if self.recorder.next_cycle == Some(now) {
            self.recorder.next_cycle = self.recorder.cycle_period.map(|cycle| now + cycle);
            self.record_cycle(record)?;
        }
        let Some(due) = self.recorder.next_dense else { return Ok(()) };
        // A pulse that begins or ends has a row of its own, or a log could miss it.
        let mut firing = [0.0; 3];
        for (axis, firing) in firing.iter_mut().enumerate().take(self.estimates.len()) {
            *firing = self.loads.actuator.effort(axis).firing;
        }
        let pulses = std::mem::replace(&mut self.recorder.firing, firing) != firing;
        if due == now {
            self.recorder.next_dense = Some(now + self.recorder.log_period);
        }
        if due == now || pulses {
            self.plant.evaluate(now)?;
            record.record(now, Sample::Report(&self.period_report()))?;
            if due == now && now >= self.recorder.next_law {
                if let Plant::OneAxis(_) = self.plant {
                    record.record(now, Sample::Row(&self.law_row()))?;
                }
                self.recorder.next_law += Span::from_seconds(1.0);
            }
        }
        Ok(())
    }

    /// Records the end of the manoeuvre, if it is at the current instant.
    pub(super) fn record_manoeuvre_end(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        let Some(arrival) = self.recorder.arrival.take_if(|arrival| arrival.at == now) else { return Ok(()) };
        self.plant.evaluate(now)?;
        let row = arrival.row(self.plant.truth(), &self.plant.about_axis(0, &self.angle_origin));
        record.record(now, Sample::Row(&row))?;
        Ok(self.recorder.events.manoeuvre_ended(now, &row, record)?)
    }

    /// Records a switching of the one-axis law, if its state was `before` and has changed, with the sensed angle (rad)
    /// and rate (rad/s) and the commanded torque.
    pub(super) fn record_switching(
        &self,
        before: Phase,
        cause: Option<DecisionCause>,
        [angle_rad, rate_rad_s]: [f64; 2],
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        let (now, LawState { phase: state, tuned: gain, .. }) = (self.now, self.controllers.about(0).state());
        let Plant::OneAxis(plant) = &self.plant else { return Ok(()) };
        if before == state {
            return Ok(());
        }
        let (time_s, time_whole_s, time_fs) = Command::times(now);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state,
            cause: if cause == Some(DecisionCause::Timeout) { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: self.loads.actuator.effort(0).demanded,
            angle_rad,
            rate_rad_s,
            gain,
        };
        record.record(now, Sample::Switching(&command, plant.state()))?;
        if record.wants_motion() {
            record.record(now, Sample::Report(&self.period_report()))?;
        }
        Ok(())
    }

    /// Records the estimates after the current sample, and journals losses of lock.
    pub(super) fn record_estimates(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.recorder.events.lock_changed(now, self.estimator.lock_lost(), self.estimates.len(), record)?;
        if !record.wants_estimates() {
            return Ok(());
        }
        self.plant.evaluate(now)?;
        Ok(record_report(now, &self.sample_report(), record)?)
    }

    pub(super) fn law_row(&self) -> flexsc_record::Law {
        let LawState { phase: state, tuned: gain, .. } = self.controllers.about(0).state();
        flexsc_record::Law { state, torque_nm: self.loads.actuator.effort(0).demanded, gain }
    }

    /// Records the cycle rows of a three-axis body and of its estimator; also updates the angle origin and the
    /// adaptation's objective.
    fn record_cycle(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.evaluate(now)?;
        // The origin follows the targets also if no law is asked.
        self.update_angle_origin(now);
        let origin = self.angle_origin;
        self.add_cycle();
        if let Plant::ThreeAxis(plant) = &self.plant {
            let truth = plant.viewed();
            let mut report = self.actuator_cycle_report(plant, truth.orientation.error_from(&origin));
            report.skip_repeated(&mut self.recorder.logged_revisions);
            self.recorder.saturation.observe(now.seconds(), &report);
            record.record(now, Sample::Report(&report))?;
            if let Some(written) = self.guidance.target_as_written(now) {
                let error = || truth.orientation.error_from(&self.guidance.target(now));
                self.recorder.events.target(now, written, error, record)?;
            }
            if self.has_estimator {
                let damped = self.controllers.damping_status();
                let report = self.estimator_cycle_report(&damped);
                record_report(now, &report, record)?;
                if report.get::<Tracking>().is_some() {
                    let trusted = |axis: usize| self.estimates[axis].elastic_is_trusted;
                    self.recorder.events.damping_changed(now, &damped, [0, 1, 2].map(trusted), record)?;
                }
            }
        }
        Ok(())
    }
}
