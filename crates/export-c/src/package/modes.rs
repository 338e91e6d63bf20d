//! Types and functions of an exported control system with modes of operation: a supervisor, and the laws of each mode.

use std::fmt::Write as _;

use super::law_scope::LawCalls;
use super::shim::{self, VECTOR};
use super::signature::{init_signature, signature};
use super::{Plan, actuation_calls, b_dot_calls, estimator_calls, parameters, supervisor_calls};
use crate::control_system::{LawsOfMode, ModeLaws, ModeSystem};

/// Returns the laws of a mode; `None` of laws that do not read estimates.
fn law_calls<'a>(plan: &'a Plan<'_>, modes: &ModeSystem, mode: &'a LawsOfMode) -> Option<LawCalls<'a>> {
    let (laws, has_attitude) = (mode.start.on_estimates()?, modes.estimator.is_some());
    Some(LawCalls { plan, laws, mode: Some(&mode.name), has_attitude })
}

/// Returns the laws of all modes that read estimates, with the indices of the modes.
fn all_laws<'a>(
    plan: &'a Plan<'_>,
    modes: &'a ModeSystem,
) -> impl Iterator<Item = (usize, &'a str, LawCalls<'a>)> {
    let all = modes.modes.iter().enumerate();
    all.filter_map(|(index, mode)| Some((index, mode.name.as_str(), law_calls(plan, modes, mode)?)))
}

/// Writes the structs with the laws of each mode.
pub fn law_states(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    for (_, name, laws) in all_laws(plan, modes) {
        let _ = writeln!(text, "/* Laws of the mode `{name}`. */\ntypedef struct {{");
        laws.members(text);
        let _ = writeln!(text, "}} {}_law_{name}_state;\n", plan.prefix);
    }
}

/// Writes the members of the state.
pub fn members(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    supervisor_calls::members(plan, modes, text);
    estimator_calls::members(plan, modes.estimator.as_ref(), text);
    if modes.field.is_some() {
        let [rate, vector] = ["FieldRate", "Vector3"].map(|name| plan.type_name(name));
        let _ = writeln!(
            text,
            "    /* Rate of change of the magnetic field. */\n    {rate} field;\n    /* Moment of the magnetorquers (A m^2). */\n    {vector} moment;"
        );
    }
    actuation_calls::members(plan, &modes.actuation, text);
    for (_, name, _) in all_laws(plan, modes) {
        let _ = writeln!(
            text,
            "    /* Laws of the mode `{name}`. */\n    {}_law_{name}_state law_{name};",
            plan.prefix
        );
    }
}

/// Writes the lists of the supervisor and the functions.
pub fn functions(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    for (_, name, laws) in all_laws(plan, modes) {
        laws_of_mode(plan, name, &laws, text);
    }
    supervisor_calls::constants(plan, modes, text);
    actuation_calls::constants(plan, &modes.actuation, text);
    let estimator = modes.estimator.as_ref();
    if let Some(unit) = estimator {
        estimator_calls::start(plan, unit, text);
    }
    start_laws(plan, modes, text);
    init(plan, modes, text);
    if let Some(unit) = estimator {
        estimator_calls::functions(plan, unit, text);
    }
    b_dot_calls::sample(plan, text);
    supervisor_calls::enter(plan, modes, text);
    supervisor_calls::supervise(plan, modes, text);
    let detumbling = modes.modes.iter().enumerate().filter(|(_, mode)| mode.start.b_dot().is_some());
    let detumbling: Vec<String> =
        detumbling.map(|(mode, _)| format!("state->supervisor.active == {mode}")).collect();
    let held = Some(detumbling.join(" || ")).filter(|held| !held.is_empty());
    let unloading =
        actuation_calls::UnloadedWheels { actuation: &modes.actuation, stored: &modes.stored, estimator };
    actuation_calls::unload(plan, &unloading, held.as_deref(), text);
    step(plan, modes, text);
}

/// Returns the parameters of the step of a mode's laws: the state, inputs and outputs of the step, and estimates of a filter.
fn law_signature(plan: &Plan<'_>, name: &str, laws: &LawCalls<'_>) -> String {
    let prefix = plan.prefix;
    let estimates = if laws.has_attitude {
        format!(",\n    {prefix}_vector3 angle, {prefix}_vector3 rate")
    } else {
        String::new()
    };
    format!(
        "static void step_law_{name}({prefix}_state *state, const {prefix}_step_input *input, {prefix}_step_output *output{estimates})"
    )
}

