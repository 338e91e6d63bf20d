//! A multiplicative extended Kalman filter of attitude and gyro bias (\[LeffertsMarkleyShuster82\]).
//!
//! The attitude is Q = Q^ exp(theta), the bias b = b^ + beta; theta and beta, three numbers each, have the covariance
//! P. A gyro reading y covers an interval: w^ = y - b^ rotates Q^ through it, and theta' = -w^ x theta - beta - n_v,
//! beta' = n_u is solved exactly for constant w^, with the exact covariance that n_v and n_u add. An attitude z
//! corrects by 2 vec(Q^* z), in Joseph's form. A vector y, r in inertial axes, corrects too: with b = Q^* r it is b + b
//! x theta, of which a direction has only the part perpendicular to b. Errors stay on the right of Q^: a reset changes
//! Q^ alone.

use crate::attitude_observation::{AttitudeObservation, Correction, ObservationKind, VectorInnovation};
use crate::covariance_propagation::IntervalNoise;
use crate::matrix3::Matrix3;
use crate::matrix6::{AttitudeBiasError, Matrix6, Matrix6x3};
use crate::quaternion::Quaternion;
use crate::reading_status::ReadingStatus;
use crate::vector3::Vector3;

/// Gyro noise in the filter's model, the same about each axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct GyroNoise {
    /// Angle random walk (rad/sqrt(s)).
    pub angle_random_walk: f64,
    /// Rate random walk (rad/s^1.5).
    pub rate_random_walk: f64,
}

/// Attitude filter at one instant: its estimates and their covariance.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeBiasFilter {
    /// Attitude: the rotation from body axes to inertial axes.
    pub attitude: Quaternion,
    /// Gyro bias (rad/s).
    pub bias: Vector3,
    /// Covariance of the errors of attitude (rad) and bias (rad/s).
    pub covariance: Matrix6,
}

impl AttitudeBiasFilter {
    /// Empty filter, which fills storage.
    pub const NONE: Self =
        Self { attitude: Quaternion::IDENTITY, bias: Vector3::ZERO, covariance: Matrix6::ZERO };

    /// Creates a filter with this attitude and bias, and standard deviations about each axis of attitude (rad) and bias
    /// (rad/s).
    pub fn new(attitude: Quaternion, bias: Vector3, angle_deviation: f64, bias_deviation: f64) -> Self {
        let mut covariance: Matrix6 = Matrix6::ZERO;
        for axis in 0..3 {
            covariance.rows[axis][axis] = angle_deviation * angle_deviation;
            covariance.rows[3 + axis][3 + axis] = bias_deviation * bias_deviation;
        }
        Self { attitude, bias, covariance }
    }

    /// Propagates the filter over `seconds` with `reading`, the gyro's mean rate over the interval (rad/s).
    pub fn predict(&mut self, reading: &Vector3, seconds: f64, noise: &GyroNoise) {
        let rate: Vector3 = reading.minus(&self.bias);
        let turn: Vector3 = rate.scaled(seconds);
        let white: f64 = noise.angle_random_walk * noise.angle_random_walk;
        let walk: f64 = noise.rate_random_walk * noise.rate_random_walk;
        self.rotate(&turn);
        let interval: IntervalNoise = IntervalNoise { seconds, white, walk };
        self.covariance.propagate(&turn, &interval);
    }

    /// Returns the attitude after `seconds` with the gyro reading `reading` (rad/s).
    #[inline]
    pub fn attitude_after(&self, reading: &Vector3, seconds: f64) -> Quaternion {
        let rate: Vector3 = reading.minus(&self.bias);
        let turn: Vector3 = rate.scaled(seconds);
        let rotation: Quaternion = Quaternion::rotation(&turn);
        self.attitude.times(&rotation)
    }

    /// Rotates the attitude by a rotation vector in body axes (rad).
    #[inline]
    pub fn rotate(&mut self, by: &Vector3) {
        let rotation: Quaternion = Quaternion::rotation(by);
        let turned: Quaternion = self.attitude.times(&rotation);
        self.attitude = turned.normalized();
    }

    /// Adds variances of attitude (rad²) and bias (rad²/s²) about each axis to the covariance.
    pub fn inflate(&mut self, angle: f64, bias: f64) {
        for axis in 0..3 {
            self.covariance.rows[axis][axis] += angle;
            self.covariance.rows[3 + axis][3 + axis] += bias;
        }
    }

