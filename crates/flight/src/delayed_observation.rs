//! Measurement of an attitude filter that comes later than its exposure.

use crate::attitude_filter::AttitudeBiasFilter;
use crate::attitude_observation::{AttitudeObservation, Correction};
use crate::ticks::Ticks;

/// Measurement of the attitude or a vector with the time of its exposure.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DelayedObservation {
    /// Number of the sensor, of those that have a counter of refused readings; 0 is the gyro.
    pub sensor: usize,
    /// Time of the exposure.
    pub exposed: Ticks,
    /// Measured attitude or vector.
    pub observation: AttitudeObservation,
    /// Variance by which that of the attitude is inflated before the correction (rad²); 0 for most measurements.
    pub angle_inflation: f64,
    /// Variance by which that of the bias is inflated (rad²/s²).
    pub bias_inflation: f64,
}

impl DelayedObservation {
    /// Empty measurement, which fills storage.
    pub const NONE: Self = Self {
        sensor: 0,
        exposed: Ticks { whole: 0, part: 0 },
        observation: AttitudeObservation::NONE,
        angle_inflation: 0.0,
        bias_inflation: 0.0,
    };

    /// Corrects a filter, if the normalised innovation squared is at most `most_nis`.
    pub fn correct(&self, filter: &mut AttitudeBiasFilter, most_nis: f64) -> Correction {
        if self.angle_inflation > 0.0 {
            filter.inflate(self.angle_inflation, self.bias_inflation);
        }
        filter.observe(&self.observation, most_nis)
    }
}
