//! Local minima of the modulus margin over frequency: of 1/s1(S), with the largest singular value of the sensitivity.

use flexsc_numerics::scalar_search::maximum;
use nalgebra::{Complex, DMatrix};

use crate::eigenvalues::{complex_eigenvalues, eigenvalues};
use crate::margins::{
    FrequencyResponse, LoopSamples, ResidueResponse, coarse_frequency_grid, frequency_grid,
    largest_direction, largest_gain, modulus, unit_circle,
};
use crate::open_loop::{OpenLoop, TransferMatrices};

/// Sensitivity of a loop.
pub struct LoopSensitivity {
    response: FrequencyResponse,
    transfer: TransferMatrices,
    /// State matrix of the loop when it is cut open.
    open: DMatrix<f64>,
    /// Number of signals at the break.
    signals: usize,
    /// Period of the loop, and samples in it.
    pub samples: LoopSamples,
}

impl LoopSensitivity {
    /// Computes the sensitivity; `None` for a loop without one.
    pub fn new(opened: &OpenLoop) -> Option<Self> {
        let transfer = opened.transfer.sensitivity()?;
        Some(Self {
            response: FrequencyResponse::new(&transfer),
            transfer,
            open: opened.transfer.a.clone(),
            signals: opened.signals.len(),
            samples: LoopSamples { period: opened.period, count: opened.samples },
        })
    }

    /// Returns the poles of the closed loop.
    pub fn closed_poles(&self) -> Option<Vec<Complex<f64>>> {
        eigenvalues(&self.transfer.a)
    }

    /// Returns the poles of the loop when it is cut open. Without them, a grid follows the resonances of the closed loop
    /// alone.
    fn open_poles(&self) -> Vec<Complex<f64>> {
        eigenvalues(&self.open).unwrap_or_default()
    }

    /// Returns 1/s1(S) over frequency (rad/s), on a grid that follows the resonances; `None` if the poles cannot be
    /// computed.
    pub fn margins(&self) -> Option<Vec<(f64, f64)>> {
        let angles = frequency_grid(&self.closed_poles()?, &self.open_poles());
        Some(angles.into_iter().map(|angle| (angle / self.samples.period, self.margin_at(angle))).collect())
    }

    /// Returns 1/s1(S) at an angle (rad) of the unit circle.
    pub fn margin_at(&self, angle: f64) -> f64 {
        self.response.at(unit_circle(angle)).as_ref().map_or(f64::INFINITY, |value| 1.0 / largest_gain(value))
    }

    /// Returns the frequency (rad/s) of a minimum at an angle (rad) of the unit circle.
    pub fn frequency(&self, angle: f64) -> f64 {
        let direction = self.response.at(unit_circle(angle)).map(|value| largest_direction(&value));
        let motion = direction.as_ref().map_or(&[][..], |direction| direction.as_slice());
        self.samples.frequency(angle, motion).0
    }

    /// Returns the least loop gain of all signals at an angle (rad) of the unit circle, of each signal with the loops of
    /// the others closed: the largest eigenvalue of S^-1 - 1 of its samples.
    pub fn loop_gain_at(&self, angle: f64) -> f64 {
        let Some(value) = self.response.at(unit_circle(angle)) else { return f64::INFINITY };
        let gain = |signal: usize| {
            let own: Vec<usize> = (signal..value.nrows()).step_by(self.signals).collect();
            let block = DMatrix::from_fn(own.len(), own.len(), |row, column| value[(own[row], own[column])]);
            let one = DMatrix::<Complex<f64>>::identity(own.len(), own.len());
            let transfer = block.try_inverse().map(|inverse| inverse - one);
            let values = transfer.and_then(complex_eigenvalues).unwrap_or_default();
            values.iter().map(|value| modulus(*value)).fold(0.0, f64::max)
        };
        (0..self.signals).map(gain).fold(f64::INFINITY, f64::min)
    }

    /// Returns the angles (rad) and values of the local minima of 1/s1(S) that exceed the least by at most `within`.
    pub fn minima(&self, closed: &[Complex<f64>], within: f64) -> Vec<(f64, f64)> {
        let angles = coarse_frequency_grid(closed, &self.open_poles());
        let modal = ResidueResponse::new(&self.response, closed);
        let value = |angle: f64| {
            let z = unit_circle(angle);
            let scanned = modal.as_ref().map_or_else(|| self.response.scan(z), |modal| modal.at(z));
            scanned.as_ref().map_or(f64::INFINITY, |value| 1.0 / largest_gain(value))
        };
        let values: Vec<f64> = angles.iter().copied().map(value).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let last = values.len() - 1;
        let is_minimum = |k: &usize| {
            values[*k] <= least + within
                && (*k == 0 || values[k - 1] > values[*k])
                && (*k == last || values[k + 1] >= values[*k])
        };
        let refined = (0..=last).filter(is_minimum).map(|k| {
            let (low, high) = (angles[k.saturating_sub(1)], angles[(k + 1).min(last)]);
            // The value is flat at its minimum: the rounding of a scan moves the angle, and not the value there.
            let (angle, negative) = maximum(|angle| -value(angle), low, high);
            let angle = if -negative < values[k] { angle } else { angles[k] };
            (angle, self.margin_at(angle))
        });
        refined.collect()
    }
}
