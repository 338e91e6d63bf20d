//! Directions that move in inertial axes.

use flexsc_numerics::attitude::Vector;

/// Unit vector in inertial axes with its derivatives.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DirectionMotion {
    /// Direction.
    pub direction: Vector,
    /// Rate of change (1/s).
    pub rate: Vector,
    /// Rate of change of the rate (1/s²).
    pub acceleration: Vector,
}

impl DirectionMotion {
    /// Returns the direction of a vector with its derivatives, from the vector, its rate and its acceleration.
    pub fn along([vector, rate, acceleration]: [Vector; 3]) -> Self {
        let length = vector.norm();
        let direction = vector / length;
        let length_rate = direction.dot(&rate);
        let turning = (rate - direction * length_rate) / length;
        let length_acceleration = turning.dot(&rate) + direction.dot(&acceleration);
        let turned = acceleration - turning * (2.0 * length_rate) - direction * length_acceleration;
        Self { direction, rate: turning, acceleration: turned / length }
    }

    /// Returns a direction that does not move, a unit vector.
    pub fn fixed(direction: Vector) -> Self {
        Self { direction, rate: Vector::zeros(), acceleration: Vector::zeros() }
    }
}
