//! A multiplicative extended Kalman filter of attitude and gyro bias (\[LeffertsMarkleyShuster82\]).
//!
//! The attitude is Q = Q^ exp(theta), the bias b = b^ + beta; theta and beta, three numbers each, have the covariance
//! P. A gyro reading y covers an interval: w^ = y - b^ rotates Q^ through it, and theta' = -w^ x theta - beta - n_v,
//! beta' = n_u is solved exactly for constant w^, with the exact covariance that n_v and n_u add. An attitude z
//! corrects by 2 vec(Q^* z), in Joseph's form. A vector y, r in inertial axes, corrects too: with b = Q^* r it is b + b
//! x theta, of which a direction has only the part perpendicular to b. Errors stay on the right of Q^: a reset changes
//! Q^ alone.

use flexsc_numerics::attitude::{Vector, rotation, rotation_vector};
use flexsc_numerics::lanes::SimdWidth4;
use flexsc_numerics::stumpff::stumpff;
use flexsc_spacecraft::environment::to_body;
use nalgebra::{
    Cholesky, Const, DMatrix, DimSub, Matrix3, Matrix6, Matrix6x3, Quaternion, SMatrix, ToTypenum,
};

use super::covariance_propagation::CovariancePropagation;
use super::elastic_states::{ElasticFilterStates, ElasticInnovation};
use super::measurement::{AttitudeMeasurement, GyroNoise, perpendicular_pair};
use crate::sensor::VectorMeasurement;

/// State of the attitude filter at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct AttitudeFilterState {
    /// Attitude: the rotation from body axes to inertial axes.
    pub attitude: Quaternion<f64>,
    /// Gyro bias (rad/s).
    pub bias: Vector,
    /// Covariance of the errors of attitude (rad) and bias (rad/s).
    pub covariance: Matrix6<f64>,
    /// Elastic modes that the filter estimates too: they hold the full covariance, of which `covariance` is the leading
    /// block.
    pub elastic: Option<Box<ElasticFilterStates>>,
}

/// Innovation of a measured attitude or vector.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Correction {
    /// Measured attitude relative to the predicted one, in body axes (rad); for a vector, the part perpendicular to it.
    pub innovation: Vector,
    /// Normalised innovation squared; for a direction, which has two components, multiplied by 3/2.
    pub nis: f64,
    /// Number of components of the measurement.
    pub numbers: u64,
}

impl AttitudeFilterState {
    /// Creates a filter with this attitude, bias and standard deviations about each axis (rad, rad/s).
    pub fn new(attitude: Quaternion<f64>, bias: Vector, deviations: [f64; 2]) -> Self {
        let variance = |row: usize, _| deviations[row / 3] * deviations[row / 3];
        let covariance =
            Matrix6::from_fn(|row, column| if row == column { variance(row, column) } else { 0.0 });
        Self { attitude, bias, covariance, elastic: None }
    }

    /// Propagates the filter over `seconds` with `reading`, the gyro's mean rate over the interval (rad/s).
    pub fn predict(&mut self, reading: &Vector, seconds: f64, noise: &GyroNoise) {
        let turn = (reading - self.bias) * seconds;
        let (white, walk) = (noise.angle_random_walk, noise.rate_random_walk);
        self.attitude = unit(self.attitude * rotation(&turn));
        let phis = stumpff(turn.norm_squared());
        let covariance = &mut self.covariance;
        SimdWidth4::best().run(CovariancePropagation {
            covariance,
            turn,
            phis,
            seconds,
            white: white * white,
            walk: walk * walk,
        });
    }

    /// Propagates the filter and its modes over `seconds`, under torques (N m), each with its duration (s).
    pub fn predict_with_torques(
        &mut self,
        reading: &Vector,
        seconds: f64,
        noise: &GyroNoise,
        torques: &[(f64, Vector)],
    ) {
        let Some(mut elastic) = self.elastic.take() else { return self.predict(reading, seconds, noise) };
        let mount = elastic.propagate(seconds, torques);
        let turn = (reading - self.bias) * seconds - mount;
        elastic.propagate_covariance(&turn, seconds, noise);
        self.attitude = unit(self.attitude * rotation(&turn));
        self.covariance = elastic.attitude_block();
        self.elastic = Some(elastic);
    }

