//! Where a body with one angle is, and what is measurable of it.

/// Where a body is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Angle of the body as if it were rigid (rad).
    pub rigid_angle: f64,
    /// Rate of the body as if it were rigid (rad/s).
    pub rigid_rate: f64,
    /// One phase for each elastic mode.
    pub modes: Vec<Phase>,
}

/// The phase of one elastic mode.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Phase {
    /// Displacement (rad).
    pub displacement: f64,
    /// Rate divided by the natural frequency (rad), so that an undamped mode runs on a circle.
    pub quadrature: f64,
}

impl State {
    /// The angle that a sensor sees (rad): rigid angle and all modes.
    pub fn angle(&self) -> f64 {
        self.modes.iter().fold(self.rigid_angle, |sum, mode| sum + mode.displacement)
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.rigid_angle.is_finite()
            && self.rigid_rate.is_finite()
            && self.modes.iter().all(|m| m.displacement.is_finite() && m.quadrature.is_finite())
    }
}

/// What is measurable at one instant.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Sensed {
    /// Angle, elastic part included (rad).
    pub angle: f64,
    /// Rate, elastic part included (rad/s).
    pub rate: f64,
    /// Acceleration, elastic part included (rad/s²).
    pub acceleration: f64,
}
