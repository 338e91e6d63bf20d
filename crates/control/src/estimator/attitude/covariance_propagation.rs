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
        let (mut turned, mut drifted) = ([kind; 3], [kind; 3]);
        // Covariance that noise adds to theta, and subtracts from the cross-covariance of theta and beta.
        let (mut angle, mut both) = ([kind; 3], [kind; 3]);
        for at in 0..3 {
            let twice = product(&cross, &sides[at]);
            both[at] = (one[at] * 0.5 - cross[at] * c3 + twice * c4) * (seconds * seconds * walk);
            angle[at] = (one[at] * c3 + along * turn[at] * c5) * (2.0 * seconds * seconds * seconds * walk)
                + one[at] * (white * seconds);
            turned[at] = one[at] - cross[at] * c1 + twice * c2;
            drifted[at] = (one[at] - cross[at] * c2 + twice * c3) * seconds;
        }
        // The transition is [turned, -drifted; 0, 1].
        let (mut carried, mut moved) = ([kind; 3], [kind; 3]);
        for at in 0..3 {
            let of_angle = [all[6 * at], all[6 * at + 1], all[6 * at + 2], 0.0];
            let across = [all[18 + 6 * at], all[19 + 6 * at], all[20 + 6 * at], 0.0];
            let back = [all[18 + at], all[24 + at], all[30 + at], 0.0];
            let of_bias = [all[21 + 6 * at], all[22 + 6 * at], all[23 + 6 * at], 0.0];
            carried[at] = product(&turned, &across) - product(&drifted, &of_bias);
            moved[at] = product(&turned, &of_angle) - product(&drifted, &back);
        }
        let (turns, drifts) = (stored(turned), stored(drifted));
        let mut of_angle = [kind; 3];
        for at in 0..3 {
            let turn = [turns[0][at], turns[1][at], turns[2][at], 0.0];
            let drift = [drifts[0][at], drifts[1][at], drifts[2][at], 0.0];
            of_angle[at] = product(&moved, &turn) - product(&carried, &drift) + angle[at];
        }
        for at in 0..3 {
            carried[at] = carried[at] - both[at];
        }
        let (of_angle, across) = (stored(of_angle), stored(carried));
        for column in 0..3 {
            for row in 0..3 {
                all[6 * column + row] = (of_angle[column][row] + of_angle[row][column]) * 0.5;
                all[6 * column + 3 + row] = across[row][column];
                all[18 + 6 * column + row] = across[column][row];
                all[21 + 6 * column + row] += ONE[column][row] * (walk * seconds);
            }
        }
    }
}

#[inline(always)]
fn columns<R: LaneFloat>(kind: R, of: &BlockColumns) -> [R; 3] {
    [kind.load(&of[0]), kind.load(&of[1]), kind.load(&of[2])]
}

#[inline(always)]
fn stored<R: LaneFloat>(of: [R; 3]) -> BlockColumns {
    let mut to = [[0.0; 4]; 3];
    for at in 0..3 {
        of[at].store(&mut to[at]);
    }
    to
}

/// Returns the product of a matrix and a vector.
#[inline(always)]
fn product<R: LaneFloat>(of: &[R; 3], vector: &[f64; 4]) -> R {
    of[0] * vector[0] + of[1] * vector[1] + of[2] * vector[2]
}