    /// Corrects the filter by a measurement of a sensor whose mount is rotated by the modes.
    pub fn correct_at_mount(
        &mut self,
        sensor: usize,
        measured: &AttitudeMeasurement,
        noise: &Matrix3<f64>,
    ) -> Option<Correction> {
        let mut elastic = self.elastic.take()?;
        let noise = DMatrix::from_fn(3, 3, |row, column| noise[(row, column)]);
        let reported = match measured {
            AttitudeMeasurement::Attitude(attitude) => {
                elastic.correct(&self.attitude, attitude, &noise, sensor)
            }
            AttitudeMeasurement::Vector(measurement) => {
                elastic.correct_vector(&self.attitude, measurement, &noise, sensor)
            }
        };
        self.covariance = elastic.attitude_block();
        self.elastic = Some(elastic);
        let (innovation, ElasticInnovation { error: [angle, bias], nis }) = reported?;
        self.attitude = unit(self.attitude * rotation(&angle));
        self.bias += bias;
        Some(Correction { innovation, nis, numbers: measured.dimension() })
    }

    /// Corrects the filter by a measured attitude whose error has the covariance `noise` in body axes (rad²). Returns
    /// `None` and changes nothing if the covariance of the innovation is not positive definite.
    pub fn correct(&mut self, measured: &Quaternion<f64>, noise: &Matrix3<f64>) -> Option<Correction> {
        let innovation = rotation_vector(&self.attitude, measured);
        let to_attitude = self.covariance.fixed_columns::<3>(0).into_owned();
        let inverse = Cholesky::new(to_attitude.fixed_rows::<3>(0) + noise)?.inverse();
        let gain = to_attitude * inverse;
        let error = gain * innovation;
        self.attitude = unit(self.attitude * rotation(&error.fixed_rows::<3>(0).into_owned()));
        self.bias += error.fixed_rows::<3>(3);
        self.covariance = corrected_covariance(&self.covariance, &gain, &(gain * noise * gain.transpose()));
        Some(Correction { innovation, nis: innovation.dot(&(inverse * innovation)), numbers: 3 })
    }

    /// Corrects the filter by a measured vector whose error has the covariance `noise` in body axes.
    pub fn correct_vector(
        &mut self,
        measurement: &VectorMeasurement,
        noise: &Matrix3<f64>,
    ) -> Option<Correction> {
        let expected = to_body(&self.attitude, &measurement.inertial);
        let (off, jacobian) = (measurement.vector - expected, expected.cross_matrix());
        let nis = if measurement.is_direction {
            let across = perpendicular_pair(&expected);
            self.update(&(across * jacobian), &(across * off), &(across * noise * across.transpose()))? * 1.5
        } else {
            self.update(&jacobian, &off, noise)?
        };
        let numbers = if measurement.is_direction { 2 } else { 3 };
        Some(Correction { innovation: off.cross(&expected) / expected.norm_squared(), nis, numbers })
    }

    /// Corrects the filter with a constant gain on the measured angle relative to the attitude. The covariance becomes
    /// that of the errors which this gain leaves.
    pub fn correct_with_gain(
        &mut self,
        measured: &AttitudeMeasurement,
        noise: &Matrix3<f64>,
        gain: &Matrix6x3<f64>,
    ) -> Option<Correction> {
        let (off, jacobian, gain) = match measured {
            AttitudeMeasurement::Attitude(attitude) => {
                (rotation_vector(&self.attitude, attitude), Matrix3::identity(), *gain)
            }
            AttitudeMeasurement::Vector(measurement) => {
                let expected = to_body(&self.attitude, &measurement.inertial);
                let to_angle = expected.cross_matrix() / -expected.norm_squared();
                (measurement.vector - expected, expected.cross_matrix(), gain * to_angle)
            }
        };
        let to_measured = self.covariance.fixed_columns::<3>(0) * jacobian.transpose();
        let spread = Cholesky::new(jacobian * to_measured.fixed_rows::<3>(0) + noise)?;
        let numbers = measured.dimension();
        let nis = 3.0 / numbers as f64 * off.dot(&spread.solve(&off));
        let error = gain * off;
        let innovation = match measured {
            AttitudeMeasurement::Attitude(_) => off,
            AttitudeMeasurement::Vector(measurement) => {
                let expected = to_body(&self.attitude, &measurement.inertial);
                off.cross(&expected) / expected.norm_squared()
            }
        };
        self.apply_correction(&error, &(gain * jacobian), &(gain * noise * gain.transpose()));
        Some(Correction { innovation, nis, numbers })
    }

