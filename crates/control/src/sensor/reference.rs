//! References of sensors: the measured attitude or vector by which an attitude filter corrects its estimate.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::NonNegative;
use flexsc_numerics::time::Span;
use nalgebra::Matrix3;

use super::{Gyro, SensorKind};

/// Measured attitude or vector of a sensor, with its noise.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum ReferenceNoise {
    /// Attitude, with the standard deviation about each axis (rad).
    Attitude([f64; 3]),
    /// Magnetic field, with the covariance of its components (T²).
    MagneticField(Matrix3<f64>),
    /// Direction to the Sun, with the covariance of its components.
    Sun(Matrix3<f64>),
    /// Direction to the planet's centre, with the covariance of its components.
    Earth(Matrix3<f64>),
}

impl SensorKind {
    /// Returns the latency and the noise of the attitude or vector that the sensor measures; `None` for other sensors.
    pub fn reference(&self) -> Option<(Span, ReferenceNoise)> {
        match self {
            Self::StarTracker(tracker) => {
                Some((tracker.latency(), ReferenceNoise::Attitude(tracker.noise.map(NonNegative::get))))
            }
            Self::Sampled(sampled) => {
                Some((Span::ZERO, ReferenceNoise::Attitude([sampled.angle_noise(); 3])))
            }
            Self::Magnetometer(magnetometer) => {
                Some((magnetometer.latency(), ReferenceNoise::MagneticField(magnetometer.covariance())))
            }
            Self::SunSensor(sensor) => Some((sensor.latency(), ReferenceNoise::Sun(sensor.covariance()))),
            Self::SunCells(sensor) => Some((sensor.latency(), ReferenceNoise::Sun(sensor.covariance()))),
            Self::EarthSensor(sensor) => Some((sensor.latency(), ReferenceNoise::Earth(sensor.covariance()))),
            Self::Continuous
            | Self::Gyro(_)
            | Self::Tachometer(_)
            | Self::Accelerometer(_)
            | Self::Own(_) => None,
        }
    }

    /// Returns the covariance of a measured attitude in the body's axes, from the standard deviation about each axis of the
    /// sensor (rad).
    pub fn attitude_covariance(&self, noise: [f64; 3]) -> Matrix3<f64> {
        match self {
            Self::StarTracker(tracker) => tracker.covariance(noise),
            _ => Matrix3::from_diagonal(&Vector::from(noise.map(|noise| noise * noise))),
        }
    }

    /// Returns the gyro, if the sensor is one.
    pub fn gyro(&self) -> Option<&Gyro> {
        if let Self::Gyro(gyro) = self { Some(gyro) } else { None }
    }
}
