//! The planet's shadow on a Kepler orbit: a cylinder opposite to the Sun, whose edges are all found, whether the Sun
//! stands still or moves.

use std::f64::consts::TAU;

use flexsc_numerics::attitude::Vector;

use super::{Kepler, SunPath};

/// Sun along a revolution, as a function of the eccentric anomaly E.
struct SunAlong {
    /// Direction, a unit vector.
    direction: Vector,
    /// Derivative of the direction by E.
    rate: Vector,
}

impl Kepler {
    /// Returns the times (s) at which the planet's shadow begins and ends, for those shadows that begin before `duration`
    /// (s). A shadow at the start begins at 0.
    pub(super) fn shadows(&self, sun: &SunPath, duration: f64) -> Vec<[f64; 2]> {
        match sun {
            SunPath::Fixed(direction) => self.repeated_shadows(direction, duration),
            SunPath::Dated(_) => self.moving_shadows(sun, duration),
        }
    }

    /// Returns the shadows under a Sun that stands still: those of one revolution, repeated.
    fn repeated_shadows(&self, sun: &Vector, duration: f64) -> Vec<[f64; 2]> {
        let fixed = |_| SunAlong { direction: *sun, rate: Vector::zeros() };
        let crossings = self.shadow_edges(&fixed, 0.0);
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

    /// Returns the shadows under a Sun that moves, revolution by revolution.
    fn moving_shadows(&self, sun: &SunPath, duration: f64) -> Vec<[f64; 2]> {
        let (e, rate) = (self.eccentricity.get(), self.mean_motion());
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
                let motion = sun.motion(time(anomaly));
                let pace = (1.0 - e * libm::cos(anomaly)) / rate;
                SunAlong { direction: motion.direction, rate: motion.rate * pace }
            };
            // E increases by 1 in a time of (1 + e)/n < 2/n at most.
            for (anomaly, enters) in self.shadow_edges(&along, 2.0 * sun.fastest() / rate) {
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

    /// Returns the eccentric anomalies of a revolution at which the orbit crosses the shadow's edge, each with true for an
    /// entry. `pace` bounds the derivative of the Sun's direction by E, and 1.1 `pace`² + `pace`/2 its second derivative.
    fn shadow_edges(&self, sun: &dyn Fn(f64) -> SunAlong, pace: f64) -> Vec<(f64, bool)> {
        let (a, e, planet) = (self.semi_major_axis.get(), self.eccentricity.get(), self.planet_radius.get());
        let [p, q, _] = self.plane();
        let minor = f64::sqrt(1.0 - e * e);
        // Distance of the body towards the Sun with its derivative.
        let towards = |anomaly: f64| {
            let ((sin, cos), sun) = (libm::sincos(anomaly), sun(anomaly));
            let [x, y] = [p, q].map(|axis| axis.dot(&sun.direction) * a);
            let position = (p * (cos - e) + q * (minor * sin)) * a;
            [x * (cos - e) + y * minor * sin, y * minor * cos - x * sin + position.dot(&sun.rate)]
        };
        // Squared distance of the body from the axis of the shadow minus the squared radius of the planet, with its
        // derivative.
        let beyond = |anomaly: f64| {
            let ((sin, cos), [x, dx]) = (libm::sincos(anomaly), towards(anomaly));
            let radius = a * (1.0 - e * cos);
            [radius * radius - x * x - planet * planet, 2.0 * (radius * a * e * sin - x * dx)]
        };
        // Upper bound of the second derivative. With |r| <= 2 a, and derivatives of r of at most a, that of r² is at most
        // 6 a², and that of x² at most 2 (1 + 2 pace)² a² + 4 (1 + 3 pace + 2.2 pace²) a².
        let bend = (16.0 + pace * (20.0 + 17.0 * pace)) * a * a;
        let mut crossings = Vec::new();
        crossings_within(&beyond, [0.0, TAU], bend, &mut crossings);
        crossings.into_iter().filter(|(anomaly, _)| towards(*anomaly)[0] < 0.0).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::quantity::Finite;

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
    fn the_shadow_of_a_circular_orbit_is_as_by_hand() {
        // With the Sun in the plane, the planet hides 2 asin(Rp/R) of the orbit, centred opposite to the Sun.
        let orbit = orbit("semi_major_axis = 7e6\nanomaly = 1.0");
        let shadows = orbit.shadows(&SunPath::Fixed(Vector::x()), 12_000.0);
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
        let first = within.shadows(&SunPath::Fixed(Vector::x()), 10.0);
        assert!(first.len() == 1 && first[0][0] == 0.0 && first[0][1] < half / rate);
        // With the Sun along the normal there is no shadow.
        assert!(orbit.shadows(&SunPath::Fixed(Vector::z()), 12_000.0).is_empty());
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
        let shadows = orbit.shadows(&SunPath::Fixed(sun), 40_000.0);
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
    fn under_a_moving_sun_the_edges_are_those_of_its_direction_then() {
        // Seconds from 1970 to 2026-11-24T00:00:00Z.
        let sun = SunPath::new(&crate::environment::Sun::Epoch, 1_795_478_400_000_000_000);
        let depth = |orbit: &Kepler, t: f64| {
            let (position, sun) = (orbit.at(t).position, sun.direction(t));
            let along = position.dot(&sun);
            if along < 0.0 { (position - sun * along).norm() - 6_378_137.0 } else { f64::INFINITY }
        };
        for (orbit, days, count) in [
            (eccentric_orbit(), 40.0, 265),
            // Low circular orbit whose shadows end as the Sun moves away from its plane.
            (orbit("semi_major_axis = 7e6\ninclination = 1.7\nnode = 6.5\nanomaly = 4.0"), 40.0, 323),
            // Geostationary orbit: no shadows but about the equinox, which is in March.
            (orbit("semi_major_axis = 4.2164e7"), 200.0, 45),
        ] {
            let duration = 86_400.0 * days;
            let shadows = orbit.shadows(&sun, duration);
            assert_eq!(shadows.len(), count, "{orbit:?}");
            for [from, to] in &shadows {
                assert!(depth(&orbit, *from).abs() < 1e-2 || *from == 0.0, "{from}");
                assert!(depth(&orbit, *to).abs() < 1e-2 && depth(&orbit, 0.5 * (from + to)) < 0.0, "{to}");
            }
            for k in 0..50_000 {
                let t = duration * f64::from(k) / 50_000.0;
                let dark = shadows.iter().any(|[from, to]| *from <= t && t < *to);
                assert_eq!(dark, depth(&orbit, t) < 0.0, "{t}");
            }
        }
        // Over an orbit the moving Sun differs little from the one at the start.
        let orbit = eccentric_orbit();
        let fixed = orbit.shadows(&SunPath::Fixed(sun.direction(0.0)), 13_000.0);
        let moving = orbit.shadows(&sun, 13_000.0);
        assert_eq!(fixed.len(), moving.len());
        for (fixed, moving) in fixed.iter().flatten().zip(moving.iter().flatten()) {
            assert!((fixed - moving).abs() < 10.0 && (fixed != moving || *fixed == 0.0), "{fixed} {moving}");
        }
    }
}
