//! Settings of a sensor: its period, its noise, and what it measures, before a run.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Span;
use nalgebra::Matrix3;

use super::linear_noise::KeyNoise;
use super::measured_quantity::quantities_of_motion;
use super::{FieldOfView, Gyro, LinearMeasurement, MeasuredQuantity, ReferenceNoise, Sensor, SensorFailure};
use crate::offers::Offers;
use crate::requirement::Requirements;

/// Subject of a sensor's measurements.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Orientation or rates of the body.
    Motion,
    /// Magnetic field along the body's axes.
    Field,
    /// Direction in the body's axes.
    Direction,
    /// Another quantity, which says nothing of the body's motion.
    Other,
}

/// Settings of a sensor.
pub trait SensorSpec: Send + Sync {
    /// Returns the sensor's run-time state on a body with `axes` axes; `ordinal` counts earlier sensors of the same kind.
    fn start(&self, axes: usize, seed: Seed, ordinal: usize) -> Box<dyn Sensor>;

    /// Returns the period of the samples of the body's motion, under a law with period `law`; `None` for a continuous
    /// sensor, and for one that measures nothing of the motion.
    fn period(&self, law: Option<Span>) -> Option<Span>;

    /// Returns the period of the samples that does not follow from a law, of the body's motion or for the log.
    fn own_period(&self) -> Option<Span> {
        self.period(None)
    }

    /// Returns the subject of the measurements.
    fn subject(&self) -> Subject {
        Subject::Motion
    }

    /// Returns the point of the structure at which the sensor is mounted, if given.
    fn point(&self) -> Option<&str> {
        None
    }

    /// Returns the sensor's failures.
    fn faults(&self) -> &[SensorFailure] {
        &[]
    }

    /// Checks the settings against each other; returns the first inconsistent key and the reason.
    fn validate(&self) -> Option<ConfigError> {
        None
    }

    /// Adds the requirements of the sensor on the other parts of a scenario.
    fn requires(&self, _ordinal: usize, _offers: &Offers, _needs: &mut Requirements) {}

    /// Returns true if the sensor measures the motion at every instant.
    fn is_continuous(&self) -> bool {
        false
    }

    /// Returns true if the sensor measures the mean rate over each of its periods.
    fn integrates(&self) -> bool {
        false
    }

    /// Returns the latency of the rates.
    fn rate_latency(&self) -> Span {
        Span::ZERO
    }

    /// Returns the exposure time.
    fn exposure(&self) -> Span {
        Span::ZERO
    }

    /// Returns the field of view, if the sensor has one that leaves out directions.
    fn field_of_view(&self) -> Option<FieldOfView> {
        None
    }

    /// Returns the direction in which the sensor looks, a unit vector in the body's axes, if there is one.
    fn boresight(&self) -> Option<Vector> {
        self.field_of_view().map(|field| field.boresight)
    }

    /// Returns the standard deviation of the measured angle (rad), including quantisation.
    fn angle_noise(&self) -> f64 {
        0.0
    }

    /// Returns the standard deviation of a measured rate about an axis (rad/s), if rates are measured.
    fn rate_noise(&self, _axis: usize) -> Option<f64> {
        None
    }

    /// Returns the latency and the noise of the attitude or vector that the sensor measures; `None` for other sensors.
    fn reference(&self) -> Option<(Span, ReferenceNoise)> {
        None
    }

    /// Returns the covariance of a measured attitude in the body's axes, from the standard deviation about each axis of the
    /// sensor (rad).
    fn attitude_covariance(&self, noise: [f64; 3]) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector::from(noise.map(|noise| noise * noise)))
    }

    /// Returns the linear form of the sensor; `None` for a sensor that does not measure angles and rates.
    fn linear_measurement(&self) -> Option<LinearMeasurement> {
        None
    }

    /// Returns the noise of the sensor's keys about `axes` axes, with `period` (s) from reading to reading; `None` for a
    /// sensor whose noise has no linear model.
    fn linear_noise(&self, _axes: usize, _period: f64) -> Option<Vec<KeyNoise>> {
        None
    }

    /// Returns the key and the reason for which the noise of the only sensor of a loop with a period has no linear model.
    fn noise_fault(&self, _period: Span) -> Option<(&'static str, &'static str)> {
        None
    }

    /// Returns the quantities that the sensor measures on a body with `axes` axes, of which it is the source of the attitude
    /// or not.
    fn measured_quantities(&self, provides_attitude: bool, axes: usize) -> Vec<MeasuredQuantity> {
        quantities_of_motion(provides_attitude, self.is_continuous() || self.rate_noise(0).is_some(), axes)
    }

    /// Returns the gyro, if the sensor is one.
    fn gyro(&self) -> Option<&Gyro> {
        None
    }
}

impl dyn SensorSpec {
    /// Returns true if the sensor measures orientation or rates of the body.
    pub fn measures_motion(&self) -> bool {
        self.subject() != Subject::Other
    }

    /// Returns true if the sensor measures a vector, which alone does not determine the attitude.
    pub fn measures_vector(&self) -> bool {
        matches!(self.subject(), Subject::Field | Subject::Direction)
    }

    /// Returns true if the sensor measures the magnetic field.
    pub fn measures_field(&self) -> bool {
        self.subject() == Subject::Field
    }
}
