//! Linear form of a sensor of angles and rates, without its errors.

use flexsc_numerics::time::Span;

use super::SensorKind;

/// Measurement of angles and rates in a linear loop.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum LinearMeasurement {
    /// Angles and rates at the samples of the law.
    Motion,
    /// Angles and rates at samples of the sensor's own.
    Samples {
        /// Period of the samples.
        period: Span,
        /// True if rates are differences of the angles of two samples, divided by the period.
        is_difference: bool,
    },
}

impl SensorKind {
    /// Returns the linear form of the sensor; `None` for a sensor that does not measure angles and rates.
    pub fn linear_measurement(&self) -> Option<LinearMeasurement> {
        match self {
            Self::Continuous | Self::Gyro(_) => Some(LinearMeasurement::Motion),
            Self::Sampled(sampled) => Some(LinearMeasurement::Samples {
                period: sampled.period,
                is_difference: sampled.rate_noise.is_none(),
            }),
            Self::StarTracker(_)
            | Self::Magnetometer(_)
            | Self::SunSensor(_)
            | Self::SunCells(_)
            | Self::EarthSensor(_)
            | Self::Tachometer(_)
            | Self::Accelerometer(_)
            | Self::Own(_) => None,
        }
    }
}
