//! State of a one-axis body, and its measurable motion.

use nalgebra::DVector;

/// State of a one-axis body: rigid angle, rigid rate and elastic modes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisState {
    /// Angle of the rigid motion (rad).
    pub rigid_angle: f64,
    /// Rate of the rigid motion (rad/s).
    pub rigid_rate: f64,
    /// State of each elastic mode.
    pub modes: Vec<ModeState>,
}

/// State of one elastic mode.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ModeState {
    /// Displacement (rad).
    pub displacement: f64,
    /// Rate divided by the natural frequency (rad), so that an undamped mode moves on a circle.
    pub quadrature: f64,
}

/// Largest angle (rad) or rate (rad/s) of a state: energies, which are squares, would overflow beyond it.
pub const LARGEST_STATE: f64 = 1e100;

/// Returns true if an angle (rad) or a rate (rad/s) is a number below [`LARGEST_STATE`].
pub fn is_bounded(value: f64) -> bool {
    value.abs() < LARGEST_STATE
}

impl AxisState {
    /// Returns the angle that a sensor measures (rad): the rigid angle plus all modes.
    pub fn angle(&self) -> f64 {
        self.modes.iter().fold(self.rigid_angle, |sum, mode| sum + mode.displacement)
    }

    /// Returns true if every number is below [`LARGEST_STATE`].
    pub fn is_bounded(&self) -> bool {
        is_bounded(self.rigid_angle)
            && is_bounded(self.rigid_rate)
            && self.modes.iter().all(|m| is_bounded(m.displacement) && is_bounded(m.quadrature))
    }

    /// Returns the state as one vector, for modes with the given frequencies (rad/s).
    pub fn to_vector(&self, frequencies: &[f64]) -> DVector<f64> {
        let mut z = vec![self.rigid_angle, self.rigid_rate];
        let modes = self.modes.iter().zip(frequencies);
        z.extend(modes.flat_map(|(mode, w)| [mode.displacement, w * mode.quadrature]));
        DVector::from_vec(z)
    }

    /// Sets the state from one vector, for modes with the given frequencies (rad/s).
    pub fn from_vector(&mut self, z: &DVector<f64>, frequencies: &[f64]) {
        (self.rigid_angle, self.rigid_rate) = (z[0], z[1]);
        for (i, (mode, w)) in self.modes.iter_mut().zip(frequencies).enumerate() {
            *mode = ModeState { displacement: z[2 + 2 * i], quadrature: z[3 + 2 * i] / w };
        }
    }
}

/// Measurable motion at one instant.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct AngleObservation {
    /// Angle, including the elastic part (rad).
    pub angle: f64,
    /// Rate, including the elastic part (rad/s).
    pub rate: f64,
    /// Acceleration, including the elastic part (rad/s²).
    pub acceleration: f64,
}
