//! Guards: thresholds of the measured angle.

/// Direction of a guard.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum GuardDirection {
    /// Trips at or above its level.
    AtLeast,
    /// Trips at or below its level.
    AtMost,
}

impl GuardDirection {
    /// Returns the direction of motion that closes the gap: +1 or -1.
    #[inline]
    pub const fn sign(self) -> f64 {
        match self {
            Self::AtLeast => 1.0,
            Self::AtMost => -1.0,
        }
    }
}

/// Threshold of the measured angle. The guard is level-sensitive: it trips at once if its condition already holds
/// when armed.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Guard {
    /// Direction from which the threshold is reached.
    pub side: GuardDirection,
    /// Threshold angle (rad).
    pub level: f64,
}

impl Guard {
    /// Returns a guard that trips at or above an angle (rad).
    #[inline]
    pub const fn at_least(level: f64) -> Self {
        Self { side: GuardDirection::AtLeast, level }
    }

    /// Returns a guard that trips at or below an angle (rad).
    #[inline]
    pub const fn at_most(level: f64) -> Self {
        Self { side: GuardDirection::AtMost, level }
    }

    /// Returns the distance of the angle from the threshold (rad): the guard holds at 0 and below.
    #[inline]
    pub fn gap(self, angle: f64) -> f64 {
        self.side.sign() * (self.level - angle)
    }

    /// Returns true if the guard's condition holds.
    #[inline]
    pub fn holds(self, angle: f64) -> bool {
        self.gap(angle) <= 0.0
    }
}
