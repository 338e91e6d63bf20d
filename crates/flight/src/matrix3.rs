//! Matrices of three rows and columns.

use crate::square_root::sqrt;
use crate::vector3::Vector3;

/// Matrix of three rows and three columns.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Matrix3 {
    /// Elements, row by row.
    pub rows: [[f64; 3]; 3],
}

impl Matrix3 {
    /// Zero matrix.
    pub const ZERO: Self = Self { rows: [[0.0; 3]; 3] };
    /// Identity.
    pub const IDENTITY: Self = Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

    /// Returns the product of the matrix and a vector.
    #[inline]
    pub fn times(&self, v: &Vector3) -> Vector3 {
        Vector3 {
            x: self.rows[0][0] * v.x + self.rows[0][1] * v.y + self.rows[0][2] * v.z,
            y: self.rows[1][0] * v.x + self.rows[1][1] * v.y + self.rows[1][2] * v.z,
            z: self.rows[2][0] * v.x + self.rows[2][1] * v.y + self.rows[2][2] * v.z,
        }
    }

    /// Returns the matrix of the vector product `v` x.
    #[inline]
    pub fn cross(v: &Vector3) -> Self {
        Self { rows: [[0.0, -v.z, v.y], [v.z, 0.0, -v.x], [-v.y, v.x, 0.0]] }
    }

    /// Returns the product of two matrices.
    #[inline]
    #[must_use]
    pub fn times_matrix(&self, other: &Self) -> Self {
        let mut product: Self = Self::ZERO;
        for row in 0..3 {
            for column in 0..3 {
                let mut sum: f64 = self.rows[row][0] * other.rows[0][column];
                sum += self.rows[row][1] * other.rows[1][column];
                sum += self.rows[row][2] * other.rows[2][column];
                product.rows[row][column] = sum;
            }
        }
        product
    }

    /// Returns the product of the matrix and the transpose of another.
    #[inline]
    #[must_use]
    pub fn times_transposed(&self, other: &Self) -> Self {
        let mut product: Self = Self::ZERO;
        for row in 0..3 {
            for column in 0..3 {
                let mut sum: f64 = self.rows[row][0] * other.rows[column][0];
                sum += self.rows[row][1] * other.rows[column][1];
                sum += self.rows[row][2] * other.rows[column][2];
                product.rows[row][column] = sum;
            }
        }
        product
    }

    /// Returns the matrix divided by a number.
    #[inline]
    #[must_use]
    pub fn divided(&self, by: f64) -> Self {
        let mut quotient: Self = Self::ZERO;
        for row in 0..3 {
            for column in 0..3 {
                quotient.rows[row][column] = self.rows[row][column] / by;
            }
        }
        quotient
    }

    /// Replaces the leading `count` rows and columns, which must be symmetric, by their Cholesky factor below and on the
    /// diagonal. Returns false if they are not positive definite; the matrix then is not valid.
    #[inline]
    pub fn factorise(&mut self, count: usize) -> bool {
        let order: usize = if count < 3 { count } else { 3 };
        for j in 0..order {
            for k in 0..j {
                let factor: f64 = -self.rows[j][k];
                for i in j..order {
                    self.rows[i][j] += factor * self.rows[i][k];
                }
            }
            let diagonal: f64 = self.rows[j][j];
            let is_positive: bool = diagonal > 0.0;
            if !is_positive {
                return false;
            }
            let root: f64 = sqrt(diagonal);
            self.rows[j][j] = root;
            for i in (j + 1)..order {
                self.rows[i][j] /= root;
            }
        }
        true
    }

    /// Solves `order` equations, at most 3, of a matrix whose Cholesky factor this is: replaces the right side, of three
    /// values, by the solution.
    #[inline]
    fn solve_factored(&self, order: usize, values: &mut [f64]) {
        for i in 0..order {
            let value: f64 = values[i] / self.rows[i][i];
            values[i] = value;
            for below in (i + 1)..order {
                values[below] += -value * self.rows[below][i];
            }
        }
        for back in 0..order {
            let i: usize = order - 1 - back;
            let mut sum: f64 = 0.0;
            for below in (i + 1)..order {
                sum += self.rows[below][i] * values[below];
            }
            values[i] = (values[i] - sum) / self.rows[i][i];
        }
    }

    /// Returns the solution of the equations of a matrix of three rows whose Cholesky factor this is.
    #[inline]
    pub fn solve(&self, right: &Vector3) -> Vector3 {
        let mut values: [f64; 3] = [right.x, right.y, right.z];
        self.solve_factored(3, &mut values);
        Vector3 { x: values[0], y: values[1], z: values[2] }
    }

    /// Replaces the leading `count` rows and columns, which must be symmetric, by their inverse. Returns false if they are not
    /// positive definite; the matrix then is not valid.
    pub fn invert_definite(&mut self, count: usize) -> bool {
        let order: usize = if count < 3 { count } else { 3 };
        let is_definite: bool = self.factorise(order);
        if !is_definite {
            return false;
        }
        let mut inverse: Self = Self::ZERO;
        for column in 0..order {
            let mut solution: [f64; 3] = [0.0; 3];
            solution[column] = 1.0;
            self.solve_factored(order, &mut solution);
            for row in 0..order {
                inverse.rows[row][column] = solution[row];
            }
        }
        for row in 0..order {
            for column in 0..order {
                self.rows[row][column] = inverse.rows[row][column];
            }
        }
        true
    }
}
