//! Reference frames of target attitudes: inertial, local orbital, or Sun-pointing.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::attitude::from_axes;
use flexsc_spacecraft::environment::{DirectionMotion, OrbitEnvironment, SunPath};
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
                rate: place.turning[0],
                acceleration: place.turning[1],
            }),
            Self::Sun => sky.sun().map_or_else(inertial, |sun| sun_axes(&sun.motion(t))),
        }
    }

    /// Returns true if the frame rotates under a sky that defines it.
    pub fn rotates(self, sky: &OrbitEnvironment) -> bool {
        match self {
            Self::Inertial => false,
            Self::Nadir => true,
            Self::Sun => sky.sun().is_some_and(SunPath::moves),
        }
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

/// Returns attitude, rate and acceleration of the axes with z to the Sun and x in the plane of the Sun and the planet's
/// axis.
fn sun_axes(sun: &DirectionMotion) -> AttitudeMotion {
    let z = sun.direction;
    let across = Vector::z().cross(&z);
    // If the Sun is along the planet's axis, any direction will do.
    let y = if across.norm() > 1e-9 { across.normalize() } else { Vector::y() };
    let y = (y - z * z.dot(&y)).normalize();
    let attitude = from_axes(&[y.cross(&z), y, z]);
    if sun.rate == Vector::zeros() {
        return AttitudeMotion::at_rest(attitude);
    }
    // Right ascension a and declination d: the axes turn by a' about the planet's axis and by -d' about y.
    let (sin, cos) = (z.z, libm::hypot(z.x, z.y));
    let (ds, dds) = (sun.rate, sun.acceleration);
    let [ascension, declination] = [(z.x * ds.y - z.y * ds.x) / (cos * cos), ds.z / cos];
    let cos_rate = -sin * declination;
    let ascension_change = (z.x * dds.y - z.y * dds.x) / (cos * cos) - 2.0 * ascension * cos_rate / cos;
    let declination_change = (dds.z + sin * declination * declination) / cos;
    AttitudeMotion {
        attitude,
        rate: Vector::new(-ascension * cos, -declination, ascension * sin),
        acceleration: Vector::new(
            -ascension_change * cos - ascension * cos_rate,
            -declination_change,
            ascension_change * sin + ascension * cos * declination,
        ),
    }
}
