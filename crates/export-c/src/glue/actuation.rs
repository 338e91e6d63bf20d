//! Actuators: torques of wheels, on-times of jets, and the unloading of wheels.

use super::member::Member;
use super::text::{VECTOR, literal, local, spread, vector, vector_from};
use super::{Glue, attitude, momentum, parameters};
use crate::control_system::{Actuation, AttitudeUnit, StoredMomentum, UnloadingDevice};

/// Adds the members of the state, the groups of jets, and the limits of magnetorquers.
pub fn add(glue: &mut Glue<'_>, own: &Actuation) {
    if let Some(wheels) = &own.wheels {
        glue.members.push(Member::list("Reaction wheels.", "wheels", "AllocatedWheel", &wheels.wheels));
    }
    glue.list("Groups of jets about the axes.", "JETS", "JetPair", own.jets.as_deref().unwrap_or_default());
    let Some(unit) = &own.unloading else { return };
    let torque = |about: &str, name: &str| Member::new(about, name, "Vector3", "Vector3::ZERO".to_owned());
    glue.members.extend([
        Member::new("Unloading of the wheels.", "unloading", "MomentumUnloading", literal(&unit.law)),
        torque("Torque that the wheels counteract (N m).", "counter"),
        torque("Torque that laws demand of the wheels (N m).", "demanded"),
    ]);
    let tuned = parameters::apply(glue, "unloading.");
    glue.init.push_str(&tuned);
    match &unit.device {
        UnloadingDevice::Magnetorquers(limits) => {
            let about = "Largest moments of the magnetorquers (A m^2).";
            glue.constant(about, "UNLOADING_LIMITS", "Vector3", &literal(limits));
        }
        UnloadingDevice::Jets(pairs, torques) => {
            let about = "Groups of jets about the axes that unload the wheels.";
            glue.list(about, "UNLOADING_JETS", "JetPair", &pairs[..]);
            glue.list("Their torques (N m).", "UNLOADING_TORQUES", "JetTorques", &torques[..]);
        }
    }
}

/// Returns the statements that give the torques of the wheels for those that laws demand, and that the wheels counteract.
fn drive(glue: &Glue<'_>, own: &Actuation, [demanded, counter]: [&str; 2]) -> String {
    let Some(wheels) = &own.wheels else { return String::new() };
    let (count, is_least_largest) = (wheels.wheels.len(), wheels.is_least_largest);
    let limit = parameters::expression(glue, "wheel_torque", wheels.limit);
    format!(
        "    wheel_allocation::drive(&mut state.wheels, &{demanded}, &{counter}, {is_least_largest}, {limit});
    for wheel in 0..{count} {{
        output.wheel_torque[wheel] = state.wheels[wheel].torque;
    }}
"
    )
}

/// Returns the statements that give the torques of the wheels for a demanded torque about each axis.
pub fn wheels<T: AsRef<str>>(glue: &Glue<'_>, own: &Actuation, torque: &[T; 3]) -> String {
    if own.wheels.is_none() {
        return String::new();
    }
    let demanded = vector(torque);
    let comment = "\n    // torques of the wheels, which turn the body the other way\n".to_owned();
    if own.unloading.is_some() {
        let kept = format!("    state.demanded = {demanded};\n");
        return comment + &kept + &drive(glue, own, ["state.demanded", "state.counter"]);
    }
    comment
        + &local("Vector3", "demanded", &demanded)
        + &local("Vector3", "counter", "Vector3::ZERO")
        + &drive(glue, own, ["demanded", "counter"])
}

/// Returns the on-times of jets for the commands among the outputs: changes of the rate, or torques.
pub fn jets(own: &Actuation, is_change: bool) -> String {
    let (function, command) = if is_change { ("change", "rate_change") } else { ("torque", "torque") };
    let on_time = |axis: usize| {
        format!(
            "    output.on_time[{axis}] = JETS[{axis}].on_time_of_{function}(output.{command}[{axis}]);\n"
        )
    };
    (0..own.jets.as_ref().map_or(0, Vec::len)).map(on_time).collect()
}

/// Adds the function that begins a cycle of the unloading. With B-dot laws `state.moment` has the moment of the magnetorquers, and
/// `held` is the condition under which these laws command it.
pub fn add_unload(
    glue: &mut Glue<'_>,
    own: &Actuation,
    stored: &StoredMomentum,
    estimator: Option<&AttitudeUnit>,
    held: Option<&str>,
) {
    let Some(unit) = &own.unloading else { return };
    let rate = if estimator.is_some() { attitude::RATE.to_owned() } else { vector_from("input.rate") };
    let mut body = local("Vector3", "rate", &rate) + &momentum::stored(glue, "unload", stored, "rate");
    match &unit.device {
        UnloadingDevice::Magnetorquers(_) => {
            body += &local("Vector3", "field", &vector_from("input.field"));
            let begin = |moment: &str| {
                format!("state.counter = state.unloading.begin_magnetic(&stored, &field, &UNLOADING_LIMITS, &mut {moment});\n")
            };
            let moment = if held.is_some() { "state.moment" } else { "moment" };
            let begun = match held {
                Some(held) => format!("    if !({held}) {{\n        {}    }}\n", begin(moment)),
                None => format!("    let mut moment: Vector3 = Vector3::ZERO;\n    {}", begin(moment)),
            };
            body += &begun;
            body += &spread("output.moment", moment, &VECTOR);
        }
        UnloadingDevice::Jets(..) => body.push_str(
            "    state.counter = state.unloading.begin_jets(&stored, &UNLOADING_JETS, &UNLOADING_TORQUES, &mut output.on_time);\n",
        ),
    }
    body += &drive(glue, own, ["state.demanded", "state.counter"]);
    glue.call("unload", &body);
}
