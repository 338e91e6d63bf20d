//! Control system with modes of operation: a supervisor, and the laws of each mode.

use std::fmt::Write as _;

use super::law_scope::LawScope;
use super::member::{self, Member};
use super::text::{VECTOR, block, camel, local, spread, vector_from};
use super::{Glue, actuation, attitude, b_dot, momentum, supervisor};
use crate::control_system::{LawsOfMode, ModeLaws, ModeSystem};

/// Returns the laws of a mode; `None` of laws that do not read estimates.
fn law_scope<'a>(modes: &ModeSystem, mode: &'a LawsOfMode) -> Option<LawScope<'a>> {
    let (laws, has_attitude) = (mode.start.on_estimates()?, modes.estimator.is_some());
    Some(LawScope { laws, mode: Some(&mode.name), has_attitude })
}

/// Adds the supervisor, the laws of each mode, estimators and actuators.
pub fn add(glue: &mut Glue<'_>, modes: &ModeSystem) {
    let estimator = modes.estimator.as_ref();
    supervisor::add(glue, modes);
    if let Some(unit) = estimator {
        attitude::add(glue, unit, "now");
    }
    if let Some(unit) = &modes.field {
        b_dot::add_field(glue, unit);
        let about = "Moment of the magnetorquers (A m^2).";
        glue.members.push(Member::new(about, "moment", "Vector3", "Vector3::ZERO".to_owned()));
    }
    actuation::add(glue, &modes.actuation);
    for mode in &modes.modes {
        if let Some(laws) = law_scope(modes, mode) {
            add_laws(glue, &mode.name, &laws);
        }
    }
    add_start(glue, modes);
    supervisor::add_functions(glue, modes);
    let detumbling = modes.modes.iter().enumerate().filter(|(_, mode)| mode.start.b_dot().is_some());
    let detumbling: Vec<String> =
        detumbling.map(|(mode, _)| format!("state.supervisor.active == {mode}")).collect();
    let held = Some(detumbling.join(" || ")).filter(|held| !held.is_empty());
    actuation::add_unload(glue, &modes.actuation, &modes.stored, estimator, held.as_deref());
    let body = step(glue, modes);
    glue.call("step", &body);
    momentum::add_axes(glue, &modes.stored);
}

/// Adds the state of the laws of a mode, their constants, their start and their step.
fn add_laws(glue: &mut Glue<'_>, name: &str, laws: &LawScope<'_>) {
    let (about, kind) = (format!("Laws of the mode `{name}`."), format!("Law{}State", camel(name)));
    let members = laws.members();
    glue.types.push_str(&member::definition(&members, &about, &kind));
    let value = member::value(&members, &kind);
    glue.members.push(Member::new(&about, &format!("law_{name}"), &kind, value).started());
    laws.add_constants(glue);
    let start = laws.start(glue);
    let about = format!("Starts the laws of the mode `{name}` without a past.");
    glue.function(&about, &format!("fn start_law_{name}()"), &["state: &mut State"], &start);
    let _ = writeln!(glue.init, "    start_law_{name}(state);");
    let estimates: &[&str] = if laws.has_attitude { &["angle: Vector3", "rate: Vector3"] } else { &[] };
    let given = ["state: &mut State", "input: &StepInput", "output: &mut StepOutput"];
    let parameters: Vec<&str> = given.iter().chain(estimates).copied().collect();
    let about = format!("Decides by the laws of the mode `{name}`.");
    let body = laws.step(glue);
    glue.function(&about, &format!("fn step_law_{name}()"), &parameters, &body);
}

/// Adds the function that starts the laws of the present mode.
fn add_start(glue: &mut Glue<'_>, modes: &ModeSystem) {
    let all = modes.modes.iter().enumerate().filter(|(_, mode)| mode.start.on_estimates().is_some());
    let arms = all.map(|(index, mode)| format!("        {index} => start_law_{}(state),\n", mode.name));
    let body = selected(&arms.collect::<Vec<_>>().concat());
    let about = "Starts the laws of the present mode without a past.";
    glue.function(about, "fn start_laws()", &["state: &mut State"], &body);
}

/// Returns the selection by the present mode; empty without arms.
fn selected(arms: &str) -> String {
    if arms.is_empty() {
        return String::new();
    }
    format!("    match state.supervisor.active {{\n{arms}        _ => {{}}\n    }}\n")
}

/// Returns the statements that decide by the laws of the present mode.
fn step(glue: &Glue<'_>, modes: &ModeSystem) -> String {
    let mut text = String::new();
    let laws = || modes.modes.iter().filter_map(|mode| Some((mode, mode.start.on_estimates()?)));
    if modes.estimator.is_some() && laws().next().is_some() {
        let change = "state.change.angle_from(&target, &attitude)";
        text += &attitude::attitudes();
        let angle = if modes.moves_angles { change } else { "target.rotation_to(&attitude)" };
        text += &local("Vector3", "angle", angle);
        text += &local("Vector3", "rate", attitude::RATE);
    }
    text += "    *output = StepOutput::ZERO;\n";
    let has_wheels = modes.actuation.wheels.is_some();
    if has_wheels {
        let is_driven = laws().any(|(mode, _)| mode.drives_wheels);
        let name = if is_driven { "mut torque" } else { "torque" };
        text += &local("Vector3", name, "Vector3::ZERO");
    }
    if modes.field.is_some() && modes.clears_moment {
        text += "    state.moment = Vector3::ZERO;\n";
    }
    let arms = modes.modes.iter().enumerate().map(|(index, mode)| {
        let decision = decide(glue, modes, mode);
        let body = block(&decision).replace('\n', "\n    ");
        if decision.is_empty() { String::new() } else { format!("        {index} => {}\n", body.trim()) }
    });
    text += &selected(&arms.collect::<String>());
    text += &actuation::wheels(glue, &modes.actuation, &VECTOR.map(|axis| format!("torque.{axis}")));
    if modes.field.is_some() {
        text += &spread("output.moment", "state.moment", &VECTOR);
    }
    text + "    output.mode = state.supervisor.active as i64;\n"
}

/// Returns the decision of the laws of a mode. B-dot laws end the unloading by magnetorquers.
fn decide(glue: &Glue<'_>, modes: &ModeSystem, mode: &LawsOfMode) -> String {
    let mut text = String::new();
    if let ModeLaws::BDot(laws) = &mode.start {
        text += &b_dot::moment(glue, laws, Some(&mode.name));
        text += "    state.moment = moment;\n";
        if modes.actuation.unloads_by_magnetorquers() {
            text += "    state.unloading.is_active = false;\n    state.counter = Vector3::ZERO;\n";
        }
    }
    let Some(scope) = law_scope(modes, mode) else { return text };
    let estimates = if scope.has_attitude { ", angle, rate" } else { "" };
    let _ = writeln!(text, "    step_law_{}(state, input, output{estimates});", mode.name);
    if mode.drives_wheels && modes.actuation.wheels.is_some() {
        let _ = writeln!(text, "    torque = {};", vector_from("output.torque"));
    }
    if mode.fires_jets {
        text += &actuation::jets(&modes.actuation, scope.laws.commands_changes());
    }
    text
}
