//! The exponential of a matrix.

use nalgebra::DMatrix;

/// exp(M), by scaling, Taylor's series and squaring. Every sum has a fixed order: the same bits on every machine.
pub fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let order = matrix.nrows();
    let norm = matrix.row_iter().map(|row| row.iter().map(|m| m.abs()).sum::<f64>()).fold(0.0, f64::max);
    let mut squarings = 0;
    let mut scale = 1.0;
    // What is not finite stays so, and needs no scaling.
    while norm * scale > 0.5 && squarings < 60 {
        squarings += 1;
        scale *= 0.5;
    }
    let small = matrix * scale;
    let mut term = DMatrix::identity(order, order);
    let mut sum = term.clone();
    // 0.5^15/15! is below the last bit of 1.
    for n in 1..=15 {
        term = &term * &small / f64::from(n);
        sum += &term;
    }
    for _ in 0..squarings {
        sum = &sum * &sum;
    }
    sum
}
