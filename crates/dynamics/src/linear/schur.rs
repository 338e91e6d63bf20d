//! Complex Schur form F = Q T Q*, by shifted QR steps in one fixed order of operations.

use flexsc_numerics::phasor::{Phasor, abs};
use nalgebra::DMatrix;

/// Limit on the steps for one eigenvalue; a few are typical.
const MOST_STEPS: usize = 300;

/// Unitary Q (`basis`) and upper triangular T (`triangle`).
#[derive(Clone, Debug)]
pub struct Schur {
    pub basis: DMatrix<Phasor>,
    pub triangle: DMatrix<Phasor>,
}

impl Schur {
    /// Computes the Schur form of a matrix; `None` if its numbers leave the range of doubles.
    pub fn new(matrix: &DMatrix<f64>) -> Option<Self> {
        let order = matrix.nrows();
        let mut schur = Self {
            basis: DMatrix::identity(order, order),
            triangle: matrix.map(|m| Phasor { re: m, im: 0.0 }),
        };
        for column in 0..order.saturating_sub(2) {
            for row in (column + 2..order).rev() {
                schur.clear(row - 1, column);
            }
        }
        let scale = matrix.amax();
        let mut last = order.saturating_sub(1);
        let mut steps = 0;
        while last > 0 {
            let first = schur.decoupled(last, scale);
            if first == last {
                (last, steps) = (last - 1, 0);
                continue;
            }
            steps += 1;
            if steps > MOST_STEPS || !scale.is_finite() {
                return None;
            }
            schur.step(first, last, steps);
        }
        Some(schur)
    }

    /// Returns the first row of the block that ends in `last` and is not yet decoupled from its neighbours.
    fn decoupled(&mut self, last: usize, scale: f64) -> usize {
        let t = &mut self.triangle;
        for row in (1..=last).rev() {
            let near = abs(t[(row - 1, row - 1)]) + abs(t[(row, row)]);
            let near = if near == 0.0 { scale } else { near };
            if abs(t[(row, row - 1)]) <= f64::EPSILON * near {
                t[(row, row - 1)] = Phasor::default();
                return row;
            }
        }
        0
    }

    /// Performs one implicit QR step with Wilkinson's shift.
    fn step(&mut self, first: usize, last: usize, steps: usize) {
        let t = &self.triangle;
        let (a, b) = (t[(last - 1, last - 1)], t[(last - 1, last)]);
        let (c, d) = (t[(last, last - 1)], t[(last, last)]);
        let half = (a - d) * 0.5;
        let root = root(half * half + b * c);
        let away = if (half * root.conj()).re < 0.0 { half - root } else { half + root };
        // An occasional exceptional shift breaks a cycle.
        let shift = if steps.is_multiple_of(10) {
            d + Phasor { re: abs(c), im: 0.5 * abs(c) }
        } else if away == Phasor::default() {
            d
        } else {
            d - b * c / away
        };
        let start = [t[(first, first)] - shift, t[(first + 1, first)]];
        self.rotate(first, start);
        for row in first + 1..last {
            self.clear(row, row - 1);
        }
    }

    /// Rotates rows `row` and the next so that the lower one has a zero in `column`.
    fn clear(&mut self, row: usize, column: usize) {
        let pair = [self.triangle[(row, column)], self.triangle[(row + 1, column)]];
        if pair[1] != Phasor::default() {
            self.rotate(row, pair);
            self.triangle[(row + 1, column)] = Phasor::default();
        }
    }

    /// Rotates coordinates `row` and the next so that the given vector lies along the first.
    fn rotate(&mut self, row: usize, [x, y]: [Phasor; 2]) {
        let (size, norm) = (abs(x), f64::sqrt(x.norm_sqr() + y.norm_sqr()));
        if norm == 0.0 {
            return;
        }
        let (c, s) = if size == 0.0 {
            (0.0, Phasor { re: 1.0, im: 0.0 })
        } else {
            (size / norm, x / size * y.conj() / norm)
        };
        let (t, q) = (&mut self.triangle, &mut self.basis);
        for j in 0..t.ncols() {
            let (u, v) = (t[(row, j)], t[(row + 1, j)]);
            (t[(row, j)], t[(row + 1, j)]) = (u * c + s * v, v * c - s.conj() * u);
        }
        for matrix in [t, q] {
            for i in 0..matrix.nrows() {
                let (u, v) = (matrix[(i, row)], matrix[(i, row + 1)]);
                (matrix[(i, row)], matrix[(i, row + 1)]) = (u * c + s.conj() * v, v * c - s * u);
            }
        }
    }

    /// Returns the invariant subspace of the eigenvalues at some places on the diagonal: an orthonormal basis, and
    /// the triangular matrix of the map on it.
    pub fn subspace(&self, places: &[usize]) -> (DMatrix<Phasor>, DMatrix<Phasor>) {
        let mut schur = self.clone();
        for (front, place) in places.iter().enumerate() {
            for row in (front..*place).rev() {
                let t = &schur.triangle;
                let (upper, lower) = (t[(row, row)], t[(row + 1, row + 1)]);
                schur.rotate(row, [t[(row, row + 1)], lower - upper]);
                let t = &mut schur.triangle;
                (t[(row, row)], t[(row + 1, row + 1)]) = (lower, upper);
                t[(row + 1, row)] = Phasor::default();
            }
        }
        let count = places.len();
        (schur.basis.columns(0, count).into_owned(), schur.triangle.view((0, 0), (count, count)).into_owned())
    }
}

/// Returns a square root of a complex number.
fn root(z: Phasor) -> Phasor {
    let size = abs(z);
    let re = f64::sqrt(0.5 * (size + z.re.abs()));
    let im = if re > 0.0 { 0.5 * z.im.abs() / re } else { 0.0 };
    let (re, im) = if z.re >= 0.0 { (re, im) } else { (im, re) };
    Phasor { re, im: if z.im < 0.0 { -im } else { im } }
}
