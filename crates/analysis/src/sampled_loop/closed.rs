//! Closed sampled loop: its matrix from sample to sample, and the angle at the samples.

use nalgebra::{DMatrix, DVector, RowDVector};

use super::CommandPath;

/// Number of samples that one product with a matrix gives.
const BLOCK: usize = 32;
/// Number of rows that are summed together.
const LANES: usize = 8;

/// Closed loop: u = shape(-feedback s), s+ = free s + forced u, x = angle s.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLoop {
    /// Transition matrix of the state without the command.
    pub free: DMatrix<f64>,
    /// Change of the state for a unit of the command.
    pub forced: DVector<f64>,
    /// Row that gives the negative command from the state.
    pub feedback: RowDVector<f64>,
    /// Row that gives the angle (rad) from the state.
    pub angle: RowDVector<f64>,
    /// State at the start.
    pub start: DVector<f64>,
    /// Sampling period (s).
    pub period: f64,
    /// Nonlinear path of the command; none for a linear loop.
    pub shape: Option<CommandPath>,
}

impl ClosedLoop {
    /// Returns a loop of `order` states whose matrices are zero.
    pub(super) fn zero(order: usize) -> Self {
        Self {
            free: DMatrix::zeros(order, order),
            forced: DVector::zeros(order),
            feedback: RowDVector::zeros(order),
            angle: RowDVector::zeros(order),
            start: DVector::zeros(order),
            period: 0.0,
            shape: None,
        }
    }

    /// Returns the matrix of the linear loop, s+ = M s, in which all of the command is executed.
    pub fn matrix(&self) -> DMatrix<f64> {
        &self.free - &self.forced * &self.feedback
    }

    /// Returns the angle at the first `count` samples (rad), the start first.
    pub fn angles(&self, count: usize) -> Vec<f64> {
        let mut angles = Vec::with_capacity(count);
        self.for_each_angle(count, |angle| angles.push(angle));
        angles
    }

    /// Calls `report` with the angle at each of the first `count` samples (rad), the start first.
    pub fn for_each_angle(&self, count: usize, report: impl FnMut(f64)) {
        match &self.shape {
            None => self.for_each_linear_block(count, report),
            Some(shape) => self.for_each_sample(shape, count, report),
        }
    }

    /// Calls `report` with the angles of a linear loop. A block of samples and the state after it are one product with a
    /// matrix: the angles are c s, c M s, c M² s, ..., and the state is M^32 s.
    fn for_each_linear_block(&self, count: usize, mut report: impl FnMut(f64)) {
        let matrix = self.matrix();
        let order = matrix.nrows();
        let mut rows = DMatrix::zeros(BLOCK, order);
        let mut row = self.angle.clone();
        let mut next = row.clone();
        for i in 0..BLOCK {
            rows.row_mut(i).copy_from(&row);
            row.mul_to(&matrix, &mut next);
            std::mem::swap(&mut row, &mut next);
        }
        let mut power = matrix;
        let mut square = power.clone();
        for _ in 0..BLOCK.ilog2() {
            power.mul_to(&power, &mut square);
            std::mem::swap(&mut power, &mut square);
        }
        let stacked = PackedMatrix::new(&[&rows, &power]);
        let mut state = self.start.as_slice().to_vec();
        let mut out = vec![0.0; stacked.rows()];
        let mut active = count;
        while active > 0 {
            stacked.apply(&state, &mut out);
            let reported = active.min(BLOCK);
            out[..reported].iter().for_each(|angle| report(*angle));
            state.copy_from_slice(&out[BLOCK..BLOCK + order]);
            active -= reported;
        }
    }
}

/// Matrix in panels of rows; the rows of a panel are adjacent in memory, column after column.
pub(super) struct PackedMatrix {
    panels: Vec<Vec<[f64; LANES]>>,
}

impl PackedMatrix {
    /// Packs matrices of the same number of columns, one below the other.
    pub(super) fn new(parts: &[&DMatrix<f64>]) -> Self {
        let columns = parts.first().map_or(0, |part| part.ncols());
        let rows: usize = parts.iter().map(|part| part.nrows()).sum();
        let mut panels = vec![vec![[0.0; LANES]; columns]; rows.div_ceil(LANES)];
        let mut first = 0;
        for part in parts {
            for (i, j) in (0..part.nrows()).flat_map(|i| (0..columns).map(move |j| (i, j))) {
                panels[(first + i) / LANES][j][(first + i) % LANES] = part[(i, j)];
            }
            first += part.nrows();
        }
        Self { panels }
    }

    /// Returns the number of rows, filled up with zeros to whole panels.
    pub(super) fn rows(&self) -> usize {
        self.panels.len() * LANES
    }

    /// Computes the product with a vector.
    pub(super) fn apply(&self, vector: &[f64], out: &mut [f64]) {
        for (panel, out) in self.panels.iter().zip(out.chunks_exact_mut(LANES)) {
            let mut sum = [0.0; LANES];
            for (column, v) in panel.iter().zip(vector) {
                for (sum, m) in sum.iter_mut().zip(column) {
                    *sum += m * v;
                }
            }
            out.copy_from_slice(&sum);
        }
    }
}
