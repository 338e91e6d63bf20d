//! Tests of conditions and decisions of modes of operation as calls of their control system.

use flexsc_core::{ControlDecision, ModeTrial};
use flexsc_flight::ticks::Ticks;

use super::{
    CallVector, VectorError, b_dot, call, compare, compare_actuators, compare_commands, step_inputs,
};
use crate::control_system::{ControlSystem, ModeLaws, ModeSystem};

/// Calls the supervisor with what the engine's conditions read, and adds the call.
pub(super) fn replay_trial(
    system: &mut ControlSystem,
    trial: &ModeTrial,
    vectors: &mut Vec<CallVector>,
) -> Result<(), VectorError> {
    let ControlSystem::Modes(modes) = &*system else { return Ok(()) };
    let inputs = trial_inputs(modes, trial);
    call(system, "supervise", trial.now.ticks(), inputs, vectors);
    let ControlSystem::Modes(modes) = &*system else { return Ok(()) };
    compare(vectors.len() - 1, "the mode", trial.mode as f64, modes.supervisor.active as f64)
}

/// Returns the words of the inputs of the supervisor.
fn trial_inputs(modes: &ModeSystem, trial: &ModeTrial) -> Vec<u64> {
    let mut words: Vec<u64> = Vec::new();
    for channel in &modes.inputs.channels {
        let known =
            channel.quantity.and_then(|own| trial.known.iter().find(|(quantity, _)| *quantity == own));
        if let Some((_, values)) = known {
            words.extend(values.iter().map(|value| value.to_bits()));
            continue;
        }
        let name = channel.name.as_str();
        let value = modes.inputs.index_of(name).map_or(f64::NAN, |index| trial.readings[index]);
        // Truth values are words 0 and 1.
        words.push(if modes.inputs.is_boolean(name) { u64::from(value == 1.0) } else { value.to_bits() });
    }
    words
}

/// Calls the laws of the present mode with what the engine's laws read, and adds the call. A stage that begins at this time is
/// entered before.
pub(super) fn replay_decision(
    system: &mut ControlSystem,
    decision: &ControlDecision,
    vectors: &mut Vec<CallVector>,
) -> Result<(), VectorError> {
    if decision.axes.iter().any(|axis| decision.now < axis.goal.from) {
        return Ok(());
    }
    let now: Ticks = decision.now.ticks();
    let ControlSystem::Modes(modes) = &*system else { return Ok(()) };
    if modes.tables.written.is_empty() {
        let due = modes.supervisor.due(&modes.tables.modes, &modes.tables.exits);
        if due.has_time && due.time == now {
            call(system, "supervise", now, Vec::new(), vectors);
        }
    }
    let ControlSystem::Modes(modes) = &*system else { return Ok(()) };
    let layout = system.calls().swap_remove(modes.call_index("step"));
    let b_dot = modes.active_laws().and_then(ModeLaws::b_dot);
    let limits = b_dot.map_or([f64::INFINITY; 3], |laws| laws.limits);
    if b_dot.is_some() {
        b_dot::compare_rate(system, decision, vectors.len())?;
    }
    let outputs = call(system, "step", now, step_inputs(&layout.inputs, decision), vectors);
    let ControlSystem::Modes(modes) = &*system else { return Ok(()) };
    let number = vectors.len() - 1;
    if let Some(own) = modes.law_outputs(&outputs) {
        compare_commands(number, decision, &own, limits)?;
    }
    compare_actuators(number, decision, |name| modes.output(&outputs, name))
}
