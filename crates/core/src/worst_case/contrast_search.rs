//! Worst case of the contrast of an image that a requirement asks for, by the loops at points of the uncertain keys.

use super::box_search::Assessed;
use super::loop_search::LoopSearch;
use super::{WorstCase, WorstCaseFault};
use flexsc_analysis::noise::{NoiseError, RequiredContrast};
use flexsc_analysis::open_loop::LoopBreak;
use flexsc_scenario::{ContrastRequirement, Scenario};

/// Badness of an unstable loop: above that of any contrast, and larger the further its poles are outside.
const UNSTABLE: f64 = 1e6;

/// Search for the least contrast over the uncertain keys.
#[derive(Clone, Debug)]
pub struct ContrastSearch {
    /// Requirement.
    pub requirement: ContrastRequirement,
    /// Largest number of loops.
    pub most_loops: usize,
}

impl ContrastSearch {
    /// Searches for the least contrast, at the worst speed of the wheels. `interrupted` returns true to stop.
    ///
    /// # Errors
    /// A scenario without a linear loop or without uncertain keys, and an interruption.
    pub fn run(
        &self,
        scenario: &Scenario,
        interrupted: impl FnMut() -> bool,
    ) -> Result<WorstCase, WorstCaseFault> {
        let refused = |fault: NoiseError| match fault {
            NoiseError::Key(fault) => WorstCaseFault::Key(fault),
            fault => WorstCaseFault::Request(fault.to_string()),
        };
        RequiredContrast::from_scenario(scenario, &self.requirement).map_err(refused)?;
        let search = LoopSearch { opened: LoopBreak::Command, most: self.most_loops, limit: UNSTABLE };
        let found = search.run(
            scenario,
            |loops, numbers| {
                let there = loops.scenario(numbers, 0)?;
                // The requirement itself may have uncertain keys.
                let own = there.study.contrasts.iter().find(|own| own.name == self.requirement.name);
                match RequiredContrast::from_scenario(&there, own.unwrap_or(&self.requirement)) {
                    Ok(found) => Ok(Assessed { badness: -found.mtf, value: found.mtf }),
                    Err(NoiseError::Unstable(unstable)) => {
                        let badness = UNSTABLE * (1.0 + unstable.spectral_radius.min(UNSTABLE));
                        Ok(Assessed { badness, value: 0.0 })
                    }
                    Err(fault) => Err(fault.to_string()),
                }
            },
            interrupted,
        )?;
        Ok(WorstCase { quantity: self.requirement.name.clone(), is_least: true, ..found })
    }
}
