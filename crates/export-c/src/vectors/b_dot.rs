//! Samples of the magnetic field and decisions of B-dot laws as calls.

use flexsc_core::{ControlDecision, SensorSample};

use super::{CallVector, VectorError, call, compare, compare_commands};
use crate::control_system::{BDotLaws, ControlSystem, FieldUnit};

/// Returns the rate of change of the field that B-dot laws read.
fn field_unit(system: &ControlSystem) -> Option<&FieldUnit> {
    match system {
        ControlSystem::BDot(own) => Some(&own.field),
        ControlSystem::Modes(modes) => modes.field.as_ref(),
        ControlSystem::Relays(_) | ControlSystem::Sampled(_) => None,
    }
}

/// Calls the function of the field with the reading of the magnetometer, if there is one, and adds the call.
pub(super) fn sample(system: &mut ControlSystem, sample: &SensorSample, vectors: &mut Vec<CallVector>) {
    let Some(unit) = field_unit(system) else { return };
    let reading = sample.readings.get(unit.sensor).and_then(Option::as_ref);
    let Some(sight) = reading.and_then(|reading| reading.sight) else { return };
    let inputs = sight.vector.iter().map(|component| component.to_bits()).collect();
    call(system, "field", sample.now.ticks(), inputs, vectors);
}

/// Fails if the laws have read another rate of change in the engine.
pub(super) fn compare_rate(
    system: &ControlSystem,
    decision: &ControlDecision,
    number: usize,
) -> Result<(), VectorError> {
    let Some(known) = field_unit(system).map(|unit| unit.field.rate_at(decision.now.ticks())) else {
        return Ok(());
    };
    for (axis, own) in decision.axes.iter().zip([known.x, known.y, known.z]) {
        compare(number, "the rate of change of the field", axis.estimate.field_rate, own)?;
    }
    Ok(())
}

/// Calls the step of B-dot laws alone, and adds the call.
pub(super) fn step(
    system: &mut ControlSystem,
    decision: &ControlDecision,
    vectors: &mut Vec<CallVector>,
) -> Result<(), VectorError> {
    compare_rate(system, decision, vectors.len())?;
    let ControlSystem::BDot(own) = &*system else { return Ok(()) };
    let BDotLaws { limits, .. } = own.laws;
    let outputs = call(system, "step", decision.now.ticks(), Vec::new(), vectors);
    compare_commands(vectors.len() - 1, decision, &outputs, limits)
}
