//! An orbit by positions at instants, between which it is interpolated: Lagrange polynomials through the four rows before
//! and the four after an instant, whose derivatives are velocity, acceleration and its rate of change.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time_arcs::SplitTime;

use super::OrbitPosition;

/// Number of rows of a polynomial.
pub(super) const ROWS: usize = 8;

/// Angle (rad) between two rows that are computed, at the perigee: one minute in a low orbit.
pub(super) const STEP: f64 = 0.065;

/// Largest number of rows.
pub(super) const MOST_ROWS: usize = 1_000_000;

/// Orbit by positions at instants.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledOrbit {
    /// Times since the start (s), increasing.
    pub(super) times: Vec<f64>,
    /// Positions from the planet's centre in inertial axes (m).
    pub(super) positions: Vec<Vector>,
    /// Gravitational parameter (m³/s²) and radius (m) of the planet.
    planet: [f64; 2],
    bounds: OrbitBounds,
}

/// Bounds of the motion on an orbit.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
struct OrbitBounds {
    /// Least and greatest distance from the planet's centre (m).
    distance: [f64; 2],
    /// Largest speed (m/s).
    speed: f64,
    /// Least speed (m/s).
    least_speed: f64,
    /// Largest acceleration (m/s²).
    acceleration: f64,
    /// Largest rate of the orbit's normal (rad/s).
    plane_rate: f64,
}

impl SampledOrbit {
    /// Creates the orbit from at least eight positions (m) at increasing times since the start (s), about a planet with
    /// this gravitational parameter (m³/s²) and radius (m).
    pub(super) fn new(times: Vec<f64>, positions: Vec<Vector>, planet: [f64; 2]) -> Self {
        let mut orbit = Self { times, positions, planet, bounds: OrbitBounds::default() };
        orbit.bounds = orbit.bound();
        orbit
    }

    /// Returns the bounds of the motion: from its values at the rows and in the middles between them, widened by the change
    /// up to the next of these.
    fn bound(&self) -> OrbitBounds {
        let mut bounds = OrbitBounds {
            distance: [f64::INFINITY, 0.0],
            least_speed: f64::INFINITY,
            ..OrbitBounds::default()
        };
        let mut longest: f64 = 0.0;
        let mut jerk_bound: f64 = 0.0;
        for pair in self.times.windows(2) {
            longest = longest.max(0.25 * (pair[1] - pair[0]));
            for t in [pair[0], 0.5 * (pair[0] + pair[1]), pair[1]] {
                let [position, velocity, acceleration, jerk] = self.motion(t);
                let (distance, speed) = (position.norm(), velocity.norm());
                bounds.distance = [bounds.distance[0].min(distance), bounds.distance[1].max(distance)];
                bounds.speed = bounds.speed.max(speed);
                bounds.least_speed = bounds.least_speed.min(speed);
                bounds.acceleration = bounds.acceleration.max(acceleration.norm());
                jerk_bound = jerk_bound.max(jerk.norm());
                let normal = position.cross(&velocity);
                let turning = position.cross(&acceleration);
                let across = turning - normal * (turning.dot(&normal) / normal.norm_squared());
                bounds.plane_rate = bounds.plane_rate.max(across.norm() / normal.norm());
            }
        }
        // The jerk between two of these instants is at most half as large again for steps of up to a sixth of a radian.
        bounds.acceleration += 1.5 * jerk_bound * longest;
        bounds.speed += bounds.acceleration * longest;
        bounds.least_speed = (bounds.least_speed - bounds.acceleration * longest).max(0.0);
        let sag = bounds.speed * longest;
        bounds.distance =
            [(bounds.distance[0] - sag.min(0.05 * bounds.distance[0])).max(0.0), bounds.distance[1] + sag];
        bounds.plane_rate *= 1.5;
        bounds
    }

    /// Returns the times (s) of the first and the last row.
    pub(super) fn range(&self) -> [f64; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
    }

    /// Returns the least distance of a row from the planet's centre (m).
    pub(super) fn nearest_row(&self) -> f64 {
        self.positions.iter().map(Vector::norm).fold(f64::INFINITY, f64::min)
    }

    /// Returns a lower bound of the distance from the planet's centre (m).
    pub fn nearest(&self) -> f64 {
        self.bounds.distance[0]
    }

    /// Returns an upper bound of the distance from the planet's centre (m).
    pub fn farthest(&self) -> f64 {
        self.bounds.distance[1]
    }

