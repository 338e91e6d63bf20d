//! Functions of an exported attitude filter: its start, and a sample of the sensors.

use std::fmt::Write as _;

use flexsc_core::record::AttitudeEstimate;
use flexsc_flight::attitude_observation::ObservationKind;

use super::initialiser::initialiser;
use super::signature::signature;
use super::{Plan, parameters};
use crate::control_system::{AttitudeUnit, counter};

/// Returns the members of the state that the filter needs.
pub fn members(unit: &AttitudeUnit) -> [(&'static str, &'static str, String); 3] {
    [
        ("Attitude filter.", "AttitudeEstimator", "estimator".to_owned()),
        ("Recent past of the filter.", "AttitudeHistoryEntry", format!("entries[{}]", unit.entries.len())),
        (
            "Observations of the recent past.",
            "DelayedObservation",
            format!("observations[{}]", unit.observations.len()),
        ),
    ]
}

/// Writes the function that starts the filter with a state, which `init` calls too.
pub fn start(plan: &Plan<'_>, unit: &AttitudeUnit, text: &mut String) {
    let prefix = plan.prefix;
    let (noise, reach) = (initialiser(&unit.noise, prefix), initialiser(&unit.reach, prefix));
    let gate = ["nis", "rate"].into_iter().fold(initialiser(&unit.gate, prefix), |text, name| {
        let value = if name == "nis" { unit.gate.most_nis } else { unit.gate.most_rate };
        let value = parameters::expression(plan, &format!("gate_{name}"), value);
        parameters::replaced(&text, &format!("most_{name}"), &value)
    });
    let [angle, bias] = unit.deviations.map(|deviation| initialiser(&deviation, prefix));
    let _ = writeln!(
        text,
        "/* Starts the attitude filter with an attitude and a gyro bias (rad/s). */\nstatic void start_filter({prefix}_state *state, {prefix}_ticks now, {prefix}_quaternion attitude, {prefix}_vector3 bias)\n{{\n    \
         const {prefix}_gyro_noise noise = {noise};\n    const {prefix}_ticks reach = {reach};\n    const {prefix}_attitude_gate gate = {gate};\n    \
         const {prefix}_attitude_bias_filter filter = attitude_bias_filter_new(attitude, bias, {angle}, {bias});\n\n    \
         state->estimator = attitude_estimator_start(now, filter, noise, reach, gate, state->entries, {});\n}}\n",
        unit.entries.len()
    );
}

/// Writes the calls `start` and `sample`.
pub fn functions(plan: &Plan<'_>, unit: &AttitudeUnit, text: &mut String) {
    let (prefix, entries) = (plan.prefix, unit.entries.len());
    let attitude = |from: &str| {
        format!("({prefix}_quaternion){{ .w = {from}[0], .x = {from}[1], .y = {from}[2], .z = {from}[3] }}")
    };
    let vector =
        |from: &str| format!("({prefix}_vector3){{ .x = {from}[0], .y = {from}[1], .z = {from}[2] }}");
    let output = "    output->attitude[0] = attitude.w;\n    output->attitude[1] = attitude.x;\n    output->attitude[2] = attitude.y;\n    \
                  output->attitude[3] = attitude.z;\n";
    let _ = writeln!(
        text,
        "{}\n{{\n    start_filter(state, now, {}, {});\n    const {prefix}_quaternion attitude = attitude_estimator_attitude(&state->estimator, now, state->entries, {entries});\n{output}}}\n",
        signature(plan, &plan.calls[0]),
        attitude("input->attitude"),
        vector("input->bias"),
    );
    let storage = format!("state->entries, {entries}, state->observations, {}", unit.observations.len());
    let _ = writeln!(
        text,
        "{}\n{{\n    output->gyro_status = 0;\n    if (input->gyro_is_valid) {{\n        const {prefix}_ticks latency = {};\n        \
         output->gyro_status = (int64_t)attitude_estimator_take_gyro(&state->estimator, now, latency, {}, {storage});\n    }}",
        signature(plan, &plan.calls[1]),
        initialiser(&unit.gyro.1, prefix),
        vector("input->gyro_rate"),
    );
    for (sensor, corrector) in (1..).zip(&unit.correctors) {
        let name = &corrector.name;
        let numbers = if corrector.observation.kind == ObservationKind::Attitude {
            format!("        observation.attitude = {};\n", attitude(&format!("input->{name}_attitude")))
        } else {
            format!(
                "        observation.vector = {};\n        observation.inertial = {};\n",
                vector(&format!("input->{name}_vector")),
                vector(&format!("input->{name}_reference"))
            )
        };
        let _ = writeln!(
            text,
            "    output->{name}_status = 0;\n    if (input->{name}_is_valid) {{\n        const {prefix}_ticks latency = {};\n        {prefix}_attitude_observation observation = {};\n{numbers}        \
             output->{name}_status = (int64_t)attitude_estimator_take_observation(&state->estimator, {sensor}, now, latency, &observation, {storage});\n    }}",
            initialiser(&corrector.latency, prefix),
            initialiser(&corrector.observation, prefix),
        );
    }
    let _ = writeln!(
        text,
        "    const {prefix}_quaternion attitude = attitude_estimator_attitude(&state->estimator, now, state->entries, {entries});\n    \
         const {prefix}_vector3 rate = attitude_estimator_rate(&state->estimator, state->entries, {entries});\n{output}    \
         output->rate[0] = rate.x;\n    output->rate[1] = rate.y;\n    output->rate[2] = rate.z;\n    \
         output->refused = (int64_t)attitude_history_refusals(&state->estimator.history);\n    output->gyro_refused = (int64_t)state->estimator.history.refused[0];\n    output->age = attitude_estimator_age(&state->estimator, now);\n    \
         output->innovation[0] = state->estimator.correction.innovation.x;\n    output->innovation[1] = state->estimator.correction.innovation.y;\n    \
         output->innovation[2] = state->estimator.correction.innovation.z;\n    output->nis = state->estimator.correction.nis / {measurements};\n    \
         const {prefix}_vector3 deviation = attitude_estimator_deviation(&state->estimator, state->entries, {entries});\n    \
         output->deviation[0] = deviation.x;\n    output->deviation[1] = deviation.y;\n    output->deviation[2] = deviation.z;",
        measurements = crate::translate::float_literal(AttitudeEstimate::MEASUREMENTS),
    );
    for (sensor, corrector) in (1..).zip(&unit.correctors) {
        let (name, counter) = (&corrector.name, counter(sensor));
        let _ = writeln!(
            text,
            "    output->{name}_refused = (int64_t)state->estimator.history.refused[{counter}];"
        );
    }
    text.push_str("}\n\n");
}
