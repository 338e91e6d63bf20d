//! A Kepler orbit about a planet: the body's position, the local axes and their rate.
//!
//! In the eccentric anomaly E with E - e sin E = n t + M (\[Wie08\]), r = a ((cos E - e) P + sqrt(1 - e²) sin E Q),
//! with P to the perigee and Q across it in the plane of the orbit. Local axes are z to the planet's centre (nadir), y
//! against the orbit's normal, and x ahead, along the velocity of a circular orbit. They turn about -y at the rate of
//! the true anomaly. Of an oblate planet, node, perigee and mean anomaly drift at their mean rates, and the axes turn with
//! them.

#[cfg(test)]
mod tests;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, shortest};
use flexsc_numerics::time_arcs::SplitTime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Oblateness;
use super::oblateness::SecularRates;
use super::phase::{Phase, product};

/// A Kepler orbit. Inertial axes are those of the planet's equator: z along its axis of rotation.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Kepler {
    /// Semi-major axis (m); for a circular orbit, its radius. Inertial axes are then those of the planet's equator,
    /// z along its axis.
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
    /// Coefficient J2 of the planet's oblateness, by which node, perigee and anomaly drift at their mean rates,
    /// without the short-period terms of some kilometres: `true` for that of the Earth, or a number; default: a
    /// sphere.
    #[serde(default, skip_serializing_if = "Oblateness::is_zero")]
    pub j2: Oblateness,
}

/// Returns GM of the Earth (m³/s²), WGS 84.
pub fn earth_gravity() -> Positive {
    Positive::new(3.986_004_418e14).unwrap_or(Positive::ONE)
}

