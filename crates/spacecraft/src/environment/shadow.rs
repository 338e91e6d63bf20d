//! Planet's shadow on an orbit: the times in a region behind the planet, whose edges are all found, whether Sun and plane
//! of the orbit stand still or move.
//!
//! With the distance x of the body towards the Sun, the region's edge is a circular cone about the axis of the shadow that
//! touches the planet, whose radius falls by tan(u) per unit of distance towards the Sun: with s = sin(u),
//! (1 - s²) r² - x² + 2 R s x - R² = 0 behind x = R s. The penumbra has s = (R_Sun + R)/D and the umbra, with the antumbra
//! beyond its apex, s = -(R_Sun - R)/D: there the discs of Sun and planet touch as the body sees them. A cylinder has
//! s = 0.

#[cfg(test)]
mod tests;

use std::f64::consts::TAU;

use flexsc_numerics::attitude::Vector;

use super::solar_disc::{ASTRONOMICAL_UNIT, SUN_RADIUS};
use super::{Kepler, OrbitPath, SampledOrbit, SunPath};

/// Region behind a planet.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum ShadowRegion {
    /// Cylinder, as of a Sun at an infinite distance.
    Cylinder,
    /// Cone in which the planet hides a part of the Sun, or all of it.
    Penumbra,
    /// Cone in which the discs lie within one another: umbra, and antumbra beyond its apex.
    Core,
}

/// Sun along a revolution, as a function of the eccentric anomaly E.
#[derive(Copy, Clone, Debug, PartialEq)]
struct SunAlong {
    /// Components of its direction along P and Q.
    toward: [f64; 2],
    /// Derivatives of these components by E.
    rate: [f64; 2],
    /// Sine s of the cone's angle, and its derivative by E.
    slant: [f64; 2],
}

impl ShadowRegion {
    /// Returns D s (m) behind a planet of this radius (m), with the distance D of the Sun.
    fn slant(self, planet_radius: f64) -> f64 {
        match self {
            Self::Cylinder => 0.0,
            Self::Penumbra => SUN_RADIUS + planet_radius,
            Self::Core => planet_radius - SUN_RADIUS,
        }
    }
}

impl OrbitPath {
    /// Returns the times (s) at which the body enters and leaves a region of the planet's shadow, for those passages that
    /// begin before `duration` (s). A passage at the start begins at 0.
    pub(super) fn shadows(&self, region: ShadowRegion, sun: &SunPath, duration: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Kepler(orbit) => orbit.shadows(region, sun, duration),
            Self::Sampled(orbit) => orbit.shadows(region, sun, duration),
        }
    }
}

impl SampledOrbit {
    /// Returns the passages through a region, of which the last may end with the run.
    fn shadows(&self, region: ShadowRegion, sun: &SunPath, duration: f64) -> Vec<[f64; 2]> {
        let planet = self.planet_radius();
        // Distance towards the Sun with its derivative, and the sine of the cone's angle with its derivative.
        let seen = |t: f64, position: &Vector, velocity: &Vector| {
            let (motion, [distance, climb]) = (sun.motion(t), sun.distance(t));
            let slant = region.slant(planet) / (distance * ASTRONOMICAL_UNIT);
            let x = position.dot(&motion.direction);
            let dx = velocity.dot(&motion.direction) + position.dot(&motion.rate);
            ([x, dx], [slant, -slant * climb / distance])
        };
        // Function that is negative in the region, with its derivative.
        let beyond = |t: f64| {
            let [position, velocity, ..] = self.motion(t);
            let ([x, dx], [s, ds]) = seen(t, &position, &velocity);
            let (squared, climb, cut) = (position.norm_squared(), position.dot(&velocity), 1.0 - s * s);
            [
                cut * squared - x * (x - 2.0 * planet * s) - planet * planet,
                2.0 * (cut * climb - s * ds * squared - x * dx + planet * (s * dx + ds * x)),
            ]
        };
        // Upper bound of the second derivative: with |x'| <= v + w r and |x''| <= a + 2 w v + 1.1 w² r, that of r² is at most
        // 2 (v² + r a), that of x² at most 2 (x'² + r x''), and that of the rest, with s below 0.11 and R below r, at most a
        // quarter of both.
        let (w, r) = (sun.fastest(), self.farthest());
        let (v, a) = (self.largest_speed(), self.largest_acceleration());
        let (dx, ddx) = (v + w * r, a + 2.0 * w * v + 1.1 * w * w * r);
        let bend = 2.5 * (v * v + r * a + dx * dx + r * ddx);
        let mut crossings = Vec::new();
        crossings_within(&beyond, [0.0, duration], bend, &mut crossings);
        let is_behind = |t: f64| {
            let [position, velocity, ..] = self.motion(t);
            let ([x, _], [s, _]) = seen(t, &position, &velocity);
            x < planet * s
        };
        let mut entry = (beyond(0.0)[0] < 0.0 && is_behind(0.0)).then_some(0.0);
        let mut shadows = Vec::new();
        for (t, enters) in crossings.into_iter().filter(|(t, _)| is_behind(*t)) {
            if enters {
                entry = entry.or(Some(t));
            } else if let Some(from) = entry.take() {
                shadows.push([from, t]);
            }
        }
        // A passage that the run does not leave ends after it.
        shadows.extend(entry.filter(|from| *from < duration).map(|from| [from, duration + 1.0]));
        shadows
    }
}

