//! The B-dot law: magnetic moments against the change of the measured magnetic field.

use crate::maths::clamp;
use crate::ticks::Ticks;
use crate::vector3::Vector3;

/// Rate of change of the magnetic field, by the difference of its last two samples.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FieldRate {
    /// True from the first sample on.
    pub has_field: bool,
    /// Time of the last sample.
    pub at: Ticks,
    /// Field of the last sample, body axes (T).
    pub field: Vector3,
    /// True if the last two samples have a difference.
    pub has_rate: bool,
    /// Rate of change (T/s); 0 before the second sample.
    pub rate: Vector3,
    /// Age of the last sample above which the rate is unknown.
    pub most_age: Ticks,
}

impl FieldRate {
    /// Returns the rate before the first sample; it is unknown if the last sample is older than `most_age`.
    pub fn new(most_age: Ticks) -> Self {
        Self {
            has_field: false,
            at: Ticks { whole: 0, part: 0 },
            field: Vector3::ZERO,
            has_rate: false,
            rate: Vector3::ZERO,
            most_age,
        }
    }

    /// Returns true if the last sample is too old, or later than `now`.
    #[inline]
    pub fn is_stale(&self, now: Ticks) -> bool {
        now.is_before(self.at) || self.at.plus(self.most_age).is_before(now)
    }

    /// Returns the rate of change at a time (T/s); 0 if it is unknown.
    #[inline]
    pub fn rate_at(&self, now: Ticks) -> Vector3 {
        if self.is_stale(now) { Vector3::ZERO } else { self.rate }
    }

    /// Takes a sample of the field in body axes (T). One at the time of the last sample replaces it; one that is not finite changes
    /// nothing. After a gap the rate is unknown until the next sample.
    pub fn take(&mut self, now: Ticks, field: &Vector3) {
        if !field.norm_squared().is_finite() {
            return;
        }
        self.has_rate = self.has_field && self.at.is_before(now) && !self.is_stale(now);
        if self.is_stale(now) {
            self.rate = Vector3::ZERO;
        }
        if self.has_rate {
            let change: Vector3 = field.minus(&self.field);
            let span: Ticks = now.since(self.at);
            self.rate = change.divided(span.seconds());
        }
        self.has_field = true;
        self.at = now;
        self.field = *field;
    }
}

/// Returns the magnetic moment along an axis (A m²) for a gain (A m² s/T) and the rate of change of the field along it (T/s).
#[inline]
pub fn opposing_moment(gain: f64, field_rate: f64) -> f64 {
    -gain * field_rate
}

/// Returns the moment that a torquer gives for a demanded one, within its largest (A m²).
#[inline]
pub fn limited_moment(demanded: f64, limit: f64) -> f64 {
    clamp(demanded, -limit, limit)
}

/// Returns the moments along the axes (A m²), within their largest ones, for gains (A m² s/T) and a rate of change of the field (T/s).
pub fn moments(field_rate: &Vector3, gains: &Vector3, limits: &Vector3) -> Vector3 {
    Vector3 {
        x: limited_moment(opposing_moment(gains.x, field_rate.x), limits.x),
        y: limited_moment(opposing_moment(gains.y, field_rate.y), limits.y),
        z: limited_moment(opposing_moment(gains.z, field_rate.z), limits.z),
    }
}
