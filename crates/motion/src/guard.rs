//! Guards: levels of the measured angle.

/// Which way a guard faces.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Side {
    /// Trips at or above its level.
    AtLeast,
    /// Trips at or below its level.
    AtMost,
}

impl Side {
    /// The direction of motion that closes the gap: +1 or -1.
    pub const fn sign(self) -> f64 {
        match self {
            Self::AtLeast => 1.0,
            Self::AtMost => -1.0,
        }
    }
}

/// A level of the measured angle. It is level-sensitive: it trips at once if it already holds when armed.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Guard {
    /// Which way it faces.
    pub side: Side,
    /// The angle (rad).
    pub level: f64,
}

impl Guard {
    /// A guard that trips at or above an angle (rad).
    pub const fn at_least(level: f64) -> Self {
        Self { side: Side::AtLeast, level }
    }

    /// A guard that trips at or below an angle (rad).
    pub const fn at_most(level: f64) -> Self {
        Self { side: Side::AtMost, level }
    }

    /// How far the angle is short of the level (rad): the guard holds at 0 and below.
    #[inline]
    pub fn gap(self, angle: f64) -> f64 {
        self.side.sign() * (self.level - angle)
    }

    /// Whether the guard holds.
    pub fn holds(self, angle: f64) -> bool {
        self.gap(angle) <= 0.0
    }
}
