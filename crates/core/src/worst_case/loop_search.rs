//! Search over the uncertain keys for the worst value of a linear loop.

use rayon::prelude::*;

use super::box_search::{Assessed, BoxSearch};
use super::{UncertainKey, WorstCase, WorstCaseFault, uncertain_box};
use flexsc_analysis::open_loop::LoopBreak;
use flexsc_analysis::structured_tuning::ScenarioLoops;
use flexsc_scenario::Scenario;

/// Number of loops that are formed between checks for an interruption.
const AT_ONCE: usize = 64;

/// Search for the worst value of a loop.
#[derive(Copy, Clone, Debug)]
pub struct LoopSearch {
    /// Point at which the loops are cut open.
    pub opened: LoopBreak,
    /// Largest number of loops.
    pub most: usize,
    /// Badness from which a loop is not stable.
    pub limit: f64,
}

impl LoopSearch {
    /// Searches for the worst loop over the uncertain keys of a scenario. `at` returns the value with numbers of the keys, and
    /// `interrupted` true to stop. The case has no name and no unit yet.
    ///
    /// # Errors
    /// A scenario without a value or without uncertain keys, no point with a value, and an interruption.
    pub fn run(
        &self,
        scenario: &Scenario,
        at: impl Fn(&ScenarioLoops, &[f64]) -> Result<Assessed, String> + Sync,
        mut interrupted: impl FnMut() -> bool,
    ) -> Result<WorstCase, WorstCaseFault> {
        let ranges = uncertain_box(scenario)?;
        let names = ranges.keys.iter().map(|own| own.key.clone()).collect();
        let loops = ScenarioLoops::new(scenario, self.opened, names, false)?;
        let own: Vec<f64> = ranges.keys.iter().map(UncertainKey::nominal_fraction).collect();
        let numbers = |parts: &[f64]| -> Vec<f64> {
            ranges.keys.iter().zip(parts).map(|(own, part)| own.number_at(*part)).collect()
        };
        // What the loop of the scenario itself lacks, no other point has.
        let nominal: Vec<f64> = ranges.keys.iter().map(UncertainKey::nominal_number).collect();
        at(&loops, &nominal).map_err(WorstCaseFault::Request)?;
        let (mut failed, mut first_failure) = (0, None);
        let assess = |points: &[Vec<f64>]| -> Result<Vec<Assessed>, WorstCaseFault> {
            let mut assessed = Vec::with_capacity(points.len());
            for some in points.chunks(AT_ONCE) {
                if interrupted() {
                    return Err(WorstCaseFault::Interrupted);
                }
                let values: Vec<Result<Assessed, String>> =
                    some.par_iter().map(|parts| at(&loops, &numbers(parts))).collect();
                for value in values {
                    assessed.push(value.unwrap_or_else(|why| {
                        failed += 1;
                        first_failure.get_or_insert(why);
                        Assessed { badness: f64::NAN, value: f64::NAN }
                    }));
                }
            }
            Ok(assessed)
        };
        let search = BoxSearch { keys: ranges.keys.len(), most: self.most, seed: scenario.seed };
        let (points, worst) = search.run(own, Vec::new(), assess)?;
        let Some(worst) = worst else {
            let reason = first_failure.map_or_else(String::new, |why| format!(": {why}"));
            return Err(WorstCaseFault::Request(format!("no point has a value{reason}")));
        };
        let witness = loops.scenario(&numbers(&points[worst].parts), 0).map_err(WorstCaseFault::Request)?;
        let is_unstable = points[worst].assessed.badness >= self.limit;
        Ok(WorstCase {
            quantity: String::new(),
            unit: String::new(),
            is_least: false,
            ranges,
            points,
            worst,
            is_unstable,
            failed,
            first_failure,
            witness,
        })
    }
}
