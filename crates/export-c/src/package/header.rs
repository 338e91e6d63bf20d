//! Header of an exported control system: types, structs of inputs and outputs, and the functions.

use std::fmt::Write as _;

use super::law_scope::LawCalls;
use super::signature::about;
use super::{Plan, actuation_calls, estimator_calls, kalman_calls, modes, parameters, start_values};
use crate::control_system::{Channel, ControlSystem, NumberKind, Relays};
use crate::translate::Translation;

/// Returns the header file: the types of the flight code, the state of the control system, and its functions.
pub fn header(plan: &Plan<'_>, translation: &Translation) -> String {
    let prefix = plan.prefix;
    let guard = format!("{}_H", prefix.to_uppercase());
    let mut text = format!(
        "/* Control system of {}, exported by flexsc {}.\n *\n * The code is translated from the Rust code that flexsc calls in a \
         run, and returns the same bits\n * if it is compiled as the Makefile does: IEEE 754 {}, no contraction, no fast-math. \
         Units are SI.\n{}\n *\n{}\n */\n#ifndef {guard}\n#define {guard}\n\n",
        plan.origin.file,
        env!("CARGO_PKG_VERSION"),
        plan.numbers(),
        excluded_parts(plan),
        trace(plan)
    );
    text.push_str(translation.includes.trim());
    text.push_str("\n\n");
    text.push_str(translation.declarations.trim());
    text.push_str("\n\n");
    text.push_str(&parameters::definition(plan));
    text.push_str(&state(plan));
    for call in plan.calls {
        let _ = writeln!(text, "/* Inputs of `{prefix}_{}`. */", call.name);
        members(&call.inputs, &format!("{prefix}_{}_input", call.name), &mut text);
        let _ = writeln!(text, "/* Outputs of `{prefix}_{}`. */", call.name);
        members(&call.outputs, &format!("{prefix}_{}_output", call.name), &mut text);
    }
    let _ = writeln!(
        text,
        "/* Version: the exporter, and the SHA-256 of the scenario in `scenario.toml`. */\nextern const char {prefix}_version[{}];\n",
        plan.version().len() + 1
    );
    let kept = if super::signature::inits_at_time(plan) {
        " Times of the run and entries of modes count from here: a computer that starts again in flight writes\n * the members `supervisor.started` and `modes` of the state that it has kept, after `enter`."
    } else {
        ""
    };
    let _ = writeln!(
        text,
        "/* Sets the state before the first call.{kept} */\n{};\n",
        super::signature::init_signature(plan)
    );
    text.push_str(&parameters::declarations(plan));
    text.push_str(&start_values::declaration(plan));
    for call in plan.calls {
        let _ = writeln!(text, "/* {} */\n{};\n", call.about, super::signature::signature(plan, call));
    }
    let _ = writeln!(text, "#endif");
    text
}

/// Returns the lines of a comment by which the export can be traced.
fn trace(plan: &Plan<'_>) -> String {
    let changes = plan
        .origin
        .changes
        .iter()
        .map(|change| format!("\n *   changed: {change}"))
        .collect::<Vec<_>>()
        .concat();
    format!(
        " * Scenario with all defaults: scenario.toml, SHA-256\n * {}.{changes}\n * The translated functions are part of flexsc: SPDX-License-Identifier: MIT OR Apache-2.0.",
        plan.digest
    )
}

/// Returns the lines of a comment that list the parts of the control loop that are not in the code, and its inputs from elsewhere.
fn excluded_parts(plan: &Plan<'_>) -> String {
    let list = |is_supplied: bool| -> String {
        let parts = plan.excluded_parts.iter().filter(|part| part.is_supplied == is_supplied);
        parts.fold(String::new(), |all, part| all + &format!("\n *   {}: {}", part.key, part.duty))
    };
    let (left_out, supplied) = (list(false), list(true));
    let mut text = if left_out.is_empty() {
        " *\n * Every part of the scenario's control loop is in this code.".to_owned()
    } else {
        format!(" *\n * Not part of this code; the caller must:{left_out}")
    };
    if !supplied.is_empty() {
        let _ = write!(text, "\n * Inputs from guidance and ephemerides; the caller must:{supplied}");
    }
    text
}

/// Returns the C struct that holds the state of the control system between its calls.
pub fn state(plan: &Plan<'_>) -> String {
    let mut text = String::new();
    if let ControlSystem::Modes(own) = plan.system {
        modes::law_states(plan, own, &mut text);
    }
    text.push_str("/* State of the control system, which its functions change. */\ntypedef struct {\n");
    let mut member = |about: &str, type_name: &str, name: &str| {
        let _ = writeln!(text, "    /* {about} */\n    {} {name};", plan.type_name(type_name));
    };
    match plan.system {
        ControlSystem::Modes(own) => modes::members(plan, own, &mut text),
        ControlSystem::Relays(Relays { axes }) => {
            member("Relay about each axis.", "PolledRelay", &about("relay", axes.len(), axes.len()));
        }
        ControlSystem::BDot(_) => member("Rate of change of the magnetic field.", "FieldRate", "field"),
        ControlSystem::Sampled(laws) => {
            LawCalls { plan, laws, mode: None, has_attitude: false }.members(&mut text);
            estimator_calls::members(plan, laws.estimator.as_ref(), &mut text);
            let (about_axes, axes) = ("Filter of the rate about each axis.", laws.axis_count());
            if laws.rate_filter.is_some() {
                let (kind, name) = (plan.type_name("RigidRateFilter"), about("rate_filter", axes, axes));
                let _ = writeln!(text, "    /* {about_axes} */\n    {kind} {name};");
            }
            actuation_calls::members(plan, &laws.actuation, &mut text);
            if let Some(unit) = &laws.filter {
                kalman_calls::members(plan, unit, &mut text);
            }
        }
    }
    if !plan.parameters.is_empty() {
        let _ = writeln!(
            text,
            "    /* Numbers that are tuned in flight. */\n    {}_parameters parameters;",
            plan.prefix
        );
    }
    let _ = writeln!(text, "}} {}_state;\n", plan.prefix);
    text
}

/// Writes a struct with a member for each channel.
pub fn members(channels: &[Channel], name: &str, text: &mut String) {
    text.push_str("typedef struct {\n");
    if channels.is_empty() {
        text.push_str("    /* A struct in C has a member. */\n    bool unused;\n");
    }
    for channel in channels {
        let kind = match channel.kind {
            NumberKind::Real => "double",
            NumberKind::Flag => "bool",
            NumberKind::Integer(_) => "int64_t",
        };
        let array = if channel.count == 1 { String::new() } else { format!("[{}]", channel.count) };
        let _ = writeln!(text, "    /* {}. */\n    {kind} {}{array};", channel.about, channel.name);
    }
    let _ = writeln!(text, "}} {name};\n");
}
