//! Directions to which a body points, as they move in inertial axes.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::Finite;
use flexsc_spacecraft::environment::{DirectionMotion, GroundSite, OrbitEnvironment, OrbitPath, SunPath};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Direction in the sky.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SkyDirection {
    /// Direction to the centre of the orbit's planet.
    Nadir,
    /// Direction to the Sun, `environment.sun`.
    Sun,
    /// Direction of the velocity on the orbit.
    Velocity,
    /// Direction of the orbit's normal.
    OrbitNormal,
    /// Direction of the magnetic field at the body, `environment.magnetic_field`.
    Field,
    /// Direction of any length, constant in the local axes of the orbit: x ahead, y against the normal, z to the planet's centre.
    Orbit([Finite; 3]),
    /// Direction of any length, constant in inertial axes.
    Inertial([Finite; 3]),
    /// Direction to a site on the Earth, which turns with it.
    Site(GroundSite),
}

impl SkyDirection {
    /// Returns the direction `t` (s) after the start, under a sky that defines it; z of the inertial axes otherwise.
    pub fn motion(&self, sky: &OrbitEnvironment, t: f64) -> DirectionMotion {
        self.defined_motion(sky, t).unwrap_or_else(|| DirectionMotion::fixed(Vector::z()))
    }

    fn defined_motion(&self, sky: &OrbitEnvironment, t: f64) -> Option<DirectionMotion> {
        Some(match self {
            Self::Nadir => {
                let [position, velocity, acceleration, _] = sky.orbit_motion(t)?;
                DirectionMotion::along([-position, -velocity, -acceleration])
            }
            Self::Velocity => {
                let [_, velocity, acceleration, jerk] = sky.orbit_motion(t)?;
                DirectionMotion::along([velocity, acceleration, jerk])
            }
            Self::OrbitNormal => DirectionMotion::along(sky.orbit_normal(t)?),
            Self::Sun => sky.sun()?.motion(t),
            Self::Field => DirectionMotion::along(sky.field_motion(t)?),
            Self::Orbit(direction) => {
                let place = sky.position(t)?;
                let [own, rate, acceleration] = [vector(direction), place.turning[0], place.turning[1]];
                let change = rate.cross(&own);
                let turned = acceleration.cross(&own) + rate.cross(&change);
                let axes = Matrix3::from_columns(&place.local);
                DirectionMotion::along([own, change, turned].map(|part| axes * part))
            }
            Self::Inertial(direction) => DirectionMotion::fixed(vector(direction).normalize()),
            Self::Site(site) => {
                let [position, velocity, acceleration, _] = sky.orbit_motion(t)?;
                let own = site.motion(sky.greenwich(), t);
                DirectionMotion::along([own[0] - position, own[1] - velocity, own[2] - acceleration])
            }
        })
    }

    /// Returns an upper bound of the rate of the direction (rad/s) from `t` (s) on, under a sky that defines it. That of the field
    /// holds for the time in which it would turn the direction by 1 rad.
    pub fn fastest(&self, sky: &OrbitEnvironment, t: f64) -> f64 {
        match self {
            // In that time the field loses at most half of its size.
            Self::Field => sky.field_at(t).map_or(0.0, |field| 2.0 * sky.field_rate_bound() / field.norm()),
            Self::Nadir | Self::Orbit(_) => sky.orbit().map_or(0.0, OrbitPath::fastest),
            Self::Velocity => sky.orbit().map_or(0.0, OrbitPath::fastest_velocity),
            Self::OrbitNormal => sky.orbit().map_or(0.0, OrbitPath::plane_rate),
            Self::Inertial(_) => 0.0,
            Self::Sun => sky.sun().map_or(0.0, SunPath::fastest),
            // The line of sight turns at most at the relative speed over the least distance.
            Self::Site(site) => sky.orbit().map_or(0.0, |orbit| {
                (orbit.largest_speed() + site.speed()) / (orbit.nearest() - site.distance()).max(0.0)
            }),
        }
    }

    /// Returns true if the direction moves under a sky that defines it.
    pub fn moves(&self, sky: &OrbitEnvironment) -> bool {
        self.fastest(sky, 0.0) > 0.0
    }

    /// Checks that a sky defines the direction; returns the key within the direction and the reason if not.
    pub fn validate(&self, sky: &OrbitEnvironment) -> Option<ConfigError> {
        let why = match self {
            Self::Nadir | Self::Velocity | Self::OrbitNormal | Self::Orbit(_) | Self::Site(_)
                if sky.orbit().is_none() =>
            {
                "needs `[environment.orbit]`, and there is none"
            }
            Self::Field if !sky.is_magnetic() => "is that of `environment.magnetic_field`, and there is none",
            Self::Field if sky.field_bound() == 0.0 => {
                "is that of `environment.magnetic_field`, and all of its `coefficients` are zero"
            }
            Self::Sun if sky.sun().is_none() => "points to `environment.sun`, and there is none",
            Self::Inertial(direction) | Self::Orbit(direction) if vector(direction) == Vector::zeros() => {
                "must be a direction, got the zero vector"
            }
            Self::Site(site) if sky.orbit().is_some_and(|orbit| orbit.nearest() <= site.distance()) => {
                "must be below the orbit's perigee"
            }
            _ => return None,
        };
        Some(ConfigError::new("along", why))
    }
}
