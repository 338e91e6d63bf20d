//! The attitude filter on the matrix library, whose bits flight code has.

use flexsc_flight::inverse_trigonometry::atan2;
use flexsc_flight::stumpff::Stumpff;
use flexsc_flight::trigonometry::sincos;
use nalgebra::{
    Cholesky, Const, DimSub, Matrix3, Matrix6, Matrix6x3, Quaternion, SMatrix, ToTypenum, Vector3,
};

/// Measured vector, with its reference in inertial axes.
pub struct VectorMeasurement {
    pub vector: Vector3<f64>,
    pub inertial: Vector3<f64>,
    pub is_direction: bool,
}

/// Measured attitude or vector.
pub enum Measured {
    Attitude(Quaternion<f64>),
    Vector(VectorMeasurement),
}

/// Result of a correction.
pub struct Corrected {
    pub innovation: Vector3<f64>,
    pub nis: f64,
    pub components: u32,
}

/// State of the filter.
pub struct MatrixFilter {
    pub attitude: Quaternion<f64>,
    pub bias: Vector3<f64>,
    pub covariance: Matrix6<f64>,
}

/// Returns the rotation by a rotation vector (rad).
pub fn rotation(by: &Vector3<f64>) -> Quaternion<f64> {
    let angle = by.norm();
    if angle == 0.0 {
        return Quaternion::new(1.0, 0.0, 0.0, 0.0);
    }
    let half = sincos(0.5 * angle);
    Quaternion::from_parts(half.cos, by * (half.sin / angle))
}

/// Returns the rotation vector from one attitude to another.
pub fn rotation_vector(from: &Quaternion<f64>, to: &Quaternion<f64>) -> Vector3<f64> {
    let difference = from.conjugate() * to;
    let sine = difference.vector().norm();
    let twice = 2.0_f64.copysign(difference.w);
    let scale = if sine == 0.0 { 1.0 } else { atan2(sine, difference.w.abs()) / sine };
    difference.vector() * (twice * scale)
}

/// Transforms an inertial vector to the body's axes.
pub fn to_body(attitude: &Quaternion<f64>, v: &Vector3<f64>) -> Vector3<f64> {
    let rotated = attitude.conjugate() * Quaternion::from_imag(*v) * attitude;
    rotated.vector() / attitude.norm_squared()
}

fn perpendicular_pair(v: &Vector3<f64>) -> SMatrix<f64, 2, 3> {
    let first = v.cross(&Vector3::ith(v.iamin(), 1.0)).normalize();
    let second = v.cross(&first).normalize();
    SMatrix::from_rows(&[first.transpose(), second.transpose()])
}

