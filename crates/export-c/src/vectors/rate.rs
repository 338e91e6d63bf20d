//! Samples of the sensors as calls of filters of the rigid rates.

use flexsc_core::SensorSample;

use super::CallVector;
use crate::control_system::ControlSystem;

/// Calls the filters with a sample, and adds the call.
pub(super) fn sample(system: &mut ControlSystem, sample: &SensorSample, vectors: &mut Vec<CallVector>) {
    let ControlSystem::Sampled(laws) = &*system else { return };
    let Some(unit) = &laws.rate_filter else { return };
    let axes = unit.axes.len();
    let rate = |axis: usize| sample.measured.as_ref().map_or(0.0, |measured| measured[axis][1]);
    let mut inputs = vec![u64::from(sample.measured.is_some())];
    inputs.extend((0..axes).map(|axis| rate(axis).to_bits()));
    inputs.extend(sample.known_inputs[..axes].iter().map(|change| change.to_bits()));
    let now = sample.now.ticks();
    let outputs = system.call(0, now, &inputs);
    vectors.push(CallVector { call: 0, now, inputs, outputs });
}
