//! Record of all values of the pointing indices that requirements limit, for budgets.

use flexsc_numerics::time::Instant;
use flexsc_record::{Record, RecordError, RequirementScopes, Sample};

use super::requirements::RequirementMetrics;
use flexsc_scenario::Scenario;

/// Values of the pointing indices of a run.
#[derive(Clone, Debug)]
pub struct IndexRecord(RequirementMetrics);

impl IndexRecord {
    /// Creates an empty record for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self(RequirementMetrics::new(scenario).with_all_values())
    }

    /// Returns the values of the index of each requirement, empty for one on a metric: of a component or of a body with
    /// one angle with its sign, else the norm.
    pub fn finish(self) -> Vec<Vec<f64>> {
        self.0.into_values()
    }
}

impl Record for IndexRecord {
    fn wants_switchings(&self) -> bool {
        false
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        sample.get().into_iter().for_each(|errors| self.0.observe(errors));
        sample.get().into_iter().for_each(|of: &RequirementScopes| self.0.observe_scopes(&of.0));
        sample.get().into_iter().for_each(|row| self.0.observe_line(now, row));
        Ok(())
    }
}
