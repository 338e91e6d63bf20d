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

    /// Replaces the leading `count` rows and columns, which must be symmetric, by their inverse. Returns false if they are not
    /// positive definite; the matrix then is not valid.
    pub fn invert_definite(&mut self, count: usize) -> bool {
        let order: usize = if count < 3 { count } else { 3 };
        // Cholesky factor, below the diagonal.
        for j in 0..order {
            for k in 0..j {
                let factor: f64 = -self.rows[j][k];
                for i in j..order {
                    self.rows[i][j] += factor * self.rows[i][k];
                }
            }
            let diagonal: f64 = self.rows[j][j];
            if !(diagonal > 0.0) {
                return false;
            }
            let root: f64 = sqrt(diagonal);
            self.rows[j][j] = root;
            for i in (j + 1)..order {
                self.rows[i][j] /= root;
            }
        }
        let mut inverse: Self = Self::ZERO;
        for column in 0..order {
            let mut solution: [f64; 3] = [0.0; 3];
            solution[column] = 1.0;
            for i in 0..order {
                let value: f64 = solution[i] / self.rows[i][i];
                solution[i] = value;
                for below in (i + 1)..order {
                    solution[below] += -value * self.rows[below][i];
                }
            }
            for back in 0..order {
                let i: usize = order - 1 - back;
                let mut sum: f64 = 0.0;
                for below in (i + 1)..order {
                    sum += self.rows[below][i] * solution[below];
                }
                solution[i] = (solution[i] - sum) / self.rows[i][i];
            }
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
