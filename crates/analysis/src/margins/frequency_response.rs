//! Frequency response of a transfer, by a solve at each frequency: never through the coefficients of polynomials.

use nalgebra::linalg::Hessenberg;
use nalgebra::{Complex, DMatrix, DVector};

use crate::open_loop::TransferMatrices;

/// Transfer whose state matrix is in Hessenberg form, so that a solve needs n² operations.
#[derive(Clone, Debug)]
pub struct FrequencyResponse {
    transfer: TransferMatrices,
    /// Orthogonal basis Q of the Hessenberg form, A = Q H Q'.
    basis: DMatrix<f64>,
    /// Hessenberg matrix H, row by row.
    hessenberg: Vec<f64>,
    /// Input matrix Q' B.
    input: DMatrix<Complex<f64>>,
    /// Output matrix C Q.
    output: DMatrix<f64>,
}

/// Returns the magnitude of a complex number.
pub fn modulus(value: Complex<f64>) -> f64 {
    libm::hypot(value.re, value.im)
}

/// Returns the point of the unit circle at an angle (rad).
pub fn unit_circle(angle: f64) -> Complex<f64> {
    Complex::new(libm::cos(angle), libm::sin(angle))
}

impl FrequencyResponse {
    /// Prepares a transfer.
    pub fn new(transfer: &TransferMatrices) -> Self {
        let order = transfer.a.nrows();
        let (basis, form) = if order > 1 {
            Hessenberg::new(transfer.a.clone()).unpack()
        } else {
            (DMatrix::identity(order, order), transfer.a.clone())
        };
        let hessenberg = form.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<_>>()).collect();
        let input = complex(&(basis.transpose() * &transfer.b));
        let output = &transfer.c * &basis;
        Self { transfer: transfer.clone(), basis, hessenberg, input, output }
    }

    /// Returns c (z - a)^-1 b + d, with the rounding of the Hessenberg form; `None` at a pole.
    pub fn scan(&self, z: Complex<f64>) -> Option<DMatrix<Complex<f64>>> {
        let x = self.solve(z, self.input.clone())?;
        finite(real_product(&self.output, &x) + complex(&self.transfer.d))
    }

    /// Returns c (z - a)^-1 b + d; `None` at a pole.
    pub fn at(&self, z: Complex<f64>) -> Option<DMatrix<Complex<f64>>> {
        let TransferMatrices { b, c, d, .. } = &self.transfer;
        let x = self.states(z, &complex(b))?;
        finite(real_product(c, &x) + complex(d))
    }

    /// Returns (z - a)^-1 forced; `None` at a pole.
    pub fn states(&self, z: Complex<f64>, forced: &DMatrix<Complex<f64>>) -> Option<DMatrix<Complex<f64>>> {
        let back = self.basis.transpose();
        let mut x = real_product(&self.basis, &self.solve(z, real_product(&back, forced))?);
        // One step of refinement with the matrix itself removes the rounding of its Hessenberg form.
        let residual = forced - (&x * z - real_product(&self.transfer.a, &x));
        let correction = self.solve(z, real_product(&back, &residual))?;
        x += real_product(&self.basis, &correction);
        finite(x)
    }

    /// Returns the number of states.
    pub fn order(&self) -> usize {
        self.transfer.a.nrows()
    }

    /// Returns the input and the output matrix in the basis of the Hessenberg form.
    pub fn in_hessenberg_basis(&self) -> (&DMatrix<Complex<f64>>, DMatrix<Complex<f64>>) {
        (&self.input, complex(&self.output))
    }

    /// Returns the feedthrough matrix.
    pub fn feedthrough(&self) -> DMatrix<Complex<f64>> {
        complex(&self.transfer.d)
    }

    /// Solves (z - H) x = b by elimination with pivots; `None` at a pole.
    pub fn solve(&self, z: Complex<f64>, mut x: DMatrix<Complex<f64>>) -> Option<DMatrix<Complex<f64>>> {
        let (order, count) = x.shape();
        let mut matrix: Vec<Complex<f64>> =
            self.hessenberg.iter().map(|entry| Complex::new(-entry, 0.0)).collect();
        for k in 0..order {
            matrix[k * order + k] += z;
        }
        for k in 0..order {
            let (above, below) = matrix.split_at_mut((k + 1) * order);
            let row = &mut above[k * order..];
            if k + 1 < order {
                let next = &mut below[..order];
                if next[k].norm_sqr() > row[k].norm_sqr() {
                    row[k..].swap_with_slice(&mut next[k..]);
                    x.swap_rows(k, k + 1);
                }
                let factor = next[k] / row[k];
                for (entry, pivot) in next[k + 1..].iter_mut().zip(&row[k + 1..]) {
                    *entry -= factor * pivot;
                }
                for column in 0..count {
                    let above = x[(k, column)];
                    x[(k + 1, column)] -= factor * above;
                }
            }
            if row[k].norm_sqr() == 0.0 {
                return None;
            }
        }
        for k in (0..order).rev() {
            let row = &matrix[k * order..(k + 1) * order];
            for column in 0..count {
                let mut sum = x[(k, column)];
                for (place, entry) in row.iter().enumerate().skip(k + 1) {
                    sum -= entry * x[(place, column)];
                }
                x[(k, column)] = sum / row[k];
            }
        }
        Some(x)
    }
}

