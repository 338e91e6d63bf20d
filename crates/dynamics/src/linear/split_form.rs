//! Coupled plant with its rigid angles split off.
//!
//! A coordinate whose column in A is zero is cyclic: no rate depends on it. Left in, a rigid body would have the
//! defective double pole 0. Cyclic coordinates are recognised by zeros of the matrix, never by the size of an
//! eigenvalue. Where only filters depend on one, they are measured from their static response to it, which makes the
//! column zero.

use nalgebra::{DMatrix, DVector};

/// Plant x' = A x + B u with outputs y = C x.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearPlant {
    /// Matrix A.
    pub matrix: DMatrix<f64>,
    /// Matrix B, one column for each input.
    pub input: DMatrix<f64>,
    /// Matrix C, one row for each output.
    pub output: DMatrix<f64>,
}

/// Plant with cyclic coordinates split off: theta' = E w, w' = F w + B u, y = C_t theta + C_w w.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitPlant {
    /// Matrix E: rates of the cyclic coordinates.
    pub carried: DMatrix<f64>,
    /// Matrix F.
    pub matrix: DMatrix<f64>,
    /// Matrix B.
    pub input: DMatrix<f64>,
    /// Matrices C_t and C_w.
    pub output: [DMatrix<f64>; 2],
    /// Matrices that give theta and w from x.
    pub split: [DMatrix<f64>; 2],
    /// Matrices that give x from theta and from w.
    pub joined: [DMatrix<f64>; 2],
}

impl LinearPlant {
    /// Returns the plant with its cyclic coordinates split off and the rest balanced.
    pub fn split(&self) -> SplitPlant {
        let order = self.matrix.nrows();
        let (mut a, mut c) = (self.matrix.clone(), self.output.clone());
        // Coordinate change x = shift z, z = unshift x.
        let (mut shift, mut unshift) = (DMatrix::identity(order, order), DMatrix::identity(order, order));
        let mut cyclic = Vec::new();
        for theta in 0..order {
            if self.input.row(theta).iter().any(|b| *b != 0.0) {
                continue;
            }
            let reached = reached(&a, theta);
            if !reached.is_empty() {
                let standing = static_response(&a, theta, &reached, &cyclic);
                let Some(standing) = standing else { continue };
                let row = a.row(theta).into_owned();
                a -= &standing * row;
                a.column_mut(theta).fill(0.0);
                let standing_output = &c * &standing;
                c.column_mut(theta).zip_apply(&standing_output, |c, offset| *c += offset);
                let moved = &shift * &standing;
                shift.column_mut(theta).zip_apply(&moved, |s, moved| *s += moved);
                let back = unshift.row(theta).into_owned();
                unshift -= &standing * back;
            }
            cyclic.push(theta);
        }
        let rest: Vec<usize> = (0..order).filter(|i| !cyclic.contains(i)).collect();
        let mut matrix = a.select_rows(&rest).select_columns(&rest);
        let scale = balance(&mut matrix);
        let scaled = DMatrix::from_diagonal(&scale);
        let unscaled = DMatrix::from_diagonal(&scale.map(|d| 1.0 / d));
        SplitPlant {
            carried: a.select_rows(&cyclic).select_columns(&rest) * &scaled,
            matrix,
            input: &unscaled * self.input.select_rows(&rest),
            output: [c.select_columns(&cyclic), c.select_columns(&rest) * &scaled],
            split: [unshift.select_rows(&cyclic), &unscaled * unshift.select_rows(&rest)],
            joined: [shift.select_columns(&cyclic), shift.select_columns(&rest) * &scaled],
        }
    }
}

/// Returns the coordinates whose rates depend on a coordinate, directly or through others.
fn reached(a: &DMatrix<f64>, from: usize) -> Vec<usize> {
    let mut reached = Vec::new();
    let mut next = vec![from];
    while let Some(j) = next.pop() {
        for i in 0..a.nrows() {
            if a[(i, j)] != 0.0 && !reached.contains(&i) {
                reached.push(i);
                next.push(i);
            }
        }
    }
    reached.sort_unstable();
    reached
}

/// Returns the static response of the coupled states to a unit value of the cyclic coordinate; `None` if it does not
/// exist, or if the coordinate depends on itself.
fn static_response(
    a: &DMatrix<f64>,
    theta: usize,
    reached: &[usize],
    cyclic: &[usize],
) -> Option<DVector<f64>> {
    if reached.iter().any(|i| *i == theta || cyclic.contains(i)) {
        return None;
    }
    let inner = a.select_rows(reached).select_columns(reached);
    let sensed = DVector::from_fn(reached.len(), |i, _| -a[(reached[i], theta)]);
    let size = inner.amax();
    let factors = inner.full_piv_lu();
    let upper = factors.u();
    if (0..reached.len()).any(|i| upper[(i, i)].abs() <= 1e-12 * size) {
        return None;
    }
    let solved = factors.solve(&sensed)?;
    let mut standing = DVector::zeros(a.nrows());
    for (i, value) in reached.iter().zip(solved.iter()) {
        standing[*i] = *value;
    }
    Some(standing)
}

/// Balances rows and columns by scaling with powers of 2, which is exact; returns the scale factors.
fn balance(matrix: &mut DMatrix<f64>) -> DVector<f64> {
    let order = matrix.nrows();
    let mut scale = DVector::repeat(order, 1.0);
    // A few sweeps suffice; more than these do not help.
    for _ in 0..20 {
        let mut done = true;
        for i in 0..order {
            let others = |sum: f64, (j, m): (usize, &f64)| if j == i { sum } else { sum + m.abs() };
            let mut column = matrix.column(i).iter().enumerate().fold(0.0, others);
            let row = matrix.row(i).iter().enumerate().fold(0.0, others);
            if column == 0.0 || row == 0.0 || !(column * row).is_finite() {
                continue;
            }
            let (before, mut factor, mut r) = (column + row, 1.0, row);
            while column < 0.5 * r {
                (factor, column, r) = (2.0 * factor, 2.0 * column, 0.5 * r);
            }
            while column >= 2.0 * r {
                (factor, column, r) = (0.5 * factor, 0.5 * column, 2.0 * r);
            }
            if column + r < 0.95 * before {
                done = false;
                scale[i] *= factor;
                matrix.column_mut(i).scale_mut(factor);
                matrix.row_mut(i).scale_mut(1.0 / factor);
            }
        }
        if done {
            break;
        }
    }
    scale
}
