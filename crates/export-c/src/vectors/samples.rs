//! Samples of the sensors as calls of the attitude filter.

use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::control::estimator::attitude::initial_state;
use flexsc_core::control::sensor::{Orientation, Reading};
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::Instant;
use flexsc_core::{Scenario, SensorSample};
use flexsc_flight::attitude_estimator::observation_exposure;
use flexsc_flight::attitude_observation::ObservationKind;

use super::{CallVector, b_dot, kalman, rate};
use crate::control_system::{AttitudeUnit, ControlSystem};

/// Calls the attitude filter with the readings of a sample, and adds the calls; at the first sample the filter is started as in
/// the run.
pub(super) fn replay(
    system: &mut ControlSystem,
    scenario: &Scenario,
    sample: &SensorSample,
    vectors: &mut Vec<CallVector>,
) {
    if let ControlSystem::Sampled(laws) = &*system {
        if laws.filter.is_some() {
            return kalman::sample(system, sample, vectors);
        }
        if laws.rate_filter.is_some() {
            return rate::sample(system, sample, vectors);
        }
    }
    attitude(system, scenario, sample, vectors);
    b_dot::sample(system, sample, vectors);
}

/// Calls the attitude filter, and adds the calls.
fn attitude(
    system: &mut ControlSystem,
    scenario: &Scenario,
    sample: &SensorSample,
    vectors: &mut Vec<CallVector>,
) {
    let Some(unit) = system.estimator() else { return };
    let now = sample.now.ticks();
    let start = vectors.is_empty().then(|| start_inputs(scenario, sample)).flatten();
    let inputs = sample_inputs(unit, scenario, sample);
    if let Some(inputs) = start {
        let outputs = system.call(0, now, &inputs);
        vectors.push(CallVector { call: 0, now, inputs, outputs });
    }
    let outputs = system.call(1, now, &inputs);
    vectors.push(CallVector { call: 1, now, inputs, outputs });
}

/// Returns the words of the attitude and the bias with which the filter starts in the run.
fn start_inputs(scenario: &Scenario, sample: &SensorSample) -> Option<Vec<u64>> {
    let Some(EstimatorKind::Attitude(spec)) = &scenario.estimator else { return None };
    let setup = scenario.study.attitude.as_ref()?;
    let seed = Seed { scenario: scenario.seed, run: 0 };
    let state = initial_state(spec, setup, &mut seed.stream("prior"), sample.attitude.as_ref()?);
    let q = state.attitude;
    let words = [q.w, q.i, q.j, q.k, state.bias.x, state.bias.y, state.bias.z];
    Some(words.map(f64::to_bits).to_vec())
}

/// Returns the words of the inputs of a sample.
fn sample_inputs(unit: &AttitudeUnit, scenario: &Scenario, sample: &SensorSample) -> Vec<u64> {
    let reading = |sensor: usize| -> Option<&Reading> { sample.readings.get(sensor)?.as_ref() };
    let rate = reading(unit.gyro.0).and_then(|reading| reading.rate);
    let mut words = vec![u64::from(rate.is_some())];
    words.extend(rate.unwrap_or_default().map(f64::to_bits));
    for corrector in &unit.correctors {
        let own = reading(corrector.sensor);
        if corrector.observation.kind == ObservationKind::Attitude {
            let attitude = own.and_then(|reading| match reading.at {
                Orientation::Attitude(attitude) => Some(attitude),
                Orientation::Angle(_) => None,
            });
            words.push(u64::from(attitude.is_some()));
            let q = attitude.unwrap_or_default();
            words.extend([q.w, q.i, q.j, q.k].map(f64::to_bits));
        } else {
            let exposed = Instant::from_ticks(observation_exposure(
                sample.now.ticks(),
                corrector.latency,
                Instant::START.ticks(),
            ));
            let setup = scenario.study.attitude.as_ref();
            let sight = own.and_then(|reading| reading.sight).zip(setup);
            let measured = sight.map(|(sight, setup)| setup.with_reference(sight, exposed));
            words.push(u64::from(measured.is_some()));
            let [vector, inertial] =
                measured.map_or([[0.0; 3]; 2], |measured| [measured.vector.into(), measured.inertial.into()]);
            words.extend(vector.into_iter().chain(inertial).map(f64::to_bits));
        }
    }
    words
}
