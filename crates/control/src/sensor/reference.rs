//! References of sensors: the measured attitude or vector by which an attitude filter corrects its estimate.

use nalgebra::Matrix3;

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
