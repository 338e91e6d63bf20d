//! Sampling of the errors that requirements limit: nothing in the loop reads them; metrics do.

use flexsc_control::operation::Expression;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{
    Record, RecordError, Report, RequirementError, RequirementErrors, RequirementScope, RequirementScopes,
    Sample,
};

use crate::run_view::{RunView, motion_error};
use flexsc_scenario::{RequirementSource, SampledError, SampledQuantity, Scenario};

/// Schedule of the samples of all requirements; lines of sight are sampled by themselves.
#[derive(Clone, Debug)]
pub struct RequirementSamples {
    schedules: Vec<SampleSchedule>,
    scopes: Vec<ScopeState>,
}

/// Condition under which samples of a requirement count, and whether they do.
#[derive(Clone, Debug)]
struct ScopeState {
    requirement: usize,
    condition: Expression,
    counts: bool,
}

/// Schedule of the samples of a requirement.
#[derive(Clone, Debug)]
struct SampleSchedule {
    /// Index of the requirement.
    requirement: usize,
    is_rate: bool,
    period: Span,
    /// Instant of the next sample, and the last instant that counts.
    next: Instant,
    to: Instant,
}

impl RequirementSamples {
    /// Creates the schedule of a scenario, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        let schedule = |(requirement, source): (usize, &RequirementSource)| {
            let RequirementSource::Error(error) = source else { return None };
            let is_rate = match error.quantity {
                SampledQuantity::PointingError => false,
                SampledQuantity::RateError => true,
                SampledQuantity::LineOfSight(..) => return None,
            };
            Some(SampleSchedule {
                requirement,
                is_rate,
                period: error.period,
                next: error.from,
                to: error.to,
            })
        };
        let sources = scenario.study.requirements.iter().map(|requirement| &requirement.source);
        let scope = |(requirement, source): (usize, &RequirementSource)| {
            let RequirementSource::Error(SampledError { scope: Some((condition, _)), .. }) = source else {
                return None;
            };
            Some(ScopeState { requirement, condition: condition.clone(), counts: true })
        };
        Self {
            schedules: sources.clone().enumerate().filter_map(schedule).collect(),
            scopes: sources.enumerate().filter_map(scope).collect(),
        }
    }

    /// Returns the next instant at which an error is sampled.
    pub fn due(&self) -> Option<Instant> {
        self.schedules.iter().filter(|one| one.next <= one.to).map(|one| one.next).min()
    }

    /// Records which requirements count from the current instant on, if that changes; before its samples.
    pub fn record_scopes(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        let mut changed = Vec::new();
        for scope in &mut self.scopes {
            let counts = scope.condition.holds(run);
            if counts != scope.counts {
                scope.counts = counts;
                changed.push(RequirementScope { requirement: scope.requirement, counts });
            }
        }
        if changed.is_empty() {
            return Ok(());
        }
        let mut report = Report::new();
        report.add_value(RequirementScopes(changed));
        record.record(run.now, Sample::Report(&report))
    }

    /// Samples the errors that are due, after all parts have acted.
    pub fn record_due(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        let mut due = Vec::new();
        for one in &mut self.schedules {
            if one.next > run.now || one.next > one.to {
                continue;
            }
            one.next = run.now + one.period;
            due.push(RequirementError {
                requirement: one.requirement,
                error: motion_error(run.plant, run.guidance, run.now, one.is_rate),
            });
        }
        if due.is_empty() {
            return Ok(());
        }
        let mut report = Report::new();
        report.add_value(RequirementErrors(due));
        record.record(run.now, Sample::Report(&report))
    }
}
