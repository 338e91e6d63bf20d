//! Batches: runs of one structure simulated together in the SIMD lanes of the processor, each with the results of a
//! single run, to the bit.
//!
//! A batch may decline a run at any time: the run is then simulated alone, as are all runs that no batch supports.

mod relay;
mod sampled;

use flexsc_numerics::lanes::Processor;

use crate::metrics::{Metrics, Selection};
use flexsc_scenario::{RequirementSource, Scenario};

/// Run to simulate, without a log.
#[derive(Copy, Clone, Debug)]
pub struct BatchJob<'a> {
    /// Number of the run.
    pub number: u64,
    /// Scenario that is simulated.
    pub scenario: &'a Scenario,
    /// Metrics that are wanted; the values of all others may be wrong.
    pub selection: &'a Selection,
}

/// Method to simulate runs of one structure together.
pub trait BatchKernel: Sync {
    /// Returns the number of runs that the batch accepts at a time.
    fn lanes(&self, processor: Processor) -> usize;

    /// Returns true if the batch may accept runs of a scenario.
    fn accepts(&self, scenario: &Scenario) -> bool;

    /// Simulates at most [`BatchKernel::lanes`] runs: returns the metrics of each, or `None` for a run that has to be
    /// simulated alone.
    fn simulate(&self, processor: Processor, jobs: &[BatchJob<'_>]) -> Vec<Option<Metrics>>;
}

/// All batches, in the order of preference.
const ALL: &[&dyn BatchKernel] = &[&relay::RelayBatch, &sampled::SampledBatch];

/// Returns true if runs of a scenario may be simulated in a batch on this machine.
pub fn accepts(scenario: &Scenario) -> bool {
    Processor::best().is_some() && ALL.iter().any(|batch| is_accepted(*batch, scenario))
}

/// Returns true if a batch may accept runs of a scenario: none has errors that requirements sample.
fn is_accepted(batch: &dyn BatchKernel, scenario: &Scenario) -> bool {
    let mut requirements = scenario.study.requirements.iter();
    batch.accepts(scenario)
        && requirements.all(|requirement| matches!(requirement.source, RequirementSource::Metric(..)))
}

/// Simulates runs in batches: returns the metrics of each, or `None` for a run that has to be simulated alone.
pub fn simulate(jobs: &[BatchJob<'_>]) -> Vec<Option<Metrics>> {
    Processor::best().map_or_else(|| vec![None; jobs.len()], |processor| simulate_on(processor, jobs))
}

/// Simulates runs in batches with the instructions of the given processor; see [`simulate`].
pub fn simulate_on(processor: Processor, jobs: &[BatchJob<'_>]) -> Vec<Option<Metrics>> {
    let mut all = vec![None; jobs.len()];
    for batch in ALL {
        let open: Vec<usize> = (0..jobs.len())
            .filter(|index| all[*index].is_none() && is_accepted(*batch, jobs[*index].scenario))
            .collect();
        for some in open.chunks(batch.lanes(processor)) {
            // A single run gains nothing from a batch.
            if some.len() > 1 {
                let batch_jobs: Vec<BatchJob<'_>> = some.iter().map(|index| jobs[*index]).collect();
                for (index, metrics) in some.iter().zip(batch.simulate(processor, &batch_jobs)) {
                    all[*index] = metrics;
                }
            }
        }
    }
    all
}
