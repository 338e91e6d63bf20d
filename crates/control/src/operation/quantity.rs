//! Quantities that conditions of modes compare, each with its word and unit.

/// Quantity in a condition.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub enum ModeQuantity {
    /// Time since the mode was entered (s).
    Time,
    /// Time since the start of the run (s).
    RunTime,
    /// Norm of the estimated rate (rad/s).
    Rate,
    /// Norm of the estimated rate relative to that of the reference (rad/s).
    RateError,
    /// Angle between the estimated attitude and the reference (rad).
    AttitudeError,
    /// Norm of the momentum stored in wheels or control moment gyros (N m s).
    Momentum,
    /// Largest speed of a reaction wheel (rad/s).
    WheelSpeed,
    /// Norm of the last measured magnetic field (T).
    Field,
    /// Norm of its measured rate of change (T/s).
    FieldRate,
    /// Part of the Sun's disc in view, from the ephemeris on board.
    Sunlight,
    /// Time since the last reading of a sensor, or since it came into use (s).
    Silent(usize),
    /// Elevation above the horizon of the ground site in the target of a mode (rad), from the ephemeris on board.
    Elevation(usize),
    /// Number of times that a mode was entered, the start included.
    Entries(usize),
    /// True if a filter has lost lock.
    LockLost,
    /// True time since the mode was entered (s), at any instant.
    TrueTime,
    /// True time since the start of the run (s), at any instant.
    TrueRunTime,
    /// Part of the Sun's disc in view, at any instant.
    TrueSunlight,
    /// Elevation above the horizon of the ground site in the target of a mode (rad), at any instant.
    TrueElevation(usize),
}

/// Words of the quantities without an argument, with their units.
const WORDS: [(&str, ModeQuantity, &str); 14] = [
    ("time", ModeQuantity::Time, "s"),
    ("run_time", ModeQuantity::RunTime, "s"),
    ("rate", ModeQuantity::Rate, "rad/s"),
    ("rate_error", ModeQuantity::RateError, "rad/s"),
    ("attitude_error", ModeQuantity::AttitudeError, "rad"),
    ("momentum", ModeQuantity::Momentum, "N m s"),
    ("wheel_speed", ModeQuantity::WheelSpeed, "rad/s"),
    ("field", ModeQuantity::Field, "T"),
    ("field_rate", ModeQuantity::FieldRate, "T/s"),
    ("sunlight", ModeQuantity::Sunlight, ""),
    ("lock_lost", ModeQuantity::LockLost, ""),
    ("truth.time", ModeQuantity::TrueTime, "s"),
    ("truth.run_time", ModeQuantity::TrueRunTime, "s"),
    ("truth.sunlight", ModeQuantity::TrueSunlight, ""),
];

impl ModeQuantity {
    /// Word of the quantity with a sensor as its argument.
    pub const SILENT: &'static str = "silent";
    /// Word of the quantity with a mode as its argument.
    pub const ENTRIES: &'static str = "entries";

    /// Words of the quantities with a mode, whose target has a ground site, as their argument.
    pub const ELEVATIONS: [&'static str; 2] = ["elevation", "truth.elevation"];

    /// Returns the quantity of a word without an argument.
    pub fn from_word(word: &str) -> Option<Self> {
        WORDS.iter().find(|(known, ..)| *known == word).map(|(_, quantity, _)| *quantity)
    }

    /// Iterates over the words of all quantities, without arguments.
    pub fn words() -> impl Iterator<Item = &'static str> {
        WORDS.iter().map(|(word, ..)| *word).chain([Self::SILENT, Self::ENTRIES]).chain(Self::ELEVATIONS)
    }

    /// Returns the unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Silent(_) => "s",
            Self::Elevation(_) | Self::TrueElevation(_) => "rad",
            _ => WORDS.iter().find(|(_, quantity, _)| *quantity == self).map_or("", |(.., unit)| *unit),
        }
    }

    /// Returns true for a quantity that is true or false.
    pub fn is_flag(self) -> bool {
        self == Self::LockLost
    }

    /// Returns true for a quantity of the truth, whose condition is met at an exact instant.
    pub fn is_truth(self) -> bool {
        matches!(self, Self::TrueTime | Self::TrueRunTime) || self.is_of_sky()
    }

    /// Returns true for a quantity of the truth that the orbit and the Sun determine before the run.
    pub fn is_of_sky(self) -> bool {
        matches!(self, Self::TrueSunlight | Self::TrueElevation(_))
    }

    /// Returns true for times that are compared exactly.
    pub fn is_clock(self) -> bool {
        matches!(self, Self::Time | Self::RunTime | Self::TrueTime | Self::TrueRunTime)
    }
}
