//! Run that is repeated for what its requirements over time read, and their robustness.

use std::path::Path;

use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{
    Log, Record, RecordError, RequirementRobustness, RequirementSignals, RobustnessOfRequirements, Sample,
};

use super::run_events::RunEvents;
use crate::error::CliError;

/// Signals and robustness of the requirements over time of a repeated run.
#[derive(Default)]
pub struct JudgedRun {
    pub signals: RequirementSignals,
    pub robustness: Vec<RequirementRobustness>,
}

impl JudgedRun {
    /// Repeats the run of a log.
    ///
    /// # Errors
    /// A run that cannot be repeated.
    pub fn read(story: &RunEvents, log: &Log, path: &Path) -> Result<Self, CliError> {
        let mut judged = Self::default();
        story.repeat(log, path, "signals of requirements", &mut judged)?;
        Ok(judged)
    }
}

impl Record for JudgedRun {
    fn wants_requirement_signals(&self) -> bool {
        true
    }

    fn record(&mut self, _: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        if let Some(signals) = sample.get::<RequirementSignals>() {
            self.signals.clone_from(signals);
        }
        if let Some(RobustnessOfRequirements(all)) = sample.get() {
            self.robustness.clone_from(all);
        }
        Ok(())
    }
}
