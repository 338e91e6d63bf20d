//! Setpoint about an axis, and the error band within which a law is expected to stay about it.

use flexsc_flight::axis_motion::AxisReference;
use flexsc_numerics::time::Instant;

/// Setpoint of the body: from a time on, this angle, which changes at this rate.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Start of the setpoint: the start of the run, or the end of the manoeuvre.
    pub from: Instant,
    /// Angle at the start of the setpoint (rad).
    pub angle: f64,
    /// Constant rate (rad/s).
    pub rate: f64,
    /// Feedforward acceleration (rad/s²), of a moving reference.
    pub acceleration: f64,
}

impl Setpoint {
    /// Returns angle (rad) and rate (rad/s) at an instant.
    pub fn at(&self, now: Instant) -> (f64, f64) {
        // Without a rate, the elapsed time has no effect.
        let travel = if self.rate == 0.0 { self.rate } else { self.rate * now.since(self.from).seconds() };
        (self.angle + travel, self.rate)
    }

    /// Returns the reference at an instant as flight code has it.
    pub fn flight_reference(&self, now: Instant) -> AxisReference {
        let (angle, rate) = self.at(now);
        AxisReference { angle, rate, acceleration: self.acceleration }
    }
}

/// Distance (rad) that rounding alone may leave.
const ROUNDING: f64 = 1e-9;

/// Expected error band of a law about the setpoint.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum ErrorBand {
    /// No error band.
    None,
    /// Half width of the band (rad).
    Absolute(f64),
    /// Half width of the band as a fraction of the initial distance from the setpoint.
    Fraction(f64),
}

impl ErrorBand {
    /// Returns the half width of the band (rad) for an initial distance (rad); NaN without a band, and for a fraction of a distance
    /// that is rounding.
    pub fn band(self, distance: f64) -> f64 {
        match self {
            Self::Absolute(band) => band,
            Self::Fraction(part) if distance > ROUNDING => part * distance,
            Self::None | Self::Fraction(_) => f64::NAN,
        }
    }
}
