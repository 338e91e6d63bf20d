//! Attitude filter: its start, and a sample of the sensors.

use flexsc_flight::attitude_observation::ObservationKind;

use super::member::Member;
use super::text::{QUATERNION, VECTOR, literal, local, quaternion_from, spread, vector_from};
use super::{Glue, parameters};
use crate::control_system::{AttitudeUnit, Corrector, counter};

/// Estimated rate.
pub const RATE: &str = "state.estimator.rate(&state.entries)";
/// Estimated attitude.
const ATTITUDE: &str = "state.estimator.attitude(now, &state.entries)";

/// Adds the filter, which `init` starts at this time at the identity.
pub fn add(glue: &mut Glue<'_>, unit: &AttitudeUnit, now: &str) {
    let (entries, observations) = (unit.entries.len(), unit.observations.len());
    let (about, none) = ("Recent past of the filter.", "AttitudeHistoryEntry::NONE");
    glue.members.extend([
        Member::new("Attitude filter.", "estimator", "AttitudeEstimator", literal(&unit.estimator)).started(),
        Member::filled(about, "entries", "AttitudeHistoryEntry", none, entries),
        Member::filled(
            "Observations of the recent past.",
            "observations",
            "DelayedObservation",
            "DelayedObservation::NONE",
            observations,
        ),
    ]);
    let [angle, bias] = unit.deviations.map(|deviation| literal(&deviation));
    let body = [
        ("GyroNoise", "noise", literal(&unit.noise)),
        ("Ticks", "reach", literal(&unit.reach)),
        ("AttitudeGate", "gate", literal(&unit.gate)),
        ("AttitudeBiasFilter", "filter", format!("AttitudeBiasFilter::new(attitude, bias, {angle}, {bias})")),
    ]
    .map(|(kind, name, value)| local(kind, name, &value))
    .concat()
        + "    state.estimator = AttitudeEstimator::start(now, filter, noise, reach, gate, &mut state.entries);\n"
        + &parameters::apply(glue, "estimator.history.gate.");
    let about = "Starts the attitude filter with an attitude and a gyro bias (rad/s).";
    let parameters = ["state: &mut State", "now: Ticks", "attitude: Quaternion", "bias: Vector3"];
    glue.function(about, "fn start_filter()", &parameters, &body);
    let start = format!("    start_filter(state, {now}, Quaternion::IDENTITY, Vector3::ZERO);\n");
    glue.init.push_str(&start);
    let start = [
        local("Quaternion", "initial", &quaternion_from("input.attitude")),
        local("Vector3", "bias", &vector_from("input.bias")),
        "    start_filter(state, now, initial, bias);\n".to_owned(),
        local("Quaternion", "attitude", ATTITUDE),
        spread("output.attitude", "attitude", &QUATERNION),
    ];
    glue.call("start", &start.concat());
    glue.call("sample", &sample(unit));
}

/// Returns the statements that take a sample of the sensors.
fn sample(unit: &AttitudeUnit) -> String {
    let latency = literal(&unit.gyro.1);
    let mut body = format!(
        "    output.gyro_status = 0;
    if input.gyro_is_valid {{
        let latency: Ticks = {latency};
        let reading: Vector3 = {};
        let status: ReadingStatus =
            state.estimator.take_gyro(now, latency, reading, &mut state.entries, &mut state.observations);
        output.gyro_status = status as i64;
    }}
",
        vector_from("input.gyro_rate")
    );
    (1..).zip(&unit.correctors).for_each(|(sensor, own)| body += &observation(sensor, own));
    body += &local("EstimatorOutput", "estimate", "state.estimator.output(now, &state.entries)");
    body += &spread("output.attitude", "estimate.attitude", &QUATERNION);
    for vector in ["rate", "innovation", "deviation"] {
        body += &spread(&format!("output.{vector}"), &format!("estimate.{vector}"), &VECTOR);
    }
    body.push_str("    output.refused = estimate.refused as i64;\n    output.age = estimate.age;\n    output.nis = estimate.nis;\n");
    let refused = |name: &str, counter: usize| {
        format!("    output.{name}_refused = state.estimator.history.refused[{counter}] as i64;\n")
    };
    body += &refused("gyro", 0);
    body.extend((1..).zip(&unit.correctors).map(|(sensor, own)| refused(&own.name, counter(sensor))));
    body
}

/// Returns the statements that take an observation.
fn observation(sensor: usize, own: &Corrector) -> String {
    let Corrector { name, latency, observation, .. } = own;
    let (latency, template) = (literal(latency), literal(observation));
    let given = |member: &str, value: String| format!("        observation.{member} = {value};\n");
    let numbers = if observation.kind == ObservationKind::Attitude {
        given("attitude", quaternion_from(&format!("input.{name}_attitude")))
    } else {
        given("vector", vector_from(&format!("input.{name}_vector")))
            + &given("inertial", vector_from(&format!("input.{name}_reference")))
    };
    format!(
        "    output.{name}_status = 0;
    if input.{name}_is_valid {{
        let latency: Ticks = {latency};
        let mut observation: AttitudeObservation = {template};
{numbers}        let status: ReadingStatus = state.estimator.take_observation(
            {sensor}, now, latency, &observation, &mut state.entries, &mut state.observations,
        );
        output.{name}_status = status as i64;
    }}
"
    )
}

/// Returns the declarations of `target`, the input, and of `attitude`, the estimate.
pub fn attitudes() -> String {
    local("Quaternion", "target", &quaternion_from("input.target_attitude"))
        + &local("Quaternion", "attitude", ATTITUDE)
}
