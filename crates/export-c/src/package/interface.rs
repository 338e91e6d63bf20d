//! Interface of an exported control system for other programs: inputs and outputs with their units, frames and ranges.

use flexsc_core::Scenario;
use flexsc_core::numerics::time::Span;
use flexsc_flight_precision::Precision;
use serde_json::{Value, json};

use super::{Plan, main_loop};
use crate::control_system::{CallLayout, Channel, NumberKind};
use crate::glue;

/// Returns the interface as JSON.
pub fn interface(plan: &Plan<'_>, scenario: &Scenario) -> String {
    let prefix = plan.prefix;
    let cycle = scenario.law.period();
    let sensors: Vec<Value> = plan.system.estimator().map_or_else(Vec::new, |unit| {
        let gyro = (unit.gyro.0, "gyro", unit.gyro.1);
        let others = unit.correctors.iter().map(|own| (own.sensor, own.name.as_str(), own.latency));
        let row = |(sensor, name, latency): (usize, &str, flexsc_flight::ticks::Ticks)| {
            let period = scenario.sensor.get(sensor).and_then(|kind| kind.period(cycle)).map(Span::seconds);
            json!({ "name": name, "period_s": period, "latency_s": latency.seconds() })
        };
        std::iter::once(gyro).chain(others).map(row).collect()
    });
    let order: Vec<String> = main_loop::order(plan).map(|call| format!("{prefix}_{}", call.name)).collect();
    let excluded_parts: Vec<Value> = plan
        .excluded_parts
        .iter()
        .map(|part| json!({ "key": part.key, "caller": part.duty, "is_input": part.is_supplied }))
        .collect();
    let functions: Vec<Value> = plan.calls.iter().map(|call| function(plan, call)).collect();
    let written = json!({
        "name": prefix,
        "scenario": plan.origin.file,
        "changes": plan.origin.changes,
        "scenario_sha256": plan.digest,
        "exporter": format!("flexsc {}", env!("CARGO_PKG_VERSION")),
        "conventions": {
            "units": "SI",
            "time": "whole seconds and femtoseconds past them, 0 to 10^15 - 1, since any epoch, the same for all calls",
            "quaternion": "w, x, y, z of unit length; rotates vectors of body axes into inertial axes",
            "axes": "right-handed; a torque is that on the body, and that of a wheel's motor is on its rotor",
        },
        "period_s": plan.system.period(),
        "order": order,
        "sensors": sensors,
        "left_out": excluded_parts,
        "functions": functions,
    });
    format!("{written:#}\n")
}

/// Returns a function with its channels.
fn function(plan: &Plan<'_>, call: &CallLayout) -> Value {
    let list = |channels: &[Channel]| {
        channels.iter().map(|own| channel(own, plan.precision)).collect::<Vec<Value>>()
    };
    json!({
        "function": format!("{}_{}", plan.prefix, call.name),
        "about": call.about,
        "called": if call.is_start { "once" } else { "repeatedly" },
        "period_s": call.period,
        "inputs": list(&call.inputs),
        "outputs": list(&call.outputs),
        "run_0": glue::start_inputs(plan, call),
    })
}

fn channel(channel: &Channel, precision: Precision) -> Value {
    let real = if precision.is_double() { "double" } else { "float" };
    let (kind, range) = match channel.kind {
        NumberKind::Real if channel.is_unit => (real, Value::from("norm within 0.001 of 1")),
        NumberKind::Real if channel.largest.is_finite() => (real, json!([-channel.largest, channel.largest])),
        NumberKind::Real => (real, Value::from("finite")),
        NumberKind::Flag => ("bool", Value::Null),
        NumberKind::Integer(0) => ("int64_t", Value::Null),
        NumberKind::Integer(below) => ("int64_t", json!([0, below - 1])),
    };
    json!({
        "name": channel.name,
        "type": kind,
        "count": channel.count,
        "unit": channel.unit_of_numbers(),
        "frame": channel.frame(),
        "range": range,
        "about": channel.about,
    })
}
