//! A multiplicative extended Kalman filter of attitude and gyro bias (\[LeffertsMarkleyShuster82\]).
//!
//! The attitude is Q = Q^ exp(theta), the bias b = b^ + beta; theta and beta, three numbers each, have the covariance P. A gyro
//! reading y covers an interval: w^ = y - b^ turns Q^ through it, and theta' = -w^ x theta - beta - n_v, beta' = n_u is solved
//! exactly for constant w^, with the exact covariance of what n_v and n_u add. An attitude z corrects by 2 vec(Q^* z), in the
//! form of Joseph. So does a vector y that is r in inertial axes: with b = Q^* r it is b + b x theta, of a direction the part across
//! b alone. Errors stay on the right of Q^: nothing has to be reset but Q^ itself.

use nalgebra::{
    Cholesky, Const, DMatrix, DimSub, Matrix3, Matrix6, Matrix6x3, Quaternion, SMatrix, ToTypenum,
};

use super::measurement::{AttitudeMeasurement, GyroNoise, across};
use super::swinging::{SwingInnovation, Swinging};
use crate::attitude::{Vector, beyond, rotation};
use crate::environment::into;
use crate::numerics::stumpff::stumpff;
use crate::sensor::VectorSight;

/// The filter: what it knows at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct AttitudeFilterState {
    /// The attitude, which turns vectors of the body's axes into inertial ones.
    pub attitude: Quaternion<f64>,
    /// The bias of the gyro (rad/s).
    pub bias: Vector,
    /// Covariance of the errors of attitude (rad) and bias (rad/s).
    pub covariance: Matrix6<f64>,
    /// Elastic modes that it knows too: the covariance of all is theirs, and the one above a part of it.
    pub swinging: Option<Box<Swinging>>,
}

/// What a measured attitude or vector told a filter.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Correction {
    /// How far the measured attitude was beyond the predicted one, in the body's axes (rad); of a vector the part across it.
    pub innovation: Vector,
    /// The normalised square of the innovation, of a direction, which has two numbers, times 3/2.
    pub nis: f64,
    /// How many numbers it has.
    pub numbers: u64,
}

impl AttitudeFilterState {
    /// The filter that knows an attitude and a bias with these standard deviations about each axis (rad, rad/s).
    pub fn new(attitude: Quaternion<f64>, bias: Vector, deviations: [f64; 2]) -> Self {
        let variance = |row: usize, _| deviations[row / 3] * deviations[row / 3];
        let covariance =
            Matrix6::from_fn(|row, column| if row == column { variance(row, column) } else { 0.0 });
        Self { attitude, bias, covariance, swinging: None }
    }

    /// Goes on through an interval of so many seconds, of which the gyro tells the mean rate (rad/s).
    pub fn predict(&mut self, reading: &Vector, seconds: f64, noise: &GyroNoise) {
        let turn = (reading - self.bias) * seconds;
        let (white, walk) = (noise.angle_random_walk, noise.rate_random_walk);
        let Interval { turned, drifted, added: [angle, both, bias] } =
            interval(&turn, seconds, [white * white, walk * walk]);
        self.attitude = unit(self.attitude * rotation(&turn));
        // The transition is [turned, -drifted; 0, 1].
        let block = |row, column| self.covariance.fixed_view::<3, 3>(row, column).into_owned();
        let (of_angle, across, of_bias) = (block(0, 0), block(0, 3), block(3, 3));
        let carried = turned * across - drifted * of_bias;
        let moved = turned * of_angle - drifted * across.transpose();
        let of_angle = moved * turned.transpose() - carried * drifted.transpose() + angle;
        self.covariance = blocks(&of_angle, &(carried + both), &(of_bias + bias));
    }

    /// The same with modes, under torques (N m) each for so long (s).
    pub fn predict_under(
        &mut self,
        reading: &Vector,
        seconds: f64,
        noise: &GyroNoise,
        torques: &[(f64, Vector)],
    ) {
        let Some(mut swinging) = self.swinging.take() else { return self.predict(reading, seconds, noise) };
        let mount = swinging.swing(seconds, torques);
        let turn = (reading - self.bias) * seconds - mount;
        swinging.spread(&turn, seconds, noise);
        self.attitude = unit(self.attitude * rotation(&turn));
        self.covariance = swinging.first();
        self.swinging = Some(swinging);
    }

