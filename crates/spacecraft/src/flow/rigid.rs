//! The rigid motion about three axes: Euler's equations and the attitude, by Gauss-Legendre steps of order 6.
//!
//! With the angular momentum L = J w in the body's axes, L' = L x w + M and Q' = 1/2 Q o (0, w). Gauss-Legendre methods keep
//! every quadratic invariant but for rounding (\[HairerLubichWanner06\]), and without a torque |L|², the energy L . w / 2 and
//! |Q|² are quadratic. Both are summed with compensation, so that rounding does not add up over millions of steps: without a torque |L|, the energy
//! and L in space stay within 1e-14 of themselves over 1e6 s of a station, and within 1e-13 over 1e4 s of a body that
//! tumbles at 0.6 rad/s (tests/spatial.rs).

use nalgebra::{Matrix3, Quaternion};

use crate::attitude::Vector;
use crate::body::spatial::{Periodic, Spatial};
use crate::motion::turning::Surroundings;
use crate::numerics::gauss_legendre::{MATRIX, NODES, WEIGHTS, exact_sum};

/// A step turns the body by at most about this (rad): the error of its direction is then below 1e-15 rad.
pub const LONGEST_TURN: f64 = 1.0 / 16.0;
/// Passes after which the stages are taken as they are: they converge by a factor of 16 or more each.
const PASSES: u32 = 40;

/// Steps after which the motion asks whether it may go on.
const STEPS: u64 = 256;

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
pub struct RigidTurn {
    /// Unit quaternion that turns vectors of the body into inertial ones.
    pub attitude: Quaternion<f64>,
    /// Angular momentum J w in the body's axes (N m s).
    momentum: Vector,
    /// The integral of the rates since the start (rad).
    turned: Vector,
    /// What rounding has left out of the three.
    lost: (Quaternion<f64>, Vector, Vector),
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

    /// The inertia tensor (kg m²).
    pub fn inertia(&self) -> &Matrix3<f64> {
        &self.inertia
    }

    /// The motion with an attitude and rates in the body's axes (rad/s).
    pub fn start(&self, attitude: Quaternion<f64>, rate: Vector) -> RigidTurn {
        let (momentum, zero) = (self.inertia * rate, Vector::zeros());
        RigidTurn { attitude, momentum, turned: zero, lost: (Quaternion::default(), zero, zero) }
    }

    /// Rates in the body's axes (rad/s).
    pub fn rate(&self, turn: &RigidTurn) -> Vector {
        self.inverse * turn.momentum
    }

    /// Angular momentum in the body's axes (N m s).
    pub fn momentum(turn: &RigidTurn) -> Vector {
        turn.momentum
    }

    /// The rates of a turn are no larger with rotors of such a momentum (N m s), and it precesses no faster (rad/s).
    pub fn fastest(&self, turn: &RigidTurn, stored: f64) -> f64 {
        self.mobility * (turn.momentum.norm() + stored)
    }

    /// The integral of the rates since the start (rad).
    pub fn turned(turn: &RigidTurn) -> Vector {
        turn.turned
    }

    /// Kinetic energy of the rotation (J).
    pub fn energy(&self, turn: &RigidTurn) -> f64 {
        0.5 * turn.momentum.dot(&self.rate(turn))
    }

