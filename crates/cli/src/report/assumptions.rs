//! Assumptions of a study: what its scenario leaves out, and the keys that were set.

use flexsc_core::Scenario;

use super::study::Study;

/// Returns the assumptions as sentences.
pub fn sentences(study: &Study) -> Vec<String> {
    let scenario = &study.scenario;
    let mut all: Vec<String> = [actuators(scenario), sensors(scenario)].into_iter().flatten().collect();
    all.push(environment(scenario));
    if scenario.mode_count() == 0 {
        all.push("The body is rigid.".to_owned());
    }
    if scenario.spacecraft.as_ref().is_some_and(|craft| craft.small_angles.is_some()) {
        all.push("Rotations are small, about a fixed target.".to_owned());
    }
    if scenario.uncertain.is_empty() {
        all.push("No key is uncertain: runs of a campaign differ by their noise alone.".to_owned());
    }
    all.extend(scenario.remarks().iter().map(|remark| format!("Noted before the run: {remark}.")));
    if !study.set.is_empty() {
        all.push(format!("Keys set on the command line: {}.", study.set.join(", ")));
    }
    all
}

/// Returns what the actuators leave out; `None` without wheels.
fn actuators(scenario: &Scenario) -> Option<String> {
    let (wheels, _) = scenario.actuator.wheels()?;
    let left_out = [("friction", wheels.friction.is_none()), ("imbalance", wheels.imbalance.is_none())];
    let left_out: Vec<&str> = left_out.iter().filter(|(_, is)| *is).map(|(name, _)| *name).collect();
    (!left_out.is_empty()).then(|| format!("Wheels without {}.", left_out.join(" and ")))
}

/// Returns which sensors are ideal, if one is.
fn sensors(scenario: &Scenario) -> Option<String> {
    let is_ideal = scenario.sensor.iter().any(|own| own.is_continuous());
    is_ideal.then(|| "The true angle is known at every instant, without a sensor.".to_owned())
}

/// Returns the disturbances of the environment, and those that are left out.
fn environment(scenario: &Scenario) -> String {
    let Some(around) = &scenario.environment else {
        return match scenario.disturbance.len() {
            0 => "No environment and no disturbance.".to_owned(),
            _ => "No environment; disturbances as the scenario gives them.".to_owned(),
        };
    };
    let parts = [
        ("gravity gradient", around.gravity_gradient.is_some()),
        ("magnetic dipole", around.dipole.is_some()),
        ("solar pressure", around.solar_pressure.is_some()),
        ("drag", around.drag.is_some()),
    ];
    let names = |wanted: bool| -> Vec<&str> {
        parts.iter().filter(|(_, is)| *is == wanted).map(|(name, _)| *name).collect()
    };
    let (modelled, left_out) = (names(true), names(false));
    let text = |names: Vec<&str>| if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    format!("Torques of the environment: {}. Left out: {}.", text(modelled), text(left_out))
}
