//! What a command has to do to the rigid body.

/// What a command has to do to the rigid body, from 0 to its time.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Task {
    /// Time that it has (s).
    pub time: f64,
    /// Its integral: inertia times the gained rate.
    pub impulse: f64,
    /// The integral of (time - t) u(t): inertia times the angle gained beyond that of the first rate.
    pub travel: f64,
}

impl Task {
    /// The mean of the command, A0 = J (Omega_T - Omega_0)/T (\[Rotation\], equations (22) and (28); (22) has the sign
    /// of the difference wrong).
    pub fn mean(&self) -> f64 {
        self.impulse / self.time
    }

    /// The travel beyond that of the mean: J (theta_T - (Omega_0 + Omega_T) T/2).
    pub fn excess(&self) -> f64 {
        self.travel - 0.5 * self.impulse * self.time
    }
}
