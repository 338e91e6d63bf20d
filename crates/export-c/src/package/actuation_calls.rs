//! Actuators in an exported control system: torques of wheels, on-times of jets, and the unloading of wheels.

use std::fmt::Write as _;

use super::initialiser::initialiser;
use super::shim::{self, VECTOR};
use super::signature::{has_time, signature};
use super::{Plan, estimator_calls, momentum_calls, parameters};
use crate::control_system::{Actuation, AttitudeUnit, StoredMomentum, UnloadingDevice};

/// Writes the members of the state.
pub fn members(plan: &Plan<'_>, own: &Actuation, text: &mut String) {
    let mut member = |about: &str, type_name: &str, name: &str| {
        let _ = writeln!(text, "    /* {about} */\n    {} {name};", plan.type_name(type_name));
    };
    if let Some(wheels) = &own.wheels {
        member("Reaction wheels.", "AllocatedWheel", &format!("wheels[{}]", wheels.wheels.len()));
    }
    if own.unloading.is_some() {
        member("Unloading of the wheels.", "MomentumUnloading", "unloading");
        member("Torque that the wheels counteract (N m).", "Vector3", "counter");
        member("Torque that laws demand of the wheels (N m).", "Vector3", "demanded");
    }
}

/// Writes the groups of jets, and the limits of magnetorquers.
pub fn constants(plan: &Plan<'_>, own: &Actuation, text: &mut String) {
    if let Some(pairs) = &own.jets {
        *text += &shim::list(plan, "Groups of jets about the axes.", "JetPair", "jets", pairs);
    }
    match own.unloading.as_ref().map(|unit| &unit.device) {
        None => {}
        Some(UnloadingDevice::Magnetorquers(limits)) => {
            let _ = writeln!(
                text,
                "/* Largest moments of the magnetorquers (A m^2). */\nstatic const {} unloading_limits = {};\n",
                plan.type_name("Vector3"),
                initialiser(limits, plan.prefix)
            );
        }
        Some(UnloadingDevice::Jets(pairs, torques)) => {
            let about = "Groups of jets about the axes that unload the wheels.";
            *text += &shim::list(plan, about, "JetPair", "unloading_jets", &pairs[..]);
            *text +=
                &shim::list(plan, "Their torques (N m).", "JetTorques", "unloading_torques", &torques[..]);
        }
    }
}

/// Writes the statements that set the members of the state.
pub fn init(plan: &Plan<'_>, own: &Actuation, text: &mut String) {
    let prefix = plan.prefix;
    for (index, wheel) in own.wheels.iter().flat_map(|wheels| &wheels.wheels).enumerate() {
        let value = initialiser(wheel, prefix);
        let _ = writeln!(text, "    state->wheels[{index}] = ({prefix}_allocated_wheel){value};");
    }
    if let Some(unit) = &own.unloading {
        let zero = shim::vector(plan, &["0.0"; 3]);
        let _ = writeln!(
            text,
            "    state->unloading = ({prefix}_momentum_unloading){};\n    state->counter = {zero};\n    state->demanded = {zero};",
            initialiser(&unit.law, prefix)
        );
        parameters::apply(plan, "unloading.", text);
    }
}

/// Writes the torques of the wheels for those that laws demand, and that the wheels counteract.
fn drive(plan: &Plan<'_>, own: &Actuation, [demanded, counter]: [&str; 2], text: &mut String) {
    let Some(wheels) = &own.wheels else { return };
    let (count, limit) = (wheels.wheels.len(), parameters::expression(plan, "wheel_torque", wheels.limit));
    let _ = writeln!(
        text,
        "    wheel_allocation_drive(state->wheels, {count}, {demanded}, {counter}, {}, {limit});\n    \
         for (size_t wheel = 0; wheel < {count}; ++wheel) {{\n        output->wheel_torque[wheel] = state->wheels[wheel].torque;\n    }}",
        wheels.is_least_largest
    );
}

/// Writes the torques of the wheels for a demanded torque about each axis.
pub fn wheels<T: AsRef<str>>(plan: &Plan<'_>, own: &Actuation, torque: &[T; 3], text: &mut String) {
    if own.wheels.is_none() {
        return;
    }
    let demanded = shim::vector(plan, torque);
    text.push_str("\n    /* torques of the wheels, which turn the body the other way */\n");
    if own.unloading.is_some() {
        let _ = writeln!(text, "    state->demanded = {demanded};");
        return drive(plan, own, ["&state->demanded", "&state->counter"], text);
    }
    shim::variable(plan, "Vector3", "demanded", &demanded, text);
    shim::variable(plan, "Vector3", "counter", &shim::vector(plan, &["0.0"; 3]), text);
    drive(plan, own, ["&demanded", "&counter"], text);
}

/// Writes the on-times of jets for the commands among the outputs: changes of the rate, or torques.
pub fn jets(own: &Actuation, is_change: bool, text: &mut String) {
    let (function, command) = if is_change { ("change", "rate_change") } else { ("torque", "torque") };
    for axis in 0..own.jets.as_ref().map_or(0, Vec::len) {
        let _ = writeln!(
            text,
            "    output->on_time[{axis}] = jet_pair_on_time_of_{function}(&jets[{axis}], output->{command}[{axis}]);"
        );
    }
}

/// Wheels that may be unloaded.
pub struct UnloadedWheels<'a> {
    pub actuation: &'a Actuation,
    pub stored: &'a StoredMomentum,
    /// Attitude filter that gives the rate; `None` if the rate is an input.
    pub estimator: Option<&'a AttitudeUnit>,
}

/// Writes the function that begins a cycle of the unloading. With B-dot laws `state->moment` has the moment of the magnetorquers, and
/// `held` is the condition in C under which these laws command it.
pub fn unload(plan: &Plan<'_>, wheels: &UnloadedWheels<'_>, held: Option<&str>, text: &mut String) {
    let own = wheels.actuation;
    let Some(unit) = &own.unloading else { return };
    let Some(call) = plan.calls.iter().find(|call| call.name == "unload") else { return };
    let _ = writeln!(text, "{}\n{{", signature(plan, call));
    if has_time(plan) {
        text.push_str("    (void)now;\n");
    }
    let rate = wheels.estimator.map_or_else(|| shim::vector_from(plan, "input->rate"), estimator_calls::rate);
    shim::variable(plan, "Vector3", "rate", &rate, text);
    momentum_calls::declaration(plan, wheels.stored, "rate", text);
    match &unit.device {
        UnloadingDevice::Magnetorquers(_) => {
            shim::variable(plan, "Vector3", "field", &shim::vector_from(plan, "input->field"), text);
            let begin = |moment: &str| {
                format!("state->counter = momentum_unloading_begin_magnetic(&state->unloading, &stored, &field, &unloading_limits, &{moment});")
            };
            let moment = if held.is_some() { "state->moment" } else { "moment" };
            let _ = match held {
                Some(held) => writeln!(text, "    if (!({held})) {{\n        {}\n    }}", begin(moment)),
                None => writeln!(text, "    {} moment;\n    {}", plan.type_name("Vector3"), begin(moment)),
            };
            shim::spread("output->moment", moment, &VECTOR, text);
        }
        UnloadingDevice::Jets(..) => text.push_str(
            "    state->counter = momentum_unloading_begin_jets(&state->unloading, &stored, unloading_jets, unloading_torques, output->on_time);\n",
        ),
    }
    drive(plan, own, ["&state->demanded", "&state->counter"], text);
    text.push_str("}\n\n");
}
