//! Sampling of the errors that requirements limit: nothing in the loop reads them; metrics do.

use flexsc_control::sensor::Orientation;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError, Report, RequirementError, RequirementErrors, Sample};

use crate::run_view::RunView;
use flexsc_scenario::{RequirementSource, SampledQuantity, Scenario};

/// Schedule of the samples of all requirements; lines of sight are sampled by themselves.
#[derive(Clone, Debug)]
pub struct RequirementSamples(Vec<SampleSchedule>);

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
        Self(sources.enumerate().filter_map(schedule).collect())
    }

    /// Returns the next instant at which an error is sampled.
    pub fn due(&self) -> Option<Instant> {
        self.0.iter().filter(|one| one.next <= one.to).map(|one| one.next).min()
    }

    /// Samples the errors that are due, after all parts have acted.
    pub fn record_due(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        let mut due = Vec::new();
        for one in &mut self.0 {
            if one.next > run.now || one.next > one.to {
                continue;
            }
            one.next = run.now + one.period;
            due.push(RequirementError { requirement: one.requirement, error: error(run, one.is_rate) });
        }
        if due.is_empty() {
            return Ok(());
        }
        let mut report = Report::new();
        report.add_value(RequirementErrors(due));
        record.record(run.now, Sample::Report(&report))
    }
}

/// Returns the error of the attitude (rad) or of the rate (rad/s) about the body's axes.
fn error(run: &RunView<'_>, is_rate: bool) -> [f64; 3] {
    let truth = run.plant.truth();
    if run.plant.quantities().one_axis().is_some() {
        let (angle, rate) = run.guidance.manoeuvre_state(run.now);
        let of_angle = || truth.orientation.error_from(&Orientation::Angle(angle));
        return if is_rate { [truth.rate[0] - rate, 0.0, 0.0] } else { of_angle() };
    }
    let error = truth.orientation.error_from(&run.guidance.origin(run.now));
    if !is_rate {
        return error;
    }
    let reference = run.guidance.reference_rate(run.now, &Vector::from(error));
    (Vector::from(truth.rigid_rate) - reference).into()
}
