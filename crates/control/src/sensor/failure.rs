//! Failures of sensors within intervals: no reading, a stuck one, or one that is wrong and looks valid.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::quantity::{Finite, Time};
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::environment::to_body;
use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Orientation, Reading, VectorMeasurement};
use crate::interval::Interval;

/// A failure of the sensor, gyro included.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Fault")]
pub enum SensorFailure {
    /// It repeats the last measurement before the failure.
    Stuck(Interval),
    /// It gives no measurement; the last one remains valid.
    Silent(Interval),
    /// Readings that are off.
    Outlier(Outlier),
    /// Readings of zeros, which are marked as valid.
    Zero(Interval),
    /// Readings that are NaN, and marked as valid.
    Invalid(Interval),
}

/// Error of the readings within an interval, in addition to other errors.
#[derive(Copy, Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outlier {
    /// Start time (s).
    pub from: Time,
    /// End time (s); default: the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// Error of the angle (rad): a measured attitude or vector is rotated about the direction (1, 1, 1) of the body.
    #[serde(default)]
    pub angle: Finite,
    /// Error of the measured rate about each axis (rad/s).
    #[serde(default)]
    pub rate: Finite,
}

impl SensorFailure {
    /// Returns the interval of the failure.
    pub fn interval(&self) -> Interval {
        match self {
            Self::Stuck(interval)
            | Self::Silent(interval)
            | Self::Zero(interval)
            | Self::Invalid(interval) => *interval,
            Self::Outlier(Outlier { from, to, .. }) => Interval { from: *from, to: *to },
        }
    }

    /// Returns the name of the kind, as in a scenario.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Stuck(_) => "stuck",
            Self::Silent(_) => "silent",
            Self::Outlier(_) => "outlier",
            Self::Zero(_) => "zero",
            Self::Invalid(_) => "invalid",
        }
    }

    /// Returns true if readings differ from those without the failure, and are not repetitions.
    pub fn alters_readings(&self) -> bool {
        matches!(self, Self::Outlier(_) | Self::Zero(_) | Self::Invalid(_))
    }

    /// Returns true if readings are not measurements of anything.
    pub fn is_senseless(&self) -> bool {
        matches!(self, Self::Zero(_) | Self::Invalid(_))
    }

    /// Checks the interval and the errors; returns a `ConfigError` without a key of its own if they are wrong.
    pub fn validate(&self) -> Option<ConfigError> {
        if let Self::Outlier(Outlier { angle, rate, .. }) = self
            && angle.get() == 0.0
            && rate.get() == 0.0
        {
            return Some(ConfigError::new("outlier", "must have an `angle` or a `rate` other than 0"));
        }
        self.interval().validate()
    }
}

/// Returns the reading of a sensor at `now` under its failures, given the reading without failures and the last
/// reading.
pub(super) fn with_failures(
    faults: &[SensorFailure],
    now: Instant,
    reading: Option<Reading>,
    last: Option<&Reading>,
) -> Option<Reading> {
    match faults.iter().find(|fault| fault.interval().contains(now)) {
        None => reading,
        Some(SensorFailure::Stuck(_)) => last.copied().or(reading),
        Some(SensorFailure::Silent(_)) => None,
        Some(SensorFailure::Outlier(outlier)) => reading.map(|reading| reading.displaced(outlier)),
        Some(SensorFailure::Zero(_)) => reading.map(|reading| reading.filled(0.0)),
        Some(SensorFailure::Invalid(_)) => reading.map(|reading| reading.filled(f64::NAN)),
    }
}

impl Reading {
    /// Returns the reading with the errors of an outlier.
    fn displaced(self, outlier: &Outlier) -> Self {
        let (angle, rate) = (outlier.angle.get(), outlier.rate.get());
        let turn = Vector::repeat(angle / f64::sqrt(3.0));
        let at = match self.at {
            Orientation::Angle(own) => Orientation::Angle(own + angle),
            Orientation::Attitude(own) => Orientation::Attitude(own * rotation(&turn)),
        };
        let sight = self
            .sight
            .map(|sight| VectorMeasurement { vector: to_body(&rotation(&turn), &sight.vector), ..sight });
        Self { at, rate: self.rate.map(|rates| rates.map(|own| own + rate)), sight }
    }

    /// Returns the reading with this value in place of each number.
    fn filled(self, value: f64) -> Self {
        let at = match self.at {
            Orientation::Angle(_) => Orientation::Angle(value),
            Orientation::Attitude(_) => Orientation::Attitude(Quaternion::new(value, value, value, value)),
        };
        let sight = self.sight.map(|sight| VectorMeasurement { vector: Vector::repeat(value), ..sight });
        Self { at, rate: self.rate.map(|rates| rates.map(|_| value)), sight }
    }
}
