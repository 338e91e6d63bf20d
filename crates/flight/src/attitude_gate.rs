//! Gate of an attitude filter: which readings it takes, and when improbable ones correct it all the same.

use crate::attitude_observation::{AttitudeObservation, ObservationKind};
use crate::quaternion::Quaternion;
use crate::ticks::Ticks;
use crate::vector3::Vector3;

/// Largest difference from 1 of the square of a unit quaternion's or unit vector's norm: 1e-3 of the norm.
const UNIT_TOLERANCE: f64 = 2e-3;

/// Limits within which an attitude filter accepts readings.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct AttitudeGate {
    /// Largest normalised innovation squared of a measurement, as of three components.
    pub most_nis: f64,
    /// Number of improbable measurements in a row after which the next one is accepted; also of gyro readings in a row that are
    /// older than the last one, after which the clock counts as set back.
    pub most_refusals: u32,
    /// Time without a correction after which an improbable measurement is accepted at once.
    pub gap: Ticks,
    /// Largest rate about an axis that is taken from the gyro (rad/s).
    pub most_rate: f64,
}

impl AttitudeGate {
    /// Returns true if a gyro reading (rad/s) is finite and within the largest rate.
    #[inline]
    pub fn is_sound_rate(&self, reading: &Vector3) -> bool {
        reading.x.abs() <= self.most_rate
            && reading.y.abs() <= self.most_rate
            && reading.z.abs() <= self.most_rate
    }
}

/// Returns true if a squared norm is that of a unit vector.
#[inline]
fn is_unit(square: f64) -> bool {
    (square - 1.0).abs() <= UNIT_TOLERANCE
}

impl AttitudeObservation {
    /// Returns the sum of the variances of the measurement error about the axes (rad²); of a vector, relative to its length.
    pub fn angle_variance(&self) -> f64 {
        let variance: f64 = self.noise.rows[0][0] + self.noise.rows[1][1] + self.noise.rows[2][2];
        if self.kind == ObservationKind::Attitude {
            return variance;
        }
        variance / self.vector.norm_squared()
    }

    /// Returns true if a measurement is finite, and of unit length if it is an attitude or a direction; a vector is not 0.
    pub fn is_sound(&self) -> bool {
        match self.kind {
            ObservationKind::Attitude => is_unit(self.attitude.norm_squared()),
            ObservationKind::Direction => {
                is_unit(self.vector.norm_squared()) && is_unit(self.inertial.norm_squared())
            }
            ObservationKind::Vector => {
                self.vector.norm_squared().is_finite()
                    && self.vector.norm_squared() > 0.0
                    && self.inertial.norm_squared().is_finite()
                    && self.inertial.norm_squared() > 0.0
            }
        }
    }
}

impl Quaternion {
    /// Returns true if the quaternion is finite and of unit length.
    #[inline]
    pub fn is_unit(&self) -> bool {
        is_unit(self.norm_squared())
    }
}
