//! The rigid motion about three axes: Euler's equations and the attitude, by Gauss-Legendre steps of order 6.
//!
//! With the angular momentum L = J w in the body's axes, L' = L x w + M and Q' = 1/2 Q o (0, w). Gauss-Legendre methods keep
//! every quadratic invariant but for rounding, and without a torque |L|², the energy L . w / 2 and |Q|² are quadratic. Both
//! are summed with compensation, so that rounding does not add up over millions of steps: without a torque |L|, the energy
//! and L in space stay within 1e-14 of themselves over 1e6 s of a station, and within 1e-13 over 1e4 s of a body that
//! tumbles at 0.6 rad/s (tests/spatial.rs).

use nalgebra::{Matrix3, Quaternion, SVector};

use super::{Periodic, Spatial, Vector};

/// A step turns the body by at most about this (rad): the error of its direction is then below 1e-15 rad.
const LONGEST: f64 = 1.0 / 16.0;
/// Passes after which the stages are taken as they are: they converge by a factor of 16 or more each.
const PASSES: u32 = 40;

/// Steps after which the motion asks whether it may go on.
const STEPS: u64 = 256;

/// sqrt(15).
const R: f64 = 3.872_983_346_207_417;
/// The three-stage Gauss-Legendre method: nodes, weights, matrix.
const NODES: [f64; 3] = [0.5 - R / 10.0, 0.5, 0.5 + R / 10.0];
const WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];
const MATRIX: [[f64; 3]; 3] = [
    [5.0 / 36.0, 2.0 / 9.0 - R / 15.0, 5.0 / 36.0 - R / 30.0],
    [5.0 / 36.0 + R / 24.0, 2.0 / 9.0, 5.0 / 36.0 - R / 24.0],
    [5.0 / 36.0 + R / 30.0, 2.0 / 9.0 + R / 15.0, 5.0 / 36.0],
];

/// The constants of a rigid body and of what its surroundings exert.
#[derive(Clone, Debug)]
pub struct Rigid {
    inertia: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// No rate is larger for a unit of angular momentum (1/(kg m²)).
    mobility: f64,
    disturbance: Option<Periodic>,
}

/// Where a rigid body is and how it turns.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Turn {
    /// Unit quaternion that turns vectors of the body into inertial ones.
    pub attitude: Quaternion<f64>,
    /// Angular momentum J w in the body's axes (N m s).
    momentum: Vector,
    /// What rounding has left out of both.
    lost: (Quaternion<f64>, Vector),
}

impl Rigid {
    /// The rigid body of a scenario's.
    pub fn new(body: &Spatial) -> Self {
        let inertia = body.tensor();
        // A body that was checked has an inverse.
        let inverse = inertia.try_inverse().unwrap_or_else(Matrix3::identity);
        // Symmetric to the last bit, so that the energy is a quadratic form.
        let inverse = (inverse + inverse.transpose()) * 0.5;
        Self { inertia, inverse, mobility: inverse.norm(), disturbance: body.disturbance.clone() }
    }

    /// The motion with an attitude and rates in the body's axes (rad/s).
    pub fn start(&self, attitude: Quaternion<f64>, rate: Vector) -> Turn {
        Turn { attitude, momentum: self.inertia * rate, lost: (Quaternion::default(), Vector::zeros()) }
    }

    /// Rates in the body's axes (rad/s).
    pub fn rate(&self, turn: &Turn) -> Vector {
        self.inverse * turn.momentum
    }

    /// Angular momentum in the body's axes (N m s).
    pub fn momentum(turn: &Turn) -> Vector {
        turn.momentum
    }

    /// Kinetic energy of the rotation (J).
    pub fn energy(&self, turn: &Turn) -> f64 {
        0.5 * turn.momentum.dot(&self.rate(turn))
    }

    /// Moves on by `h` seconds from `t` seconds after the start, under this torque (N m) and the surroundings', as long as
    /// it may `go_on`.
    pub fn advance<E>(
        &self,
        turn: &mut Turn,
        torque: &Vector,
        (t, h): (f64, f64),
        mut go_on: impl FnMut() -> Result<(), E>,
    ) -> Result<(), E> {
        let (exerted, slow) = self.disturbance.as_ref().map_or((0.0, 0.0), |d| (d.bound(), d.frequency()));
        let push = torque.norm() + exerted;
        let rate = self.mobility * (turn.momentum.norm() + push * h);
        let steps = libm::ceil(h * (rate + slow) / LONGEST).max(1.0);
        let small = h / steps;
        for step in 0..steps as u64 {
            if step % STEPS == STEPS - 1 {
                go_on()?;
            }
            let from = t + small * step as f64;
            let torques = NODES.map(|node| match &self.disturbance {
                None => *torque,
                Some(disturbance) => torque + disturbance.at(from + node * small),
            });
            self.step(turn, &torques, small, rate * small);
        }
        Ok(())
    }

    /// One step of `h` seconds under the torques at the nodes. Each pass over the stages errs less by `contraction`.
    fn step(&self, turn: &mut Turn, torques: &[Vector; 3], h: f64, contraction: f64) {
        let Turn { attitude, momentum, lost } = turn;
        let mut pushes = torques.map(|torque| momentum.cross(&(self.inverse * *momentum)) + torque);
        let mut turns = [spin(attitude, &(self.inverse * *momentum)); 3];
        let size = momentum.norm() + h * torques[1].norm();
        for _ in 0..PASSES {
            let mut change = 0.0_f64;
            for stage in 0..3 {
                let row = &MATRIX[stage];
                let stage_of = |of: &[Vector; 3]| of[0] * row[0] + of[1] * row[1] + of[2] * row[2];
                let here = *momentum + stage_of(&pushes) * h;
                let rate = self.inverse * here;
                let push = here.cross(&rate) + torques[stage];
                let facing = *attitude + (turns[0] * row[0] + turns[1] * row[1] + turns[2] * row[2]) * h;
                let turned = spin(&facing, &rate);
                // Of the momentum relative to its size.
                if size > 0.0 {
                    change = change.max((push - pushes[stage]).norm() / size);
                }
                change = change.max((turned - turns[stage]).norm());
                (pushes[stage], turns[stage]) = (push, turned);
            }
            if change * h * contraction <= 1e-18 {
                break;
            }
        }
        let increment = pushes[0] * WEIGHTS[0] + pushes[1] * WEIGHTS[1] + pushes[2] * WEIGHTS[2];
        let turned = turns[0] * WEIGHTS[0] + turns[1] * WEIGHTS[1] + turns[2] * WEIGHTS[2];
        (*momentum, lost.1) = exact_sum(*momentum, increment * h + lost.1);
        (attitude.coords, lost.0.coords) = exact_sum(attitude.coords, (turned * h + lost.0).coords);
        // The method keeps the length but for rounding, of which this removes what is left.
        let excess = attitude.norm_squared() - 1.0;
        if excess.abs() > 4.0 * f64::EPSILON {
            *attitude *= 1.0 - 0.5 * excess;
        }
    }
}

/// A sum, and what rounding takes from it (Knuth).
fn exact_sum<const N: usize>(a: SVector<f64, N>, b: SVector<f64, N>) -> (SVector<f64, N>, SVector<f64, N>) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// Q' = 1/2 Q o (0, w).
fn spin(attitude: &Quaternion<f64>, rate: &Vector) -> Quaternion<f64> {
    *attitude * Quaternion::from_imag(rate * 0.5)
}
