//! Reference frames of target attitudes: inertial, local orbital, or Sun-pointing.

use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::attitude::Vector;
use crate::attitude::of_axes;
use crate::document::Fault;
use crate::environment::Sky;
use crate::manoeuvre::Pose;

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
    pub fn at(self, sky: &Sky, t: f64) -> Pose {
        let inertial = || Pose::at_rest(Quaternion::new(1.0, 0.0, 0.0, 0.0));
        match self {
            Self::Inertial => inertial(),
            Self::Nadir => sky.place(t).map_or_else(inertial, |place| Pose {
                attitude: of_axes(&place.local),
                rate: Vector::new(0.0, -place.turning[0], 0.0),
                acceleration: Vector::new(0.0, -place.turning[1], 0.0),
            }),
            Self::Sun => sky.sun().map_or_else(inertial, |sun| {
                let across = Vector::z().cross(sun);
                // If the Sun is along the planet's axis, any direction will do.
                let y = if across.norm() > 1e-9 { across.normalize() } else { Vector::y() };
                let y = (y - sun * sun.dot(&y)).normalize();
                Pose::at_rest(of_axes(&[y.cross(sun), y, *sun]))
            }),
        }
    }

    /// Returns true if the frame rotates.
    pub fn turns(self) -> bool {
        self == Self::Nadir
    }

    /// Returns the name of the reference frame for messages.
    pub fn words(self) -> &'static str {
        match self {
            Self::Inertial => "",
            Self::Nadir => " from the local axes of the orbit",
            Self::Sun => " from the Sun's axes",
        }
    }

    /// Checks that the frame is defined under a sky; returns the key and the reason if not.
    pub fn fault(self, sky: &Sky) -> Option<Fault> {
        let why = match self {
            Self::Nadir if sky.orbit().is_none() => {
                "points to the planet of `[environment.orbit]`, and there is none"
            }
            Self::Sun if sky.sun().is_none() => "points to `environment.sun`, and there is none",
            _ => return None,
        };
        Some(Fault::new("frame", why))
    }
}
