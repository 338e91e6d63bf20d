//! Actuators in an exported control system: torques of wheels, on-times of jets, and the unloading of wheels.

use std::fmt::Write as _;

use super::initialiser::initialiser;
use super::signature::signature;
use super::{Plan, momentum_calls, parameters};
use crate::control_system::{Actuation, StoredMomentum, UnloadingDevice};

/// Returns the paths of the functions of the flight code that the actuators call; `are_changes` are the kinds of commands that jets
/// execute, changes of the rate or torques.
pub fn roots(own: &Actuation, are_changes: &[bool]) -> Vec<&'static str> {
    let mut roots = Vec::new();
    if own.wheels.is_some() {
        roots.extend(["wheel_allocation::allocate", "wheel_allocation::limit_torques"]);
    }
    if own.jets.is_some() {
        let each = are_changes.iter().map(|is_change| on_time_function(*is_change).0);
        roots.extend(each);
    }
    match own.unloading.as_ref().map(|unit| &unit.device) {
        None => return roots,
        Some(UnloadingDevice::Magnetorquers(_)) => {
            roots.extend(["magnetorquers::moment_of_torque", "magnetorquers::torque_of_moment"]);
        }
        Some(UnloadingDevice::Jets(..)) => roots.extend([
            "jet_pulses::JetPair::on_time_of_torque",
            "jet_pulses::JetTorques::impulse",
            "vector3::Vector3::plus",
            "vector3::Vector3::divided",
        ]),
    }
    roots.extend(["momentum_unloading::MomentumUnloading::torque", "vector3::Vector3::minus"]);
    roots
}

/// Returns the function that converts a command of jets, in Rust and in C.
fn on_time_function(is_change: bool) -> (&'static str, &'static str) {
    if is_change {
        ("jet_pulses::JetPair::on_time_of_change", "jet_pair_on_time_of_change")
    } else {
        ("jet_pulses::JetPair::on_time_of_torque", "jet_pair_on_time_of_torque")
    }
}

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

/// Writes the groups of jets, and the function that sets the torques of unloaded wheels.
pub fn constants(plan: &Plan<'_>, own: &Actuation, text: &mut String) {
    let mut list = |about: &str, type_name: &str, name: &str, rows: Vec<String>| {
        let _ = writeln!(
            text,
            "/* {about} */\nstatic const {} {name}[{}] = {{\n{}\n}};\n",
            plan.type_name(type_name),
            rows.len(),
            rows.join(",\n")
        );
    };
    if let Some(pairs) = &own.jets {
        list("Groups of jets about the axes.", "JetPair", "jets", rows(plan, pairs));
    }
    let Some(unit) = &own.unloading else { return };
    match &unit.device {
        UnloadingDevice::Magnetorquers(limits) => {
            let _ = writeln!(
                text,
                "/* Largest moments of the magnetorquers (A m^2). */\nstatic const {} unloading_limits = {};\n",
                plan.type_name("Vector3"),
                initialiser(limits, plan.prefix)
            );
        }
        UnloadingDevice::Jets(pairs, torques) => {
            let about = "Groups of jets about the axes that unload the wheels.";
            list(about, "JetPair", "unloading_jets", rows(plan, pairs));
            list("Their torques (N m).", "JetTorques", "unloading_torques", rows(plan, torques));
        }
    }
    let prefix = plan.prefix;
    let _ = writeln!(
        text,
        "/* Sets the torques of the wheels, which turn the body the other way. */\nstatic void drive_wheels({prefix}_state *state, double *wheel_torque)\n{{\n    \
         const {prefix}_vector3 demanded = vector3_minus(&state->counter, &state->demanded);\n{}}}\n",
        allocation(plan, own, "", "wheel_torque")
    );
}

fn rows(plan: &Plan<'_>, values: &[impl std::fmt::Debug]) -> Vec<String> {
    values.iter().map(|value| format!("    {}", initialiser(value, plan.prefix))).collect()
}

/// Writes the statements that set the members of the state.
pub fn init(plan: &Plan<'_>, own: &Actuation, text: &mut String) {
    let prefix = plan.prefix;
    for (index, wheel) in own.wheels.iter().flat_map(|wheels| &wheels.wheels).enumerate() {
        let value = initialiser(wheel, prefix);
        let _ = writeln!(text, "    state->wheels[{index}] = ({prefix}_allocated_wheel){value};");
    }
    if let Some(unit) = &own.unloading {
        let zero = format!("({prefix}_vector3){{ .x = 0.0, .y = 0.0, .z = 0.0 }}");
        let members = [("above", "above"), ("below", "below"), ("gain", "gain"), ("most", "torque")];
        let law = members.into_iter().fold(initialiser(&unit.law, prefix), |law, (member, name)| {
            let name = format!("unload_{name}");
            let is_tuned = plan.parameters.iter().any(|own| own.name == name);
            if is_tuned { parameters::replaced(&law, member, &format!("parameters->{name}")) } else { law }
        });
        let _ = writeln!(
            text,
            "    state->unloading = ({prefix}_momentum_unloading){law};\n    state->counter = {zero};\n    state->demanded = {zero};"
        );
    }
}

/// Returns the allocation of a torque `demanded` to the wheels.
fn allocation(plan: &Plan<'_>, own: &Actuation, indent: &str, output: &str) -> String {
    let Some(wheels) = &own.wheels else { return String::new() };
    let (count, limit) = (wheels.wheels.len(), parameters::expression(plan, "wheel_torque", wheels.limit));
    format!(
        "{indent}    wheel_allocation_allocate(state->wheels, {count}, &demanded, {});\n\
         {indent}    wheel_allocation_limit_torques(state->wheels, {count}, {limit});\n\
         {indent}    for (size_t wheel = 0; wheel < {count}; ++wheel) {{\n{indent}        {output}[wheel] = state->wheels[wheel].torque;\n{indent}    }}\n",
        wheels.is_least_largest
    )
}

