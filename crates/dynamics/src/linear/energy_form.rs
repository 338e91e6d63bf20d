//! Second-order plant in energy coordinates, in which damping never becomes negative by rounding.
//!
//! With M = R' R and K = N' N, the coordinates s = N q and v = R q' give s' = L v, v' = -L' s - R^-T (D + G) R^-1 v
//! with L = N R^-1. Without damping the matrix is skew, and its eigenvectors are unitary. Coordinates without
//! stiffness do not appear.

use nalgebra::{Cholesky, DMatrix};

use super::split_form::{LinearPlant, SplitPlant};

/// Second-order plant M q'' + (D + G) q' + K q = B u with outputs y = C q.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondOrderPlant {
    /// Mass matrix M, symmetric and positive definite.
    pub mass: DMatrix<f64>,
    /// Matrix D + G: damping, symmetric, and gyroscopic forces, skew.
    pub damping: DMatrix<f64>,
    /// Stiffness matrix K, symmetric. A rigid coordinate has a row and a column of zeros.
    pub stiffness: DMatrix<f64>,
    /// Matrix B, one column for each input.
    pub input: DMatrix<f64>,
    /// Matrix C, one row for each output.
    pub output: DMatrix<f64>,
}

impl SecondOrderPlant {
    /// Returns the plant in energy coordinates, or in balanced ones if a stiffness is negative; its state is x = (q,
    /// q'). `None` if the mass matrix is not positive definite.
    pub fn to_split_form(&self) -> Option<SplitPlant> {
        let mass = Cholesky::new(self.mass.clone())?;
        let order = self.mass.nrows();
        let (rigid, elastic): (Vec<usize>, Vec<usize>) =
            (0..order).partition(|i| self.stiffness.column(*i).iter().all(|k| *k == 0.0));
        let stiff = self.stiffness.select_rows(&elastic).select_columns(&elastic);
        Some(match Cholesky::new(stiff) {
            Some(stiffness) => self.in_energy(&mass.l(), &stiffness.l(), (&rigid, &elastic)),
            None => self.balanced(&mass),
        })
    }

    fn in_energy(
        &self,
        mass: &DMatrix<f64>,
        stiffness: &DMatrix<f64>,
        (rigid, elastic): (&[usize], &[usize]),
    ) -> SplitPlant {
        let (order, stiff) = (self.mass.nrows(), elastic.len());
        let identity = DMatrix::<f64>::identity(order, order);
        // Cholesky factors of positive definite matrices have no zero on their diagonals.
        let inverse = |l: &DMatrix<f64>, matrix: &DMatrix<f64>| {
            l.solve_lower_triangular(matrix).unwrap_or_else(|| matrix.clone()).transpose()
        };
        let r = mass.transpose();
        let back = inverse(mass, &identity);
        let small = DMatrix::identity(stiff, stiff);
        let unbent = inverse(stiffness, &small);
        let coupling = stiffness.transpose() * back.select_rows(elastic);
        let mut matrix = DMatrix::zeros(stiff + order, stiff + order);
        matrix.view_mut((0, stiff), (stiff, order)).copy_from(&coupling);
        matrix.view_mut((stiff, 0), (order, stiff)).copy_from(&-coupling.transpose());
        matrix
            .view_mut((stiff, stiff), (order, order))
            .copy_from(&-(back.transpose() * &self.damping * &back));
        let wide = |rows: usize| DMatrix::zeros(rows, stiff + order);
        let mut carried = wide(rigid.len());
        carried.columns_mut(stiff, order).copy_from(&back.select_rows(rigid));
        let mut input = DMatrix::zeros(stiff + order, self.input.ncols());
        input.rows_mut(stiff, order).copy_from(&(back.transpose() * &self.input));
        let mut output = wide(self.output.nrows());
        output.columns_mut(0, stiff).copy_from(&(self.output.select_columns(elastic) * &unbent));
        let place = |rows: &[usize]| {
            DMatrix::from_fn(rows.len(), 2 * order, |i, j| f64::from(u8::from(rows[i] == j)))
        };
        let mut split = DMatrix::zeros(stiff + order, 2 * order);
        split.rows_mut(0, stiff).copy_from(&(stiffness.transpose() * place(elastic)));
        split.view_mut((stiff, order), (order, order)).copy_from(&r);
        let mut joined = DMatrix::zeros(2 * order, stiff + order);
        joined.columns_mut(0, stiff).copy_from(&(place(elastic).transpose() * unbent));
        joined.view_mut((order, stiff), (order, order)).copy_from(&back);
        SplitPlant {
            carried,
            matrix,
            input,
            output: [self.output.select_columns(rigid), output],
            split: [place(rigid), split],
            joined: [place(rigid).transpose(), joined],
        }
    }

    /// Returns the plant in q and q', for a negative stiffness, where energy coordinates do not exist.
    fn balanced(&self, mass: &Cholesky<f64, nalgebra::Dyn>) -> SplitPlant {
        let order = self.mass.nrows();
        let mut matrix = DMatrix::zeros(2 * order, 2 * order);
        matrix.view_mut((0, order), (order, order)).fill_with_identity();
        matrix.view_mut((order, 0), (order, order)).copy_from(&-mass.solve(&self.stiffness));
        matrix.view_mut((order, order), (order, order)).copy_from(&-mass.solve(&self.damping));
        // Columns of zeros remain exactly zero.
        let mut input = DMatrix::zeros(2 * order, self.input.ncols());
        input.rows_mut(order, order).copy_from(&mass.solve(&self.input));
        let mut output = DMatrix::zeros(self.output.nrows(), 2 * order);
        output.columns_mut(0, order).copy_from(&self.output);
        LinearPlant { matrix, input, output }.split()
    }
}
