//! Cycles of the unloading of wheels as calls.

use flexsc_core::UnloadingCall;
use flexsc_core::control::flight_quantity::FlightQuantity;

use super::{CallVector, VectorError, call, compare_numbers};
use crate::control_system::{Actuation, Channel, ControlSystem};

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
    if unloading(system).is_none() {
        return Ok(());
    }
    let rotors = &cycle.rotors;
    let layout = system.calls().into_iter().find(|call| call.name == "unload");
    let values = |channel: Channel| match channel.quantity {
        Some(FlightQuantity::WheelSpeed) => rotors.wheel_speeds.clone(),
        Some(FlightQuantity::Rate) => rotors.rate.to_vec(),
        Some(FlightQuantity::Field) => cycle.field.unwrap_or_default().to_vec(),
        _ => rotors.stored_momentum.to_vec(),
    };
    let inputs =
        layout.into_iter().flat_map(|layout| layout.inputs).flat_map(values).map(f64::to_bits).collect();
    let outputs = call(system, "unload", cycle.now.ticks(), inputs, vectors);
    let number = vectors.len() - 1;
    if let Some(unit) = unloading(system).and_then(|own| own.unloading.as_ref()) {
        let own = [unit.counter.x, unit.counter.y, unit.counter.z].map(f64::to_bits);
        compare_numbers(number, "the torque that wheels counteract", &cycle.counter_torque, &own)?;
    }
    compare_numbers(number, "the torque of a wheel", &cycle.wheel_torques, &outputs[3..])
}
