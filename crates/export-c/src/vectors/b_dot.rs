//! Samples of the magnetic field and decisions of B-dot laws as calls.

use flexsc_core::control::law::Command;
use flexsc_core::{ControlDecision, SensorSample};
use flexsc_flight::b_dot::limited_moment;

use super::{CallVector, VectorError, compare};
use crate::control_system::ControlSystem;

/// Calls the sample of the field with the reading of the magnetometer, if there is one, and adds the call.
pub(super) fn sample(system: &mut ControlSystem, sample: &SensorSample, vectors: &mut Vec<CallVector>) {
    let ControlSystem::BDot(laws) = &*system else { return };
    let reading = sample.readings.get(laws.magnetometer).and_then(Option::as_ref);
    let Some(sight) = reading.and_then(|reading| reading.sight) else { return };
    let now = sample.now.ticks();
    let inputs: Vec<u64> = sight.vector.iter().map(|component| component.to_bits()).collect();
    let outputs = system.call(0, now, &inputs);
    vectors.push(CallVector { call: 0, now, inputs, outputs });
}

/// Calls the step of the laws with the rate of change that the engine's laws read, and adds the call.
pub(super) fn step(
    system: &mut ControlSystem,
    decision: &ControlDecision,
    vectors: &mut Vec<CallVector>,
) -> Result<(), VectorError> {
    let ControlSystem::BDot(laws) = &*system else { return Ok(()) };
    let (limits, known) = (laws.limits, laws.field.rate);
    let now = decision.now.ticks();
    let rates: Vec<f64> = decision.axes.iter().map(|axis| axis.estimate.field_rate).collect();
    for (rate, own) in rates.iter().zip([known.x, known.y, known.z]) {
        compare(vectors.len(), "the rate of change of the field", *rate, own)?;
    }
    let inputs: Vec<u64> = rates.into_iter().map(f64::to_bits).collect();
    let outputs = system.call(1, now, &inputs);
    for axis in &decision.axes {
        let Command::Moment(moment) = axis.output.command else { continue };
        let limited = limited_moment(moment, limits[axis.axis]);
        compare(vectors.len(), "the magnetic moment", limited, f64::from_bits(outputs[axis.axis]))?;
    }
    vectors.push(CallVector { call: 1, now, inputs, outputs });
    Ok(())
}