    /// Returns an upper bound of the speed (m/s).
    pub fn largest_speed(&self) -> f64 {
        self.bounds.speed
    }

    /// Returns an upper bound of the acceleration (m/s²).
    pub(super) fn largest_acceleration(&self) -> f64 {
        self.bounds.acceleration
    }

    /// Returns an upper bound of the rate of the local axes (rad/s).
    pub fn fastest(&self) -> f64 {
        self.bounds.speed / self.bounds.distance[0] + self.bounds.plane_rate
    }

    /// Returns an upper bound of the rate of the velocity's direction (rad/s).
    pub fn fastest_velocity(&self) -> f64 {
        self.bounds.acceleration / self.bounds.least_speed
    }

    /// Returns an upper bound of the rate of the orbit's normal (rad/s).
    pub fn plane_rate(&self) -> f64 {
        self.bounds.plane_rate
    }

    /// Returns the gravitational parameter of the planet (m³/s²).
    pub fn gravity(&self) -> f64 {
        self.planet[0]
    }

    /// Returns the radius of the planet (m).
    pub fn planet_radius(&self) -> f64 {
        self.planet[1]
    }

    /// Returns the index of the first row of the polynomial at a time since the start (s).
    pub(super) fn first_row(&self, t: f64) -> usize {
        let next = self.times.partition_point(|time| *time <= t);
        next.saturating_sub(ROWS / 2).min(self.times.len() - ROWS)
    }

    /// Returns the times (s) about an instant between which the orbit is one polynomial: of two rows, and beyond the rows in
    /// steps of the last two.
    pub(super) fn span(&self, t: f64) -> [f64; 2] {
        let last = self.times.len() - 1;
        let next = self.times.partition_point(|time| *time <= t);
        if (1..=last).contains(&next) {
            return [self.times[next - 1], self.times[next]];
        }
        let next = next.clamp(1, last);
        let (from, length) = (self.times[next - 1], self.times[next] - self.times[next - 1]);
        let border = |step: f64| from + step * length;
        // The step by the quotient may be one off by rounding.
        let mut step = libm::floor((t - from) / length);
        while t < border(step) {
            step -= 1.0;
        }
        while t >= border(step + 1.0) {
            step += 1.0;
        }
        [step, step + 1.0].map(border)
    }

    /// Returns position (m), velocity, acceleration and its rate of change in inertial axes at a time since the start (s).
    pub fn motion(&self, t: f64) -> [Vector; 4] {
        self.motion_at(t.into())
    }

    /// Returns position (m), velocity, acceleration and its rate of change in inertial axes at a time since the start, by the
    /// polynomial of its middle.
    pub(super) fn motion_at(&self, t: SplitTime) -> [Vector; 4] {
        let first = self.first_row(t.middle);
        let times = &self.times[first..first + ROWS];
        // Newton's form: differences of the positions, divided by those of the times.
        let mut divided: [Vector; ROWS] = std::array::from_fn(|row| self.positions[first + row]);
        for order in 1..ROWS {
            for row in (order..ROWS).rev() {
                divided[row] = (divided[row] - divided[row - 1]) / (times[row] - times[row - order]);
            }
        }
        // Value and derivatives by Horner's rule, with factorials last.
        let mut motion = [divided[ROWS - 1], Vector::zeros(), Vector::zeros(), Vector::zeros()];
        for row in (0..ROWS - 1).rev() {
            let past = t.since(times[row]);
            motion[3] = motion[3] * past + motion[2];
            motion[2] = motion[2] * past + motion[1];
            motion[1] = motion[1] * past + motion[0];
            motion[0] = motion[0] * past + divided[row];
        }
        motion[2] *= 2.0;
        motion[3] *= 6.0;
        motion
    }

