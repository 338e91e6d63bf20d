//! Eigenvalues and eigenvectors: those of real matrices by QR steps with two shifts at a time \[Francis61\].
//!
//! Loops have defective eigenvalues 0, which delays give them, and equal eigenvalues of several axes: steps with shifts
//! that are not eigenvalues leave cycles, and after many steps an entry that is a rounding of the whole matrix is 0. The
//! error of the eigenvalues is then still that of a rounding of the matrix.

use nalgebra::linalg::{Hessenberg, Schur};
use nalgebra::{Complex, DMatrix, DVector};

/// Number of sweeps after which the search for a Schur form is given up.
const SWEEPS: usize = 10_000;
/// Limit on the times that all coordinates are scaled.
const SCALINGS: usize = 50;
/// Limit on the steps for one eigenvalue; a few are typical.
const MOST_STEPS: usize = 300;
/// Number of steps after which a shift is used that is not an eigenvalue of the last rows.
const EXCEPTIONAL: usize = 10;
/// Number of steps after which entries are compared with the whole matrix in place of their neighbours.
const PATIENCE: usize = 25;

/// Returns the eigenvalues of a square matrix, in no particular order; `None` if an entry is not finite, or if the search
/// does not converge.
pub fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let mut balanced = matrix.clone();
    let size = matrix.amax();
    if size > 0.0 {
        balanced /= size;
        balance(&mut balanced);
    }
    let form = if balanced.nrows() > 2 { Hessenberg::new(balanced).unpack_h() } else { balanced };
    let values = HessenbergSearch { scale: form.norm(), form }.run()?;
    Some(values.into_iter().map(|value| value * size).collect())
}

/// Returns the eigenvalues as the Schur form has them, for metrics, whose bits do not change; as [`eigenvalues`] has them if
/// the search for that form does not converge.
pub fn schur_eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    match Schur::try_new(matrix.clone(), f64::EPSILON, SWEEPS) {
        Some(schur) => Some(schur.complex_eigenvalues().iter().copied().collect()),
        None => eigenvalues(matrix),
    }
}

/// Scales the coordinates of a matrix by powers of 2 so that rows and columns have norms of one size \[JamesLangouLowery14\]. The
/// norms have the diagonal, so that couplings that are roundings remain small.
fn balance(matrix: &mut DMatrix<f64>) {
    let mut is_balanced = false;
    for _ in 0..SCALINGS {
        if std::mem::replace(&mut is_balanced, true) {
            return;
        }
        for index in 0..matrix.nrows() {
            let (column, row) = (matrix.column(index).norm(), matrix.row(index).norm());
            if column == 0.0 || row == 0.0 {
                continue;
            }
            let factor = libm::exp2(libm::round(0.5 * libm::log2(row / column)));
            if column * factor + row / factor < 0.95 * (column + row) {
                is_balanced = false;
                matrix.column_mut(index).scale_mut(factor);
                matrix.row_mut(index).unscale_mut(factor);
            }
        }
    }
}

/// Returns the eigenvalues of a complex square matrix; `None` if the search does not converge.
pub fn complex_eigenvalues(matrix: DMatrix<Complex<f64>>) -> Option<Vec<Complex<f64>>> {
    if matrix.len() == 1 {
        return Some(vec![matrix[(0, 0)]]);
    }
    if matrix.iter().any(|entry| !(entry.re.is_finite() && entry.im.is_finite())) {
        return None;
    }
    let (_, triangle) = Schur::try_new(matrix, f64::EPSILON, SWEEPS)?.unpack();
    Some(triangle.diagonal().iter().copied().collect())
}

/// Returns an eigenvector by inverse iteration, from a shift close to the eigenvalue; its largest entry is 1.
pub fn eigenvector(matrix: &DMatrix<f64>, value: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let order = matrix.nrows();
    let perturbed = value * (1.0 + 1e-11);
    let shifted = matrix.map(|entry| Complex::new(entry, 0.0))
        - DMatrix::from_diagonal_element(order, order, perturbed);
    let factors = shifted.lu();
    let mut vector = DVector::from_fn(order, |row, _| Complex::new(1.0, 0.1 * row as f64));
    for _ in 0..4 {
        vector = factors.solve(&vector)?;
        let size = vector.iter().map(|entry| libm::hypot(entry.re, entry.im)).fold(0.0, f64::max);
        vector.iter_mut().for_each(|entry| *entry /= size);
    }
    vector.iter().all(|entry| entry.re.is_finite() && entry.im.is_finite()).then_some(vector)
}

