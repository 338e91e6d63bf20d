//! Slew, or decay of a rate, about one axis with an acceleration that is a waveform: a planned command, or a limited motion
//! through a shaper.

use flexsc_dynamics::waveform::Waveform;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, rotation};
use nalgebra::Quaternion;

use super::rate_decay::REST;
use super::slew::{AttitudeMotion, eigenaxis};

/// Number of samples from which the largest rate is taken, besides the breaks of the acceleration.
const PLACES: u32 = 200;

/// Slew to rest by a planned command, from rest or from a rate about its axis.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedSlew {
    from: Quaternion<f64>,
    to: Quaternion<f64>,
    /// Rotation axis, with the same components in both attitudes.
    axis: Vector,
    /// Rate at the start (rad/s).
    start_rate: f64,
    /// Acceleration about the axis (rad/s²).
    acceleration: Waveform,
}

impl PlannedSlew {
    /// Creates the shorter rotation, with the acceleration (rad/s²) that `plan` returns for its angle (rad).
    ///
    /// # Errors
    /// The reason why there is no plan.
    pub fn new(
        [from, to]: [Quaternion<f64>; 2],
        plan: impl FnOnce(f64) -> Result<Waveform, ConfigError>,
    ) -> Result<Self, ConfigError> {
        let (axis, angle) = eigenaxis(&from, &to);
        Ok(Self { from, to, axis, start_rate: 0.0, acceleration: plan(angle)? })
    }

    /// Creates the decay of the rate of a motion about its axis, with the acceleration (rad/s²) that `plan` returns for the
    /// rate (rad/s); `None` at rest.
    ///
    /// # Errors
    /// The reason why there is no plan.
    pub fn to_rest(
        from: &AttitudeMotion,
        plan: impl FnOnce(f64) -> Result<Waveform, ConfigError>,
    ) -> Result<Option<Self>, ConfigError> {
        let start_rate = from.rate.norm();
        if start_rate <= REST {
            return Ok(None);
        }
        let (axis, acceleration) = (from.rate / start_rate, plan(start_rate)?);
        let end = acceleration.end();
        let angle = start_rate * end + acceleration.travel(0.0, end);
        let to = from.attitude * rotation(&(axis * angle));
        Ok(Some(Self { from: from.attitude, to, axis, start_rate, acceleration }))
    }

    /// Returns the final attitude.
    pub fn to(&self) -> Quaternion<f64> {
        self.to
    }

    /// Returns the duration (s).
    pub fn duration(&self) -> f64 {
        self.acceleration.end()
    }

    /// Returns the rate about the axis (rad/s).
    fn rate(&self, t: f64) -> f64 {
        self.start_rate + self.acceleration.impulse(0.0, t)
    }

    /// Returns an estimate of the largest rate of the slew (rad/s), from samples.
    pub fn fastest(&self) -> f64 {
        let step = self.duration() / f64::from(PLACES);
        let places = (0..=PLACES).map(|place| step * f64::from(place)).chain(self.acceleration.breaks());
        places.map(|t| self.rate(t).abs()).fold(0.0, f64::max)
    }

    /// Returns attitude, rate and acceleration at `t` seconds after the start of the slew.
    pub fn at(&self, t: f64) -> AttitudeMotion {
        if t >= self.duration() {
            return AttitudeMotion::at_rest(self.to);
        }
        let t = t.max(0.0);
        AttitudeMotion {
            attitude: self.from
                * rotation(&(self.axis * (self.start_rate * t + self.acceleration.travel(0.0, t)))),
            rate: self.axis * self.rate(t),
            acceleration: self.axis * self.acceleration.at(t),
        }
    }
}
