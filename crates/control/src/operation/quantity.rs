//! Quantities that conditions of modes and requirements compare, each with its word, its unit and its formula.

use crate::flight_quantity::FlightQuantity::{
    self, Angle, Field, FieldRate, Rate, ReferenceAngle, ReferenceRate, StoredMomentum, WheelSpeed,
};

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
    /// Time since the last correction of the attitude filter (s).
    FilterAge,
    /// Size of the innovation of its last correction (rad).
    FilterInnovation,
    /// Standard deviation of its attitude about all axes together (rad).
    FilterDeviation,
    /// True time since the mode was entered (s), at any instant.
    TrueTime,
    /// True time since the start of the run (s), at any instant.
    TrueRunTime,
    /// Part of the Sun's disc in view, at any instant.
    TrueSunlight,
    /// Elevation above the horizon of the ground site in the target of a mode (rad), at any instant.
    TrueElevation(usize),
    /// Rotation from the reference attitude, or angle from the reference (rad), at any instant.
    PointingError,
    /// Norm of the true rate (rad/s), at any instant.
    TrueRate,
    /// Norm of the true rate relative to that of the reference (rad/s), at any instant.
    TrueRateError,
    /// Error of a line of sight (rad), at any instant.
    LineOfSight(usize),
    /// Flag that a mode is active.
    Mode(usize),
    /// Flag that a bright body blinds a sensor.
    Blinded(usize),
    /// Flag that a failure of a fault acts.
    Fault(usize),
    /// Metric by its index among the names of the metrics, or an element of it.
    Metric(usize, Option<usize>),
}

/// Formula of a quantity over what the control system knows.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ModeFormula {
    /// Value of its own.
    Single,
    /// Norm of a vector.
    Norm(FlightQuantity),
    /// Norm of the difference of two vectors.
    Distance(FlightQuantity, FlightQuantity),
    /// Largest size in a list.
    LargestSize(FlightQuantity),
}

impl ModeFormula {
    /// Iterates over the vectors and lists that the formula reads.
    pub fn vectors(self) -> impl Iterator<Item = FlightQuantity> {
        let [first, second] = match self {
            Self::Single => [None, None],
            Self::Norm(only) | Self::LargestSize(only) => [Some(only), None],
            Self::Distance(first, second) => [Some(first), Some(second)],
        };
        first.into_iter().chain(second)
    }
}

/// Quantity of a word, with its argument.
#[derive(Copy, Clone, Debug)]
pub(super) enum ModeWord {
    /// Quantity without an argument.
    Plain(ModeQuantity),
    /// Quantity of a sensor.
    OfSensor(fn(usize) -> ModeQuantity),
    /// Quantity of a mode.
    OfMode(fn(usize) -> ModeQuantity),
    /// Quantity of a line of sight.
    OfLine(fn(usize) -> ModeQuantity),
    /// Quantity of a fault.
    OfFault(fn(usize) -> ModeQuantity),
}

impl ModeWord {
    /// True if a condition of a mode may have the word, or a requirement if `is_requirement`.
    pub(super) fn is_for(self, is_requirement: bool) -> bool {
        let quantity = match self {
            Plain(quantity) => quantity,
            OfSensor(of) | OfMode(of) | OfLine(of) | OfFault(of) => of(0),
        };
        is_requirement || !quantity.is_of_requirements()
    }
}

use ModeFormula::{Distance, LargestSize, Norm, Single};
use ModeWord::{OfFault, OfLine, OfMode, OfSensor, Plain};

/// Words of the quantities, with their units and formulas.
const QUANTITIES: [(&str, ModeWord, &str, ModeFormula); 28] = [
    ("time", Plain(ModeQuantity::Time), "s", Single),
    ("run_time", Plain(ModeQuantity::RunTime), "s", Single),
    ("rate", Plain(ModeQuantity::Rate), "rad/s", Norm(Rate)),
    ("rate_error", Plain(ModeQuantity::RateError), "rad/s", Distance(Rate, ReferenceRate)),
    ("attitude_error", Plain(ModeQuantity::AttitudeError), "rad", Distance(Angle, ReferenceAngle)),
    ("momentum", Plain(ModeQuantity::Momentum), "N m s", Norm(StoredMomentum)),
    ("wheel_speed", Plain(ModeQuantity::WheelSpeed), "rad/s", LargestSize(WheelSpeed)),
    ("field", Plain(ModeQuantity::Field), "T", Norm(Field)),
    ("field_rate", Plain(ModeQuantity::FieldRate), "T/s", Norm(FieldRate)),
    ("sunlight", Plain(ModeQuantity::Sunlight), "", Single),
    ("lock_lost", Plain(ModeQuantity::LockLost), "", Single),
    ("filter_age", Plain(ModeQuantity::FilterAge), "s", Single),
    ("filter_innovation", Plain(ModeQuantity::FilterInnovation), "rad", Single),
    ("filter_deviation", Plain(ModeQuantity::FilterDeviation), "rad", Single),
    ("truth.time", Plain(ModeQuantity::TrueTime), "s", Single),
    ("truth.run_time", Plain(ModeQuantity::TrueRunTime), "s", Single),
    ("truth.sunlight", Plain(ModeQuantity::TrueSunlight), "", Single),
    ("silent", OfSensor(ModeQuantity::Silent), "s", Single),
    ("entries", OfMode(ModeQuantity::Entries), "", Single),
    ("elevation", OfMode(ModeQuantity::Elevation), "rad", Single),
    ("truth.elevation", OfMode(ModeQuantity::TrueElevation), "rad", Single),
    ("pointing_error", Plain(ModeQuantity::PointingError), "rad", Single),
    ("truth.rate", Plain(ModeQuantity::TrueRate), "rad/s", Single),
    ("truth.rate_error", Plain(ModeQuantity::TrueRateError), "rad/s", Single),
    ("line_of_sight", OfLine(ModeQuantity::LineOfSight), "rad", Single),
    ("mode", OfMode(ModeQuantity::Mode), "", Single),
    ("blinded", OfSensor(ModeQuantity::Blinded), "", Single),
    ("fault", OfFault(ModeQuantity::Fault), "", Single),
];

