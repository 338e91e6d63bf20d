//! Matrices of a loop transfer, and of the loop when it is closed.

use flexsc_numerics::inverse::inverse;
use nalgebra::DMatrix;

/// Transfer `x[k+1] = a x[k] + b u[k]`, `y[k] = c x[k] + d u[k]`.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferMatrices {
    /// State matrix, of shape (states, states).
    pub a: DMatrix<f64>,
    /// Input matrix, of shape (states, inputs).
    pub b: DMatrix<f64>,
    /// Output matrix, of shape (outputs, states).
    pub c: DMatrix<f64>,
    /// Feedthrough matrix, of shape (outputs, inputs).
    pub d: DMatrix<f64>,
}

impl TransferMatrices {
    /// Closes a loop transfer L with negative feedback and returns the sensitivity S = (1 + L)^-1; `None` if it does
    /// not exist.
    pub fn sensitivity(&self) -> Option<Self> {
        let one = DMatrix::identity(self.d.nrows(), self.d.ncols());
        let back = inverse(one + &self.d)?;
        let c = &back * &self.c;
        Some(Self { a: &self.a - &self.b * &c, b: &self.b * &back, c: -c, d: back })
    }

    /// Returns the loop transfer of some signals of a loop, with the loops of the others closed; `None` if it does not
    /// exist.
    pub fn with_others_closed(&self, opened: &[usize]) -> Option<Self> {
        let others: Vec<usize> = (0..self.d.ncols()).filter(|place| !opened.contains(place)).collect();
        let (b, c) = (self.b.select_columns(opened), self.c.select_rows(opened));
        let (b_others, c_others) = (self.b.select_columns(&others), self.c.select_rows(&others));
        let d = |rows: &[usize], columns: &[usize]| self.d.select_rows(rows).select_columns(columns);
        if others.is_empty() {
            return Some(Self { a: self.a.clone(), b, c, d: d(opened, opened) });
        }
        let one = DMatrix::identity(others.len(), others.len());
        let back = inverse(one + d(&others, &others))?;
        // Outputs of the others, by the states and by the opened inputs.
        let (by_state, by_input) = (&back * c_others, &back * d(&others, opened));
        let across = d(opened, &others);
        Some(Self {
            a: &self.a - &b_others * &by_state,
            b: b - b_others * &by_input,
            c: c - &across * by_state,
            d: d(opened, opened) - across * by_input,
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    /// Response of a transfer with one state at a real z.
    fn at(transfer: &TransferMatrices, z: f64) -> DMatrix<f64> {
        &transfer.c * &transfer.b / (z - transfer.a[(0, 0)]) + &transfer.d
    }

    fn two_loops() -> TransferMatrices {
        TransferMatrices {
            a: dmatrix![0.5],
            b: dmatrix![1.0, -2.0],
            c: dmatrix![0.3; 0.7],
            d: dmatrix![0.0, 0.0; 0.4, 0.1],
        }
    }

    #[test]
    fn the_sensitivity_is_the_inverse_of_one_plus_the_loop() {
        let z = 2.0;
        let sensitivity = two_loops().sensitivity().expect("exists");
        let product = at(&sensitivity, z) * (DMatrix::identity(2, 2) + at(&two_loops(), z));
        assert!((product - DMatrix::identity(2, 2)).amax() < 1e-15);
    }

    #[test]
    fn a_loop_with_the_other_closed_is_a_schur_complement() {
        let z = -1.5;
        let l = at(&two_loops(), z);
        for (own, other) in [(0, 1), (1, 0)] {
            let one = two_loops().with_others_closed(&[own]).expect("exists");
            let expected = l[(own, own)] - l[(own, other)] * l[(other, own)] / (1.0 + l[(other, other)]);
            assert!((at(&one, z)[(0, 0)] - expected).abs() < 1e-15);
        }
    }
}
