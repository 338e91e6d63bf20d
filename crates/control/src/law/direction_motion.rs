//! Directions to which a body points, as they move in inertial axes.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::Finite;
use flexsc_spacecraft::environment::{DirectionMotion, GroundSite, OrbitEnvironment, OrbitPath, SunPath};
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
            Self::Inertial(direction) => DirectionMotion::fixed(vector(direction).normalize()),
            Self::Site(site) => {
                let [position, velocity, acceleration, _] = sky.orbit_motion(t)?;
                let own = site.motion(sky.greenwich(), t);
                DirectionMotion::along([own[0] - position, own[1] - velocity, own[2] - acceleration])
            }
        })
    }

    /// Returns an upper bound of the rate of the direction (rad/s) under a sky that defines it.
    pub fn fastest(&self, sky: &OrbitEnvironment) -> f64 {
        match self {
            Self::Nadir => sky.orbit().map_or(0.0, OrbitPath::fastest),
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
        self.fastest(sky) > 0.0
    }

    /// Checks that a sky defines the direction; returns the key within the direction and the reason if not.
    pub fn validate(&self, sky: &OrbitEnvironment) -> Option<ConfigError> {
        let why = match self {
            Self::Nadir | Self::Velocity | Self::OrbitNormal | Self::Site(_) if sky.orbit().is_none() => {
                "needs `[environment.orbit]`, and there is none"
            }
            Self::Sun if sky.sun().is_none() => "points to `environment.sun`, and there is none",
            Self::Inertial(direction) if vector(direction) == Vector::zeros() => {
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
