//! Rigid motion about three axes: Euler's equations and the attitude, by Gauss-Legendre steps of order 6.
//!
//! With the angular momentum L = J w in the body's axes, L' = L x w + M and Q' = 1/2 Q o (0, w). Gauss-Legendre methods
//! keep every quadratic invariant except for rounding (\[HairerLubichWanner06\]), and without a torque |L|², the energy
//! L . w / 2 and |Q|² are quadratic. Momentum and attitude are summed with compensation, so that rounding does not
//! accumulate over millions of steps: without a torque |L|, the energy and L in space stay constant within 1e-14 over
//! 1e6 s for a station, and within 1e-13 over 1e4 s for a body that tumbles at 0.6 rad/s (tests/spatial.rs).

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::gauss_legendre::{MATRIX, NODES, WEIGHTS, exact_sum};
use flexsc_numerics::inverse::inverse_3x3;
use nalgebra::{Matrix3, Quaternion};

use crate::periodic_torque::PeriodicTorque;
use crate::three_axis::Surroundings;
use crate::three_axis_model::ThreeAxisModel;

/// Approximate largest rotation in a step (rad): the error of its direction is then below 1e-15 rad.
pub const LONGEST_TURN: f64 = 1.0 / 16.0;
/// Largest number of passes over the stages, which converge by a factor of 16 or more each.
const PASSES: u32 = 40;

/// Number of steps after which the integrator asks whether to continue.
const STEPS: u64 = 256;

/// Inertia and periodic disturbance of a rigid body.
#[derive(Clone, Debug)]
pub struct RigidBody {
    inertia: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// Upper bound of the rate per unit of angular momentum (1/(kg m²)).
    mobility: f64,
    disturbance: Option<PeriodicTorque>,
}

/// Attitude and angular momentum of a rigid body.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RigidState {
    /// Unit quaternion that transforms vectors from the body's axes to inertial axes.
    pub attitude: Quaternion<f64>,
    /// Angular momentum J w in the body's axes (N m s).
    momentum: Vector,
    /// Integral of the rates since the start (rad).
    turned: Vector,
    /// Compensation terms of the three sums for rounding errors.
    lost: (Quaternion<f64>, Vector, Vector),
}

impl RigidBody {
    /// Creates the rigid body of a spatial body.
    pub fn new(body: &ThreeAxisModel) -> Self {
        let inertia = body.inertia;
        // A validated body has an inverse.
        let inverse = inverse_3x3(inertia).unwrap_or_else(Matrix3::identity);
        // Symmetric to the last bit, so that the energy is a quadratic form.
        let inverse = (inverse + inverse.transpose()) * 0.5;
        Self { inertia, inverse, mobility: inverse.norm(), disturbance: body.disturbance }
    }

    /// Returns the inertia tensor (kg m²).
    pub fn inertia(&self) -> &Matrix3<f64> {
        &self.inertia
    }

    /// Returns the state of an attitude and rates in the body's axes (rad/s).
    pub fn start(&self, attitude: Quaternion<f64>, rate: Vector) -> RigidState {
        let (momentum, zero) = (self.inertia * rate, Vector::zeros());
        RigidState { attitude, momentum, turned: zero, lost: (Quaternion::default(), zero, zero) }
    }

    /// Returns the rates in the body's axes (rad/s).
    pub fn rate(&self, turn: &RigidState) -> Vector {
        self.inverse * turn.momentum
    }

    /// Returns the angular momentum in the body's axes (N m s).
    pub fn momentum(turn: &RigidState) -> Vector {
        turn.momentum
    }

    /// Returns an upper bound of the rates and of the precession (rad/s), with rotors of momentum `stored` (N m s).
    pub fn fastest(&self, turn: &RigidState, stored: f64) -> f64 {
        self.mobility * (turn.momentum.norm() + stored)
    }

    /// Returns the integral of the rates since the start (rad).
    pub fn rigid_angle(turn: &RigidState) -> Vector {
        turn.turned
    }

    /// Returns the kinetic energy of the rotation (J).
    pub fn energy(&self, turn: &RigidState) -> f64 {
        0.5 * turn.momentum.dot(&self.rate(turn))
    }