impl MatrixFilter {
    /// Propagates the filter with the squares of the random walks.
    pub fn predict(&mut self, reading: &Vector3<f64>, seconds: f64, [white, walk]: [f64; 2]) {
        let turn = (reading - self.bias) * seconds;
        self.attitude = unit(self.attitude * rotation(&turn));
        let c = Stumpff::at(turn.norm_squared());
        let (one, cross) = (Matrix3::identity(), turn.cross_matrix());
        let twice = cross * cross;
        let both = (one * 0.5 - cross * c.c3 + twice * c.c4) * (seconds * seconds * walk);
        let angle = (one * c.c3 + turn * turn.transpose() * c.c5)
            * (2.0 * seconds * seconds * seconds * walk)
            + one * (white * seconds);
        let turned = one - cross * c.c1 + twice * c.c2;
        let drifted = (one - cross * c.c2 + twice * c.c3) * seconds;
        let block = |row: usize, column: usize| self.covariance.fixed_view::<3, 3>(row, column).into_owned();
        let carried = turned * block(0, 3) - drifted * block(3, 3);
        let moved = turned * block(0, 0) - drifted * block(0, 3).transpose();
        let angle = moved * turned.transpose() - carried * drifted.transpose() + angle;
        let across = carried - both;
        let bias = block(3, 3) + one * (walk * seconds);
        self.covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&((angle + angle.transpose()) * 0.5));
        self.covariance.fixed_view_mut::<3, 3>(0, 3).copy_from(&across);
        self.covariance.fixed_view_mut::<3, 3>(3, 0).copy_from(&across.transpose());
        self.covariance.fixed_view_mut::<3, 3>(3, 3).copy_from(&bias);
    }

    /// Corrects the filter by a measured attitude whose error has the covariance `noise` in body axes (rad²). Returns
    /// `None` and changes nothing if the covariance of the innovation is not positive definite.
    pub fn correct(&mut self, measured: &Quaternion<f64>, noise: &Matrix3<f64>) -> Option<Corrected> {
        let innovation = rotation_vector(&self.attitude, measured);
        let to_attitude = self.covariance.fixed_columns::<3>(0).into_owned();
        let inverse = Cholesky::new(to_attitude.fixed_rows::<3>(0) + noise)?.inverse();
        let gain = to_attitude * inverse;
        let error = gain * innovation;
        self.attitude = unit(self.attitude * rotation(&error.fixed_rows::<3>(0).into_owned()));
        self.bias += error.fixed_rows::<3>(3);
        self.covariance = corrected_covariance(&self.covariance, &gain, &(gain * noise * gain.transpose()));
        Some(Corrected { innovation, nis: innovation.dot(&(inverse * innovation)), components: 3 })
    }

    /// Corrects the filter by a measured vector whose error has the covariance `noise` in body axes.
    pub fn correct_vector(
        &mut self,
        measurement: &VectorMeasurement,
        noise: &Matrix3<f64>,
    ) -> Option<Corrected> {
        let expected = to_body(&self.attitude, &measurement.inertial);
        let (off, jacobian) = (measurement.vector - expected, expected.cross_matrix());
        let nis = if measurement.is_direction {
            let across = perpendicular_pair(&expected);
            self.update(&(across * jacobian), &(across * off), &(across * noise * across.transpose()))? * 1.5
        } else {
            self.update(&jacobian, &off, noise)?
        };
        let components = if measurement.is_direction { 2 } else { 3 };
        Some(Corrected { innovation: off.cross(&expected) / expected.norm_squared(), nis, components })
    }

    /// Corrects the filter with a constant gain on the measured angle relative to the attitude. The covariance becomes
    /// that of the errors which this gain leaves.
    pub fn correct_with_gain(
        &mut self,
        measured: &Measured,
        noise: &Matrix3<f64>,
        gain: &Matrix6x3<f64>,
    ) -> Option<Corrected> {
        let (off, jacobian, gain) = match measured {
            Measured::Attitude(attitude) => {
                (rotation_vector(&self.attitude, attitude), Matrix3::identity(), *gain)
            }
            Measured::Vector(measurement) => {
                let expected = to_body(&self.attitude, &measurement.inertial);
                let to_angle = expected.cross_matrix() / -expected.norm_squared();
                (measurement.vector - expected, expected.cross_matrix(), gain * to_angle)
            }
        };
        let to_measured = self.covariance.fixed_columns::<3>(0) * jacobian.transpose();
        let spread = Cholesky::new(jacobian * to_measured.fixed_rows::<3>(0) + noise)?;
        let components = if matches!(measured, Measured::Vector(VectorMeasurement { is_direction: true, .. }))
        {
            2
        } else {
            3
        };
        let nis = 3.0 / f64::from(components) * off.dot(&spread.solve(&off));
        let error = gain * off;
        let innovation = match measured {
            Measured::Attitude(_) => off,
            Measured::Vector(measurement) => {
                let expected = to_body(&self.attitude, &measurement.inertial);
                off.cross(&expected) / expected.norm_squared()
            }
        };
        self.apply_correction(&error, &(gain * jacobian), &(gain * noise * gain.transpose()));
        Some(Corrected { innovation, nis, components })
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
