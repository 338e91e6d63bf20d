//! Runs of one structure side by side, in the lanes of the processor: each comes to what it comes to alone, to the bit.
//!
//! A batch takes what it can, and declines a run at any time: that one is then simulated alone, as every run is where there is
//! no batch for it.

mod relay;
mod sampled;

use crate::lanes::Processor;
use crate::metrics::{Metrics, Selection};
use crate::scenario::Scenario;

/// A run to simulate, without a log.
#[derive(Copy, Clone, Debug)]
pub struct Job<'a> {
    /// The number of the run.
    pub number: u64,
    /// What is simulated.
    pub scenario: &'a Scenario,
    /// The metrics that are wanted; others may be wrong.
    pub selection: &'a Selection,
}

/// A way to simulate runs of one structure side by side.
pub trait Batch: Sync {
    /// How many runs it takes at a time.
    fn lanes(&self, processor: Processor) -> usize;

    /// Whether runs of a scenario may be for it.
    fn takes(&self, scenario: &Scenario) -> bool;

    /// Simulates at most so many runs: the metrics of each, none of one that has to be simulated alone.
    fn simulate(&self, processor: Processor, jobs: &[Job<'_>]) -> Vec<Option<Metrics>>;
}

/// All there are, in the order in which they are asked.
const ALL: &[&dyn Batch] = &[&relay::Side, &sampled::Side];

/// Whether runs of a scenario may go side by side on this machine.
pub fn takes(scenario: &Scenario) -> bool {
    Processor::best().is_some() && ALL.iter().any(|batch| batch.takes(scenario))
}

/// Simulates runs side by side: the metrics of each, none of one that has to be simulated alone.
pub fn simulate(jobs: &[Job<'_>]) -> Vec<Option<Metrics>> {
    Processor::best().map_or_else(|| vec![None; jobs.len()], |processor| simulate_on(processor, jobs))
}

/// The same with instructions that the processor has.
pub fn simulate_on(processor: Processor, jobs: &[Job<'_>]) -> Vec<Option<Metrics>> {
    let mut all = vec![None; jobs.len()];
    for batch in ALL {
        let open: Vec<usize> =
            (0..jobs.len()).filter(|at| all[*at].is_none() && batch.takes(jobs[*at].scenario)).collect();
        for some in open.chunks(batch.lanes(processor)) {
            // One run has no neighbours.
            if some.len() > 1 {
                let taken: Vec<Job<'_>> = some.iter().map(|at| jobs[*at]).collect();
                for (at, metrics) in some.iter().zip(batch.simulate(processor, &taken)) {
                    all[*at] = metrics;
                }
            }
        }
    }
    all
}