    /// Corrects the filter by a measurement of any kind, with its constant gain if it has one. Changes nothing if the normalised
    /// innovation squared exceeds `most_nis` or is NaN.
    pub fn observe(&mut self, observation: &AttitudeObservation, most_nis: f64) -> Correction {
        if observation.has_gain {
            return self.correct_with_gain(observation, most_nis);
        }
        match observation.kind {
            ObservationKind::Attitude => self.correct(&observation.attitude, &observation.noise, most_nis),
            ObservationKind::Vector | ObservationKind::Direction => {
                self.correct_vector(observation, most_nis)
            }
        }
    }

    /// Corrects the filter by a measured attitude whose error has the covariance `noise` in body axes (rad²). Changes
    /// nothing if the covariance of the innovation is not positive definite, or if the normalised innovation squared exceeds
    /// `most_nis`.
    pub fn correct(&mut self, measured: &Quaternion, noise: &Matrix3, most_nis: f64) -> Correction {
        let innovation: Vector3 = self.attitude.rotation_to(measured);
        let to_attitude: Matrix6x3 = self.covariance.first_columns();
        let mut inverse: Matrix3 = Matrix3::ZERO;
        for row in 0..3 {
            for column in 0..3 {
                inverse.rows[row][column] = to_attitude.rows[row][column] + noise.rows[row][column];
            }
        }
        let is_definite: bool = inverse.invert_definite(3);
        if !is_definite {
            return Correction::NONE;
        }
        let scaled: Vector3 = inverse.times(&innovation);
        let nis: f64 = innovation.dot(&scaled);
        if !(nis <= most_nis) {
            return Correction { innovation, nis, components: 3, status: ReadingStatus::Improbable };
        }
        let gain: Matrix6x3 = to_attitude.times(3, &inverse);
        let error: AttitudeBiasError = gain.times_vector(3, &innovation);
        let added: Matrix6 = gain.spread(3, noise);
        self.apply(&error, &gain, &added);
        Correction { innovation, nis, components: 3, status: ReadingStatus::Accepted }
    }

    /// Corrects the filter by a measured vector or direction. Changes nothing if the covariance of the innovation is not
    /// positive definite, or if the normalised innovation squared exceeds `most_nis`.
    pub fn correct_vector(&mut self, observation: &AttitudeObservation, most_nis: f64) -> Correction {
        let expected: Vector3 = self.attitude.to_body(&observation.inertial);
        let is_direction: bool = matches!(observation.kind, ObservationKind::Direction);
        let off: Vector3 = observation.vector.minus(&expected);
        let measured: VectorInnovation = if is_direction {
            VectorInnovation::for_direction(&expected, &off, &observation.noise)
        } else {
            VectorInnovation {
                components: 3,
                off,
                jacobian: Matrix3::cross(&expected),
                noise: observation.noise,
            }
        };
        let count: usize = measured.components;
        let to_attitude: Matrix6x3 = self.covariance.first_columns();
        let to_measured: Matrix6x3 = to_attitude.times_transposed(&measured.jacobian);
        let mut inverse: Matrix3 = to_measured.innovation_covariance(&measured.jacobian, &measured.noise);
        let is_definite: bool = inverse.invert_definite(count);
        if !is_definite {
            return Correction::NONE;
        }
        let across: Vector3 = off.cross(&expected);
        let innovation: Vector3 = across.divided(expected.norm_squared());
        let components: u32 = if is_direction { 2 } else { 3 };
        let x: f64 = inverse.rows[0][0] * measured.off.x + inverse.rows[0][1] * measured.off.y;
        let y: f64 = inverse.rows[1][0] * measured.off.x + inverse.rows[1][1] * measured.off.y;
        let across_direction: f64 = (measured.off.x * x + measured.off.y * y) * 1.5;
        let scaled: Vector3 = inverse.times(&off);
        let nis: f64 = if is_direction { across_direction } else { off.dot(&scaled) };
        if !(nis <= most_nis) {
            return Correction { innovation, nis, components, status: ReadingStatus::Improbable };
        }
        let gain: Matrix6x3 = to_measured.times(count, &inverse);
        let error: AttitudeBiasError = gain.times_vector(count, &measured.off);
        let action: Matrix6x3 = gain.times(count, &measured.jacobian);
        let added: Matrix6 = gain.spread(count, &measured.noise);
        self.apply(&error, &action, &added);
        Correction { innovation, nis, components, status: ReadingStatus::Accepted }
    }