    /// Advances the motion by `h` seconds from `t` seconds after the start, under the torque (N m), the body's
    /// disturbance and the environment `around`, and aborts with the error of `go_on`. `rotors` are the rotors'
    /// momentum (N m s) and its rate of change (N m), whose reaction on the body is part of the torque.
    pub fn advance<E>(
        &self,
        turn: &mut RigidState,
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
            slow += around.frequency_at(t);
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
            let torques = match &self.disturbance {
                None => [*torque; 3],
                Some(disturbance) => NODES.map(|node| torque + disturbance.at(from + node * small)),
            };
            let began = small * step as f64;
            let spun =
                rotors.map(|(momentum, rate)| NODES.map(|node| momentum + rate * (began + node * small)));
            let around = around.map(|around| (around, from));
            self.step(turn, &torques, spun.as_ref(), around, (small, rate * small));
        }
        Ok(())
    }

    /// Advances by one step of `h` seconds under the torques and rotor momenta at the nodes, and the environment from a
    /// time after the start (s). Each pass over the stages reduces the error by the factor `contraction`.
    fn step(
        &self,
        turn: &mut RigidState,
        torques: &[Vector; 3],
        rotors: Option<&[Vector; 3]>,
        around: Option<(&dyn Surroundings, f64)>,
        (h, contraction): (f64, f64),
    ) {
        let RigidState { attitude, momentum, turned: angle, lost } = turn;
        let mut pushes = torques.map(|torque| momentum.cross(&(self.inverse * *momentum)) + torque);
        let mut rates = [Vector::zeros(); 3];
        let mut turns = [spin(attitude, &(self.inverse * *momentum)); 3];
        let size = momentum.norm() + rotors.map_or(0.0, |rotors| rotors[1].norm()) + h * torques[1].norm();
        // Changes are compared by their squares, because roots would take a quarter of the step.
        let per_size = if size > 0.0 { 1.0 / size } else { 0.0 };
        let largest = 1e-18 / (h * contraction);
        let around = around.map(|(around, from)| (around, NODES.map(|node| around.sky_at(from + node * h))));
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
                if let Some((around, skies)) = &around {
                    push += around.torque(&skies[stage], &facing, &self.inertia);
                }
                let turned = spin(&facing, &rate);
                // Squared change of the momentum's derivative relative to the momentum.
                change = change.max(((push - pushes[stage]) * per_size).norm_squared());
                change = change.max((turned - turns[stage]).norm_squared());
                (pushes[stage], turns[stage], rates[stage]) = (push, turned, rate);
            }
            if change <= largest * largest {
                break;
            }
        }
        let increment = pushes[0] * WEIGHTS[0] + pushes[1] * WEIGHTS[1] + pushes[2] * WEIGHTS[2];
        let turned = turns[0] * WEIGHTS[0] + turns[1] * WEIGHTS[1] + turns[2] * WEIGHTS[2];
        let mean = rates[0] * WEIGHTS[0] + rates[1] * WEIGHTS[1] + rates[2] * WEIGHTS[2];
        (*momentum, lost.1) = exact_sum(*momentum, increment * h + lost.1);
        (attitude.coords, lost.0.coords) = exact_sum(attitude.coords, (turned * h + lost.0).coords);
        (*angle, lost.2) = exact_sum(*angle, mean * h + lost.2);
        // The method keeps the length except for rounding; this removes that error.
        let excess = attitude.norm_squared() - 1.0;
        if excess.abs() > 4.0 * f64::EPSILON {
            *attitude *= 1.0 - 0.5 * excess;
        }
    }
}

/// Returns Q' = 1/2 Q o (0, w).
fn spin(q: &Quaternion<f64>, rate: &Vector) -> Quaternion<f64> {
    let half = rate * 0.5;
    Quaternion::new(
        -q.i * half.x - q.j * half.y - q.k * half.z,
        q.w * half.x + q.j * half.z - q.k * half.y,
        q.w * half.y - q.i * half.z + q.k * half.x,
        q.w * half.z + q.i * half.y - q.j * half.x,
    )
}
