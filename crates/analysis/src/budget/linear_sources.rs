//! Sources of a pointing index by the linear loop of a scenario: the bias under steady disturbances, the sines under
//! periodic ones, and noise, each at every place of the index and for every point of an ensemble.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::axes::Axis;
use flexsc_spacecraft::disturbance::Disturbance;
use nalgebra::Complex;

use super::linear_noise::{
    index_variances, index_vibration, line_variances, linear_noise, output_names, set_starts,
};
use super::{ErrorSources, SourceCombination};
use crate::margins::frequency_response::{modulus, unit_circle};
use crate::noise::{LineLoop, NoisyLoop, TurningMotion};
use flexsc_scenario::{SampledError, Scenario};

/// Value of an index, relative to its largest sample, that is rounding.
const ROUNDING: f64 = 1e-13;

/// Torque amplitude sin(w t + phase) about an axis of the body (N m, rad).
type AxisSine = (usize, f64, f64);

/// Linear loop of a scenario under its noise and its disturbances.
pub struct DisturbedLoop<'a> {
    noisy: NoisyLoop,
    lines: LineLoop<'a>,
}

/// Index of one component of an error in a linear loop.
struct DisturbedIndex<'a> {
    within: &'a DisturbedLoop<'a>,
    error: &'a SampledError,
    output: usize,
    /// Variance under the noise at each place of each set of samples.
    variances: Vec<f64>,
    /// Amplitudes of the index at each place of a set under each line of machines.
    tones: Vec<Vec<f64>>,
    /// Index at each place under a torque cos w t of 1 N m, by the frequency w and the axis.
    responses: BTreeMap<(u64, usize), Vec<Complex<f64>>>,
}

impl<'a> DisturbedLoop<'a> {
    /// Returns the loop of a scenario; `None` if it is not linear, or not stable.
    pub fn from_scenario(scenario: &'a Scenario) -> Option<Self> {
        let noisy = NoisyLoop::from_scenario(scenario).ok()?;
        Some(Self { noisy, lines: LineLoop::from_scenario(scenario).ok()? })
    }

    /// Returns the rms of the index of an error under the noise of the loop: see [`linear_noise`].
    ///
    /// # Errors
    /// See [`linear_noise`].
    pub fn noise(&self, error: &SampledError) -> Result<Option<f64>, ConfigError> {
        linear_noise(&self.noisy, Some(&self.lines), error)
    }

    /// Returns the loop under its noise.
    pub fn noisy(&self) -> &NoisyLoop {
        &self.noisy
    }

    fn index(&'a self, error: &'a SampledError) -> Result<Option<DisturbedIndex<'a>>, ConfigError> {
        let names = output_names(error);
        let outputs: Vec<usize> = names.iter().filter_map(|name| self.noisy.output(name)).collect();
        let &[output] = &outputs[..] else { return Ok(None) };
        let vibration = index_vibration(&self.lines, &[output], error)?;
        let tone = |line| {
            let variances = line_variances(std::iter::once(line), error)?;
            Some(variances.iter().map(|variance| f64::sqrt(2.0 * variance)).collect())
        };
        let tones = vibration.lines(output, false).map(tone).collect::<Option<_>>();
        let variances = index_variances((&self.noisy, &vibration), output, error);
        Ok(variances.zip(tones).map(|(variances, tones)| DisturbedIndex {
            within: self,
            error,
            output,
            variances,
            tones,
            responses: BTreeMap::new(),
        }))
    }
}

/// Returns the sources of the indices of some components of errors about the target at rest: the bias under the steady
/// torques of all disturbances together, the amplitude under each of their sines and under the periodic torque of the body,
/// and the rms of the noise. `points` are the equally likely scenarios of an ensemble, whose loop is that of the `nominal`
/// one if they share it. `None` for an index that the loop of a point does not have. Pulses, steady forces and the imbalance of wheels
/// are left out; machines with lines are at their worst frequency for the index.
///
/// # Errors
/// A frequency at which a motion without damping grows without limit; see [`Vibration::new`](crate::noise::Vibration::new).
pub fn linear_sources(
    nominal: &DisturbedLoop<'_>,
    points: &[Scenario],
    share_loop: bool,
    errors: &[&SampledError],
) -> Result<Vec<Option<ErrorSources>>, ConfigError> {
    let mut found: Vec<Option<Vec<SourceCombination>>> = vec![Some(Vec::new()); errors.len()];
    let mut add = |indices: &mut [Option<DisturbedIndex<'_>>], scenario: &Scenario| {
        for (sum, index) in found.iter_mut().zip(indices) {
            let own = index.as_mut().map(|index| index.combinations(scenario)).transpose()?;
            *sum = sum.take().zip(own).map(|(sum, own)| [sum, own].concat());
        }
        Ok(())
    };
    if share_loop {
        let mut indices = errors.iter().map(|error| nominal.index(error)).collect::<Result<Vec<_>, _>>()?;
        for scenario in points {
            add(&mut indices, scenario)?;
        }
    } else {
        for scenario in points {
            let Some(own) = DisturbedLoop::from_scenario(scenario) else {
                return Ok(vec![None; errors.len()]);
            };
            let mut indices = errors.iter().map(|error| own.index(error)).collect::<Result<Vec<_>, _>>()?;
            add(&mut indices, scenario)?;
        }
    }
    Ok(found.into_iter().map(|all| all.map(ErrorSources::new)).collect())
}

