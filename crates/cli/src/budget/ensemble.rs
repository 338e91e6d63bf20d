//! Ensemble of a scenario's `[uncertain]` keys as equally likely scenarios, for the linear levels of a budget.

use flexsc_core::campaign::{Campaign, Design, Sampling};
use flexsc_core::scenario::Scenario;

/// Number of scenarios that share a loop: only their disturbances differ.
const POINTS: u64 = 1024;
/// Least and largest number of scenarios that have a loop of their own each: as many as runs.
const LOOPS: [u64; 2] = [64, 1024];

/// Equally likely scenarios of an ensemble.
pub struct Ensemble {
    /// Scenarios at the points of a Sobol sequence; the scenario itself if nothing is uncertain.
    pub points: Vec<Scenario>,
    /// True if all have the loop of the scenario itself.
    pub shares_loop: bool,
}

impl Ensemble {
    /// Returns the ensemble of a scenario beside a number of runs; `None` if one of its points is no valid scenario.
    pub fn from_scenario(scenario: &Scenario, origin: &str, runs: u64) -> Option<Self> {
        if scenario.uncertain.is_empty() {
            return Some(Self { points: vec![Campaign::undrawn(scenario.clone())], shares_loop: true });
        }
        let shares_loop = scenario.uncertain.keys().all(|key| is_of_torque(key));
        let design = Design { draws: Sampling::Sobol, ..Design::default() };
        let campaign = Campaign::from_design(scenario.clone(), origin, design).ok()?;
        let count = if shares_loop { POINTS } else { runs.clamp(LOOPS[0], LOOPS[1]) };
        let points =
            (0..count).map(|point| Some(campaign.run(point).ok()?.scenario)).collect::<Option<_>>()?;
        Some(Self { points, shares_loop })
    }
}

/// Returns true for the key of a steady torque or of a sine among the disturbances, on which the loop does not depend.
fn is_of_torque(key: &str) -> bool {
    let within = key.strip_prefix("disturbance[").and_then(|rest| Some(rest.split_once("].")?.1));
    within.is_some_and(|within| within == "torque" || within.starts_with("sines["))
}
