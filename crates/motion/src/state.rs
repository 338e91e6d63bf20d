//! Where a body with one angle is, and what is measurable of it.

use nalgebra::DVector;

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

    /// The state as one vector, of modes with these frequencies (rad/s).
    pub fn to_vector(&self, frequencies: &[f64]) -> DVector<f64> {
        let mut z = vec![self.rigid_angle, self.rigid_rate];
        let modes = self.modes.iter().zip(frequencies);
        z.extend(modes.flat_map(|(mode, w)| [mode.displacement, w * mode.quadrature]));
        DVector::from_vec(z)
    }

    /// Takes the state from one vector.
    pub fn set_vector(&mut self, z: &DVector<f64>, frequencies: &[f64]) {
        (self.rigid_angle, self.rigid_rate) = (z[0], z[1]);
        for (i, (mode, w)) in self.modes.iter_mut().zip(frequencies).enumerate() {
            *mode = Phase { displacement: z[2 + 2 * i], quadrature: z[3 + 2 * i] / w };
        }
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
