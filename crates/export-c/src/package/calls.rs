//! Functions of an exported control system: their signatures and bodies.

use std::fmt::Write as _;

use super::initialiser::initialiser;
use super::law_scope::LawCalls;
use super::signature::{about, signature};
use super::{
    Plan, actuation_calls, b_dot_calls, estimator_calls, kalman_calls, modes, momentum_calls, parameters,
    rate_calls,
};
use crate::control_system::{ControlSystem, LawsOfAxes, Relays, SampledLaws};

/// Returns the constants and the functions.
pub fn functions(plan: &Plan<'_>) -> String {
    let mut text = String::new();
    match plan.system {
        ControlSystem::Relays(relays) => of_relays(plan, relays, &mut text),
        ControlSystem::Sampled(laws) => {
            of_laws(plan, laws, &mut text);
            text.insert_str(0, &momentum_calls::constants(plan, &laws.stored, &text));
        }
        ControlSystem::BDot(laws) => b_dot_calls::functions(plan, laws, &mut text),
        ControlSystem::Modes(own) => {
            modes::functions(plan, own, &mut text);
            text.insert_str(0, &momentum_calls::constants(plan, &own.stored, &text));
        }
    }
    text
}

/// Writes the functions of relays.
fn of_relays(plan: &Plan<'_>, relays: &Relays, text: &mut String) {
    let (prefix, axes) = (plan.prefix, relays.axes.len());
    let upper = prefix.to_uppercase();
    let _ = writeln!(text, "void {prefix}_init({prefix}_state *state)\n{{");
    for (axis, relay) in relays.axes.iter().enumerate() {
        let member = about("relay", axis, axes);
        let value = initialiser(relay, prefix);
        let _ = writeln!(text, "    state->{member} = ({prefix}_polled_relay){value};");
    }
    let _ = writeln!(text, "}}\n");
    let pointer = if axes == 1 {
        "&state->relay".to_owned()
    } else {
        format!("&state->relay[input->axis < {axes} && input->axis >= 0 ? input->axis : 0]")
    };
    let _ = writeln!(
        text,
        "{}\n{{\n    {prefix}_polled_relay *relay = {pointer};\n    const {prefix}_relay_event event = relay_event_from_number(input->event);\n    \
         polled_relay_decide(relay, now, event, input->angle);",
        signature(plan, &plan.calls[0])
    );
    for (output, value) in [
        ("torque", "torque"),
        ("has_timeout", "has_timeout"),
        ("until_whole", "until.whole"),
        ("until_part", "until.part"),
    ] {
        let _ = writeln!(text, "    output->{output} = relay->command.{value};");
    }
    let _ = writeln!(
        text,
        "    output->guard_count = (int64_t)relay->command.guard_count;\n    for (size_t guard = 0; guard < 2; ++guard) {{\n        \
         output->guard_is_lower[guard] = relay->command.guards[guard].side == {upper}_GUARD_DIRECTION_AT_MOST;\n        \
         output->guard_level[guard] = relay->command.guards[guard].level;\n    }}\n}}\n"
    );
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[1]));
    for axis in 0..axes {
        let [torque, relay, angle] = ["torque", "relay", "angle"].map(|name| about(name, axis, axes));
        let _ =
            writeln!(text, "    output->{torque} = polled_relay_step(&state->{relay}, now, input->{angle});");
    }
    text.push_str("}\n");
}

/// Writes the constants and functions of laws that decide at their period.
fn of_laws(plan: &Plan<'_>, laws: &SampledLaws, text: &mut String) {
    let own = LawCalls { plan, laws, mode: None, has_attitude: laws.estimator.is_some() };
    own.constants(text);
    actuation_calls::constants(plan, &laws.actuation, text);
    if let Some(unit) = &laws.estimator {
        estimator_calls::start(plan, unit, text);
    }
    if let Some(unit) = &laws.filter {
        kalman_calls::start(plan, unit, text);
    }
    init(&own, text);
    if let Some(unit) = &laws.estimator {
        estimator_calls::functions(plan, unit, text);
    }
    if let Some(unit) = &laws.filter {
        kalman_calls::functions(plan, unit, text);
    }
    if let Some(unit) = &laws.rate_filter {
        rate_calls::sample(plan, unit, text);
    }
    let (actuation, stored, estimator) = (&laws.actuation, &laws.stored, laws.estimator.as_ref());
    let wheels = actuation_calls::UnloadedWheels { actuation, stored, estimator };
    actuation_calls::unload(plan, &wheels, None, text);
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[laws.step_index()]));
    if let Some(unit) = estimator {
        estimator_calls::attitudes(plan, unit, text);
        super::shim::variable(plan, "Vector3", "angle", "quaternion_rotation_to(&target, &attitude)", text);
        super::shim::variable(plan, "Vector3", "rate", &estimator_calls::rate(unit), text);
    }
    own.step(text);
    actuation_calls::wheels(plan, actuation, &[0, 1, 2].map(|axis| format!("output->torque[{axis}]")), text);
    if actuation.jets.is_some() {
        text.push_str("\n    /* pulses of the jets */\n");
        actuation_calls::jets(actuation, laws.commands_changes(), text);
    }
    text.push_str("}\n");
}

/// Writes the function that sets the state.
fn init(own: &LawCalls<'_>, text: &mut String) {
    let (plan, laws) = (own.plan, own.laws);
    let _ = writeln!(text, "void {0}_init({0}_state *state)\n{{", plan.prefix);
    if laws.estimator.is_some() || matches!(laws.laws, LawsOfAxes::StateSpace(_)) {
        text.push_str("    memset(state, 0, sizeof *state);\n");
    }
    parameters::init(plan, text);
    if laws.estimator.is_some() {
        let start = format!("({}_ticks){{ .whole = 0, .part = 0 }}", plan.prefix);
        estimator_calls::init(plan, &start, text);
    }
    if let Some(unit) = &laws.filter {
        kalman_calls::init(unit, text);
    }
    own.start(text);
    for (axis, filter) in laws.rate_filter.iter().flat_map(|unit| &unit.axes).enumerate() {
        let (member, value) =
            (about("rate_filter", axis, laws.axis_count()), initialiser(filter, plan.prefix));
        let _ = writeln!(text, "    state->{member} = ({}){value};", plan.type_name("RigidRateFilter"));
    }
    actuation_calls::init(plan, &laws.actuation, text);
    text.push_str("}\n\n");
}
