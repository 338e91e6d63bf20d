//! Matrices of blocks.

use nalgebra::DMatrix;

/// Returns a matrix of blocks, row by row.
pub fn blocks<const ROWS: usize, const COLUMNS: usize>(
    parts: [[&DMatrix<f64>; COLUMNS]; ROWS],
) -> DMatrix<f64> {
    let rows = parts.iter().map(|row| row[0].nrows()).sum();
    let columns = parts[0].iter().map(|part| part.ncols()).sum();
    let (mut whole, mut top) = (DMatrix::zeros(rows, columns), 0);
    for row in parts {
        let mut left = 0;
        for part in row {
            whole.view_mut((top, left), part.shape()).copy_from(part);
            left += part.ncols();
        }
        top += row[0].nrows();
    }
    whole
}

/// Returns matrices one below the other.
pub fn stacked(parts: &[&DMatrix<f64>]) -> DMatrix<f64> {
    let rows = parts.iter().map(|part| part.nrows()).sum();
    let (mut whole, mut top) = (DMatrix::zeros(rows, parts[0].ncols()), 0);
    for part in parts {
        whole.view_mut((top, 0), part.shape()).copy_from(*part);
        top += part.nrows();
    }
    whole
}