    /// Takes what a sensor measured whose mount the modes turn.
    pub fn correct_at(
        &mut self,
        sensor: usize,
        measured: &AttitudeMeasurement,
        noise: &Matrix3<f64>,
    ) -> Option<Correction> {
        let mut swinging = self.swinging.take()?;
        let noise = DMatrix::from_fn(3, 3, |row, column| noise[(row, column)]);
        let told = match measured {
            AttitudeMeasurement::Attitude(attitude) => {
                swinging.correct(&self.attitude, attitude, &noise, sensor)
            }
            AttitudeMeasurement::Vector(sight) => swinging.correct_by(&self.attitude, sight, &noise, sensor),
        };
        self.covariance = swinging.first();
        self.swinging = Some(swinging);
        let (innovation, SwingInnovation { error: [angle, bias], nis }) = told?;
        self.attitude = unit(self.attitude * rotation(&angle));
        self.bias += bias;
        Some(Correction { innovation, nis, numbers: measured.numbers() })
    }

    /// Takes a measured attitude whose error in the body's axes has this covariance (rad²). It tells nothing where the
    /// covariance of the innovation is not positive.
    pub fn correct(&mut self, measured: &Quaternion<f64>, noise: &Matrix3<f64>) -> Option<Correction> {
        let innovation = beyond(&self.attitude, measured);
        let to_attitude = self.covariance.fixed_columns::<3>(0).into_owned();
        let inverse = Cholesky::new(to_attitude.fixed_rows::<3>(0) + noise)?.inverse();
        let gain = to_attitude * inverse;
        let error = gain * innovation;
        self.attitude = unit(self.attitude * rotation(&error.fixed_rows::<3>(0).into_owned()));
        self.bias += error.fixed_rows::<3>(3);
        let mut kept = Matrix6::identity();
        let mut told = kept.fixed_columns_mut::<3>(0);
        told -= gain;
        self.covariance =
            symmetric(&(kept * self.covariance * kept.transpose() + gain * noise * gain.transpose()));
        Some(Correction { innovation, nis: innovation.dot(&(inverse * innovation)), numbers: 3 })
    }

    /// Takes a measured vector whose error in the body's axes has this covariance.
    pub fn correct_by(&mut self, sight: &VectorSight, noise: &Matrix3<f64>) -> Option<Correction> {
        let expected = into(&self.attitude, &sight.inertial);
        let (off, moved) = (sight.vector - expected, expected.cross_matrix());
        let nis = if sight.is_direction {
            let across = across(&expected);
            self.update(&(across * moved), &(across * off), &(across * noise * across.transpose()))? * 1.5
        } else {
            self.update(&moved, &off, noise)?
        };
        let numbers = if sight.is_direction { 2 } else { 3 };
        Some(Correction { innovation: off.cross(&expected) / expected.norm_squared(), nis, numbers })
    }

    /// The same with a constant gain from the angle that is measured beyond the attitude. The covariance is that of the errors
    /// which this gain leaves.
    pub fn correct_with(
        &mut self,
        measured: &AttitudeMeasurement,
        noise: &Matrix3<f64>,
        gain: &Matrix6x3<f64>,
    ) -> Option<Correction> {
        let (off, moved, gain) = match measured {
            AttitudeMeasurement::Attitude(attitude) => {
                (beyond(&self.attitude, attitude), Matrix3::identity(), *gain)
            }
            AttitudeMeasurement::Vector(sight) => {
                let expected = into(&self.attitude, &sight.inertial);
                let to_angle = expected.cross_matrix() / -expected.norm_squared();
                (sight.vector - expected, expected.cross_matrix(), gain * to_angle)
            }
        };
        let to_measured = self.covariance.fixed_columns::<3>(0) * moved.transpose();
        let spread = Cholesky::new(moved * to_measured.fixed_rows::<3>(0) + noise)?;
        let numbers = measured.numbers();
        let nis = 3.0 / numbers as f64 * off.dot(&spread.solve(&off));
        let error = gain * off;
        let innovation = match measured {
            AttitudeMeasurement::Attitude(_) => off,
            AttitudeMeasurement::Vector(sight) => {
                let expected = into(&self.attitude, &sight.inertial);
                off.cross(&expected) / expected.norm_squared()
            }
        };
        self.take(&error, &(gain * moved), &(gain * noise * gain.transpose()));
        Some(Correction { innovation, nis, numbers })
    }

