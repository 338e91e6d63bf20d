//! Settings of a sensor that another crate provides.

use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Span;

use super::Sensor;

/// Settings of a sensor that another crate provides.
pub trait SensorSpec: Send + Sync {
    /// Returns the sensor's run-time state on a body with `axes` axes.
    fn start(&self, axes: usize, seed: Seed) -> Box<dyn Sensor>;

    /// Returns the period of the samples.
    fn period(&self) -> Span;

    /// Returns the standard deviation of the measured angle (rad).
    fn angle_noise(&self) -> f64 {
        0.0
    }

    /// Returns the standard deviation of the measured rate (rad/s), if rates are measured.
    fn rate_noise(&self) -> Option<f64> {
        None
    }
}
