//! Actuators of a loop as one linear actuator: torque per command, and delay.

use flexsc_control::actuator::{ActuatorTask, CommandResponse};
use flexsc_formats::document::ConfigError;

use flexsc_scenario::Scenario;

/// Returns the response of the actuators that execute the commands of the laws, as one, with their delay or another (s).
///
/// # Errors
/// An actuator that is not linear, or actuators with different gains about the axes or different delays: the key, and
/// the reason.
pub fn combined_response(
    scenario: &Scenario,
    axes: usize,
    delay: Option<f64>,
) -> Result<CommandResponse, ConfigError> {
    let mut gains = vec![0.0; axes];
    for member in scenario.actuator.members() {
        let ActuatorTask::Executes(shares) = &member.task else { continue };
        let Some(response) = member.kind.command_response() else {
            let why = "is not linear: a loop has `ideal`, `wheel` or `wheels`";
            return Err(ConfigError::new(member.key, why));
        };
        for (gain, share) in gains.iter_mut().zip(shares) {
            *gain += share * response.gain;
        }
    }
    let delay = delay.map_or_else(|| common_delay(scenario), Ok)?;
    let most = gains.iter().copied().fold(0.0, f64::max);
    let least = gains.iter().copied().fold(f64::INFINITY, f64::min);
    if most - least > 1e-12 * most {
        let why = format!("has different gains about the axes, {gains:?}: a linear loop has one");
        return Err(ConfigError::new("actuator", why));
    }
    Ok(CommandResponse { gain: gains[0], delay })
}

/// Returns the delay (s) of all actuators that execute the commands of the laws.
///
/// # Errors
/// Actuators with different delays: the key, and the reason.
pub fn common_delay(scenario: &Scenario) -> Result<f64, ConfigError> {
    let mut delays: Vec<f64> = Vec::new();
    for member in scenario.actuator.members() {
        let delay = member.kind.command_response().map_or(0.0, |response| response.delay);
        if matches!(member.task, ActuatorTask::Executes(_)) && !delays.contains(&delay) {
            delays.push(delay);
        }
    }
    delays.sort_by(f64::total_cmp);
    if delays.len() > 1 {
        let why = format!("has different delays, {delays:?} s: a linear loop has one, in Python `delay`");
        return Err(ConfigError::new("actuator", why));
    }
    Ok(delays.first().copied().unwrap_or(0.0))
}