/// Search for the eigenvalues of a Hessenberg matrix.
struct HessenbergSearch {
    form: DMatrix<f64>,
    /// Norm of the matrix.
    scale: f64,
}

impl HessenbergSearch {
    fn run(mut self) -> Option<Vec<Complex<f64>>> {
        let mut values = Vec::with_capacity(self.form.nrows());
        let mut steps = 0;
        // Rows whose eigenvalues are not yet known.
        let mut open = self.form.nrows();
        while open > 0 {
            let last = open - 1;
            let first = self.decouple(last, steps);
            if first == last {
                values.push(Complex::new(self.form[(last, last)], 0.0));
            } else if first + 1 == last {
                values.extend(self.pair(first));
            } else {
                steps += 1;
                if steps > MOST_STEPS {
                    return None;
                }
                self.step(first, last, steps);
                continue;
            }
            (open, steps) = (first, 0);
        }
        Some(values)
    }

    /// Returns the first row of the block that ends in `last` and is not decoupled from the rows above it.
    fn decouple(&mut self, last: usize, steps: usize) -> usize {
        let h = &mut self.form;
        for row in (1..=last).rev() {
            let neighbours = h[(row - 1, row - 1)].abs() + h[(row, row)].abs();
            let near = if neighbours == 0.0 || steps > PATIENCE { self.scale } else { neighbours };
            if h[(row, row - 1)].abs() <= f64::EPSILON * near {
                h[(row, row - 1)] = 0.0;
                return row;
            }
        }
        0
    }

    /// Returns the eigenvalues of two rows.
    fn pair(&self, row: usize) -> [Complex<f64>; 2] {
        let h = &self.form;
        let (first, last) = (h[(row, row)], h[(row + 1, row + 1)]);
        let product = h[(row, row + 1)] * h[(row + 1, row)];
        let half = 0.5 * (first - last);
        let square = half * half + product;
        if square < 0.0 {
            let (re, im) = (last + half, f64::sqrt(-square));
            return [Complex::new(re, im), Complex::new(re, -im)];
        }
        let away = half + f64::sqrt(square).copysign(half);
        let near = if away == 0.0 { last } else { last - product / away };
        [Complex::new(last + away, 0.0), Complex::new(near, 0.0)]
    }

    /// Performs one implicit step on a block of three or more rows, whose shifts are the eigenvalues of its last two.
    fn step(&mut self, first: usize, last: usize, steps: usize) {
        let h = &self.form;
        let (above, below, product) = if steps.is_multiple_of(EXCEPTIONAL) {
            // A pair of other size and angle.
            let away = h[(last, last - 1)].abs() + h[(last - 1, last - 2)].abs();
            let middle = h[(last, last)] + 0.75 * away;
            (middle, middle, -0.4375 * away * away)
        } else {
            (h[(last - 1, last - 1)], h[(last, last)], h[(last - 1, last)] * h[(last, last - 1)])
        };
        // Differences of the diagonal: its products cancel where all eigenvalues are near to 1.
        let corner = h[(first, first)];
        let (above, below) = (above - corner, below - corner);
        let next = h[(first + 1, first + 1)] - corner;
        let under = h[(first + 1, first)];
        let start = [
            above * below - product + h[(first, first + 1)] * under,
            under * (next - above - below),
            under * h[(first + 2, first + 1)],
        ];
        self.reflect(first, [first, last], start);
        for row in first + 1..last {
            let below = if row + 2 <= last { self.form[(row + 2, row - 1)] } else { 0.0 };
            let column = [self.form[(row, row - 1)], self.form[(row + 1, row - 1)], below];
            self.reflect(row, [first, last], column);
            for under in row + 1..=(row + 2).min(last) {
                self.form[(under, row - 1)] = 0.0;
            }
        }
    }

