//! Bright bodies that blind a sensor: the Sun, the Moon and the planet's limb, by their angles to a direction.

use std::f64::consts::PI;

use flexsc_numerics::attitude::Vector;

use super::{OrbitEnvironment, SunPath, moon};

/// Body whose light blinds a sensor.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum BrightBody {
    /// Centre of the Sun, in the light or in the planet's shadow.
    Sun,
    /// Centre of the Moon.
    Moon,
    /// Limb of the planet: the edge of its disc.
    Limb,
}

impl BrightBody {
    /// Returns the name of the body, as in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sun => "sun",
            Self::Moon => "moon",
            Self::Limb => "limb",
        }
    }
}

/// Returns the angle between two directions of any length (rad).
fn angle_between(one: &Vector, other: &Vector) -> f64 {
    libm::atan2(one.cross(other).norm(), one.dot(other))
}

impl OrbitEnvironment {
    /// Returns the angle (rad) from a direction in inertial axes to a bright body at a time since the start (s); negative
    /// within the limb, pi for a body that the environment does not have.
    pub fn angle_to(&self, body: BrightBody, direction: &Vector, t: f64) -> f64 {
        match body {
            BrightBody::Sun => self.sun().map_or(PI, |sun| angle_between(direction, &sun.direction(t))),
            BrightBody::Moon => {
                let place = self.position(t).map_or_else(Vector::zeros, |place| place.position);
                self.moon(t).map_or(PI, |moon| angle_between(direction, &(moon - place)))
            }
            BrightBody::Limb => self.position(t).zip(self.planet_radius()).map_or(PI, |(place, radius)| {
                let distance = place.position.norm();
                angle_between(direction, &-place.position) - libm::asin((radius / distance).min(1.0))
            }),
        }
    }

    /// Returns an upper bound of the rate (rad/s) at which the angle from a fixed direction to a bright body changes.
    pub fn angle_rate(&self, body: BrightBody) -> f64 {
        let orbit = self.orbit();
        match body {
            BrightBody::Sun => self.sun().map_or(0.0, SunPath::fastest),
            BrightBody::Moon => {
                let (speed, farthest) =
                    orbit.map_or((0.0, 0.0), |orbit| (orbit.largest_speed(), orbit.farthest()));
                (moon::FASTEST + speed) / (moon::NEAREST - farthest).max(f64::MIN_POSITIVE)
            }
            BrightBody::Limb => orbit.map_or(0.0, |orbit| {
                // asin(R/r) falls by R r'/(r sqrt(r² - R²)).
                let (nearest, radius) = (orbit.nearest(), orbit.planet_radius());
                let tangent = f64::sqrt((nearest - radius) * (nearest + radius));
                orbit.fastest() + radius * orbit.largest_speed() / (nearest * tangent)
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::time::Span;

    /// The Moon seen from an orbit, with its direction and distance of 2026-11-24 by ERFA: the parallax is 0.015 rad.
    #[test]
    fn the_moon_has_a_parallax() {
        let environment = flexsc_formats::document::from_text("orbit = { semi_major_axis = 7e6 }");
        let epoch = Some(1_795_478_400_000_000_000);
        let sky = OrbitEnvironment::new(&environment.expect("an orbit"), Span::from_seconds(1e3), epoch);
        let place = sky.position(0.0).expect("an orbit").position;
        let moon = Vector::new(0.598_916, 0.695_693, 0.396_625) * 362_491.3e3;
        let found = sky.angle_to(BrightBody::Moon, &place, 0.0);
        assert!((found - angle_between(&place, &(moon - place))).abs() < 5e-3, "{found}");
        assert!((found - angle_between(&place, &moon)).abs() > 1e-2, "{found}");
    }
}
