//! Propagation of the covariance of attitude and gyro bias through an interval in which the body rotates, in blocks of
//! three rows and columns.

use crate::matrix3::Matrix3;
use crate::matrix6::Matrix6;
use crate::stumpff::Stumpff;
use crate::vector3::Vector3;

/// Blocks of the transition of an interval, and of the covariance that the noise of the gyro adds.
struct IntervalBlocks {
    /// Transition of the attitude error.
    turned: Matrix3,
    /// Transition from the bias error to the attitude error, with a minus.
    drifted: Matrix3,
    /// Covariance added to the attitude error (rad²).
    angle: Matrix3,
    /// Covariance subtracted from that of attitude and bias errors (rad²/s).
    both: Matrix3,
}

/// Random walks of a gyro over an interval.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct IntervalNoise {
    /// Length of the interval (s).
    pub seconds: f64,
    /// Square of the angle random walk (rad²/s).
    pub white: f64,
    /// Square of the rate random walk (rad²/s³).
    pub walk: f64,
}

impl IntervalBlocks {
    /// Returns the blocks, exact for a constant rate that rotates the body by `turn` (rad).
    #[inline]
    fn new(turn: &Vector3, noise: &IntervalNoise) -> Self {
        let c: Stumpff = Stumpff::at(turn.norm_squared());
        let seconds: f64 = noise.seconds;
        let along: [f64; 3] = [turn.x, turn.y, turn.z];
        let both_scale: f64 = seconds * seconds * noise.walk;
        let angle_scale: f64 = 2.0 * seconds * seconds * seconds * noise.walk;
        let white: f64 = noise.white * seconds;
        let mut angle: Matrix3 = Matrix3::ZERO;
        for row in 0..3 {
            for column in 0..row {
                let across: f64 = along[row] * along[column] * c.c5 * angle_scale;
                angle.rows[row][column] = across;
                angle.rows[column][row] = across;
            }
            angle.rows[row][row] = (c.c3 + along[row] * along[row] * c.c5) * angle_scale + white;
        }
        Self {
            turned: cross_polynomial(turn, 1.0, c.c1, c.c2, 1.0),
            drifted: cross_polynomial(turn, 1.0, c.c2, c.c3, seconds),
            angle,
            both: cross_polynomial(turn, 0.5, c.c3, c.c4, both_scale),
        }
    }
}

/// Returns (`one` I - `once` \[v\] + `twice` \[v\]²) `scale`, where \[v\] is the matrix of the cross product with `v`.
#[inline]
fn cross_polynomial(v: &Vector3, one: f64, once: f64, twice: f64, scale: f64) -> Matrix3 {
    let x: f64 = v.x * once;
    let y: f64 = v.y * once;
    let z: f64 = v.z * once;
    let xx: f64 = v.x * v.x;
    let yy: f64 = v.y * v.y;
    let zz: f64 = v.z * v.z;
    let xy: f64 = v.x * v.y * twice;
    let yz: f64 = v.y * v.z * twice;
    let zx: f64 = v.z * v.x * twice;
    Matrix3 {
        rows: [
            [(one - (yy + zz) * twice) * scale, (xy + z) * scale, (zx - y) * scale],
            [(xy - z) * scale, (one - (zz + xx) * twice) * scale, (yz + x) * scale],
            [(zx + y) * scale, (yz - x) * scale, (one - (xx + yy) * twice) * scale],
        ],
    }
}

impl Matrix6 {
    /// Propagates the covariance, which is symmetric, through an interval in which the body rotates by `turn` (rad) at a
    /// constant rate: the attitude error theta becomes `turned` theta - `drifted` beta, and noise adds its exact covariance.
    pub fn propagate(&mut self, turn: &Vector3, noise: &IntervalNoise) {
        let blocks: IntervalBlocks = IntervalBlocks::new(turn, noise);
        let mut carried: Matrix3 = Matrix3::ZERO;
        let mut moved: Matrix3 = Matrix3::ZERO;
        // Columns are read along rows, next to each other.
        for row in 0..3 {
            for column in 0..3 {
                moved.rows[row][column] = (blocks.turned.rows[row][0] * self.rows[0][column]
                    + blocks.turned.rows[row][1] * self.rows[1][column]
                    + blocks.turned.rows[row][2] * self.rows[2][column])
                    - (blocks.drifted.rows[row][0] * self.rows[3][column]
                        + blocks.drifted.rows[row][1] * self.rows[4][column]
                        + blocks.drifted.rows[row][2] * self.rows[5][column]);
                carried.rows[row][column] = (blocks.turned.rows[row][0] * self.rows[0][3 + column]
                    + blocks.turned.rows[row][1] * self.rows[1][3 + column]
                    + blocks.turned.rows[row][2] * self.rows[2][3 + column])
                    - (blocks.drifted.rows[row][0] * self.rows[3][3 + column]
                        + blocks.drifted.rows[row][1] * self.rows[4][3 + column]
                        + blocks.drifted.rows[row][2] * self.rows[5][3 + column]);
            }
        }
        let mut angle: Matrix3 = Matrix3::ZERO;
        for row in 0..3 {
            for column in 0..3 {
                angle.rows[row][column] = (moved.rows[row][0] * blocks.turned.rows[column][0]
                    + moved.rows[row][1] * blocks.turned.rows[column][1]
                    + moved.rows[row][2] * blocks.turned.rows[column][2])
                    - (carried.rows[row][0] * blocks.drifted.rows[column][0]
                        + carried.rows[row][1] * blocks.drifted.rows[column][1]
                        + carried.rows[row][2] * blocks.drifted.rows[column][2])
                    + blocks.angle.rows[row][column];
            }
        }
        for row in 0..3 {
            for column in 0..row {
                let mean: f64 = (angle.rows[row][column] + angle.rows[column][row]) * 0.5;
                self.rows[row][column] = mean;
                self.rows[column][row] = mean;
            }
            self.rows[row][row] = angle.rows[row][row];
            for column in 0..3 {
                let across: f64 = carried.rows[row][column] - blocks.both.rows[row][column];
                self.rows[row][3 + column] = across;
                self.rows[3 + column][row] = across;
            }
            self.rows[3 + row][3 + row] += noise.walk * noise.seconds;
        }
    }
}
