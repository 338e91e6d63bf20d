//! Rotors in gimbals: their angular momentum as a function of time, while each gimbal turns at a constant rate.
//!
//! A rotor of momentum h in a gimbal at the angle d has h (s cos d + t sin d), with t = g x s across its spin axis s as the gimbal
//! turns about g. The rate of d is constant between departures, so the momentum is known at the nodes of a step, and what
//! turns the body is the rate of H alone. What the gimbal itself has of momentum is left out.

use super::vectors::{StoredVectors, vector};
use crate::attitude::Vector;
use crate::numerics::gauss_legendre::NODES;

/// A rotor whose gimbal turns it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Gimbal {
    /// The direction of its momentum with the gimbal at angle 0, a unit vector of the body.
    pub spin: Vector,
    /// The unit vector towards which the gimbal turns it from there.
    pub across: Vector,
    /// The size of its momentum (N m s).
    pub momentum: f64,
    /// Angle of the gimbal at the departure (rad).
    pub angle: f64,
    /// Rate of the gimbal until the next departure (rad/s).
    pub rate: f64,
}

impl Gimbal {
    /// Angular momentum (N m s) and its rate (N m), `t` seconds after the departure.
    pub fn at(&self, t: f64) -> (Vector, Vector) {
        let (sin, cos) = libm::sincos(self.angle + self.rate * t);
        let change = self.momentum * self.rate;
        (
            (self.spin * cos + self.across * sin) * self.momentum,
            (self.across * cos - self.spin * sin) * change,
        )
    }
}

/// Momentum of all of them (N m s), and its rate (N m), `t` seconds after the departure; none if there are none.
pub(super) fn sum(gimbals: &[Gimbal], t: f64) -> Option<(Vector, Vector)> {
    gimbals.iter().map(|gimbal| gimbal.at(t)).reduce(|sum, of| (sum.0 + of.0, sum.1 + of.1))
}

/// The largest rate of a gimbal (rad/s).
pub(super) fn fastest(gimbals: &[Gimbal]) -> f64 {
    gimbals.iter().map(|gimbal| gimbal.rate.abs()).fold(0.0, f64::max)
}

/// The momentum of all rotors in gimbals over a step.
#[derive(Copy, Clone, Debug)]
pub(super) struct Swung {
    /// At its start (N m s), and the rate there (N m).
    pub start: (Vector, Vector),
    /// At its nodes; nothing reads the fourth.
    pub nodes: StoredVectors,
}

impl Swung {
    /// Over a step of `h` seconds that begins `t` seconds after the departure; none if there are no gimbals.
    pub fn over(gimbals: &[Gimbal], t: f64, h: f64) -> Option<Self> {
        let start = sum(gimbals, t)?;
        let mut nodes = [[0.0; 4]; 3];
        for (lane, node) in NODES.into_iter().enumerate() {
            let (momentum, _) = sum(gimbals, t + node * h)?;
            nodes.iter_mut().zip(&momentum).for_each(|(row, part)| row[lane] = *part);
        }
        Some(Self { start, nodes })
    }

    /// At a stage: the start, then the nodes.
    pub fn stage(&self, stage: usize) -> Vector {
        stage.checked_sub(1).map_or(self.start.0, |node| vector(&self.nodes, node))
    }
}
