//! Matrices of six rows, of attitude and gyro bias.

use crate::matrix3::Matrix3;
use crate::vector3::Vector3;

/// Matrix of six rows and six columns.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Matrix6 {
    /// Elements, row by row.
    pub rows: [[f64; 6]; 6],
}

impl Matrix6 {
    /// Zero matrix.
    pub const ZERO: Self = Self { rows: [[0.0; 6]; 6] };

    /// Returns the first three columns.
    #[inline]
    pub fn first_columns(&self) -> Matrix6x3 {
        let mut columns: Matrix6x3 = Matrix6x3::ZERO;
        for row in 0..6 {
            for column in 0..3 {
                columns.rows[row][column] = self.rows[row][column];
            }
        }
        columns
    }
}

/// Matrix of six rows and three columns. Products take the number of its columns that count: 3 or 2.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Matrix6x3 {
    /// Elements, row by row.
    pub rows: [[f64; 3]; 6],
}

impl Matrix6x3 {
    /// Zero matrix.
    pub const ZERO: Self = Self { rows: [[0.0; 3]; 6] };

    /// Returns the product of the leading `count` columns and the leading `count` rows of another matrix.
    #[inline]
    #[must_use]
    pub fn times(&self, count: usize, other: &Matrix3) -> Self {
        let mut product: Self = Self::ZERO;
        for row in 0..6 {
            for column in 0..3 {
                let mut sum: f64 = self.rows[row][0] * other.rows[0][column];
                for k in 1..count {
                    sum += self.rows[row][k] * other.rows[k][column];
                }
                product.rows[row][column] = sum;
            }
        }
        product
    }

    /// Returns the product of the matrix and the transpose of another.
    #[inline]
    #[must_use]
    pub fn times_transposed(&self, other: &Matrix3) -> Self {
        let mut product: Self = Self::ZERO;
        for row in 0..6 {
            for column in 0..3 {
                let mut sum: f64 = self.rows[row][0] * other.rows[column][0];
                for k in 1..3 {
                    sum += self.rows[row][k] * other.rows[column][k];
                }
                product.rows[row][column] = sum;
            }
        }
        product
    }

    /// Returns the product of the leading `count` columns and a vector, row by row of attitude and bias.
    #[inline]
    pub fn times_vector(&self, count: usize, v: &Vector3) -> AttitudeBiasError {
        let mut product: [f64; 6] = [0.0; 6];
        for row in 0..6 {
            let mut sum: f64 = self.rows[row][0] * v.x + self.rows[row][1] * v.y;
            if count > 2 {
                sum += self.rows[row][2] * v.z;
            }
            product[row] = sum;
        }
        AttitudeBiasError {
            attitude: Vector3 { x: product[0], y: product[1], z: product[2] },
            bias: Vector3 { x: product[3], y: product[4], z: product[5] },
        }
    }

    /// Returns the product of the matrix, a covariance and the transpose of the matrix: leading `count` columns and rows.
    #[inline]
    pub fn spread(&self, count: usize, covariance: &Matrix3) -> Matrix6 {
        let scaled: Self = self.times(count, covariance);
        let mut product: Matrix6 = Matrix6::ZERO;
        for row in 0..6 {
            for column in 0..6 {
                let mut sum: f64 = scaled.rows[row][0] * self.rows[column][0];
                for k in 1..count {
                    sum += scaled.rows[row][k] * self.rows[column][k];
                }
                product.rows[row][column] = sum;
            }
        }
        product
    }
}

/// Error of an estimate: truth relative to the estimate.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct AttitudeBiasError {
    /// Rotation vector (rad), in body axes.
    pub attitude: Vector3,
    /// Error of the gyro bias (rad/s).
    pub bias: Vector3,
}
