//! A turn about one axis by an acceleration that is a waveform: a planned command, or a turn with limits through a shaper.

use nalgebra::Quaternion;

use super::slew::{Pose, eigenaxis};
use crate::attitude::{Vector, rotation};
use crate::document::Fault;
use crate::waveform::Waveform;

/// How many places of a turn its largest rate is taken from, beside where its acceleration jumps.
const PLACES: u32 = 200;

/// A turn from rest to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct RestToRest {
    from: Quaternion<f64>,
    to: Quaternion<f64>,
    /// The axis, the same in both attitudes.
    axis: Vector,
    /// The acceleration about it (rad/s²).
    acceleration: Waveform,
}

impl RestToRest {
    /// The turn on the shorter way, with the acceleration (rad/s²) that is planned for its angle (rad).
    ///
    /// # Errors
    /// Why there is no such plan.
    pub fn new(
        [from, to]: [Quaternion<f64>; 2],
        plan: impl FnOnce(f64) -> Result<Waveform, Fault>,
    ) -> Result<Self, Fault> {
        let (axis, angle) = eigenaxis(&from, &to);
        Ok(Self { from, to, axis, acceleration: plan(angle)? })
    }

    /// The attitude at its end.
    pub fn to(&self) -> Quaternion<f64> {
        self.to
    }

    /// How long it lasts (s).
    pub fn duration(&self) -> f64 {
        self.acceleration.end()
    }

    /// About the largest rate on the way (rad/s).
    pub fn fastest(&self) -> f64 {
        let step = self.duration() / f64::from(PLACES);
        let places = (0..=PLACES).map(|place| step * f64::from(place)).chain(self.acceleration.breaks());
        places.map(|t| self.acceleration.impulse(0.0, t).abs()).fold(0.0, f64::max)
    }

    /// Where it is so many seconds after it began.
    pub fn at(&self, t: f64) -> Pose {
        if t >= self.duration() {
            return Pose::at_rest(self.to);
        }
        let t = t.max(0.0);
        Pose {
            attitude: self.from * rotation(&(self.axis * self.acceleration.travel(0.0, t))),
            rate: self.axis * self.acceleration.impulse(0.0, t),
            acceleration: self.axis * self.acceleration.at(t),
        }
    }
}
