//! A Kepler orbit about a planet: the body's position, the local axes and their rate, and the planet's shadow.
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
    pub(super) fn nearest(&self) -> f64 {
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

    /// Returns the unit vectors P, Q and along the orbit's normal.
    fn plane(&self) -> [Vector; 3] {
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

    /// Returns the times (s) at which the planet's shadow, a cylinder opposite to the direction `sun`, begins and ends,
    /// for those shadows that begin before `duration` (s).
    pub(super) fn shadows(&self, sun: &Vector, duration: f64) -> Vec<[f64; 2]> {
        let crossings = self.shadow_edges(sun);
        let e = self.eccentricity.get();
        let (rate, period) = (self.mean_motion(), TAU / self.mean_motion());
        let since_start = |anomaly: f64| {
            let mean = anomaly - e * libm::sin(anomaly) - self.anomaly.get();
            (mean - TAU * libm::floor(mean / TAU)) / rate
        };
        let mut shadows = Vec::new();
        for (index, (begins, enters)) in crossings.iter().enumerate() {
            if !enters {
                continue;
            }
            let (ends, _) = crossings[(index + 1) % crossings.len()];
            let (from, to) = (since_start(*begins), since_start(ends));
            let length = if to > from { to - from } else { to - from + period };
            // The run may begin within a shadow.
            let mut orbit = -1.0;
            while from + orbit * period < duration {
                let from = from + orbit * period;
                if from + length > 0.0 {
                    shadows.push([from.max(0.0), from + length]);
                }
                orbit += 1.0;
            }
        }
        shadows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        shadows
    }

    /// Returns the eccentric anomalies at which the orbit crosses the shadow's edge, each with true for an entry.
    fn shadow_edges(&self, sun: &Vector) -> Vec<(f64, bool)> {
        let (a, e, planet) = (self.semi_major_axis.get(), self.eccentricity.get(), self.planet_radius.get());
        let [p, q, _] = self.plane().map(|axis| axis.dot(sun) * a);
        let minor = f64::sqrt(1.0 - e * e);
        // Distance of the body towards the Sun, and its squared distance from the axis of the shadow minus the squared
        // radius of the planet, with their derivatives.
        let towards = |sin: f64, cos: f64| p * (cos - e) + q * minor * sin;
        let beyond = |anomaly: f64| {
            let (sin, cos) = libm::sincos(anomaly);
            let (x, dx) = (towards(sin, cos), q * minor * cos - p * sin);
            let radius = a * (1.0 - e * cos);
            [radius * radius - x * x - planet * planet, 2.0 * (radius * a * e * sin - x * dx)]
        };
        let mut crossings = Vec::new();
        // Upper bound of the second derivative.
        crossings_within(&beyond, [0.0, TAU], 16.0 * a * a, &mut crossings);
        let behind = |(anomaly, _): &(f64, bool)| {
            let (sin, cos) = libm::sincos(*anomaly);
            towards(sin, cos) < 0.0
        };
        crossings.into_iter().filter(behind).collect()
    }
}

/// Finds the zeros of a function, given with its derivative, within an interval, in order, each with true if the
/// function decreases there. `bend` bounds the second derivative: no zero is missed.
fn crossings_within(
    motion: &dyn Fn(f64) -> [f64; 2],
    [from, to]: [f64; 2],
    bend: f64,
    found: &mut Vec<(f64, bool)>,
) {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let [value, slope] = motion(middle);
    if value.abs() > slope.abs() * half + 0.5 * bend * half * half || half < 1e-9 {
        return;
    }
    if slope.abs() <= bend * half {
        crossings_within(motion, [from, middle], bend, found);
        return crossings_within(motion, [middle, to], bend, found);
    }
    let falls = slope < 0.0;
    let above = |time: f64| motion(time)[0] >= 0.0;
    if above(from) != falls || above(to) == falls {
        return;
    }
    let (mut low, mut high) = (from, to);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return found.push((high, falls));
        }
        if above(middle) == falls { low = middle } else { high = middle }
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
    fn the_shadow_of_a_circular_orbit_is_as_by_hand() {
        // With the Sun in the plane, the planet hides 2 asin(Rp/R) of the orbit, centred opposite to the Sun.
        let orbit = orbit("semi_major_axis = 7e6\nanomaly = 1.0");
        let shadows = orbit.shadows(&Vector::x(), 12_000.0);
        let half = libm::asin(6_378_137.0 / 7e6);
        let rate = orbit.mean_motion();
        assert_eq!(shadows.len(), 2);
        for (k, [from, to]) in shadows.into_iter().enumerate() {
            let middle = (std::f64::consts::PI - 1.0 + TAU * k as f64) / rate;
            assert!(
                (from - (middle - half / rate)).abs() < 1e-8 && (to - (middle + half / rate)).abs() < 1e-8
            );
        }
        // For a run that begins within a shadow, only the rest of it.
        let within = Kepler { anomaly: Finite::new(3.2).unwrap(), ..orbit };
        let first = within.shadows(&Vector::x(), 10.0);
        assert!(first.len() == 1 && first[0][0] == 0.0 && first[0][1] < half / rate);
        // With the Sun along the normal there is no shadow.
        assert!(orbit.shadows(&Vector::z(), 12_000.0).is_empty());
    }

    #[test]
    fn at_its_edges_the_body_leaves_the_shadow() {
        let orbit = eccentric_orbit();
        let sun = Vector::new(-0.5, -0.4, 0.3).normalize();
        let depth = |t: f64| {
            let position = orbit.at(t).position;
            let along = position.dot(&sun);
            (along < 0.0).then(|| (position - sun * along).norm() - 6_378_137.0)
        };
        let shadows = orbit.shadows(&sun, 40_000.0);
        // Reference by a scan of every second with other code: after 9104, 11 764, 22 187, 24 847, 35 269 and 37 929 s.
        let scanned = [[9104.5, 11_764.5], [22_187.5, 24_847.5], [35_269.5, 37_929.5]];
        assert_eq!(shadows.len(), scanned.len());
        for (found, scanned) in shadows.iter().flatten().zip(scanned.iter().flatten()) {
            assert!((found - scanned).abs() <= 0.5, "{found} {scanned}");
        }
        for [from, to] in &shadows {
            if *from > 0.0 {
                assert!(depth(*from).unwrap().abs() < 1e-4);
            }
            assert!(depth(*to).unwrap().abs() < 1e-4 && depth(0.5 * (from + to)).unwrap() < 0.0);
        }
        // No other time is in shadow.
        for k in 0..4000 {
            let t = 10.0 * f64::from(k);
            let dark = shadows.iter().any(|[from, to]| *from <= t && t < *to);
            assert_eq!(dark, depth(t).is_some_and(|depth| depth < 0.0), "{t}");
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
