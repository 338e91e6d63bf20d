//! Source of an exported control system: the translated flight code, and the functions that call it.

use std::fmt::Write as _;

use super::{
    Plan, actuation_calls, b_dot_calls, compensator_calls, kalman_calls, momentum_calls, parameters,
    rate_calls, start_values,
};
use crate::control_system::{ControlSystem, LawsOfAxes, LawsOfMode};
use crate::translate::Translation;

/// Functions of an attitude filter.
const ESTIMATOR: [&str; 10] = [
    "attitude_history::AttitudeHistory::refusals",
    "attitude_estimator::AttitudeEstimator::start",
    "attitude_estimator::AttitudeEstimator::take_gyro",
    "attitude_estimator::AttitudeEstimator::take_observation",
    "attitude_estimator::AttitudeEstimator::attitude",
    "attitude_estimator::AttitudeEstimator::rate",
    "attitude_estimator::AttitudeEstimator::age",
    "attitude_estimator::AttitudeEstimator::deviation",
    "attitude_filter::AttitudeBiasFilter::new",
    "quaternion::Quaternion::rotation_to",
];

/// Functions of a supervisor of modes.
const SUPERVISOR: [&str; 4] = [
    "mode_supervisor::ModeSupervisor::start",
    "mode_supervisor::ModeSupervisor::enter",
    "mode_supervisor::ModeSupervisor::due",
    "mode_supervisor::ModeSupervisor::test",
];

/// Functions of the readings of conditions, with their names in C.
const READINGS: [(&str, &str); 5] = [
    ("attitude_estimator::AttitudeEstimator::deviation_size", "attitude_estimator_deviation_size"),
    ("attitude_estimator::AttitudeEstimator::innovation_size", "attitude_estimator_innovation_size"),
    ("mode_readings::norm", "mode_readings_norm"),
    ("mode_readings::distance", "mode_readings_distance"),
    ("mode_readings::largest_size", "mode_readings_largest_size"),
];

/// Returns the paths of the functions of the flight code that the exported `functions` call.
pub fn roots(system: &ControlSystem, functions: &str) -> Vec<&'static str> {
    let mut roots = Vec::new();
    if functions.contains("binary64_infinity") {
        roots.push("binary64::infinity");
    }
    roots.extend(momentum_calls::root(functions));
    match system {
        ControlSystem::Modes(modes) => {
            roots.extend(SUPERVISOR);
            roots.extend(READINGS.iter().filter(|(_, name)| functions.contains(name)).map(|(path, _)| path));
            if modes.estimator.is_some() {
                roots.extend(ESTIMATOR);
            }
            let are_changes = |mode: &LawsOfMode| Some(mode.start.on_estimates()?.commands_changes());
            let are_changes: Vec<bool> =
                modes.modes.iter().filter(|mode| mode.fires_jets).filter_map(are_changes).collect();
            roots.extend(actuation_calls::roots(&modes.actuation, &are_changes));
            if modes.field.is_some() {
                roots.extend(b_dot_calls::ROOTS);
            }
            for laws in super::modes::systems(modes) {
                roots.extend(self::roots(&laws, ""));
            }
            roots.sort_unstable();
            roots.dedup();
        }
        ControlSystem::Relays(_) => roots.extend(["relay::RelayLaw::decide", "relay::PolledRelay::step"]),
        ControlSystem::BDot(_) => roots.extend(b_dot_calls::ROOTS),
        ControlSystem::Sampled(laws) => {
            if laws.axis_count() == 3 && !matches!(laws.laws, LawsOfAxes::StateSpace(_)) {
                roots.push("axis_motion::total_angle");
            }
            match &laws.laws {
                LawsOfAxes::Pd(_) => roots.push("pd::PdLaw::step"),
                LawsOfAxes::PhasePlane(..) => roots.push("phase_plane::PhasePlaneLaw::step"),
                LawsOfAxes::Attitude(_) => roots.push("attitude_law::AttitudeFeedback::step"),
                LawsOfAxes::StateSpace(own) => roots.extend(compensator_calls::roots(own)),
            }
            if laws.is_acceleration() {
                roots.push("torque_distribution::torque");
            }
            if laws.estimator.is_some() {
                roots.extend(ESTIMATOR);
            }
            if laws.filter.is_some() {
                let is_called =
                    |root: &&str| !root.ends_with("shift") || functions.contains("kalman_axis_shift");
                roots.extend(kalman_calls::ROOTS.into_iter().filter(is_called));
            }
            if laws.rate_filter.is_some() {
                roots.push(rate_calls::ROOT);
            }
            roots.extend(actuation_calls::roots(&laws.actuation, &[laws.commands_changes()]));
        }
    }
    roots
}

/// Returns the source: the translated flight code, and the exported functions that call it.
pub fn source(plan: &Plan<'_>, translation: &Translation, functions: &str) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "/* Control system of {}: see {}.h. */\n\n#include \"{}.h\"\n",
        plan.origin.file, plan.prefix, plan.prefix
    );
    text.push_str(translation.guards.trim());
    text.push_str("\n\n");
    text.push_str(translation.definitions.trim());
    text.push_str("\n\n");
    let _ = writeln!(
        text,
        "const char {}_version[{}] = \"{}\";\n",
        plan.prefix,
        plan.version().len() + 1,
        plan.version()
    );
    parameters::defaults(plan, &mut text);
    start_values::definition(plan, &mut text);
    text.push_str(functions);
    text
}
