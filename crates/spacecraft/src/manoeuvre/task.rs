//! Task of a command: the change of the rigid body's angle and rate.

/// Change of the rigid body's motion that a command must produce, from 0 to its time.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RestToRestTask {
    /// Duration of the command (s).
    pub time: f64,
    /// Integral of the command: inertia times the gained rate.
    pub impulse: f64,
    /// Integral of (time - t) u(t): inertia times the angle gained over that of the initial rate.
    pub travel: f64,
}

impl RestToRestTask {
    /// Returns the mean of the command, A0 = J (Omega_T - Omega_0)/T (\[Rotation\], equations (22) and (28); (22) has
    /// the sign of the difference wrong).
    pub fn mean(&self) -> f64 {
        self.impulse / self.time
    }

    /// Returns the excess travel over that of the mean command: J (theta_T - (Omega_0 + Omega_T) T/2).
    pub fn excess_travel(&self) -> f64 {
        self.travel - 0.5 * self.impulse * self.time
    }
}
