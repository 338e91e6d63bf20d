//! Rows of a cycle of three axes: errors, rates, jets, wheels, and adaptive observers.

use flexsc_control::actuator::Saturation;
use flexsc_record::{LoggedRevisions, Record, RecordError, Report, Tracking};

use super::journal_events::JournalEvents;
use crate::run_view::RunView;
use flexsc_scenario::Scenario;

/// Memory of the rows of the cycles.
#[derive(Clone, Debug)]
pub struct CycleRows {
    /// Revisions of the rows that are logged only when they change.
    revisions: LoggedRevisions,
    /// How wheels and magnetorquers reach their limits.
    saturation: Saturation,
    /// True if there are adaptive observers, whose elastic rates active damping needs.
    has_observers: bool,
    /// Reports of the last cycle: of the body and its actuators, and of the estimator.
    actuator_report: Report,
    estimator_report: Report,
}

impl CycleRows {
    /// Creates the memory of a scenario's rows, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        let saturation = Saturation::new(&scenario.actuator, scenario.duration.seconds());
        Self {
            has_observers: scenario.has_adaptive_observers(),
            revisions: LoggedRevisions::default(),
            saturation,
            actuator_report: Report::new(),
            estimator_report: Report::new(),
        }
    }

    /// Returns the warning of the run's end that wheels or magnetorquers have reached their limits.
    pub fn saturation_warning(&self) -> Option<String> {
        self.saturation.warning()
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
        if is_journaled {
            self.saturation.observe(now.seconds(), report);
        }
        run.record_report(report, record)?;
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
