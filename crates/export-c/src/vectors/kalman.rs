//! Samples of the sensors as calls of Kalman filters.

use flexsc_core::SensorSample;
use flexsc_flight::ticks::Ticks;

use super::CallVector;
use crate::control_system::ControlSystem;

/// Calls the filters with a sample, and adds the calls; at the first sample they are started as in the run.
pub(super) fn sample(system: &mut ControlSystem, sample: &SensorSample, vectors: &mut Vec<CallVector>) {
    let ControlSystem::Sampled(laws) = &*system else { return };
    let Some(unit) = &laws.filter else { return };
    let (axes, now) = (unit.axes.len(), sample.now.ticks());
    if vectors.is_empty() {
        let prior = unit.axes.iter().flat_map(|axis| &axis.prior).map(|mean| mean.to_bits()).collect();
        add(system, 0, now, prior, vectors);
    }
    shift(system, now, sample.shift, vectors);
    let mut inputs: Vec<u64> = sample.known_inputs[..axes].iter().map(|moment| moment.to_bits()).collect();
    inputs.push(u64::from(sample.measured.is_some()));
    for part in 0..2 {
        let value = |axis: usize| sample.measured.as_ref().map_or(0.0, |measured| measured[axis][part]);
        inputs.extend((0..axes).map(|axis| value(axis).to_bits()));
    }
    add(system, 1, now, inputs, vectors);
}

/// Calls the filters with the shift of the angles by a new target, if there is one, and adds the call.
pub(super) fn shift(
    system: &mut ControlSystem,
    now: Ticks,
    shift: Option<[f64; 3]>,
    vectors: &mut Vec<CallVector>,
) {
    let ControlSystem::Sampled(laws) = &*system else { return };
    let is_about_three = laws.filter.as_ref().is_some_and(|unit| unit.axes.len() == 3);
    if let Some(shift) = shift.filter(|_| is_about_three && !vectors.is_empty()) {
        add(system, 2, now, shift.map(f64::to_bits).to_vec(), vectors);
    }
}

/// Calls a function, and adds the call.
fn add(system: &mut ControlSystem, call: usize, now: Ticks, inputs: Vec<u64>, vectors: &mut Vec<CallVector>) {
    let outputs = system.call(call, now, &inputs);
    vectors.push(CallVector { call, now, inputs, outputs });
}
