//! A Kepler orbit about a planet: the body's position, the local axes and their rate.
//!
//! In the eccentric anomaly E with E - e sin E = n t + M (\[Wie08\]), r = a ((cos E - e) P + sqrt(1 - e²) sin E Q),
//! with P to the perigee and Q across it in the plane of the orbit. Local axes are z to the planet's centre (nadir), y
//! against the orbit's normal, and x ahead, along the velocity of a circular orbit. They turn about -y at the rate of
//! the true anomaly.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A Kepler orbit. Inertial axes are those of the planet's equator: z along its axis of rotation.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Kepler {
    /// Semi-major axis (m); for a circular orbit, its radius.
    pub semi_major_axis: Positive,
    /// Eccentricity.
    #[serde(default)]
    pub eccentricity: NonNegative,
    /// Inclination to the equator (rad).
    #[serde(default)]
    pub inclination: Finite,
    /// Angle from the inertial x to the ascending node (rad).
    #[serde(default)]
    pub node: Finite,
    /// Angle from the node to the perigee (rad).
    #[serde(default)]
    pub perigee: Finite,
    /// Mean anomaly at the start (rad); for a circular orbit, the angle from the perigee.
    #[serde(default)]
    pub anomaly: Finite,
    /// Gravitational parameter of the planet (m³/s²); default: the Earth's.
    #[serde(default = "earth_gravity")]
    pub gravity: Positive,
    /// Radius of the planet (m), for its shadow; default: the Earth's equatorial radius.
    #[serde(default = "earth_radius")]
    pub planet_radius: Positive,
}

/// Returns GM of the Earth (m³/s²), WGS 84.
fn earth_gravity() -> Positive {
    Positive::new(3.986_004_418e14).unwrap_or(Positive::ONE)
}

/// Returns the radius of the Earth at its equator (m), WGS 84.
fn earth_radius() -> Positive {
    Positive::new(6_378_137.0).unwrap_or(Positive::ONE)
}

/// State of a body on its orbit.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct OrbitPosition {
    /// Position from the planet's centre in inertial axes (m).
    pub position: Vector,
    /// Velocity in inertial axes (m/s).
    pub velocity: Vector,
    /// Unit vectors of the local axes in inertial axes.
    pub local: [Vector; 3],
    /// Rate of the local axes about -y (rad/s), and its derivative (rad/s²).
    pub turning: [f64; 2],
    /// Gravity-gradient strength mu/R³ (1/s²): gravity per unit of distance from the centre of mass.
    pub tide: f64,
}

impl Kepler {
    /// Returns an inconsistency between values: a key within the orbit, and the reason.
    pub(super) fn fault(&self) -> Option<ConfigError> {
        let (e, planet) = (self.eccentricity.get(), self.planet_radius.get());
        if e >= 1.0 {
            return Some(ConfigError::new("eccentricity", format!("must be below 1, got {e}")));
        }
        let nearest = self.nearest();
        (nearest <= planet).then(|| {
            let why = format!(
                "must keep the perigee, at {nearest} m, above the planet's radius of {planet} m, got {}",
                self.semi_major_axis.get()
            );
            ConfigError::new("semi_major_axis", why)
        })
    }

    /// Returns the least distance from the planet's centre (m).
    pub fn nearest(&self) -> f64 {
        self.semi_major_axis.get() * (1.0 - self.eccentricity.get())
    }

    /// Returns the mean motion (rad/s).
    pub fn mean_motion(&self) -> f64 {
        let a = self.semi_major_axis.get();
        f64::sqrt(self.gravity.get() / a) / a
    }

    /// Returns the largest rate of the local axes (rad/s), at the perigee.
    pub fn fastest(&self) -> f64 {
        let e = self.eccentricity.get();
        f64::sqrt(self.gravity.get() * (1.0 + e) / self.nearest()) / self.nearest()
    }

    /// Returns the largest speed (m/s), at the perigee.
    pub fn largest_speed(&self) -> f64 {
        f64::sqrt(self.gravity.get() * (1.0 + self.eccentricity.get()) / self.nearest())
    }

    /// Returns an upper bound of the rate of the velocity's direction (rad/s): the largest acceleration over the least
    /// speed.
    pub fn fastest_velocity(&self) -> f64 {
        let e = self.eccentricity.get();
        let least = self.largest_speed() * (1.0 - e) / (1.0 + e);
        self.gravity.get() / (self.nearest() * self.nearest() * least)
    }

    /// Returns the unit vectors P, Q and along the orbit's normal.
    pub(super) fn plane(&self) -> [Vector; 3] {
        let [(si, ci), (sn, cn), (sp, cp)] =
            [self.inclination, self.node, self.perigee].map(|angle| libm::sincos(angle.get()));
        let ahead =
            |sin: f64, cos: f64| Vector::new(cn * cos - sn * ci * sin, sn * cos + cn * ci * sin, si * sin);
        [ahead(sp, cp), ahead(cp, -sp), Vector::new(sn * si, -cn * si, ci)]
    }