/// Returns a real matrix as a complex one.
fn complex(matrix: &DMatrix<f64>) -> DMatrix<Complex<f64>> {
    matrix.map(|entry| Complex::new(entry, 0.0))
}

/// Returns a matrix if it is finite.
fn finite(matrix: DMatrix<Complex<f64>>) -> Option<DMatrix<Complex<f64>>> {
    matrix.iter().all(|entry| entry.re.is_finite() && entry.im.is_finite()).then_some(matrix)
}

/// Returns the product of a real and a complex matrix.
pub fn real_product(left: &DMatrix<f64>, right: &DMatrix<Complex<f64>>) -> DMatrix<Complex<f64>> {
    let (re, im) = (left * right.map(|entry| entry.re), left * right.map(|entry| entry.im));
    re.zip_map(&im, Complex::new)
}

/// Returns the largest singular value of a small matrix.
pub fn largest_gain(matrix: &DMatrix<Complex<f64>>) -> f64 {
    if matrix.len() == 1 {
        return modulus(matrix[(0, 0)]);
    }
    let size = matrix.iter().map(|entry| modulus(*entry)).fold(0.0, f64::max);
    if size == 0.0 || !size.is_finite() {
        return size;
    }
    let scaled = matrix.map(|entry| entry / size);
    let values = (scaled.adjoint() * scaled).symmetric_eigenvalues();
    size * f64::sqrt(values.max().max(0.0))
}

/// Returns the direction into which a small matrix has its largest gain: the left singular vector.
pub fn largest_direction(matrix: &DMatrix<Complex<f64>>) -> DVector<Complex<f64>> {
    let size = matrix.iter().map(|entry| modulus(*entry)).fold(f64::MIN_POSITIVE, f64::max);
    let scaled = matrix.map(|entry| entry / size);
    let eigen = (&scaled * scaled.adjoint()).symmetric_eigen();
    eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned()
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    /// Three lags in a row with a pole pair at a distance of 1e-3 from the circle, against their closed form.
    #[test]
    fn the_response_is_that_of_the_closed_form() {
        let (re, im) = (0.999 * libm::cos(0.4), 0.999 * libm::sin(0.4));
        let transfer = TransferMatrices {
            a: dmatrix![re, im, 0.0; -im, re, 0.0; 0.0, 1.0, 0.5],
            b: dmatrix![0.0; 1.0; 0.0],
            c: dmatrix![0.0, 0.0, 1.0],
            d: dmatrix![0.25],
        };
        let response = FrequencyResponse::new(&transfer);
        for angle in [0.1, 0.399, 0.4, 1.5, 3.0] {
            let z = unit_circle(angle);
            let pair = (z - re) * (z - re) + im * im;
            let expected = (z - re) / pair / (z - 0.5) + 0.25;
            let found = response.at(z).expect("no pole")[(0, 0)];
            assert!(modulus(found - expected) < 1e-12 * modulus(expected), "{angle}: {found} {expected}");
        }
    }

    #[test]
    fn the_largest_gain_of_a_rotation_and_a_stretch() {
        let turn = Complex::new(0.6, 0.8);
        let matrix = dmatrix![turn * 3.0, turn * 4.0; turn * -4.0, turn * 3.0];
        assert!((largest_gain(&matrix) - 5.0).abs() < 1e-14);
        let rank_one = dmatrix![Complex::new(0.0, 3e-200), Complex::new(4e-200, 0.0)];
        assert!((largest_gain(&rank_one) / 5e-200 - 1.0).abs() < 1e-15);
    }
}
