//! Simulation, sample by sample, of a loop whose command has a dead zone, a quantum or a limit.

use nalgebra::DMatrix;

use super::closed::PackedMatrix;
use super::{ClosedLoop, CommandPath};

impl ClosedLoop {
    /// Calls `report` with the angle (rad) at each of the first `count` samples; one product a sample gives the state,
    /// and from it the angle and the command of the next sample.
    pub(super) fn for_each_sample(&self, shape: &CommandPath, count: usize, mut report: impl FnMut(f64)) {
        let order = self.free.nrows();
        let dense = |row: &nalgebra::RowDVector<f64>| DMatrix::from_iterator(1, order, row.iter().copied());
        let (angle_row, feedback_row) = (dense(&self.angle), dense(&self.feedback));
        let ahead = [&angle_row * &self.free, &feedback_row * &self.free];
        let stacked = PackedMatrix::new(&[&self.free, &ahead[0], &ahead[1]]);
        let forced = DMatrix::from_column_slice(order, 1, self.forced.as_slice());
        let added = [&angle_row * &forced, &feedback_row * &forced];
        let added = PackedMatrix::new(&[&forced, &added[0], &added[1]]);

        let mut state = self.start.as_slice().to_vec();
        let (mut angle, mut fed_back) = ((&self.angle * &self.start).x, (&self.feedback * &self.start).x);
        let (mut out, mut push) = (vec![0.0; stacked.rows()], vec![0.0; stacked.rows()]);
        added.apply(&[1.0], &mut push);
        for _ in 0..count {
            report(angle);
            let command = shape.execute(-fed_back);
            stacked.apply(&state, &mut out);
            for (out, push) in out.iter_mut().zip(&push) {
                *out += push * command;
            }
            state.copy_from_slice(&out[..order]);
            (angle, fed_back) = (out[order], out[order + 1]);
        }
    }
}
