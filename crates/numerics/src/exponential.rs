//! Exponential of a matrix.

use nalgebra::DMatrix;

use crate::lanes::{LaneFloat, Processor, SimdTask};

/// Highest power of Taylor's series: the next term, 0.5^16/16!, is below the last bit of 1.
const TERMS: u32 = 15;

/// Returns exp(M), by scaling, Taylor's series and squaring. Every sum has a fixed order: the result has the same
/// bits on every machine.
pub fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    match Processor::best() {
        Some(processor) => processor.run::<1, _>(MatrixRows(matrix)),
        None => MatrixRows(matrix).run(f64::NAN),
    }
}

/// SIMD task for one matrix, with its rows side by side in lanes.
struct MatrixRows<'a>(&'a DMatrix<f64>);

impl SimdTask for MatrixRows<'_> {
    type Output = DMatrix<f64>;

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> DMatrix<f64> {
        let Self(matrix) = self;
        let order = matrix.nrows();
        let (squarings, scale) = scaling(matrix);
        // Columns of whole registers; the rows that fill the last one have no meaning.
        let height = order.next_multiple_of(R::LANES);
        let mut small = vec![0.0; height * order];
        for column in 0..order {
            for row in 0..order {
                small[column * height + row] = matrix[(row, column)] * scale;
            }
        }
        let mut term = vec![0.0; height * order];
        for row in 0..order {
            term[row * height + row] = 1.0;
        }
        let mut sum = term.clone();
        let mut product = vec![0.0; height * order];
        for n in 1..=TERMS {
            multiply_rows(kind, &term, &small, order, &mut product);
            for first in (0..height * order).step_by(R::LANES) {
                let entries = kind.load(&product[first..]) / kind.splat(f64::from(n));
                entries.store(&mut term[first..]);
                (kind.load(&sum[first..]) + entries).store(&mut sum[first..]);
            }
        }
        for _ in 0..squarings {
            multiply_rows(kind, &sum, &sum, order, &mut product);
            std::mem::swap(&mut sum, &mut product);
        }
        let mut found = DMatrix::zeros(order, order);
        for column in 0..order {
            for row in 0..order {
                found[(row, column)] = sum[column * height + row];
            }
        }
        found
    }
}

/// Columns of a product that are summed side by side: each sum alone would wait for its last addition.
const COLUMNS: usize = 8;

/// Multiplies square matrices stored by columns of whole registers, each sum in the order of nalgebra's.
#[inline(always)]
fn multiply_rows<R: LaneFloat>(kind: R, a: &[f64], b: &[f64], order: usize, into: &mut [f64]) {
    let height = order.next_multiple_of(R::LANES);
    let together = order - order % COLUMNS;
    let mut factors = vec![[0.0; COLUMNS]; order.min(order * together)];
    for start in (0..together).step_by(COLUMNS) {
        for place in 0..COLUMNS {
            for k in 0..order {
                factors[k][place] = b[(start + place) * height + k];
            }
        }
        for first in (0..height).step_by(R::LANES) {
            let entries = kind.load(&a[first..]);
            let mut sums = [entries; COLUMNS];
            for place in 0..COLUMNS {
                sums[place] = entries * factors[0][place];
            }
            for k in 1..order {
                let entries = kind.load(&a[k * height + first..]);
                for place in 0..COLUMNS {
                    sums[place] = entries * factors[k][place] + sums[place];
                }
            }
            for place in 0..COLUMNS {
                sums[place].store(&mut into[(start + place) * height + first..]);
            }
        }
    }
    for column in together..order {
        let factors = &b[column * height..column * height + order];
        for first in (0..height).step_by(R::LANES) {
            let mut sum = kind.load(&a[first..]) * factors[0];
            for k in 1..order {
                sum = kind.load(&a[k * height + first..]) * factors[k] + sum;
            }
            sum.store(&mut into[column * height + first..]);
        }
    }
}

/// Returns the number of squarings and the scale factor of the matrix.
fn scaling(matrix: &DMatrix<f64>) -> (u32, f64) {
    let norm = matrix.row_iter().map(|row| row.iter().map(|m| m.abs()).sum::<f64>()).fold(0.0, f64::max);
    let mut squarings = 0;
    let mut scale = 1.0;
    // Non-finite matrices need no scaling.
    while norm * scale > 0.5 && squarings < 60 {
        squarings += 1;
        scale *= 0.5;
    }
    (squarings, scale)
}

/// Returns the exponentials of matrices of one order, each equal to the bit to [`exponential`], computed in SIMD
/// lanes if possible.
pub fn exponentials(matrices: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
    let Some(processor) = Processor::best().filter(|_| matrices.len() > 1) else {
        return matrices.iter().map(exponential).collect();
    };
    let some = |some: &[DMatrix<f64>]| processor.run::<1, _>(MatrixBatch(some));
    matrices.chunks(processor.lanes(1)).flat_map(some).collect()
}

/// SIMD task for at most as many matrices as there are lanes.
struct MatrixBatch<'a>(&'a [DMatrix<f64>]);

