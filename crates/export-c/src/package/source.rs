//! Source of an exported control system: the translated flight code, and the functions that call it.

use std::fmt::Write as _;

use super::Plan;
use crate::control_system::{ControlSystem, LawsOfAxes};
use crate::translate::Translation;

/// Functions of an attitude filter.
const ESTIMATOR: [&str; 7] = [
    "attitude_estimator::AttitudeEstimator::start",
    "attitude_estimator::AttitudeEstimator::take_gyro",
    "attitude_estimator::AttitudeEstimator::take_observation",
    "attitude_estimator::AttitudeEstimator::attitude",
    "attitude_estimator::AttitudeEstimator::rate",
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
const READINGS: [(&str, &str); 3] = [
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
    match system {
        ControlSystem::Modes(modes) => {
            roots.extend(SUPERVISOR);
            roots.extend(READINGS.iter().filter(|(_, name)| functions.contains(name)).map(|(path, _)| path));
            if modes.estimator.is_some() {
                roots.extend(ESTIMATOR);
            }
            for laws in super::modes::systems(modes) {
                roots.extend(self::roots(&laws, ""));
            }
            roots.sort_unstable();
            roots.dedup();
        }
        ControlSystem::Relays(_) => roots.extend(["relay::RelayLaw::decide", "relay::PolledRelay::step"]),
        ControlSystem::Sampled(laws) => {
            if laws.axis_count() == 3 {
                roots.push("axis_motion::total_angle");
            }
            match laws.laws {
                LawsOfAxes::Pd(_) => roots.push("pd::PdLaw::step"),
                LawsOfAxes::PhasePlane(..) => roots.push("phase_plane::PhasePlaneLaw::step"),
                LawsOfAxes::Attitude(_) => {
                    roots.extend(["attitude_law::AttitudeFeedback::step", "torque_distribution::torque"]);
                }
            }
            if laws.estimator.is_some() {
                roots.extend(ESTIMATOR);
            }
            if laws.wheels.is_some() {
                roots.extend(["wheel_allocation::allocate", "wheel_allocation::limit_torques"]);
            }
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
        plan.origin, plan.prefix, plan.prefix
    );
    text.push_str(translation.guards.trim());
    text.push_str("\n\n");
    text.push_str(translation.definitions.trim());
    text.push_str("\n\n");
    text.push_str(functions);
    text
}
