//! Propagation of the covariance of attitude and bias through an interval in which the body rotates: products of 3x3
//! blocks, one column in the lanes of a register.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::lanes::{LaneFloat, SimdTask};
use nalgebra::Matrix6;

/// Columns of a matrix with three rows; the fourth lane is unused.
type BlockColumns = [[f64; 4]; 3];

const ONE: BlockColumns = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// Propagates theta to `turned` theta - `drifted` beta, exactly for a constant rate, with the exact covariance added by
/// noise.
pub(super) struct CovariancePropagation<'a> {
    pub covariance: &'a mut Matrix6<f64>,
    /// Rotation of the body (rad), and the Stumpff functions of its square.
    pub turn: Vector,
    pub phis: [f64; 5],
    pub seconds: f64,
    /// Squares of the gyro's random walks, of angle (rad²/s) and rate (rad²/s³).
    pub white: f64,
    pub walk: f64,
}

impl SimdTask for CovariancePropagation<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        let Self { covariance, turn, phis: [c1, c2, c3, c4, c5], seconds, white, walk } = self;
        let Some(all) = covariance.as_mut_slice().first_chunk_mut::<36>() else { return };
        let (x, y, z) = (turn.x, turn.y, turn.z);
        let sides: BlockColumns = [[0.0, z, -y, 0.0], [-z, 0.0, x, 0.0], [y, -x, 0.0, 0.0]];
        let cross = columns(kind, &sides);
        let one = columns(kind, &ONE);
        let along = kind.load(&[x, y, z, 0.0]);
        let (mut angle_rows, mut bias_rows) = ([kind; 3], [kind; 3]);
        // Covariance that noise adds to theta, and subtracts from the cross-covariance of theta and beta.
        let (mut angle, mut both) = ([kind; 3], [kind; 3]);
        for row in 0..3 {
            let twice = product(&cross, &sides[row]);
            both[row] = (one[row] * 0.5 - cross[row] * c3 + twice * c4) * (seconds * seconds * walk);
            angle[row] = (one[row] * c3 + along * turn[row] * c5)
                * (2.0 * seconds * seconds * seconds * walk)
                + one[row] * (white * seconds);
            angle_rows[row] = one[row] - cross[row] * c1 + twice * c2;
            bias_rows[row] = (one[row] - cross[row] * c2 + twice * c3) * seconds;
        }
        // The transition is [turned, -drifted; 0, 1].
        let (mut carried, mut moved) = ([kind; 3], [kind; 3]);
        for row in 0..3 {
            let angle_row = [all[6 * row], all[6 * row + 1], all[6 * row + 2], 0.0];
            let across = [all[18 + 6 * row], all[19 + 6 * row], all[20 + 6 * row], 0.0];
            let back = [all[18 + row], all[24 + row], all[30 + row], 0.0];
            let bias_row = [all[21 + 6 * row], all[22 + 6 * row], all[23 + 6 * row], 0.0];
            carried[row] = product(&angle_rows, &across) - product(&bias_rows, &bias_row);
            moved[row] = product(&angle_rows, &angle_row) - product(&bias_rows, &back);
        }
        let (turns, drifts) = (stored(angle_rows), stored(bias_rows));
        let mut angle_block = [kind; 3];
        for row in 0..3 {
            let turn = [turns[0][row], turns[1][row], turns[2][row], 0.0];
            let drift = [drifts[0][row], drifts[1][row], drifts[2][row], 0.0];
            angle_block[row] = product(&moved, &turn) - product(&carried, &drift) + angle[row];
        }
        for row in 0..3 {
            carried[row] = carried[row] - both[row];
        }
        let (angle_block, across) = (stored(angle_block), stored(carried));
        for column in 0..3 {
            for row in 0..3 {
                all[6 * column + row] = (angle_block[column][row] + angle_block[row][column]) * 0.5;
                all[6 * column + 3 + row] = across[row][column];
                all[18 + 6 * column + row] = across[column][row];
                all[21 + 6 * column + row] += ONE[column][row] * (walk * seconds);
            }
        }
    }
}

#[inline(always)]
fn columns<R: LaneFloat>(kind: R, columns: &BlockColumns) -> [R; 3] {
    [kind.load(&columns[0]), kind.load(&columns[1]), kind.load(&columns[2])]
}

#[inline(always)]
fn stored<R: LaneFloat>(columns: [R; 3]) -> BlockColumns {
    let mut to = [[0.0; 4]; 3];
    for row in 0..3 {
        columns[row].store(&mut to[row]);
    }
    to
}

/// Returns the product of a matrix and a vector.
#[inline(always)]
fn product<R: LaneFloat>(columns: &[R; 3], vector: &[f64; 4]) -> R {
    columns[0] * vector[0] + columns[1] * vector[1] + columns[2] * vector[2]
}
