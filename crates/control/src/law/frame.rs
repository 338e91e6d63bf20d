//! Reference frames of target attitudes: inertial, local orbital, or Sun-pointing.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::attitude::from_axes;
use flexsc_spacecraft::environment::OrbitEnvironment;
use flexsc_spacecraft::manoeuvre::AttitudeMotion;
use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Frame relative to which a target's attitude is given.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Frame {
    /// Inertial axes.
    #[default]
    Inertial,
    /// The local axes of the orbit: z to the planet's centre, y against the orbit's normal, x ahead. They rotate with the orbit.
    Nadir,
    /// z to the Sun, x in the plane of the Sun and the planet's axis.
    Sun,
}

impl Frame {
    /// Returns attitude, rate and acceleration of the frame `t` (s) after the start, under a sky that defines it.
    pub fn state_at(self, sky: &OrbitEnvironment, t: f64) -> AttitudeMotion {
        let inertial = || AttitudeMotion::at_rest(Quaternion::new(1.0, 0.0, 0.0, 0.0));
        match self {
            Self::Inertial => inertial(),
            Self::Nadir => sky.position(t).map_or_else(inertial, |place| AttitudeMotion {
                attitude: from_axes(&place.local),
                rate: Vector::new(0.0, -place.turning[0], 0.0),
                acceleration: Vector::new(0.0, -place.turning[1], 0.0),
            }),
            Self::Sun => sky.sun().map_or_else(inertial, |sun| {
                let across = Vector::z().cross(sun);
                // If the Sun is along the planet's axis, any direction will do.
                let y = if across.norm() > 1e-9 { across.normalize() } else { Vector::y() };
                let y = (y - sun * sun.dot(&y)).normalize();
                AttitudeMotion::at_rest(from_axes(&[y.cross(sun), y, *sun]))
            }),
        }
    }

    /// Returns true if the frame rotates.
    pub fn rotates(self) -> bool {
        self == Self::Nadir
    }

    /// Returns the name of the reference frame for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inertial => "",
            Self::Nadir => " from the local axes of the orbit",
            Self::Sun => " from the Sun's axes",
        }
    }

    /// Checks that the frame is defined under a sky; returns the key and the reason if not.
    pub fn validate(self, sky: &OrbitEnvironment) -> Option<ConfigError> {
        let why = match self {
            Self::Nadir if sky.orbit().is_none() => {
                "points to the planet of `[environment.orbit]`, and there is none"
            }
            Self::Sun if sky.sun().is_none() => "points to `environment.sun`, and there is none",
            _ => return None,
        };
        Some(ConfigError::new("frame", why))
    }
}
