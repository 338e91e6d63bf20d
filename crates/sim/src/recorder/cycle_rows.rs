//! Rows of a cycle of three axes: errors, rates, jets, wheels, and adaptive observers.

use flexsc_control::actuator::{Saturation, TargetLoss};
use flexsc_numerics::time::Instant;
use flexsc_record::{LoggedRevisions, Record, RecordError, Report, Tracking};

use super::journal_events::JournalEvents;
use crate::run_view::RunView;
use flexsc_scenario::Scenario;

/// Memory of the rows of the cycles.
#[derive(Clone, Debug)]
pub struct CycleRows {
    /// Revisions of the rows that are logged only when they change.
    revisions: LoggedRevisions,
    /// How actuators reach their limits.
    saturation: Saturation,
    /// Names of the modes of operation.
    modes: Vec<String>,
    /// True if there are adaptive observers, whose elastic rates active damping needs.
    has_observers: bool,
    /// Reports of the last cycle: of the body and its actuators, and of the estimator.
    actuator_report: Report,
    estimator_report: Report,
}

impl CycleRows {
    /// Creates the memory of a scenario's rows, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            has_observers: scenario.has_adaptive_observers(),
            revisions: LoggedRevisions::default(),
            saturation: scenario.saturation(),
            modes: scenario.mode.iter().map(|mode| mode.name.clone()).collect(),
            actuator_report: Report::new(),
            estimator_report: Report::new(),
        }
    }

    /// Returns the warnings of the run's end that actuators have lost the target at their limits, or are at them.
    pub fn saturation_warnings(&self, end: Instant) -> impl Iterator<Item = String> {
        let loss = self.saturation.clone().close(end).map(|loss| self.loss_text(&loss));
        loss.into_iter().chain(self.saturation.warning())
    }

    fn loss_text(&self, loss: &TargetLoss) -> String {
        loss.text(self.modes.get(loss.mode).map(String::as_str), self.saturation.limits().name(loss.limit))
    }

    /// Records the rows of the cycle that begins now.
    pub fn record(
        &mut self,
        run: &RunView<'_>,
        journal: &mut JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Some(motion) = run.plant.quantities().three_axis() else { return Ok(()) };
        let (now, truth, is_journaled) = (run.now, run.plant.truth(), record.wants_journal());
        let report = &mut self.actuator_report;
        report.clear();
        run.add_actuator_cycle(motion, report);
        report.skip_repeated(&mut self.revisions);
        let loss = if is_journaled { self.saturation.observe(now, report) } else { None };
        run.record_report(report, record)?;
        if let Some(loss) = loss {
            journal.warned(now, "actuators", self.loss_text(&loss), record)?;
        }
        if is_journaled {
            let error = || run.sensors.angles_of(&truth.orientation, &run.guidance.target(now));
            journal.target(now, run.guidance, error, record)?;
        }
        if run.estimation.has_estimator {
            let damped = if self.has_observers { run.laws.damping_status() } else { Default::default() };
            let report = &mut self.estimator_report;
            report.clear();
            run.add_estimator_cycle(&damped, report);
            run.record_report(report, record)?;
            if is_journaled && report.row::<Tracking>().is_some() {
                let trusted = |axis: usize| run.estimation.estimates[axis].elastic_is_trusted;
                journal.damping_changed(now, &damped, [0, 1, 2].map(trusted), record)?;
            }
        }
        Ok(())
    }
}
