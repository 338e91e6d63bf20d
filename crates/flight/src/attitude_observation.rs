//! Measurements that correct an attitude, and the corrections by them.

use crate::matrix3::Matrix3;
use crate::matrix6::Matrix6x3;
use crate::quaternion::Quaternion;
use crate::reading_status::ReadingStatus;
use crate::vector3::Vector3;

/// Quantity that a sensor measures.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ObservationKind {
    /// Attitude, as of a star tracker.
    Attitude,
    /// Vector with its length, as of a magnetometer.
    Vector,
    /// Direction of a vector, as of a sun sensor.
    Direction,
}

/// Measured attitude or vector.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeObservation {
    /// Quantity that is measured.
    pub kind: ObservationKind,
    /// Measured attitude, of a sensor of the attitude.
    pub attitude: Quaternion,
    /// Measured vector in the body's axes, of a sensor of vectors; of length 1 for a direction.
    pub vector: Vector3,
    /// Reference of the measured vector in inertial axes; of length 1 for a direction.
    pub inertial: Vector3,
    /// Covariance of the measurement error in the body's axes (rad², or that of the vector's unit).
    pub noise: Matrix3,
    /// True if the filter corrects with the constant gain.
    pub has_gain: bool,
    /// Constant gain from the measured angle relative to the estimate to attitude and bias, of a filter that has one.
    pub gain: Matrix6x3,
}

impl AttitudeObservation {
    /// Empty observation, which fills storage.
    pub const NONE: Self = Self {
        kind: ObservationKind::Attitude,
        attitude: Quaternion::IDENTITY,
        vector: Vector3::ZERO,
        inertial: Vector3::ZERO,
        noise: Matrix3::ZERO,
        has_gain: false,
        gain: Matrix6x3::ZERO,
    };
}

/// Result of a correction.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Correction {
    /// Innovation: measured attitude relative to the predicted one, in body axes (rad); for a vector, the part
    /// perpendicular to it.
    pub innovation: Vector3,
    /// Normalised innovation squared; for a direction, which has two components, multiplied by 3/2.
    pub nis: f64,
    /// Number of components of the measurement.
    pub components: u32,
    /// Outcome of the measurement.
    pub status: ReadingStatus,
}

impl Correction {
    /// Result of a measurement that changed nothing.
    pub const NONE: Self =
        Self { innovation: Vector3::ZERO, nis: 0.0, components: 0, status: ReadingStatus::None };

    /// Returns the result of a measurement that has changed nothing for this reason.
    #[inline]
    pub fn unused(status: ReadingStatus) -> Self {
        Self { innovation: Vector3::ZERO, nis: 0.0, components: 0, status }
    }
}

/// Components of the innovation of a vector.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct VectorInnovation {
    /// Number of components: 2 of a direction, else 3.
    pub components: usize,
    /// Measured less expected components.
    pub off: Vector3,
    /// Derivatives of the components with respect to the attitude error, row by row.
    pub jacobian: Matrix3,
    /// Covariance of the measurement error of the components.
    pub noise: Matrix3,
}

impl VectorInnovation {
    /// Returns the two components perpendicular to the expected direction, from the difference `off` of the vectors and
    /// the covariance `noise` of its three components.
    pub fn for_direction(expected: &Vector3, off: &Vector3, noise: &Matrix3) -> Self {
        let across: Matrix3 = perpendicular_pair(expected);
        let scaled: Matrix3 = across.times_matrix(noise);
        let cross: Matrix3 = Matrix3::cross(expected);
        Self {
            components: 2,
            off: across.times(off),
            jacobian: across.times_matrix(&cross),
            noise: scaled.times_transposed(&across),
        }
    }
}

/// Returns two unit vectors perpendicular to `v` and to each other, as the first two rows.
pub fn perpendicular_pair(v: &Vector3) -> Matrix3 {
    let mut axis: Vector3 = Vector3 { x: 1.0, y: 0.0, z: 0.0 };
    let mut least: f64 = v.x.abs();
    if v.y.abs() < least {
        least = v.y.abs();
        axis = Vector3 { x: 0.0, y: 1.0, z: 0.0 };
    }
    if v.z.abs() < least {
        axis = Vector3 { x: 0.0, y: 0.0, z: 1.0 };
    }
    let across: Vector3 = v.cross(&axis);
    let first: Vector3 = across.normalized();
    let third: Vector3 = v.cross(&first);
    let second: Vector3 = third.normalized();
    Matrix3 { rows: [[first.x, first.y, first.z], [second.x, second.y, second.z], [0.0, 0.0, 0.0]] }
}

impl Matrix6x3 {
    /// Returns the covariance of an innovation with the derivatives `jacobian` and the measurement error `noise`, where this
    /// matrix is the covariance of the state and the measured components without it.
    #[inline]
    pub fn innovation_covariance(&self, jacobian: &Matrix3, noise: &Matrix3) -> Matrix3 {
        let mut covariance: Matrix3 = Matrix3::ZERO;
        for row in 0..3 {
            for column in 0..3 {
                let mut sum: f64 = jacobian.rows[row][0] * self.rows[0][column];
                sum += jacobian.rows[row][1] * self.rows[1][column];
                sum += jacobian.rows[row][2] * self.rows[2][column];
                covariance.rows[row][column] = sum + noise.rows[row][column];
            }
        }
        covariance
    }
}