impl SimdTask for MatrixBatch<'_> {
    type Output = Vec<DMatrix<f64>>;

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> Vec<DMatrix<f64>> {
        let Self(matrices) = self;
        let order = matrices[0].nrows();
        let (mut each, mut squarings) = ([0.0; 16], [0; 16]);
        let mut scales = [0.0; 16];
        for (lane, matrix) in matrices.iter().enumerate() {
            (squarings[lane], scales[lane]) = scaling(matrix);
        }
        let scale = kind.load(&scales);
        let zero = kind.splat(0.0);
        let mut small = vec![zero; order * order];
        for (index, entry) in small.iter_mut().enumerate() {
            for (lane, matrix) in matrices.iter().enumerate() {
                each[lane] = matrix.as_slice()[index];
            }
            *entry = kind.load(&each) * scale;
        }
        let mut term = vec![zero; order * order];
        for row in 0..order {
            term[row * order + row] = kind.splat(1.0);
        }
        let mut sum = term.clone();
        let mut room = term.clone();
        for n in 1..=TERMS {
            multiply(&term, &small, order, &mut room);
            let divisor = kind.splat(f64::from(n));
            for index in 0..order * order {
                term[index] = room[index] / divisor;
                sum[index] = sum[index] + term[index];
            }
        }
        for done in 0..squarings.into_iter().max().unwrap_or(0) {
            for lane in 0..R::LANES {
                each[lane] = f64::from(u8::from(done < squarings[lane]));
            }
            let continuing = zero.lt(kind.load(&each));
            multiply(&sum, &sum, order, &mut room);
            for index in 0..order * order {
                sum[index] = R::select(continuing, room[index], sum[index]);
            }
        }
        let mut found = vec![DMatrix::zeros(order, order); matrices.len()];
        for (index, entry) in sum.iter().enumerate() {
            entry.store(&mut each);
            for (lane, matrix) in found.iter_mut().enumerate() {
                matrix.as_mut_slice()[index] = each[lane];
            }
        }
        found
    }
}

/// Rows of a product that are summed side by side.
const TILE: usize = 4;

/// Multiplies square matrices stored by columns, each sum in the order of nalgebra's.
#[inline(always)]
pub fn multiply<R: LaneFloat>(a: &[R], b: &[R], order: usize, into: &mut [R]) {
    for (factors, results) in b.chunks_exact(order).zip(into.chunks_exact_mut(order)) {
        let mut row = 0;
        while row + TILE <= order {
            sum_rows::<R, TILE>(a, factors, row, results);
            row += TILE;
        }
        while row < order {
            sum_rows::<R, 1>(a, factors, row, results);
            row += 1;
        }
    }
}

/// Computes `N` rows of a column of a product from the column `factors` of the second matrix.
#[inline(always)]
fn sum_rows<R: LaneFloat, const N: usize>(a: &[R], factors: &[R], row: usize, results: &mut [R]) {
    let mut sums = [factors[0]; N];
    for (sum, entry) in sums.iter_mut().zip(&a[row..row + N]) {
        *sum = *entry * factors[0];
    }
    for (entries, factor) in a.chunks_exact(factors.len()).zip(factors).skip(1) {
        for (sum, entry) in sums.iter_mut().zip(&entries[row..row + N]) {
            *sum = *entry * *factor + *sum;
        }
    }
    results[row..row + N].copy_from_slice(&sums);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns exp(M) by nalgebra's products.
    fn by_products(matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let order = matrix.nrows();
        let (squarings, scale) = scaling(matrix);
        let small = matrix * scale;
        let mut term = DMatrix::identity(order, order);
        let mut sum = term.clone();
        for n in 1..=TERMS {
            term = &term * &small / f64::from(n);
            sum += &term;
        }
        for _ in 0..squarings {
            sum = &sum * &sum;
        }
        sum
    }

    #[test]
    fn the_bits_are_those_of_plain_products() {
        for order in 1..=19 {
            let size = libm::pow(10.0, f64::from(order % 5) - 2.0);
            let matrix = DMatrix::from_fn(order as usize, order as usize, |i, j| {
                size * libm::sin((i * 17 + j * 7) as f64)
            });
            let expected = by_products(&matrix);
            assert_eq!(exponential(&matrix), expected, "order {order}");
            assert_eq!(MatrixRows(&matrix).run(f64::NAN), expected, "order {order}, no lanes");
        }
    }

    #[test]
    fn side_by_side_each_is_as_alone() {
        for (count, order) in [(1, 3), (2, 11), (9, 11), (21, 10)] {
            let entry = |matrix: usize, i: usize, j: usize| {
                let seed = (matrix * 131 + i * 17 + j * 7) as f64;
                libm::sin(seed) * libm::pow(10.0, libm::cos(3.0 * matrix as f64))
            };
            let all: Vec<_> =
                (0..count).map(|matrix| DMatrix::from_fn(order, order, |i, j| entry(matrix, i, j))).collect();
            for (matrix, found) in all.iter().zip(exponentials(&all)) {
                assert_eq!(found, exponential(matrix), "{count} of order {order}");
            }
        }
    }
}
