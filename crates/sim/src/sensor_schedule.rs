//! Sampling schedule of one sensor, with its last readings.

use flexsc_control::sensor::{ExposureMean, Reading, Sensor, Truth};
use flexsc_numerics::time::{Instant, Span};

/// Sensor with its sampling schedule.
#[derive(Clone, Debug)]
pub struct SensorSchedule {
    pub sensor: Box<dyn Sensor>,
    /// True if the sensor measures the attitude or angle, not only rates.
    pub provides_attitude: bool,
    pub period: Option<Span>,
    pub next: Option<Instant>,
    /// Reading before the newest one.
    pub last: Option<Reading>,
    /// True for the magnetometer that provides the field.
    pub is_field_source: bool,
    /// True if rates are derived from differences of the sensor's angles.
    pub derives_rates: bool,
}

impl SensorSchedule {
    /// Hands the mean of the exposure that ends now to the sensor.
    pub fn close_exposure(&mut self, exposure: &ExposureMean) {
        self.sensor.close_exposure(exposure);
    }

    /// Returns the rates (rad/s) of a sensor that measures angles only: differences over the period, and the true rates
    /// at first.
    pub fn differentiated_rates(&self, now: Instant, reading: &Reading, truth: &Truth) -> Option<[f64; 3]> {
        if !self.derives_rates {
            return None;
        }
        let (Some(period), true) = (self.period, now > Instant::START) else { return Some(truth.rate) };
        // Without a previous reading, differences count from angle 0, or from the attitude itself.
        let last = self.last.map_or_else(|| reading.at.difference_origin(), |last| last.at);
        Some(reading.at.error_from(&last).map(|difference| difference / period.seconds()))
    }
}
