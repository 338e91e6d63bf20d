//! Sites on the Earth's surface, which turn with it: the ellipsoid of WGS 84.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, Latitude, Longitude};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Equatorial radius of the Earth (m), WGS 84.
pub(super) const RADIUS: f64 = 6_378_137.0;
/// Flattening of the Earth, WGS 84.
pub(super) const FLATTENING: f64 = 1.0 / 298.257_223_563;
/// Rotation rate of the Earth (rad/s).
const ROTATION: f64 = 7.292_115e-5;

/// Returns the height (m) above the Earth's ellipsoid of a position in axes with z along the Earth's axis, by Bowring's
/// formula for the latitude.
pub(super) fn height(position: &Vector) -> f64 {
    let (squared, minor) = (FLATTENING * (2.0 - FLATTENING), RADIUS * (1.0 - FLATTENING));
    let across = libm::hypot(position.x, position.y);
    let (sin, cos) = libm::sincos(libm::atan2(position.z * RADIUS, across * minor));
    let beyond = squared / (1.0 - squared) * minor;
    let latitude =
        libm::atan2(position.z + beyond * sin * sin * sin, across - squared * RADIUS * cos * cos * cos);
    let (sin, cos) = libm::sincos(latitude);
    across * cos + position.z * sin - RADIUS * f64::sqrt(1.0 - squared * sin * sin)
}

/// Site that turns with the Earth.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroundSite {
    /// Geodetic latitude (rad).
    pub latitude: Latitude,
    /// Longitude east of Greenwich (rad), whose angle at the start is that of the `epoch`, or 0 without one.
    pub longitude: Longitude,
    /// Height above the ellipsoid of WGS 84 (m).
    #[serde(default)]
    pub height: Finite,
}

impl GroundSite {
    /// Returns the distance from the Earth's axis and along it (m).
    fn meridian_position(&self) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.latitude.get());
        let squared = FLATTENING * (2.0 - FLATTENING);
        let across = RADIUS / f64::sqrt(1.0 - squared * sin * sin);
        let height = self.height.get();
        [(across + height) * cos, (across * (1.0 - squared) + height) * sin]
    }

    /// Returns position (m), velocity (m/s) and acceleration (m/s²) in inertial axes at a time since the start (s), with
    /// the angle of Greenwich at the start (rad).
    pub fn motion(&self, greenwich: f64, t: f64) -> [Vector; 3] {
        let [across, along] = self.meridian_position();
        let (sin, cos) = libm::sincos(greenwich + self.longitude.get() + ROTATION * t);
        let position = Vector::new(across * cos, across * sin, along);
        let turned = |v: &Vector| Vector::new(-ROTATION * v.y, ROTATION * v.x, 0.0);
        let velocity = turned(&position);
        [position, velocity, turned(&velocity)]
    }

    /// Returns the elevation (rad) above the horizon of the site of a position (m) in inertial axes at a time since the start
    /// (s), with the angle of Greenwich at the start (rad).
    pub fn elevation(&self, position: &Vector, greenwich: f64, t: f64) -> f64 {
        let [site, ..] = self.motion(greenwich, t);
        let (sin, cos) = libm::sincos(greenwich + self.longitude.get() + ROTATION * t);
        let (up, across) = libm::sincos(self.latitude.get());
        let vertical = Vector::new(across * cos, across * sin, up);
        let line = position - site;
        libm::atan2(vertical.dot(&line), vertical.cross(&line).norm())
    }

    /// Returns a time (s) after `t` within which the elevation of a body on an orbit, at most as fast as `speed` (m/s), cannot
    /// change by `change` (rad).
    pub fn steady_time(&self, position: &Vector, greenwich: f64, t: f64, [speed, change]: [f64; 2]) -> f64 {
        let [site, ..] = self.motion(greenwich, t);
        let (distance, relative) = ((position - site).norm(), speed + self.speed());
        // Until half of the distance is covered, the line of sight turns at most twice as fast as at that speed here.
        (0.5 * distance / relative).min(change / (2.0 * relative / distance + ROTATION))
    }

    /// Returns the distance from the Earth's centre (m).
    pub fn distance(&self) -> f64 {
        let [across, along] = self.meridian_position();
        libm::hypot(across, along)
    }

    /// Returns the speed in inertial axes (m/s).
    pub fn speed(&self) -> f64 {
        ROTATION * self.meridian_position()[0].abs()
    }
}