    /// Reflects the coordinates of a row and the next two within a block, so that a vector along them becomes parallel to the
    /// first of them. Other rows and columns have no part in the eigenvalues of the block.
    fn reflect(&mut self, row: usize, [first, last]: [usize; 2], vector: [f64; 3]) {
        let size = vector.iter().fold(0.0, |size: f64, entry| size.max(entry.abs()));
        if size == 0.0 {
            return;
        }
        let [x, y, z] = vector.map(|entry| entry / size);
        let norm = f64::sqrt(x * x + y * y + z * z).copysign(x);
        // 1 - axis factors^T.
        let axis = [1.0, y / (x + norm), z / (x + norm)];
        let factors = axis.map(|entry| entry * (x + norm) / norm);
        let count = (last - row + 1).min(3);
        let h = &mut self.form;
        for column in row.saturating_sub(1).max(first)..=last {
            let sum: f64 = (0..count).map(|k| factors[k] * h[(row + k, column)]).sum();
            (0..count).for_each(|k| h[(row + k, column)] -= axis[k] * sum);
        }
        for under in first..=(row + 3).min(last) {
            let sum: f64 = (0..count).map(|k| axis[k] * h[(under, row + k)]).sum();
            (0..count).for_each(|k| h[(under, row + k)] -= factors[k] * sum);
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;
    use proptest::prelude::*;

    use super::*;

    fn sorted(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
        let mut values = eigenvalues(matrix).expect("values");
        values.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
        values
    }

    fn distance(a: Complex<f64>, b: Complex<f64>) -> f64 {
        libm::hypot(a.re - b.re, a.im - b.im)
    }

    /// Three samples of delay, twice, beside an integrator and a slow pole.
    #[test]
    fn delays_have_the_eigenvalue_0() {
        let mut matrix = DMatrix::<f64>::zeros(8, 8);
        for (row, column) in [(1, 0), (2, 1), (4, 3), (5, 4), (6, 2), (6, 5)] {
            matrix[(row, column)] = 1.0;
        }
        (matrix[(6, 6)], matrix[(7, 7)], matrix[(7, 6)]) = (1.0, 0.5, 0.3);
        let mut sizes: Vec<f64> = eigenvalues(&matrix)
            .expect("values")
            .iter()
            .map(|value| libm::hypot(value.re, value.im))
            .collect();
        sizes.sort_by(f64::total_cmp);
        assert_eq!(sizes.len(), 8);
        for (size, expected) in sizes.iter().zip([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 1.0]) {
            // A defective value of order three has an error of the third root of the rounding.
            assert!((size - expected).abs() < 1e-4, "{sizes:?}");
        }
    }

    #[test]
    fn matrices_of_few_rows() {
        assert!(eigenvalues(&DMatrix::zeros(0, 0)).expect("values").is_empty());
        assert_eq!(sorted(&dmatrix![-3e200]), [Complex::new(-3e200, 0.0)]);
        assert_eq!(sorted(&DMatrix::zeros(4, 4)), [Complex::ZERO; 4]);
        let turn = sorted(&dmatrix![0.0, -2.0; 2.0, 0.0]);
        assert_eq!(turn, [Complex::new(0.0, -2.0), Complex::new(0.0, 2.0)]);
        assert_eq!(eigenvalues(&dmatrix![1.0, f64::NAN; 0.0, 1.0]), None);
    }

    /// A permutation is left as it is by steps whose shifts are those of its last rows, 0.
    #[test]
    fn the_roots_of_one() {
        for order in 3..30 {
            let matrix = DMatrix::from_fn(order, order, |row, column| {
                f64::from(u8::from((column + 1) % order == row))
            });
            let values = sorted(&matrix);
            assert_eq!(values.len(), order);
            for k in 0..order {
                let angle = std::f64::consts::TAU * k as f64 / order as f64;
                let root = Complex::new(libm::cos(angle), libm::sin(angle));
                let nearest = values.iter().map(|value| distance(*value, root)).fold(1.0, f64::min);
                assert!(nearest < 1e-13, "{order}: {nearest:e}");
            }
        }
    }

    /// Values 1 + 1e-7 root: the products of the diagonal with itself would cancel.
    #[test]
    fn values_near_to_1() {
        for order in 3..30 {
            let matrix = DMatrix::from_fn(order, order, |row, column| {
                f64::from(u8::from(row == column)) + 1e-7 * f64::from(u8::from((column + 1) % order == row))
            });
            for value in sorted(&matrix) {
                let size = 1e7 * distance(value, Complex::new(1.0, 0.0));
                assert!((size - 1.0).abs() < 1e-7, "{order}: {size}");
            }
        }
    }

    /// Coordinates in units whose sizes are 12 decades apart.
    #[test]
    fn units_have_no_effect() {
        let order = 12;
        let matrix =
            DMatrix::from_fn(order, order, |row, column| libm::sin((1 + 7 * row + 3 * column) as f64));
        let unit = |index: usize| libm::exp2(((index * 17) % 40) as f64);
        let scaled =
            DMatrix::from_fn(order, order, |row, column| matrix[(row, column)] * unit(row) / unit(column));
        let plain = sorted(&matrix);
        for value in sorted(&scaled) {
            let nearest = plain.iter().map(|own| distance(value, *own)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12, "{value} {nearest:e}");
        }
    }

    /// Equal loops about three axes, with delays: LAPACK (numpy.linalg.eigvals) has the same values of the first axis.
    #[test]
    fn equal_axes_have_equal_eigenvalues() {
        let one = |delays: usize| {
            let order = delays + 2;
            let mut matrix = DMatrix::<f64>::zeros(order, order);
            // Integrators of the rate and the angle, under the command before all delays.
            (matrix[(0, 0)], matrix[(0, 1)], matrix[(1, 1)]) = (1.0, 0.25, 1.0);
            (matrix[(0, order - 1)], matrix[(1, order - 1)]) = (0.03125, 0.25);
            (matrix[(2, 0)], matrix[(2, 1)]) = (-0.04, -0.32);
            (3..order).for_each(|row| matrix[(row, row - 1)] = 1.0);
            matrix
        };
        for delays in 1..14 {
            let single = one(delays);
            let order = single.nrows();
            let mut all = DMatrix::<f64>::zeros(3 * order, 3 * order);
            (0..3).for_each(|axis| {
                all.view_mut((axis * order, axis * order), (order, order)).copy_from(&single);
            });
            // In other coordinates, axes are coupled by roundings.
            let turn = dmatrix![0.36, 0.48, -0.8; -0.8, 0.6, 0.0; 0.48, 0.64, 0.6];
            let turn = turn.kronecker(&DMatrix::<f64>::identity(order, order));
            let all = &turn * all * turn.transpose();
            let (single, all) = (sorted(&single), sorted(&all));
            assert_eq!(all.len(), 3 * order);
            for value in &all {
                let nearest = single.iter().map(|own| distance(*value, *own)).fold(f64::INFINITY, f64::min);
                assert!(nearest < 1e-10, "{delays}: {nearest:e}");
            }
            assert!(single.iter().any(|value| value.im != 0.0));
        }
    }

    proptest! {
        /// The values of a triangular matrix in other coordinates.
        #[test]
        fn values_do_not_depend_on_coordinates(
            diagonal in prop::collection::vec(-1.0..1.0, 1..12),
            entries in prop::collection::vec(-1.0..1.0, 144),
        ) {
            let order = diagonal.len();
            let at = |row: usize, column: usize| entries[12 * row + column];
            // Values apart from each other: the others depend on roundings.
            let known: Vec<f64> = (0..order).map(|k| k as f64 + 0.4 * diagonal[k]).collect();
            let triangle = DMatrix::from_fn(order, order, |row, column| match row.cmp(&column) {
                std::cmp::Ordering::Less => 0.1 * at(row, column),
                std::cmp::Ordering::Equal => known[row],
                std::cmp::Ordering::Greater => 0.0,
            });
            let basis = DMatrix::from_fn(order, order, at).qr().q();
            let values = sorted(&(&basis * triangle * basis.transpose()));
            prop_assert_eq!(values.len(), order);
            for (value, known) in values.iter().zip(known) {
                prop_assert!(distance(*value, Complex::new(known, 0.0)) < 1e-10, "{} {}", value, known);
            }
        }
    }
}
