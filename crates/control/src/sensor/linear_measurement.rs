//! Linear form of a sensor of angles and rates, without its errors.

use flexsc_numerics::time::Span;

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
