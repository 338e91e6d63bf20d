//! Laws of a scenario as flight code, without its spacecraft.

use flexsc_core::Scenario;
use flexsc_core::numerics::time::Span;
use flexsc_export_c::control_system::ControlSystem;

use crate::error::CoSimulationError;

/// Returns the laws of a scenario, which read estimates, with their period.
///
/// # Errors
/// Fails for laws that have no flight code, and for those that decide at events.
pub fn laws_alone(scenario: &Scenario) -> Result<(ControlSystem, Span), CoSimulationError> {
    let refused = |key: &str, why: &str| {
        let why = format!(
            "{}: `{key}` {why}: part `controller` cannot be exported\n\nhint: `loop` is the closed loop",
            scenario.name
        );
        CoSimulationError::refused(why)
    };
    let laws = ControlSystem::new(scenario).map_err(|fault| refused(&fault.key, &fault.reason))?;
    match laws {
        ControlSystem::Relays(_) => Err(refused(
            "law.relay",
            "decides when an angle crosses a limit, between the points of an importer",
        )),
        ControlSystem::BDot(_) => Err(refused(
            "law.b_dot",
            "reads the change of the magnetic field, which a plant does not have as an output",
        )),
        ControlSystem::Modes(_) => {
            let key = if scenario.mode.is_empty() { "law.stages" } else { "mode" };
            Err(refused(
                key,
                "changes the law within an instant, on whose new target the law decides (`--mode NAME` chooses one mode)",
            ))
        }
        ControlSystem::Sampled(_) => match scenario.study.law_period {
            Some(period) => Ok((laws.on_estimates(), period)),
            None => Err(refused("law", "has no period")),
        },
    }
}