/// Writes the torques of the wheels for a demanded torque about each axis.
pub fn wheels(plan: &Plan<'_>, own: &Actuation, torque: impl Fn(usize) -> String, text: &mut String) {
    if own.wheels.is_none() {
        return;
    }
    let prefix = plan.prefix;
    let [x, y, z] = [0, 1, 2].map(torque);
    if own.unloading.is_some() {
        let _ = writeln!(
            text,
            "\n    state->demanded = ({prefix}_vector3){{ .x = {x}, .y = {y}, .z = {z} }};\n    drive_wheels(state, output->wheel_torque);"
        );
        return;
    }
    let _ = write!(
        text,
        "\n    /* torques of the wheels, which turn the body the other way */\n    const {prefix}_vector3 demanded = \
         ({prefix}_vector3){{ .x = 0.0 - {x}, .y = 0.0 - {y}, .z = 0.0 - {z} }};\n{}",
        allocation(plan, own, "", "output->wheel_torque")
    );
}

/// Writes the on-times of jets for the commands in `from`.
pub fn jets(own: &Actuation, is_change: bool, indent: &str, from: &str, text: &mut String) {
    let Some(pairs) = &own.jets else { return };
    let (function, demand) =
        (on_time_function(is_change).1, if is_change { "rate_change" } else { "torque" });
    for axis in 0..pairs.len() {
        let _ = writeln!(
            text,
            "{indent}output->on_time[{axis}] = {function}(&jets[{axis}], {from}{demand}[{axis}]);"
        );
    }
}

/// Wheels that may be unloaded.
pub struct UnloadedWheels<'a> {
    pub actuation: &'a Actuation,
    pub stored: &'a StoredMomentum,
    /// Number of entries of the attitude filter that gives the rate; `None` if the rate is an input.
    pub entries: Option<usize>,
}

/// Writes the function that begins a cycle of the unloading. With B-dot laws `state->moment` has the moment of the magnetorquers, and
/// `held` is the condition in C under which these laws command it.
pub fn unload(plan: &Plan<'_>, wheels: &UnloadedWheels<'_>, held: Option<&str>, text: &mut String) {
    let own = wheels.actuation;
    let Some(unit) = &own.unloading else { return };
    let Some(call) = plan.calls.iter().find(|call| call.name == "unload") else { return };
    let prefix = plan.prefix;
    let vector = |from: &str| {
        format!("({prefix}_vector3){{ .x = input->{from}[0], .y = input->{from}[1], .z = input->{from}[2] }}")
    };
    let _ = writeln!(text, "{}\n{{", signature(plan, call));
    if super::signature::has_time(plan) {
        text.push_str("    (void)now;\n");
    }
    let rate = match wheels.entries {
        Some(entries) => {
            format!("attitude_estimator_rate(&state->estimator, state->entries, {entries})")
        }
        None => vector("rate"),
    };
    let _ = writeln!(text, "    const {prefix}_vector3 rate = {rate};");
    momentum_calls::declaration(plan, wheels.stored, "rate", text);
    let torque = "momentum_unloading_torque(&state->unloading, &stored)";
    match &unit.device {
        UnloadingDevice::Magnetorquers(_) => {
            let (moment, indent, declared) = match held {
                Some(_) => ("state->moment", "        ", String::new()),
                None => ("moment", "    ", format!("const {prefix}_vector3 ")),
            };
            let _ = writeln!(text, "    const {prefix}_vector3 field = {};", vector("field"));
            if let Some(held) = held {
                let _ = writeln!(text, "    if (!({held})) {{");
            }
            let _ = writeln!(
                text,
                "{indent}const {prefix}_vector3 torque = {torque};\n{indent}{declared}{moment} = magnetorquers_moment_of_torque(&torque, &field, &unloading_limits);\n\
                 {indent}state->counter = magnetorquers_torque_of_moment(&{moment}, &field);"
            );
            if held.is_some() {
                text.push_str("    }\n");
            }
            moment_output(moment, text);
        }
        UnloadingDevice::Jets(pairs, _) => {
            let _ = writeln!(text, "    const {prefix}_vector3 torque = {torque};");
            for (axis, component) in ["x", "y", "z"].into_iter().enumerate().take(pairs.len()) {
                let _ = writeln!(
                    text,
                    "    output->on_time[{axis}] = jet_pair_on_time_of_torque(&unloading_jets[{axis}], torque.{component});\n    \
                     const {prefix}_vector3 impulse_{component} = jet_torques_impulse(&unloading_torques[{axis}], output->on_time[{axis}]);"
                );
            }
            let _ = writeln!(
                text,
                "    const {prefix}_vector3 impulse_xy = vector3_plus(&impulse_x, &impulse_y);\n    \
                 const {prefix}_vector3 impulse = vector3_plus(&impulse_xy, &impulse_z);\n    \
                 state->counter = vector3_divided(&impulse, {});",
                initialiser(&unit.law.period, prefix)
            );
        }
    }
    text.push_str("    drive_wheels(state, output->wheel_torque);\n}\n\n");
}

/// Writes the output of a magnetic moment.
pub fn moment_output(moment: &str, text: &mut String) {
    for (axis, component) in ["x", "y", "z"].into_iter().enumerate() {
        let _ = writeln!(text, "    output->moment[{axis}] = {moment}.{component};");
    }
}
