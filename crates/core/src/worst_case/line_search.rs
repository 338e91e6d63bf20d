//! Worst case of the lines of unbalanced wheels, at the worst of their speeds, by the loops at points of the uncertain keys.

use super::box_search::Assessed;
use super::loop_search::LoopSearch;
use super::{WorstCase, WorstCaseFault};
use flexsc_analysis::noise::{NoiseError, WheelOutput, WorstSpeed};
use flexsc_analysis::open_loop::LoopBreak;
use flexsc_scenario::Scenario;

/// Badness of an unstable loop: above that of any motion, and larger the further its poles are outside.
const UNSTABLE: f64 = 1e30;

/// Search for the largest lines of an output over the uncertain keys.
#[derive(Clone, Debug)]
pub struct LineSearch {
    /// Output.
    pub output: WheelOutput,
    /// Largest number of loops.
    pub most_loops: usize,
}

impl LineSearch {
    /// Searches for the largest rms of the output at the worst speed of the wheels. `interrupted` returns true to stop.
    ///
    /// # Errors
    /// A scenario without a linear loop, without unbalanced wheels or without uncertain keys, and an interruption.
    pub fn run(
        &self,
        scenario: &Scenario,
        interrupted: impl FnMut() -> bool,
    ) -> Result<WorstCase, WorstCaseFault> {
        let (_, unit) = WorstSpeed::from_scenario(scenario, &self.output)
            .map_err(|fault| WorstCaseFault::Request(fault.to_string()))?;
        let search = LoopSearch { opened: LoopBreak::Command, most: self.most_loops, limit: UNSTABLE };
        let found = search.run(
            scenario,
            |loops, numbers| match WorstSpeed::from_scenario(&loops.scenario(numbers, 0)?, &self.output) {
                Ok((WorstSpeed { rms, .. }, _)) => Ok(Assessed { badness: rms.min(UNSTABLE), value: rms }),
                Err(NoiseError::Unstable(unstable)) => {
                    let badness = UNSTABLE * (1.0 + unstable.spectral_radius.min(UNSTABLE));
                    Ok(Assessed { badness, value: f64::INFINITY })
                }
                Err(fault) => Err(fault.to_string()),
            },
            interrupted,
        )?;
        let within = if self.output.window.is_some() { " within windows" } else { "" };
        let quantity = format!("rms of {}{within} at the worst speed of the wheels", self.output.name);
        Ok(WorstCase { quantity, unit, ..found })
    }
}