    /// Returns the position on the orbit at a time since the start (s).
    ///
    /// With the momentum h along n and the acceleration a, the local axes turn at h/r² about n and at r a.n/h about the
    /// position.
    pub fn at(&self, t: f64) -> OrbitPosition {
        let [position, velocity, acceleration, jerk] = self.motion(t);
        let squared = position.norm_squared();
        let distance = f64::sqrt(squared);
        let momentum = position.cross(&velocity);
        let h = momentum.norm();
        let (normal, nadir) = (momentum / h, -position / distance);
        let climb = position.dot(&velocity) / distance;
        let h_rate = normal.dot(&position.cross(&acceleration));
        let about_normal = h / squared;
        let about_normal_rate = (h_rate - 2.0 * h * climb / distance) / squared;
        let lift = acceleration.dot(&momentum) / (h * h);
        let lift_rate = jerk.dot(&momentum) / (h * h) - 2.0 * lift * h_rate / h;
        OrbitPosition {
            position,
            velocity,
            local: [(-normal).cross(&nadir), -normal, nadir],
            turning: [
                Vector::new(0.0, -about_normal, -distance * lift),
                Vector::new(0.0, -about_normal_rate, -(climb * lift + distance * lift_rate)),
            ],
            tide: self.planet[0] / (squared * distance),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::Kepler;

    const PLANET: [f64; 2] = [3.986_004_418e14, 6_378_137.0];

    fn kepler() -> Kepler {
        flexsc_formats::document::from_text(
            "semi_major_axis = 7e6\neccentricity = 0.02\ninclination = 1.1\nnode = 0.5\nperigee = 0.8\nj2 = true",
        )
        .unwrap()
    }

    fn sampled(step: f64, rows: usize) -> SampledOrbit {
        let times: Vec<f64> = (0..rows).map(|row| step * (row as f64 - 4.0)).collect();
        let positions = times.iter().map(|t| kepler().at(*t).position).collect();
        SampledOrbit::new(times, positions, PLANET)
    }

    /// Worst errors of interpolated positions grow with the eighth power of the step. Of rows of SGP4 at 780 km they are 6.8e-6
    /// m at steps of 60 s, 9e-4 m at 120 s and 0.023 m at 180 s; this orbit has a lower perigee.
    #[test]
    fn eight_rows_interpolate_low_orbits_to_micrometres() {
        for (step, largest) in [(60.0, 2e-5), (120.0, 5e-3), (180.0, 0.12)] {
            let orbit = sampled(step, 200);
            let worst = (0..1000)
                .map(|k| 5.123 * f64::from(k))
                .map(|t| (orbit.motion(t)[0] - kepler().at(t).position).norm())
                .fold(0.0, f64::max);
            assert!(worst < largest && worst > 0.02 * largest, "{step}: {worst:e}");
        }
    }

    #[test]
    fn rates_are_those_of_the_orbit_within_their_bounds() {
        let (orbit, kepler) = (sampled(30.0, 300), kepler());
        for k in 0..400 {
            let t = 20.7 * f64::from(k);
            let (found, exact) = (orbit.motion(t), kepler.motion(t));
            for (order, tolerance) in [(0, 1e-7), (1, 1e-7), (2, 1e-7), (3, 1e-7)] {
                let off = (found[order] - exact[order]).norm();
                assert!(off < tolerance, "{t} {order}: {off:e}");
            }
            let (found, exact) = (orbit.at(t), kepler.at(t));
            for axis in 0..3 {
                // The normal of a Kepler orbit that drifts is that of its plane, not of its momentum.
                assert!((found.local[axis] - exact.local[axis]).norm() < 2e-3);
            }
            assert!((found.tide - exact.tide).abs() < 1e-16);
            let h = 0.5;
            let [before, after] = [t - h, t + h].map(|t| orbit.at(t));
            let axes = nalgebra::Matrix3::from_columns(&found.local);
            for axis in 0..3 {
                let turned = (after.local[axis] - before.local[axis]) / (2.0 * h);
                let rate = (axes * found.turning[0]).cross(&found.local[axis]);
                assert!((turned - rate).norm() < 1e-9, "{t} {axis}: {:e}", (turned - rate).norm());
            }
            let change = (after.turning[0] - before.turning[0]) / (2.0 * h);
            assert!(
                (change - found.turning[1]).norm() < 1e-11,
                "{t}: {:e}",
                (change - found.turning[1]).norm()
            );
            let [position, velocity, acceleration, _] = orbit.motion(t);
            assert!((orbit.nearest()..=orbit.farthest()).contains(&position.norm()));
            assert!(velocity.norm() <= orbit.largest_speed());
            assert!(acceleration.norm() <= orbit.largest_acceleration());
            assert!(found.turning[0].norm() <= orbit.fastest());
            let turn = velocity.cross(&acceleration).norm() / velocity.norm_squared();
            assert!(turn <= orbit.fastest_velocity());
        }
    }
}