    /// Moves on by `h` seconds from `t` seconds after the start, under this torque (N m), the disturbance of the body and what
    /// is `around` it, as long as it may `go_on`. Rotors have a momentum (N m s) that changes at a rate (N m); the torque has what that gives the body.
    pub fn advance<E>(
        &self,
        turn: &mut RigidTurn,
        torque: &Vector,
        rotors: Option<(Vector, Vector)>,
        around: Option<&dyn Surroundings>,
        (t, h): (f64, f64),
        mut go_on: impl FnMut() -> Result<(), E>,
    ) -> Result<(), E> {
        let (mut exerted, mut slow) =
            self.disturbance.as_ref().map_or((0.0, 0.0), |d| (d.bound(), d.frequency()));
        if let Some(around) = around {
            exerted += around.bound();
            slow += around.frequency();
        }
        let push = torque.norm() + exerted;
        let spun = rotors.map_or(0.0, |(momentum, rate)| momentum.norm() + rate.norm() * h);
        let rate = self.mobility * (turn.momentum.norm() + spun + push * h);
        let steps = libm::ceil(h * (rate + slow) / LONGEST_TURN).max(1.0);
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
            let began = small * step as f64;
            let spun =
                rotors.map(|(momentum, rate)| NODES.map(|node| momentum + rate * (began + node * small)));
            let around = around.map(|around| (around, from));
            self.step(turn, &torques, spun.as_ref(), around, (small, rate * small));
        }
        Ok(())
    }

    /// One step of `h` seconds under the torques at the nodes, where rotors have a momentum, and what is around since a time
    /// after the start (s). Each pass over the stages errs less by `contraction`.
    fn step(
        &self,
        turn: &mut RigidTurn,
        torques: &[Vector; 3],
        rotors: Option<&[Vector; 3]>,
        around: Option<(&dyn Surroundings, f64)>,
        (h, contraction): (f64, f64),
    ) {
        let RigidTurn { attitude, momentum, turned: angle, lost } = turn;
        let mut pushes = torques.map(|torque| momentum.cross(&(self.inverse * *momentum)) + torque);
        let mut rates = [Vector::zeros(); 3];
        let mut turns = [spin(attitude, &(self.inverse * *momentum)); 3];
        let size = momentum.norm() + rotors.map_or(0.0, |rotors| rotors[1].norm()) + h * torques[1].norm();
        for _ in 0..PASSES {
            let mut change = 0.0_f64;
            for stage in 0..3 {
                let row = &MATRIX[stage];
                let stage_of = |of: &[Vector; 3]| of[0] * row[0] + of[1] * row[1] + of[2] * row[2];
                let here = *momentum + stage_of(&pushes) * h;
                let rate = self.inverse * here;
                let whole = rotors.map_or(here, |rotors| here + rotors[stage]);
                let mut push = whole.cross(&rate) + torques[stage];
                let facing = *attitude + (turns[0] * row[0] + turns[1] * row[1] + turns[2] * row[2]) * h;
                if let Some((around, from)) = around {
                    push += around.torque(from + NODES[stage] * h, &facing, &self.inertia);
                }
                let turned = spin(&facing, &rate);
                // Of the momentum relative to its size.
                if size > 0.0 {
                    change = change.max((push - pushes[stage]).norm() / size);
                }
                change = change.max((turned - turns[stage]).norm());
                (pushes[stage], turns[stage], rates[stage]) = (push, turned, rate);
            }
            if change * h * contraction <= 1e-18 {
                break;
            }
        }
        let increment = pushes[0] * WEIGHTS[0] + pushes[1] * WEIGHTS[1] + pushes[2] * WEIGHTS[2];
        let turned = turns[0] * WEIGHTS[0] + turns[1] * WEIGHTS[1] + turns[2] * WEIGHTS[2];
        let mean = rates[0] * WEIGHTS[0] + rates[1] * WEIGHTS[1] + rates[2] * WEIGHTS[2];
        (*momentum, lost.1) = exact_sum(*momentum, increment * h + lost.1);
        (attitude.coords, lost.0.coords) = exact_sum(attitude.coords, (turned * h + lost.0).coords);
        (*angle, lost.2) = exact_sum(*angle, mean * h + lost.2);
        // The method keeps the length but for rounding, of which this removes what is left.
        let excess = attitude.norm_squared() - 1.0;
        if excess.abs() > 4.0 * f64::EPSILON {
            *attitude *= 1.0 - 0.5 * excess;
        }
    }
}

/// Q' = 1/2 Q o (0, w).
fn spin(attitude: &Quaternion<f64>, rate: &Vector) -> Quaternion<f64> {
    *attitude * Quaternion::from_imag(rate * 0.5)
}