/// Returns the radius of the Earth at its equator (m), WGS 84.
pub fn earth_radius() -> Positive {
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
    /// Rate of the local axes in these axes (rad/s), and its derivative (rad/s²).
    pub turning: [Vector; 2],
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
        let (nearest, axis) = (self.nearest(), self.semi_major_axis.get());
        (nearest <= planet).then(|| {
            let meant = if 1e3 * nearest > planet && axis < 1e5 {
                format!("is it meant as \"{} km\"?", shortest(axis))
            } else {
                format!("it counts from the centre: write `altitude` for {0} m above the surface, where it is {1}", shortest(axis), planet + axis)
            };
            let why = format!(
                "must keep the perigee, at {nearest} m, above the planet's radius of {planet} m, got {axis}: the orbit is inside the planet; \
                 {meant}"
            );
            ConfigError::new("semi_major_axis", why)
        })
    }

    /// Returns the least distance from the planet's centre (m).
    pub fn nearest(&self) -> f64 {
        self.semi_major_axis.get() * (1.0 - self.eccentricity.get())
    }

    /// Returns the greatest distance from the planet's centre (m).
    pub fn farthest(&self) -> f64 {
        self.semi_major_axis.get() * (1.0 + self.eccentricity.get())
    }

    /// Returns the mean motion (rad/s) about a sphere.
    pub fn mean_motion(&self) -> f64 {
        let a = self.semi_major_axis.get();
        f64::sqrt(self.gravity.get() / a) / a
    }

    /// Returns the rate of the mean anomaly (rad/s).
    pub fn anomaly_rate(&self) -> f64 {
        self.mean_motion() + self.secular_rates().anomaly
    }

    /// Returns the mean anomaly over time. Its rate is exact: rounded, it would err by 5e-12 rad after a year.
    fn mean_anomaly(&self, drift: &SecularRates) -> Phase {
        let (a, gravity, motion, drift) =
            (self.semi_major_axis.get(), self.gravity.get(), self.mean_motion(), drift.anomaly);
        // Step of Newton's method for n with (n a)² a = mu.
        let [speed, speed_rest] = product(motion, a);
        let [squared, squared_rest] = product(speed, speed);
        let [pull, pull_rest] = product(squared, a);
        let rest = pull_rest + (squared_rest + 2.0 * speed * speed_rest) * a;
        let more = motion * ((gravity - pull) - rest) / (2.0 * gravity);
        let rate = motion + drift;
        Phase { start: self.anomaly.get(), rate: [rate, (motion - rate) + drift + more] }
    }

    /// Returns true if the elements drift.
    pub fn drifts(&self) -> bool {
        !self.j2.is_zero()
    }

    /// Returns an upper bound of the rate at which plane and perigee turn (rad/s).
    pub fn plane_rate(&self) -> f64 {
        let drift = self.secular_rates();
        drift.node.abs() + drift.perigee.abs()
    }

    /// Returns the ratio of the rate of the mean anomaly to the mean motion.
    fn haste(&self, drift: &SecularRates) -> f64 {
        let motion = self.mean_motion();
        (motion + drift.anomaly) / motion
    }

    /// Returns an upper bound of the rate of the local axes (rad/s), reached at the perigee about a sphere. Times the least
    /// distance, it bounds the speed.
    pub fn fastest(&self) -> f64 {
        let e = self.eccentricity.get();
        let own = f64::sqrt(self.gravity.get() * (1.0 + e) / self.nearest()) / self.nearest();
        if self.drifts() {
            self.haste(&self.secular_rates()) * own + self.plane_rate() * (1.0 + e) / (1.0 - e)
        } else {
            own
        }
    }

    /// Returns an upper bound of the speed (m/s), reached at the perigee about a sphere.
    pub fn largest_speed(&self) -> f64 {
        let own = f64::sqrt(self.gravity.get() * (1.0 + self.eccentricity.get()) / self.nearest());
        if self.drifts() {
            self.haste(&self.secular_rates()) * own + self.plane_rate() * self.farthest()
        } else {
            own
        }
    }

    /// Returns an upper bound of the rate of the velocity's direction (rad/s): the largest acceleration over the least
    /// speed.
    pub fn fastest_velocity(&self) -> f64 {
        let (e, nearest) = (self.eccentricity.get(), self.nearest());
        let largest = f64::sqrt(self.gravity.get() * (1.0 + e) / nearest);
        let least = largest * (1.0 - e) / (1.0 + e);
        if !self.drifts() {
            return self.gravity.get() / (nearest * nearest * least);
        }
        let (haste, turn, farthest) = (self.haste(&self.secular_rates()), self.plane_rate(), self.farthest());
        let pull = haste * haste * self.gravity.get() / (nearest * nearest);
        let acceleration = pull + 2.0 * turn * (haste * largest + turn * farthest);
        acceleration / (haste * least - turn * farthest).max(0.0)
    }

    /// Returns the unit vectors P, Q and along the orbit's normal at a time since the start.
    pub(super) fn plane(&self, t: SplitTime) -> [Vector; 3] {
        self.drifted_plane(&self.secular_rates(), t)
    }

    fn drifted_plane(&self, drift: &SecularRates, t: SplitTime) -> [Vector; 3] {
        let at = |start: Finite, rate: f64| Phase { start: start.get(), rate: [rate, 0.0] }.at(t);
        let (node, perigee) = (at(self.node, drift.node), at(self.perigee, drift.perigee));
        let [(si, ci), (sn, cn), (sp, cp)] = [self.inclination.get(), node, perigee].map(libm::sincos);
        let ahead =
            |sin: f64, cos: f64| Vector::new(cn * cos - sn * ci * sin, sn * cos + cn * ci * sin, si * sin);
        [ahead(sp, cp), ahead(cp, -sp), Vector::new(sn * si, -cn * si, ci)]
    }

    /// Returns the rotation rate of P and Q in inertial axes (rad/s) at a time since the start.
    pub(super) fn plane_rotation(&self, t: SplitTime) -> Vector {
        let drift = self.secular_rates();
        drift.rotation(&self.drifted_plane(&drift, t)[2])
    }

    /// Returns the orbit's normal with its first two derivatives, about an oblate planet.
    pub(super) fn normal_motion(&self, t: f64) -> [Vector; 3] {
        let drift = self.secular_rates();
        drift.normal_motion(self.drifted_plane(&drift, t.into())[2])
    }

    /// Returns the position on the orbit at `t` seconds after the start.
    pub fn at(&self, t: f64) -> OrbitPosition {
        self.place(t.into())
    }

    /// Returns the position on the orbit at a time since the start.
    pub(super) fn place(&self, t: SplitTime) -> OrbitPosition {
        let drift = self.secular_rates();
        let place = self.in_plane(&drift, t);
        if self.drifts() { self.turned(place, &drift) } else { place }
    }

    /// Returns position (m), velocity, acceleration and its rate of change in inertial axes at `t` seconds after the
    /// start.
    pub fn motion(&self, t: f64) -> [Vector; 4] {
        let drift = self.secular_rates();
        let place = self.in_plane(&drift, t.into());
        let (position, velocity) = (place.position, place.velocity);
        let climb = 3.0 * position.dot(&velocity) / position.norm_squared();
        let jerk = (position * climb - velocity) * place.tide;
        let acceleration = position * -place.tide;
        if !self.drifts() {
            return [position, velocity, acceleration, jerk];
        }
        // Derivatives along the ellipse, on which the anomaly moves by `haste`, and those of the ellipse that turns by w.
        let haste = self.haste(&drift);
        let own = [velocity * haste, acceleration * (haste * haste), jerk * (haste * haste * haste)];
        let [normal, normal_rate, normal_change] = drift.normal_motion(-place.local[1]);
        let w = drift.rotation(&normal);
        let (dw, ddw) = (normal_rate * drift.perigee, normal_change * drift.perigee);
        let velocity = own[0] + w.cross(&position);
        let turned = w.cross(&own[0]);
        let acceleration = own[1] + turned + dw.cross(&position) + w.cross(&velocity);
        let jerk = own[2]
            + w.cross(&own[1]) * 2.0
            + dw.cross(&own[0])
            + w.cross(&turned)
            + ddw.cross(&position)
            + dw.cross(&velocity) * 2.0
            + w.cross(&acceleration);
        [position, velocity, acceleration, jerk]
    }

    /// Returns the position on the ellipse at a time since the start, with velocity and rates as if the mean anomaly
    /// moved at the mean motion and the ellipse stood still.
    fn in_plane(&self, drift: &SecularRates, t: SplitTime) -> OrbitPosition {
        let (a, e, gravity) = (self.semi_major_axis.get(), self.eccentricity.get(), self.gravity.get());
        let anomaly = eccentric(self.mean_anomaly(drift).at(t), e);
        let (sin, cos) = libm::sincos(anomaly);
        let [p, q, normal] = self.drifted_plane(drift, t);
        let minor = f64::sqrt(1.0 - e * e);
        let radius = a * (1.0 - e * cos);
        let position = (p * (cos - e) + q * (minor * sin)) * a;
        let anomaly_rate = f64::sqrt(gravity * a) / radius;
        let velocity = (q * (minor * cos) - p * sin) * anomaly_rate;
        let nadir = -position / radius;
        let orbit_rate = f64::sqrt(gravity * a) * minor / (radius * radius);
        // r r' = sqrt(mu a) e sin E.
        let climb = anomaly_rate * e * sin;
        let about_normal = |rate: f64| Vector::new(0.0, -rate, 0.0);
        OrbitPosition {
            position,
            velocity,
            local: [(-normal).cross(&nadir), -normal, nadir],
            turning: [about_normal(orbit_rate), about_normal(-2.0 * orbit_rate * climb / radius)],
            tide: gravity / (radius * radius * radius),
        }
    }

    /// Returns a position with the velocity and rates that it has as the elements drift.
    fn turned(&self, place: OrbitPosition, drift: &SecularRates) -> OrbitPosition {
        let haste = self.haste(drift);
        let [rate, acceleration] = place.turning;
        let axis = Vector::from_iterator(place.local.iter().map(|axis| axis.z));
        let turn = axis * drift.node;
        let rate = rate * haste + turn - Vector::y() * drift.perigee;
        OrbitPosition {
            velocity: place.velocity * haste + drift.rotation(&-place.local[1]).cross(&place.position),
            // The planet's axis stands still: in the local axes it turns against them.
            turning: [rate, acceleration * (haste * haste) + turn.cross(&rate)],
            ..place
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