impl ModeQuantity {
    /// Returns the quantity of a word.
    pub(super) fn from_word(word: &str) -> Option<ModeWord> {
        QUANTITIES.iter().find(|(known, ..)| *known == word).map(|(_, quantity, ..)| *quantity)
    }

    /// Iterates over the words of the quantities of modes, or of requirements if `is_requirement`, without arguments.
    pub fn words(is_requirement: bool) -> impl Iterator<Item = String> {
        let known = QUANTITIES.iter().filter(move |(_, word, ..)| word.is_for(is_requirement));
        known.map(move |(word, of, ..)| match of {
            Plain(quantity) if is_requirement => quantity.word(),
            _ => (*word).to_owned(),
        })
    }

    /// Iterates over the vectors and lists that the formulas read.
    pub fn all_vectors() -> impl Iterator<Item = FlightQuantity> {
        QUANTITIES.iter().flat_map(|(.., formula)| formula.vectors())
    }

    /// Returns the word, the unit, and the formula over what the control system knows.
    fn declaration(self) -> (&'static str, &'static str, ModeFormula) {
        let argument = match self {
            Self::Silent(index)
            | Self::Elevation(index)
            | Self::Entries(index)
            | Self::TrueElevation(index)
            | Self::LineOfSight(index)
            | Self::Mode(index)
            | Self::Blinded(index)
            | Self::Fault(index) => index,
            _ => 0,
        };
        let is_own = |word: ModeWord| match word {
            Plain(quantity) => quantity == self,
            OfSensor(of) | OfMode(of) | OfLine(of) | OfFault(of) => of(argument) == self,
        };
        let found = QUANTITIES.iter().find(|(_, word, ..)| is_own(*word));
        found.map_or(("", "", Single), |(word, _, unit, formula)| (*word, *unit, *formula))
    }

    /// Returns the word as requirements have it, without an argument.
    pub fn word(self) -> String {
        let word = self.declaration().0;
        if self.is_estimate() { format!("estimate.{word}") } else { word.to_owned() }
    }

    /// Returns the unit.
    pub fn unit(self) -> &'static str {
        self.declaration().1
    }

    /// Returns the formula over what the control system knows.
    pub fn formula(self) -> ModeFormula {
        self.declaration().2
    }

    /// Returns true if the quantity is a boolean.
    pub fn is_boolean(self) -> bool {
        matches!(self, Self::LockLost | Self::Mode(_) | Self::Blinded(_) | Self::Fault(_))
    }

    /// Returns true for a quantity that is not available on board, and that only requirements compare.
    pub fn is_of_requirements(self) -> bool {
        self.is_of_motion()
            || matches!(self, Self::Mode(_) | Self::Blinded(_) | Self::Fault(_) | Self::Metric(..))
    }

    /// Returns true for a quantity of the true motion.
    pub fn is_of_motion(self) -> bool {
        matches!(self, Self::PointingError | Self::TrueRate | Self::TrueRateError | Self::LineOfSight(_))
    }

    /// Returns true for a quantity of the estimated motion.
    pub fn is_estimate(self) -> bool {
        matches!(self, Self::Rate | Self::RateError | Self::AttitudeError)
    }

    /// Returns true for a quantity whose values follow from the time and from its value at an instant: the time itself, and
    /// times since an event.
    pub fn grows_with_time(self) -> bool {
        self.is_clock() || matches!(self, Self::Silent(_) | Self::FilterAge)
    }

    /// Returns true for a quantity of the truth, whose condition is met at an exact instant.
    pub fn is_truth(self) -> bool {
        matches!(self, Self::TrueTime | Self::TrueRunTime) || self.is_of_sky()
    }

    /// Returns true for a quantity of the truth that is known at all times before the run.
    pub fn is_of_sky(self) -> bool {
        matches!(self, Self::TrueSunlight | Self::TrueElevation(_) | Self::Fault(_))
    }

    /// Returns true for times that are compared exactly.
    pub fn is_clock(self) -> bool {
        matches!(self, Self::Time | Self::RunTime | Self::TrueTime | Self::TrueRunTime)
    }
}