    /// Corrects the filter with the observation's constant gain on the measured angle relative to the attitude. The
    /// covariance becomes that of the errors which this gain leaves. Changes nothing if the normalised innovation squared exceeds
    /// `most_nis`.
    pub fn correct_with_gain(&mut self, observation: &AttitudeObservation, most_nis: f64) -> Correction {
        let is_attitude: bool = matches!(observation.kind, ObservationKind::Attitude);
        let components: u32 = if matches!(observation.kind, ObservationKind::Direction) { 2 } else { 3 };
        let off: Vector3;
        let innovation: Vector3;
        let jacobian: Matrix3;
        let gain: Matrix6x3;
        if is_attitude {
            off = self.attitude.rotation_to(&observation.attitude);
            innovation = off;
            jacobian = Matrix3::IDENTITY;
            gain = observation.gain;
        } else {
            let expected: Vector3 = self.attitude.to_body(&observation.inertial);
            let square: f64 = expected.norm_squared();
            off = observation.vector.minus(&expected);
            let across: Vector3 = off.cross(&expected);
            innovation = across.divided(square);
            jacobian = Matrix3::cross(&expected);
            let to_angle: Matrix3 = jacobian.divided(-square);
            gain = observation.gain.times(3, &to_angle);
        }
        let to_attitude: Matrix6x3 = self.covariance.first_columns();
        let to_measured: Matrix6x3 = to_attitude.times_transposed(&jacobian);
        let mut factor: Matrix3 = to_measured.innovation_covariance(&jacobian, &observation.noise);
        let is_definite: bool = factor.factorise(3);
        if !is_definite {
            return Correction::NONE;
        }
        let solution: Vector3 = factor.solve(&off);
        let nis: f64 = 3.0 / f64::from(components) * off.dot(&solution);
        if !(nis <= most_nis) {
            return Correction { innovation, nis, components, status: ReadingStatus::Improbable };
        }
        let error: AttitudeBiasError = gain.times_vector(3, &off);
        let action: Matrix6x3 = gain.times(3, &jacobian);
        let added: Matrix6 = gain.spread(3, &observation.noise);
        self.apply(&error, &action, &added);
        Correction { innovation, nis, components, status: ReadingStatus::Accepted }
    }

    /// Applies the estimated error, and updates the covariance for the action `gain` on the attitude and the term
    /// `added`: K P K' + `added` with K = 1 - \[`gain`, 0\].
    fn apply(&mut self, error: &AttitudeBiasError, gain: &Matrix6x3, added: &Matrix6) {
        self.rotate(&error.attitude);
        self.bias = self.bias.plus(&error.bias);
        let mut reduction: Matrix6x3 = Matrix6x3::ZERO;
        for row in 0..6 {
            for column in 0..3 {
                let one: f64 = if row == column { 1.0 } else { 0.0 };
                reduction.rows[row][column] = one - gain.rows[row][column];
            }
        }
        // The other columns of K are those of the identity.
        let mut once: Matrix6 = Matrix6::ZERO;
        for row in 0..6 {
            for column in 0..6 {
                let mut sum: f64 = reduction.rows[row][0] * self.covariance.rows[0][column];
                sum += reduction.rows[row][1] * self.covariance.rows[1][column];
                sum += reduction.rows[row][2] * self.covariance.rows[2][column];
                once.rows[row][column] = if row < 3 { sum } else { sum + self.covariance.rows[row][column] };
            }
        }
        let mut twice: Matrix6 = Matrix6::ZERO;
        for row in 0..6 {
            for column in 0..6 {
                let mut sum: f64 = once.rows[row][0] * reduction.rows[column][0];
                sum += once.rows[row][1] * reduction.rows[column][1];
                sum += once.rows[row][2] * reduction.rows[column][2];
                if column > 2 {
                    sum += once.rows[row][column];
                }
                twice.rows[row][column] = sum + added.rows[row][column];
            }
        }
        for row in 0..6 {
            for column in 0..6 {
                self.covariance.rows[row][column] = (twice.rows[row][column] + twice.rows[column][row]) * 0.5;
            }
        }
    }
}
