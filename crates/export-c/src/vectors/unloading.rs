//! Cycles of the unloading of wheels as calls.

use flexsc_core::UnloadingCall;

use super::{CallVector, VectorError, call, compare_numbers};
use crate::control_system::{Actuation, ControlSystem};

/// Returns the actuators of a control system that unloads wheels.
fn unloading(system: &ControlSystem) -> Option<&Actuation> {
    let actuation = match system {
        ControlSystem::Sampled(laws) => &laws.actuation,
        ControlSystem::Modes(modes) => &modes.actuation,
        ControlSystem::Relays(_) | ControlSystem::BDot(_) => return None,
    };
    actuation.unloading.is_some().then_some(actuation)
}

/// Calls the function that unloads the wheels with what the engine has read, and adds the call.
pub(super) fn replay(
    system: &mut ControlSystem,
    cycle: &UnloadingCall,
    vectors: &mut Vec<CallVector>,
) -> Result<(), VectorError> {
    let Some(actuation) = unloading(system) else { return Ok(()) };
    let mut inputs = cycle.stored_momentum.map(f64::to_bits).to_vec();
    if actuation.unloads_by_magnetorquers() {
        inputs.extend(cycle.field.unwrap_or_default().map(f64::to_bits));
    }
    let outputs = call(system, "unload", cycle.now.ticks(), inputs, vectors);
    let number = vectors.len() - 1;
    if let Some(unit) = unloading(system).and_then(|own| own.unloading.as_ref()) {
        let own = [unit.counter.x, unit.counter.y, unit.counter.z].map(f64::to_bits);
        compare_numbers(number, "the torque that wheels counteract", &cycle.counter_torque, &own)?;
    }
    compare_numbers(number, "the torque of a wheel", &cycle.wheel_torques, &outputs[3..])
}