impl Kepler {
    /// Returns the times (s) at which the body enters and leaves a region of the planet's shadow, for those passages that
    /// begin before `duration` (s). A passage at the start begins at 0.
    pub(super) fn shadows(&self, region: ShadowRegion, sun: &SunPath, duration: f64) -> Vec<[f64; 2]> {
        if sun.moves() || self.drifts() {
            self.moving_shadows(region, sun, duration)
        } else {
            self.repeated_shadows(region, sun, duration)
        }
    }

    /// Returns the passages under a Sun that stands still: those of one revolution, repeated.
    fn repeated_shadows(&self, region: ShadowRegion, sun: &SunPath, duration: f64) -> Vec<[f64; 2]> {
        let still = self.sun_along(region, sun, 0.0, 0.0);
        let crossings = self.shadow_edges(&|_| still, 0.0);
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

    /// Returns the passages under a Sun or a plane of the orbit that moves, revolution by revolution from perigee to
    /// perigee.
    fn moving_shadows(&self, region: ShadowRegion, sun: &SunPath, duration: f64) -> Vec<[f64; 2]> {
        let (e, rate) = (self.eccentricity.get(), self.anomaly_rate());
        let (first, period) = (self.anomaly.get(), TAU / rate);
        let first = first - TAU * libm::floor(first / TAU);
        let (mut shadows, mut entry) = (Vec::new(), None);
        // A shadow at the start was entered in the revolution before, and the last one ends in the revolution after.
        let mut revolution = -1.0;
        loop {
            let perigee = (TAU * revolution - first) / rate;
            if perigee >= duration + period {
                return shadows;
            }
            let time = |anomaly: f64| perigee + (anomaly - e * libm::sin(anomaly)) / rate;
            let along = |anomaly: f64| {
                self.sun_along(region, sun, time(anomaly), (1.0 - e * libm::cos(anomaly)) / rate)
            };
            // E increases by 1 in a time of (1 + e)/n < 2/n at most.
            let pace = 2.0 * (sun.fastest() + self.plane_rate()) / rate;
            for (anomaly, enters) in self.shadow_edges(&along, pace) {
                let now = time(anomaly);
                if enters {
                    entry = entry.or(Some(now));
                } else if let Some(from) = entry.take().filter(|from| *from < duration && now > 0.0) {
                    shadows.push([from.max(0.0), now]);
                }
            }
            revolution += 1.0;
        }
    }

    /// Returns the Sun in the axes of the orbit's plane at a time since the start (s), where E increases by 1 in `pace` (s).
    fn sun_along(&self, region: ShadowRegion, sun: &SunPath, t: f64, pace: f64) -> SunAlong {
        let (motion, [distance, climb], drift) =
            (sun.motion(t), sun.distance(t), self.plane_rotation(t.into()));
        let [p, q, _] = self.plane(t.into());
        let change = motion.rate + motion.direction.cross(&drift);
        let slant = region.slant(self.planet_radius.get()) / (distance * ASTRONOMICAL_UNIT);
        SunAlong {
            toward: [p, q].map(|axis| axis.dot(&motion.direction)),
            rate: [p, q].map(|axis| axis.dot(&change) * pace),
            slant: [slant, -slant * climb / distance * pace],
        }
    }

    /// Returns the eccentric anomalies of a revolution at which the orbit crosses the edge of a region, each with true for
    /// an entry. With respect to the orbit's plane, `pace` bounds the derivative of the Sun's direction by E, and
    /// 1.35 `pace`² + `pace`/2 its second derivative.
    fn shadow_edges(&self, sun: &dyn Fn(f64) -> SunAlong, pace: f64) -> Vec<(f64, bool)> {
        let (a, e, planet) = (self.semi_major_axis.get(), self.eccentricity.get(), self.planet_radius.get());
        let minor = f64::sqrt(1.0 - e * e);
        // Distance of the body towards the Sun with its derivative.
        let towards = |anomaly: f64, sun: &SunAlong| {
            let ((sin, cos), [p, q], [dp, dq]) = (libm::sincos(anomaly), sun.toward, sun.rate);
            let x = (cos - e) * p + minor * sin * q;
            [a * x, a * (minor * cos * q - sin * p + (cos - e) * dp + minor * sin * dq)]
        };
        // Function that is negative in the region, with its derivative.
        let beyond = |anomaly: f64| {
            let sun = sun(anomaly);
            let ((sin, cos), [x, dx], [s, ds]) = (libm::sincos(anomaly), towards(anomaly, &sun), sun.slant);
            let (radius, dr, cut) = (a * (1.0 - e * cos), a * e * sin, 1.0 - s * s);
            [
                cut * radius * radius - x * (x - 2.0 * planet * s) - planet * planet,
                2.0 * (radius * (cut * dr - s * ds * radius) - x * dx + planet * (s * dx + ds * x)),
            ]
        };
        // Upper bound of the second derivative. With |r| <= 2 a, and derivatives of r of at most a, that of r² is at most
        // 6 a², and that of x² at most 2 (1 + 2 pace)² a² + 4 (1 + 3 pace + 2.7 pace²) a². With s below 0.11 and its relative
        // derivatives below 0.1 (pace + pace²), the rest is below (0.25 + 0.9 pace + 0.9 pace²) a².
        let bend = (16.0 + pace * (24.0 + 24.0 * pace)) * a * a;
        let mut crossings = Vec::new();
        crossings_within(&beyond, [0.0, TAU], bend, &mut crossings);
        crossings
            .into_iter()
            .filter(|(anomaly, _)| {
                let sun = sun(*anomaly);
                towards(*anomaly, &sun)[0] < planet * sun.slant[0]
            })
            .collect()
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
