//! Functions of an exported attitude filter: its start, and a sample of the sensors.

use std::fmt::Write as _;

use flexsc_flight::attitude_observation::ObservationKind;

use super::initialiser::initialiser;
use super::shim::{self, QUATERNION, VECTOR};
use super::signature::signature;
use super::{Plan, parameters};
use crate::control_system::{AttitudeUnit, counter};

/// Writes the members of the state that the filter needs.
pub fn members(plan: &Plan<'_>, unit: Option<&AttitudeUnit>, text: &mut String) {
    let Some(unit) = unit else { return };
    let (entries, observations) = (unit.entries.len(), unit.observations.len());
    for (about, name, member) in [
        ("Attitude filter.", "AttitudeEstimator", "estimator".to_owned()),
        ("Recent past of the filter.", "AttitudeHistoryEntry", format!("entries[{entries}]")),
        ("Observations of the recent past.", "DelayedObservation", format!("observations[{observations}]")),
    ] {
        let _ = writeln!(text, "    /* {about} */\n    {} {member};", plan.type_name(name));
    }
}

/// Writes the function that starts the filter with a state, which `init` calls too.
pub fn start(plan: &Plan<'_>, unit: &AttitudeUnit, text: &mut String) {
    let prefix = plan.prefix;
    let (noise, reach) = (initialiser(&unit.noise, prefix), initialiser(&unit.reach, prefix));
    let gate = initialiser(&unit.gate, prefix);
    let [angle, bias] = unit.deviations.map(|deviation| initialiser(&deviation, prefix));
    let _ = writeln!(
        text,
        "/* Starts the attitude filter with an attitude and a gyro bias (rad/s). */\nstatic void start_filter({prefix}_state *state, {prefix}_ticks now, {prefix}_quaternion attitude, {prefix}_vector3 bias)\n{{\n    \
         const {prefix}_gyro_noise noise = {noise};\n    const {prefix}_ticks reach = {reach};\n    const {prefix}_attitude_gate gate = {gate};\n    \
         const {prefix}_attitude_bias_filter filter = attitude_bias_filter_new(attitude, bias, {angle}, {bias});\n\n    \
         state->estimator = attitude_estimator_start(now, filter, noise, reach, gate, state->entries, {});",
        unit.entries.len()
    );
    parameters::apply(plan, "estimator.history.gate.", text);
    text.push_str("}\n\n");
}

/// Writes the statement of `init` that starts the filter at the identity.
pub fn init(plan: &Plan<'_>, now: &str, text: &mut String) {
    let identity = shim::quaternion(plan, &["1.0", "0.0", "0.0", "0.0"]);
    let zero = shim::vector(plan, &["0.0"; 3]);
    let _ = writeln!(text, "    start_filter(state, {now}, {identity}, {zero});");
}

/// Returns the estimated rate in C.
pub fn rate(unit: &AttitudeUnit) -> String {
    format!("attitude_estimator_rate(&state->estimator, state->entries, {})", unit.entries.len())
}

/// Writes the declarations of `target`, the input, and of `attitude`, the estimate.
pub fn attitudes(plan: &Plan<'_>, unit: &AttitudeUnit, text: &mut String) {
    shim::variable(
        plan,
        "Quaternion",
        "target",
        &shim::quaternion_from(plan, "input->target_attitude"),
        text,
    );
    attitude(plan, unit, text);
}

/// Writes the declaration of `attitude`, the estimate.
fn attitude(plan: &Plan<'_>, unit: &AttitudeUnit, text: &mut String) {
    let entries = unit.entries.len();
    let attitude = format!("attitude_estimator_attitude(&state->estimator, now, state->entries, {entries})");
    shim::variable(plan, "Quaternion", "attitude", &attitude, text);
}

/// Writes the calls `start` and `sample`.
pub fn functions(plan: &Plan<'_>, unit: &AttitudeUnit, text: &mut String) {
    let (prefix, entries) = (plan.prefix, unit.entries.len());
    let _ = writeln!(
        text,
        "{}\n{{\n    start_filter(state, now, {}, {});",
        signature(plan, &plan.calls[0]),
        shim::quaternion_from(plan, "input->attitude"),
        shim::vector_from(plan, "input->bias"),
    );
    attitude(plan, unit, text);
    shim::spread("output->attitude", "attitude", &QUATERNION, text);
    let storage = format!("state->entries, {entries}, state->observations, {}", unit.observations.len());
    let _ = writeln!(
        text,
        "}}\n\n{}\n{{\n    output->gyro_status = 0;\n    if (input->gyro_is_valid) {{\n        const {prefix}_ticks latency = {};\n        \
         output->gyro_status = (int64_t)attitude_estimator_take_gyro(&state->estimator, now, latency, {}, {storage});\n    }}",
        signature(plan, &plan.calls[1]),
        initialiser(&unit.gyro.1, prefix),
        shim::vector_from(plan, "input->gyro_rate"),
    );
    for (sensor, corrector) in (1..).zip(&unit.correctors) {
        let name = &corrector.name;
        let of = |part: &str| format!("input->{name}_{part}");
        let observed = |member: &str, value: &str| format!("        observation.{member} = {value};\n");
        let vector = |member: &str, part: &str| observed(member, &shim::vector_from(plan, &of(part)));
        let numbers = if corrector.observation.kind == ObservationKind::Attitude {
            observed("attitude", &shim::quaternion_from(plan, &of("attitude")))
        } else {
            vector("vector", "vector") + &vector("inertial", "reference")
        };
        let _ = writeln!(
            text,
            "    output->{name}_status = 0;\n    if (input->{name}_is_valid) {{\n        const {prefix}_ticks latency = {};\n        {prefix}_attitude_observation observation = {};\n{numbers}        \
             output->{name}_status = (int64_t)attitude_estimator_take_observation(&state->estimator, {sensor}, now, latency, &observation, {storage});\n    }}",
            initialiser(&corrector.latency, prefix),
            initialiser(&corrector.observation, prefix),
        );
    }
    let estimate = format!("attitude_estimator_output(&state->estimator, now, state->entries, {entries})");
    shim::variable(plan, "EstimatorOutput", "estimate", &estimate, text);
    shim::spread("output->attitude", "estimate.attitude", &QUATERNION, text);
    for vector in ["rate", "innovation", "deviation"] {
        shim::spread(&format!("output->{vector}"), &format!("estimate.{vector}"), &VECTOR, text);
    }
    text.push_str(
        "    output->refused = (int64_t)estimate.refused;\n    output->age = estimate.age;\n    output->nis = estimate.nis;\n",
    );
    let refused = |name: &str, counter: usize, text: &mut String| {
        let _ = writeln!(
            text,
            "    output->{name}_refused = (int64_t)state->estimator.history.refused[{counter}];"
        );
    };
    refused("gyro", 0, text);
    (1..).zip(&unit.correctors).for_each(|(sensor, own)| refused(&own.name, counter(sensor), text));
    text.push_str("}\n\n");
}