    /// Applies the estimated `error`, and updates the covariance for the action `gain` on the attitude and the
    /// term `added`.
    fn apply_correction(&mut self, error: &SMatrix<f64, 6, 1>, gain: &Matrix6x3<f64>, added: &Matrix6<f64>) {
        self.attitude = unit(self.attitude * rotation(&error.fixed_rows::<3>(0).into_owned()));
        self.bias += error.fixed_rows::<3>(3);
        self.covariance = corrected_covariance(&self.covariance, gain, added);
    }

    /// Updates the filter with D components `off` of an innovation, their derivatives `jacobian` with respect to theta,
    /// and their covariance `noise`; returns the normalised innovation squared.
    fn update<const D: usize>(
        &mut self,
        jacobian: &SMatrix<f64, D, 3>,
        off: &SMatrix<f64, D, 1>,
        noise: &SMatrix<f64, D, D>,
    ) -> Option<f64>
    where
        Const<D>: ToTypenum + DimSub<Const<1>>,
    {
        let to_measured = self.covariance.fixed_columns::<3>(0) * jacobian.transpose();
        let inverse = Cholesky::new(jacobian * to_measured.fixed_rows::<3>(0) + noise)?.inverse();
        let gain = to_measured * inverse;
        self.apply_correction(&(gain * off), &(gain * jacobian), &(gain * noise * gain.transpose()));
        Some(off.dot(&(inverse * off)))
    }

    /// Returns the errors against a true attitude and bias: truth relative to the estimate (rad, rad/s).
    pub fn error(&self, attitude: &Quaternion<f64>, bias: &Vector) -> [Vector; 2] {
        [rotation_vector(&self.attitude, attitude), bias - self.bias]
    }

    /// Returns the normalised squared error against a true attitude and bias; NaN if the covariance is not positive
    /// definite.
    pub fn nees(&self, attitude: &Quaternion<f64>, bias: &Vector) -> f64 {
        self.normalised(&self.error(attitude, bias))
    }

    /// Returns the normalised square of an error (rad, rad/s); NaN if the covariance is not positive definite.
    pub fn normalised(&self, [angle, rate]: &[Vector; 2]) -> f64 {
        let error = SMatrix::<f64, 6, 1>::from_fn(|row, _| if row < 3 { angle[row] } else { rate[row - 3] });
        Cholesky::new(self.covariance).map_or(f64::NAN, |factor| error.dot(&factor.solve(&error)))
    }

    /// Returns the standard deviations of attitude (rad) and bias (rad/s) about each axis.
    pub fn deviations(&self) -> [[f64; 3]; 2] {
        [0, 3].map(|from| [0, 1, 2].map(|axis| f64::sqrt(self.covariance[(from + axis, from + axis)])))
    }
}

fn unit(q: Quaternion<f64>) -> Quaternion<f64> {
    q / q.norm()
}

/// Returns the covariance after a correction: K P K' + `added` with K = 1 - [`gain`, 0].
fn corrected_covariance(
    covariance: &Matrix6<f64>,
    gain: &Matrix6x3<f64>,
    added: &Matrix6<f64>,
) -> Matrix6<f64> {
    let reduction = Matrix6x3::identity() - gain;
    // The other columns of K are those of the identity.
    let mut once = reduction * covariance.fixed_rows::<3>(0);
    let mut below = once.fixed_rows_mut::<3>(3);
    below += covariance.fixed_rows::<3>(3);
    let mut twice = once.fixed_columns::<3>(0) * reduction.transpose();
    let mut right_columns = twice.fixed_columns_mut::<3>(3);
    right_columns += once.fixed_columns::<3>(3);
    symmetric(&(twice + added))
}

fn symmetric(matrix: &Matrix6<f64>) -> Matrix6<f64> {
    (matrix + matrix.transpose()) * 0.5
}
