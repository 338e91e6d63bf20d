//! Estimates of an attitude filter with their covariance, as logs and checks read them.

use flexsc_flight::attitude_filter::AttitudeBiasFilter;
use flexsc_numerics::attitude::{Vector, rotation_vector};
use flexsc_numerics::flight_types::{
    from_matrix6, from_quaternion, from_vector3, to_matrix6, to_quaternion, to_vector3,
};
use nalgebra::{Matrix6, Quaternion};

/// State of the attitude filter at one instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeFilterState {
    /// Attitude: the rotation from body axes to inertial axes.
    pub attitude: Quaternion<f64>,
    /// Gyro bias (rad/s).
    pub bias: Vector,
    /// Covariance of the errors of attitude (rad) and bias (rad/s).
    pub covariance: Matrix6<f64>,
}

impl AttitudeFilterState {
    /// Creates a filter with this attitude, bias and standard deviations about each axis (rad, rad/s).
    pub fn new(attitude: Quaternion<f64>, bias: Vector, [angle, rate]: [f64; 2]) -> Self {
        Self::from_flight(&AttitudeBiasFilter::new(to_quaternion(&attitude), to_vector3(&bias), angle, rate))
    }

    /// Returns the state of the filter in flight code.
    pub fn from_flight(filter: &AttitudeBiasFilter) -> Self {
        Self {
            attitude: from_quaternion(&filter.attitude),
            bias: from_vector3(&filter.bias),
            covariance: from_matrix6(&filter.covariance),
        }
    }

    /// Returns the filter in flight code.
    pub fn to_flight(&self) -> AttitudeBiasFilter {
        AttitudeBiasFilter {
            attitude: to_quaternion(&self.attitude),
            bias: to_vector3(&self.bias),
            covariance: to_matrix6(&self.covariance),
        }
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
        let error = [angle[0], angle[1], angle[2], rate[0], rate[1], rate[2]];
        inverse_form(&self.covariance.data.0, error).unwrap_or(f64::NAN)
    }

    /// Returns the standard deviations of attitude (rad) and bias (rad/s) about each axis.
    pub fn deviations(&self) -> [[f64; 3]; 2] {
        [0, 3].map(|from| [0, 1, 2].map(|axis| f64::sqrt(self.covariance[(from + axis, from + axis)])))
    }
}

/// Returns e' P^-1 e for a vector e and a symmetric matrix P, of which the lower half of each column is read; `None` if P is not
/// positive definite. With a constant order, the loops are without branches: this is part of every sample.
fn inverse_form(matrix: &[[f64; 6]; 6], vector: [f64; 6]) -> Option<f64> {
    let (mut factor, mut solution) = (*matrix, vector);
    for j in 0..6 {
        for k in 0..j {
            let by = factor[k][j];
            for row in j..6 {
                factor[j][row] -= by * factor[k][row];
            }
        }
        if factor[j][j].is_nan() || factor[j][j] <= 0.0 {
            return None;
        }
        let root = f64::sqrt(factor[j][j]);
        factor[j][j] = root;
        factor[j][j + 1..].iter_mut().for_each(|below| *below /= root);
    }
    for i in 0..6 {
        solution[i] /= factor[i][i];
        for row in i + 1..6 {
            solution[row] -= solution[i] * factor[i][row];
        }
    }
    for i in (0..6).rev() {
        let known: f64 = (i + 1..6).fold(0.0, |sum, row| sum + factor[i][row] * solution[row]);
        solution[i] = (solution[i] - known) / factor[i][i];
    }
    Some((0..6).fold(0.0, |sum, row| sum + vector[row] * solution[row]))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Cholesky, Vector6};

    use super::*;

    #[test]
    fn the_normalised_square_has_the_bits_of_a_general_solution() {
        for seed in 1..50 {
            let part = |place: usize| libm::sin(f64::from(seed) * (1.0 + place as f64));
            let root = Matrix6::from_fn(|row, column| part(6 * row + column));
            let matrix = root * root.transpose();
            let vector = Vector6::from_fn(|row, _| part(40 + row));
            let expected = Cholesky::new(matrix).map(|factor| vector.dot(&factor.solve(&vector)));
            let found = inverse_form(&matrix.data.0, vector.data.0[0]);
            assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
        }
        for wrong in [0.0, -1.0, f64::NAN] {
            let mut matrix = Matrix6::identity();
            matrix[(3, 3)] = wrong;
            assert_eq!(inverse_form(&matrix.data.0, [1.0; 6]), None);
        }
    }
}