    /// Returns the position on the orbit at `t` seconds after the start.
    pub fn at(&self, t: f64) -> OrbitPosition {
        let (a, e, gravity) = (self.semi_major_axis.get(), self.eccentricity.get(), self.gravity.get());
        let anomaly = eccentric(libm::fmod(self.anomaly.get() + self.mean_motion() * t, TAU), e);
        let (sin, cos) = libm::sincos(anomaly);
        let [p, q, normal] = self.plane();
        let minor = f64::sqrt(1.0 - e * e);
        let radius = a * (1.0 - e * cos);
        let position = (p * (cos - e) + q * (minor * sin)) * a;
        let anomaly_rate = f64::sqrt(gravity * a) / radius;
        let velocity = (q * (minor * cos) - p * sin) * anomaly_rate;
        let nadir = -position / radius;
        let orbit_rate = f64::sqrt(gravity * a) * minor / (radius * radius);
        // r r' = sqrt(mu a) e sin E.
        let climb = anomaly_rate * e * sin;
        OrbitPosition {
            position,
            velocity,
            local: [(-normal).cross(&nadir), -normal, nadir],
            turning: [orbit_rate, -2.0 * orbit_rate * climb / radius],
            tide: gravity / (radius * radius * radius),
        }
    }
}

/// Returns the eccentric anomaly of a mean anomaly, by Newton's method.
fn eccentric(mean: f64, e: f64) -> f64 {
    let mut anomaly = mean + libm::copysign(0.85 * e, libm::sin(mean));
    for _ in 0..50 {
        let (sin, cos) = libm::sincos(anomaly);
        let step = (anomaly - e * sin - mean) / (1.0 - e * cos);
        anomaly -= step;
        if step.abs() <= 1e-15 {
            break;
        }
    }
    anomaly
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit(text: &str) -> Kepler {
        let orbit: Kepler = flexsc_formats::document::from_text(text).unwrap();
        assert_eq!(orbit.fault(), None);
        orbit
    }

    fn eccentric_orbit() -> Kepler {
        orbit(
            "semi_major_axis = 1.2e7\neccentricity = 0.4\ninclination = 0.9\nnode = 0.7\nperigee = 2.1\nanomaly = -0.5",
        )
    }

    #[test]
    fn it_falls_as_gravity_pulls() {
        let orbit = eccentric_orbit();
        let (h, gravity) = (1e-2, 3.986_004_418e14);
        for t in [0.0, 777.0, 5000.0, 30_000.0] {
            let [before, now, after] = [t - h, t, t + h].map(|t| orbit.at(t));
            let speed = (after.position - before.position) / (2.0 * h);
            assert!((speed - now.velocity).norm() < 1e-5, "{t}");
            let pull = (after.velocity - before.velocity) / (2.0 * h);
            let radius = now.position.norm();
            let exact = -now.position * (gravity / (radius * radius * radius));
            assert!((pull - exact).norm() < 1e-7 && (now.tide * radius - exact.norm()).abs() < 1e-13, "{t}");
            // Energy -mu/2a, and momentum sqrt(mu a (1 - e²)) along the normal.
            let energy = 0.5 * now.velocity.norm_squared() - gravity / radius;
            assert!((energy / (-gravity / 2.4e7) - 1.0).abs() < 1e-14, "{t}");
            let momentum = now.position.cross(&now.velocity);
            let exact = f64::sqrt(gravity * 1.2e7 * (1.0 - 0.16));
            assert!((momentum + now.local[1] * exact).norm() < 1e-13 * exact, "{t}");
            // The local axes turn about -y at the rate of the true anomaly.
            let [rate, change] = now.turning;
            let nadir = (after.local[2] - before.local[2]) / (2.0 * h);
            assert!((nadir + now.local[0] * rate).norm() < 1e-10, "{t}");
            assert!(((after.turning[0] - before.turning[0]) / (2.0 * h) - change).abs() < 1e-12, "{t}");
            assert!(rate <= orbit.fastest() * (1.0 + 1e-14));
        }
    }

    #[test]
    fn an_orbit_through_the_planet_is_refused() {
        let fault = |text: &str| {
            flexsc_formats::document::from_text::<Kepler>(text).unwrap().fault().unwrap().to_string()
        };
        assert!(
            fault("semi_major_axis = 7e6\neccentricity = 0.1").starts_with("`semi_major_axis` must keep")
        );
        assert!(
            fault("semi_major_axis = 7e6\neccentricity = 1.0").starts_with("`eccentricity` must be below 1")
        );
    }
}
