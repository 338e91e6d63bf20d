//! Rotors in gimbals: their angular momentum as a function of time, while each gimbal turns at a constant rate.
//!
//! A rotor of momentum h in a gimbal at the angle d has the momentum h (s cos d + t sin d), where s is its spin axis
//! at d = 0, g the gimbal axis and t = g x s. The rate of d is constant within a segment, so the momentum is known at
//! the nodes of a step, and the body is driven by the rate of H alone. The gimbal's own momentum is neglected.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::gauss_legendre::NODES;

use crate::three_axis::vectors::{StoredVectors, vector};

/// A rotor of constant momentum in a gimbal.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Gimbal {
    /// Direction of the rotor's momentum at gimbal angle 0, a unit vector in the body's axes.
    pub spin: Vector,
    /// Direction of the rotor's momentum at gimbal angle pi/2, a unit vector in the body's axes.
    pub across: Vector,
    /// Magnitude of the rotor's momentum (N m s).
    pub momentum: f64,
    /// Gimbal angle at the start of the segment (rad).
    pub angle: f64,
    /// Gimbal rate during the segment (rad/s).
    pub rate: f64,
}

impl Gimbal {
    /// Returns the angular momentum (N m s) and its rate (N m) at `t` (s) since the start of the segment.
    pub fn at(&self, t: f64) -> (Vector, Vector) {
        let (sin, cos) = libm::sincos(self.angle + self.rate * t);
        let change = self.momentum * self.rate;
        (
            (self.spin * cos + self.across * sin) * self.momentum,
            (self.across * cos - self.spin * sin) * change,
        )
    }
}

/// Returns the total momentum of the gimbals' rotors (N m s) and its rate (N m) at `t` (s) since the start of the
/// segment; `None` without gimbals.
#[inline]
pub fn total_momentum(gimbals: &[Gimbal], t: f64) -> Option<(Vector, Vector)> {
    // Most bodies have none, and ask in every step.
    if gimbals.is_empty() { None } else { sum_momentum(gimbals, t) }
}

/// Returns the sum of the momenta of the gimbals' rotors (N m s) and its rate (N m); `None` without gimbals.
fn sum_momentum(gimbals: &[Gimbal], t: f64) -> Option<(Vector, Vector)> {
    gimbals.iter().map(|gimbal| gimbal.at(t)).reduce(|sum, of| (sum.0 + of.0, sum.1 + of.1))
}

/// Returns the largest gimbal rate (rad/s).
pub fn largest_rate(gimbals: &[Gimbal]) -> f64 {
    gimbals.iter().map(|gimbal| gimbal.rate.abs()).fold(0.0, f64::max)
}

/// Total momentum of all rotors in gimbals over a step.
#[derive(Copy, Clone, Debug)]
pub struct GimbalMomentum {
    /// Momentum at the start of the step (N m s), and its rate (N m).
    pub start: (Vector, Vector),
    /// Momentum at the nodes (N m s); the fourth lane is unused.
    pub nodes: StoredVectors,
}

impl GimbalMomentum {
    /// Computes the momentum over a step of `h` (s) that begins `t` (s) after the start of the segment; `None`
    /// without gimbals.
    pub fn over(gimbals: &[Gimbal], t: f64, h: f64) -> Option<Self> {
        let start = total_momentum(gimbals, t)?;
        let mut nodes = StoredVectors::default();
        for (lane, node) in NODES.into_iter().enumerate() {
            let (momentum, _) = total_momentum(gimbals, t + node * h)?;
            nodes.0.iter_mut().zip(&momentum).for_each(|(row, part)| row[lane] = *part);
        }
        Some(Self { start, nodes })
    }

    /// Returns the momentum (N m s) at a stage: 0 for the start, then the nodes.
    pub fn stage(&self, stage: usize) -> Vector {
        stage.checked_sub(1).map_or(self.start.0, |node| vector(&self.nodes, node))
    }
}
