//! Inputs of an attitude filter: the measurements that correct an attitude.

use flexsc_flight::attitude_observation::{self, AttitudeObservation, ObservationKind};
use flexsc_flight::delayed_observation::DelayedObservation;
use flexsc_flight::matrix6::Matrix6x3 as FlightGain;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::flight_types::{to_matrix3, to_matrix6x3, to_quaternion, to_vector3};
use flexsc_numerics::time::Instant;
use nalgebra::{Matrix3, Matrix6x3, Quaternion, SMatrix};

use crate::sensor::VectorMeasurement;

/// Measurement with the time of its exposure.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DelayedMeasurement {
    /// Time of the exposure.
    pub exposed: Instant,
    /// Measured attitude or vector.
    pub measured: AttitudeMeasurement,
    /// Covariance of the measurement error in the body's axes (rad², or that of the vector's unit).
    pub noise: Matrix3<f64>,
    /// Constant gain, of a filter that has one.
    pub gain: Option<Matrix6x3<f64>>,
    /// Index of the sensor.
    pub sensor: usize,
}

impl DelayedMeasurement {
    /// Returns the measurement in flight code.
    pub fn to_flight(&self) -> DelayedObservation {
        let mut observation = AttitudeObservation {
            noise: to_matrix3(&self.noise),
            has_gain: self.gain.is_some(),
            gain: self.gain.as_ref().map_or(FlightGain::ZERO, to_matrix6x3),
            ..AttitudeObservation::NONE
        };
        match &self.measured {
            AttitudeMeasurement::Attitude(attitude) => observation.attitude = to_quaternion(attitude),
            AttitudeMeasurement::Vector(measurement) => {
                observation.kind = if measurement.is_direction {
                    ObservationKind::Direction
                } else {
                    ObservationKind::Vector
                };
                observation.vector = to_vector3(&measurement.vector);
                observation.inertial = to_vector3(&measurement.inertial);
            }
        }
        let (sensor, exposed) = (self.sensor, self.exposed.ticks());
        DelayedObservation { sensor, exposed, observation, ..DelayedObservation::NONE }
    }
}

/// Measurement that corrects an attitude.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum AttitudeMeasurement {
    /// Measured attitude.
    Attitude(Quaternion<f64>),
    /// Measured vector.
    Vector(VectorMeasurement),
}

impl AttitudeMeasurement {
    /// Returns the number of components: 2 of a direction, else 3.
    pub fn dimension(&self) -> u32 {
        if matches!(self, Self::Vector(VectorMeasurement { is_direction: true, .. })) { 2 } else { 3 }
    }
}

/// Returns two unit vectors perpendicular to `v` and to each other, as rows.
pub fn perpendicular_pair(v: &Vector) -> SMatrix<f64, 2, 3> {
    let rows = attitude_observation::perpendicular_pair(&to_vector3(v)).rows;
    SMatrix::from_fn(|row, column| rows[row][column])
}