/// Writes the constants of the laws of a mode, their start and their step.
fn laws_of_mode(plan: &Plan<'_>, name: &str, laws: &LawCalls<'_>, text: &mut String) {
    let _ = writeln!(text, "/* Laws of the mode `{name}`. */\n");
    laws.constants(text);
    let _ = writeln!(text, "static void start_law_{name}({}_state *state)\n{{", plan.prefix);
    laws.start(text);
    let mut step = String::new();
    laws.step(&mut step);
    let _ = writeln!(text, "}}\n\n{}\n{{", law_signature(plan, name, laws));
    if laws.has_attitude && !step.contains("rate.x") {
        text.push_str("    (void)rate;\n");
    }
    let _ = writeln!(text, "{step}}}\n");
}

/// Writes the function that starts the laws of the present mode.
fn start_laws(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let _ = writeln!(
        text,
        "/* Starts the laws of the present mode without a past. */\nstatic void start_laws({}_state *state)\n{{\n    \
         switch (state->supervisor.active) {{",
        plan.prefix
    );
    for (index, name, _) in all_laws(plan, modes) {
        let _ = writeln!(text, "    case {index}:\n        start_law_{name}(state);\n        break;");
    }
    text.push_str("    default:\n        break;\n    }\n}\n\n");
}

/// Writes the function that sets the state.
fn init(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let _ = writeln!(text, "{}\n{{\n    memset(state, 0, sizeof *state);", init_signature(plan));
    parameters::init(plan, text);
    if modes.estimator.is_some() {
        estimator_calls::init(plan, "now", text);
    }
    if let Some(unit) = &modes.field {
        b_dot_calls::init(plan, unit, text);
    }
    supervisor_calls::init(plan, modes, text);
    actuation_calls::init(plan, &modes.actuation, text);
    text.push_str("    start_laws(state);\n}\n\n");
}

/// Writes the function that decides by the laws of the present mode.
fn step(plan: &Plan<'_>, modes: &ModeSystem, text: &mut String) {
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[modes.call_index("step")]));
    if let Some(unit) = &modes.estimator {
        estimator_calls::attitudes(plan, unit, text);
        let angle = if modes.moves_angles {
            "target_change_angle_from(&state->change, &target, &attitude)"
        } else {
            "quaternion_rotation_to(&target, &attitude)"
        };
        shim::variable(plan, "Vector3", "angle", angle, text);
        shim::variable(plan, "Vector3", "rate", &estimator_calls::rate(unit), text);
    } else if modes.field.is_none() {
        text.push_str("    (void)now;\n");
    }
    if all_laws(plan, modes).next().is_none() {
        text.push_str("    (void)input;\n");
    }
    text.push_str("    memset(output, 0, sizeof *output);\n");
    let zero = shim::vector(plan, &["0.0"; 3]);
    if modes.actuation.wheels.is_some() {
        let _ = writeln!(text, "    {} torque = {zero};", plan.type_name("Vector3"));
    }
    if modes.field.is_some() && modes.clears_moment {
        let _ = writeln!(text, "    state->moment = {zero};");
    }
    text.push_str("    switch (state->supervisor.active) {\n");
    for (index, mode) in modes.modes.iter().enumerate() {
        let mut decision = String::new();
        decide(plan, modes, mode, &mut decision);
        if !decision.is_empty() {
            let _ = writeln!(text, "    case {index}: {{");
            decision.lines().for_each(|line| text.extend(["    ", line, "\n"]));
            text.push_str("        break;\n    }\n");
        }
    }
    text.push_str("    default:\n        break;\n    }\n");
    actuation_calls::wheels(plan, &modes.actuation, &VECTOR.map(|axis| format!("torque.{axis}")), text);
    if modes.field.is_some() {
        shim::spread("output->moment", "state->moment", &VECTOR, text);
    }
    text.push_str("    output->mode = (int64_t)state->supervisor.active;\n}\n");
}

/// Writes the decision of the laws of a mode. B-dot laws end the unloading by magnetorquers.
fn decide(plan: &Plan<'_>, modes: &ModeSystem, mode: &LawsOfMode, text: &mut String) {
    if let ModeLaws::BDot(laws) = &mode.start {
        b_dot_calls::moment(plan, laws, Some(&mode.name), text);
        text.push_str("    state->moment = moment;\n");
        if modes.actuation.unloads_by_magnetorquers() {
            let zero = shim::vector(plan, &["0.0"; 3]);
            let _ = writeln!(text, "    state->unloading.is_active = false;\n    state->counter = {zero};");
        }
    }
    let Some(calls) = law_calls(plan, modes, mode) else { return };
    let estimates = if calls.has_attitude { ", angle, rate" } else { "" };
    let _ = writeln!(text, "    step_law_{}(state, input, output{estimates});", mode.name);
    if mode.drives_wheels && modes.actuation.wheels.is_some() {
        let _ = writeln!(text, "    torque = {};", shim::vector_from(plan, "output->torque"));
    }
    if mode.fires_jets {
        actuation_calls::jets(&modes.actuation, calls.laws.commands_changes(), text);
    }
}