    /// Takes errors over that were found with a gain of which this acts on the attitude, and adds this to the covariance.
    fn take(&mut self, error: &SMatrix<f64, 6, 1>, told: &Matrix6x3<f64>, added: &Matrix6<f64>) {
        self.attitude = unit(self.attitude * rotation(&error.fixed_rows::<3>(0).into_owned()));
        self.bias += error.fixed_rows::<3>(3);
        let mut kept = Matrix6::identity();
        let mut first = kept.fixed_columns_mut::<3>(0);
        first -= told;
        self.covariance = symmetric(&(kept * self.covariance * kept.transpose() + added));
    }

    /// Takes D numbers that are beyond what is expected by so much, where a unit of theta moves them so, and errors have this
    /// covariance; returns the normalised square.
    fn update<const D: usize>(
        &mut self,
        moved: &SMatrix<f64, D, 3>,
        off: &SMatrix<f64, D, 1>,
        noise: &SMatrix<f64, D, D>,
    ) -> Option<f64>
    where
        Const<D>: ToTypenum + DimSub<Const<1>>,
    {
        let to_measured = self.covariance.fixed_columns::<3>(0) * moved.transpose();
        let inverse = Cholesky::new(moved * to_measured.fixed_rows::<3>(0) + noise)?.inverse();
        let gain = to_measured * inverse;
        self.take(&(gain * off), &(gain * moved), &(gain * noise * gain.transpose()));
        Some(off.dot(&(inverse * off)))
    }

    /// Its error where these are attitude and bias: so far is the truth beyond the estimate (rad, rad/s).
    pub fn error(&self, attitude: &Quaternion<f64>, bias: &Vector) -> [Vector; 2] {
        [beyond(&self.attitude, attitude), bias - self.bias]
    }

    /// The normalised square of its error where these are attitude and bias; NaN of a covariance that is not positive.
    pub fn nees(&self, attitude: &Quaternion<f64>, bias: &Vector) -> f64 {
        let [angle, rate] = self.error(attitude, bias);
        let error = SMatrix::<f64, 6, 1>::from_fn(|row, _| if row < 3 { angle[row] } else { rate[row - 3] });
        Cholesky::new(self.covariance).map_or(f64::NAN, |factor| error.dot(&factor.solve(&error)))
    }

    /// Standard deviations of attitude (rad) and bias (rad/s) about each axis.
    pub fn deviations(&self) -> [[f64; 3]; 2] {
        [0, 3].map(|from| [0, 1, 2].map(|axis| libm::sqrt(self.covariance[(from + axis, from + axis)])))
    }
}

/// What errors go through while the body turns: theta becomes `turned` theta - `drifted` beta.
struct Interval {
    turned: Matrix3<f64>,
    drifted: Matrix3<f64>,
    /// The covariance that noise adds: of theta, of theta with beta, and of beta.
    added: [Matrix3<f64>; 3],
}

/// An interval in which the body turns so far (rad), under noise of these densities.
fn interval(turn: &Vector, seconds: f64, [white, walk]: [f64; 2]) -> Interval {
    let [c1, c2, c3, c4, c5] = stumpff(turn.norm_squared());
    let (one, cross) = (Matrix3::identity(), turn.cross_matrix());
    let twice = cross * cross;
    let with_bias = (one * 0.5 - cross * c3 + twice * c4) * (seconds * seconds * walk);
    let both = (one * c3 + turn * turn.transpose() * c5) * (2.0 * seconds * seconds * seconds * walk);
    Interval {
        turned: one - cross * c1 + twice * c2,
        drifted: (one - cross * c2 + twice * c3) * seconds,
        added: [both + one * (white * seconds), -with_bias, one * (walk * seconds)],
    }
}

/// The symmetric matrix of these blocks.
fn blocks(first: &Matrix3<f64>, across: &Matrix3<f64>, second: &Matrix3<f64>) -> Matrix6<f64> {
    let mut all = Matrix6::zeros();
    all.fixed_view_mut::<3, 3>(0, 0).copy_from(&((first + first.transpose()) * 0.5));
    all.fixed_view_mut::<3, 3>(0, 3).copy_from(across);
    all.fixed_view_mut::<3, 3>(3, 0).copy_from(&across.transpose());
    all.fixed_view_mut::<3, 3>(3, 3).copy_from(second);
    all
}

fn unit(q: Quaternion<f64>) -> Quaternion<f64> {
    q / q.norm()
}

fn symmetric(of: &Matrix6<f64>) -> Matrix6<f64> {
    (of + of.transpose()) * 0.5
}