/// Returns the torques among a scenario's disturbances, each with the index of its axis, without pulses.
fn torques(scenario: &Scenario) -> impl Iterator<Item = (usize, &Disturbance)> {
    let torques = scenario.disturbance.iter().filter(|own| !own.is_force() && own.pulse.is_none());
    torques.map(|own| (own.about.map_or(0, Axis::index), own))
}

/// Returns the steady torques on a scenario's body.
fn steady_torques(scenario: &Scenario) -> Vec<AxisSine> {
    let own = scenario.model.three_axis().and_then(|body| body.disturbance);
    let constant = own.into_iter().flat_map(|own| (0..3).map(move |axis| (axis, own.constant[axis])));
    let all = torques(scenario).map(|(axis, own)| (axis, own.torque.get())).chain(constant);
    all.map(|(axis, torque)| (axis, torque, FRAC_PI_2)).collect()
}

/// Returns the sines of the torques on a scenario's body, those of one frequency (rad/s) together.
fn sine_torques(scenario: &Scenario) -> Vec<(f64, Vec<AxisSine>)> {
    let mut all: Vec<(f64, Vec<AxisSine>)> = Vec::new();
    let mut add = |frequency: f64, torque: AxisSine| match all.iter_mut().find(|own| own.0 == frequency) {
        Some((_, torques)) => torques.push(torque),
        None => all.push((frequency, vec![torque])),
    };
    for (axis, disturbance) in torques(scenario) {
        for sine in &disturbance.sines {
            add(sine.frequency.get(), (axis, sine.amplitude.get(), sine.phase.get()));
        }
    }
    let own = scenario.model.three_axis().and_then(|body| body.disturbance);
    if let Some(own) = own.filter(|own| own.amplitude.norm() > 0.0) {
        (0..3).for_each(|axis| add(own.frequency(), (axis, own.amplitude[axis], own.phase[axis])));
    }
    all
}

/// Returns the frequencies (rad/s) of the sines of the torques on a scenario's body.
pub fn sine_frequencies(scenario: &Scenario) -> Vec<f64> {
    sine_torques(scenario).into_iter().map(|(frequency, _)| frequency).collect()
}

impl DisturbedIndex<'_> {
    /// Returns the sources at each place of each set of samples under the disturbances of a scenario with this loop.
    fn combinations(&mut self, scenario: &Scenario) -> Result<Vec<SourceCombination>, ConfigError> {
        let bias = self.values(0.0, &steady_torques(scenario))?;
        let sines = sine_torques(scenario);
        let sines = sines.iter().map(|(frequency, torques)| self.values(*frequency, torques));
        let sines = sines.collect::<Result<Vec<_>, _>>()?;
        let combination = |(place, variance): (usize, &f64)| SourceCombination {
            weight: 1.0,
            bias: bias[place].re,
            amplitudes: sines
                .iter()
                .map(|sine| modulus(sine[place]))
                .chain(self.tones.iter().map(|tone| tone[place % tone.len()]))
                .collect(),
            noise: f64::sqrt(*variance),
        };
        Ok(self.variances.iter().enumerate().map(combination).collect())
    }

    /// Returns the complex values of the index at each place under torques of one frequency (rad/s) together.
    fn values(&mut self, frequency: f64, torques: &[AxisSine]) -> Result<Vec<Complex<f64>>, ConfigError> {
        let mut sum = vec![Complex::ZERO; self.variances.len()];
        for (axis, amplitude, phase) in torques.iter().filter(|(_, amplitude, _)| *amplitude != 0.0) {
            // sin(w t + phase) is the real part of -j exp(j phase) exp(j w t).
            let factor = unit_circle(phase - FRAC_PI_2) * *amplitude;
            let key = (frequency.to_bits(), *axis);
            if !self.responses.contains_key(&key) {
                let load = self.within.lines.torque(*axis);
                let motion = self.within.lines.motion(frequency, &load)?;
                self.responses.insert(key, self.response(&motion));
            }
            for (sum, value) in sum.iter_mut().zip(&self.responses[&key]) {
                *sum += value * factor;
            }
        }
        Ok(sum)
    }

    /// Returns the complex values of the index at each place under the load of a motion.
    fn response(&self, motion: &TurningMotion) -> Vec<Complex<f64>> {
        let (times, starts) = set_starts(self.error, self.within.noisy.period_ticks());
        let (index, length) = (self.error.index, self.error.index.reach());
        let weights = index.weights(0);
        let of_set = |start: u64| {
            let places = times.places(start, length, motion.period);
            let values = motion.values(self.output, places);
            let rounding = ROUNDING * values.iter().map(|value| modulus(*value)).fold(0.0, f64::max);
            let exact = |value: Complex<f64>| if modulus(value) > rounding { value } else { Complex::ZERO };
            if index.places() == 1 {
                let sum: Complex<f64> =
                    values.iter().zip(&weights).map(|(value, weight)| value * *weight).sum();
                return vec![exact(sum)];
            }
            let mean = values.iter().sum::<Complex<f64>>() / values.len() as f64;
            values.into_iter().map(|value| exact(value - mean)).collect()
        };
        starts.into_iter().flat_map(of_set).collect()
    }
}
