//! Elastic modes of a spatial body whose frequencies drift: each by the Taylor series of its equation, exact to
//! rounding.

use flexsc_numerics::quantity::Finite;

use super::DriftingFlow;
use crate::ModeState;
use crate::axis_model::{AxisMode, AxisModel};
use crate::frequency_drift::FrequencyDrift;
use crate::three_axis_model::{ThreeAxisMode, ThreeAxisModel};

/// Motion of the drifting modes under modal forces that are constant for a while.
#[derive(Clone, Debug)]
pub struct DriftingModes {
    /// One motion for each mode, as the only mode of a one-axis body whose moment is the modal force.
    modes: Vec<DriftingFlow>,
    drift: FrequencyDrift,
    /// Frequencies at the start of the run (rad/s).
    frequencies: Vec<f64>,
}

impl DriftingModes {
    /// Creates the modes in their initial state, under no force.
    pub fn new(body: &ThreeAxisModel, drift: &FrequencyDrift) -> Self {
        let gain = Finite::new(1.0).unwrap_or_default();
        let alone = |(index, mode): (usize, &ThreeAxisMode)| {
            let own = match drift {
                FrequencyDrift::Common(profile) => FrequencyDrift::Common(profile.clone()),
                FrequencyDrift::Each(profiles) => {
                    FrequencyDrift::Each(profiles.get(index).cloned().into_iter().collect())
                }
            };
            let start = AxisMode {
                displacement: mode.displacement,
                rate: mode.rate,
                ..AxisMode::at_rest(mode.frequency, gain, mode.damping)
            };
            DriftingFlow::new(&AxisModel { modes: vec![start], ..AxisModel::default() }, &own, 0.0, false)
        };
        Self {
            modes: body.modes.iter().enumerate().map(alone).collect(),
            drift: drift.clone(),
            frequencies: body.modes.iter().map(|mode| mode.frequency.get()).collect(),
        }
    }

    /// Begins a motion under constant modal forces (N/sqrt(kg)), from the current state, at the time `now` (s).
    pub fn depart(&mut self, now: f64, forces: &[f64]) {
        let forces = forces.iter().copied().chain(std::iter::repeat(0.0));
        for (mode, force) in self.modes.iter_mut().zip(forces) {
            mode.zero_rigid_angle();
            mode.depart(now, force);
        }
    }

    /// Advances the modes to `h` seconds after departure, which must not precede an earlier request. A phase holds q
    /// and q'/w, with w at the start of the run.
    pub fn advance(&mut self, h: f64, phases: &mut [ModeState]) {
        for ((mode, w), phase) in self.modes.iter_mut().zip(&self.frequencies).zip(phases) {
            mode.advance(h);
            if let Some([displacement, rate, _]) = mode.motion().nth(1) {
                *phase = ModeState { displacement, quadrature: rate / w };
            }
        }
    }

    /// Returns the largest ratio of a mode's frequency at a time (s) to that at the start.
    pub fn ratio(&self, t: f64) -> f64 {
        (0..self.frequencies.len()).map(|index| self.drift.ratio(index, t)).fold(0.0, f64::max)
    }

    /// Returns the kinetic and strain energy of each mode at a time `t` (s) (J): (q'² + w² q²)/2.
    pub fn energies(&self, t: f64, phases: &[ModeState]) -> Vec<f64> {
        let energy = |(index, (phase, w)): (usize, (&ModeState, &f64))| {
            let (rate, stretch) = (w * phase.quadrature, self.drift.ratio(index, t) * w * phase.displacement);
            0.5 * (rate * rate + stretch * stretch)
        };
        phases.iter().zip(&self.frequencies).enumerate().map(energy).collect()
    }
}
