//! Exposures of a star tracker, and the mean attitude over them.

use flexsc_numerics::attitude::{Vector, rotation, rotation_vector};
use flexsc_numerics::time::Span;
use nalgebra::Quaternion;

use super::SensorKind;
use crate::one_or_many::OneOrMany;

/// Attitudes at instants of an exposure, each with its weight.
#[derive(Clone, Debug, Default)]
pub struct ExposureMean(Vec<(f64, Quaternion<f64>)>);

impl ExposureMean {
    /// Adds an attitude with its weight, the duration that it represents (s).
    pub fn add(&mut self, attitude: Quaternion<f64>, duration: f64) {
        self.0.push((duration, attitude));
    }

    /// Removes all attitudes.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Returns the mean attitude: that of the middle, rotated by the mean of the rotation vectors of the others
    /// relative to it. A different reference attitude would change the result in the third order of the rotation
    /// angles.
    pub fn mean(&self, middle: &Quaternion<f64>) -> Quaternion<f64> {
        let (mut whole, mut sum) = (0.0, Vector::zeros());
        for (duration, attitude) in &self.0 {
            whole += duration;
            sum += rotation_vector(middle, attitude) * *duration;
        }
        if whole > 0.0 { middle * rotation(&(sum / whole)) } else { *middle }
    }
}

impl OneOrMany<SensorKind> {
    /// Iterates over the star trackers with an exposure time: index among the sensors, period, and half the exposure
    /// time.
    pub fn exposures(&self) -> impl Iterator<Item = (usize, [Span; 2])> {
        self.iter().enumerate().filter_map(|(index, sensor)| match sensor {
            SensorKind::StarTracker(tracker) if tracker.has_exposure() => {
                Some((index, [tracker.period, tracker.half_exposure()]))
            }
            _ => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::quadrature::nodes;

    /// Returns the mean over pieces between these instants, relative to the attitude at 0, for rotations up to 40
    /// rad/s.
    fn mean(breaks: &[f64], angle_at: impl Fn(f64) -> Vector) -> Quaternion<f64> {
        let attitude_at = |t: f64| rotation(&Vector::new(0.4, -1.1, 0.3)) * rotation(&angle_at(t));
        let mut exposure = ExposureMean::default();
        for ends in breaks.windows(2) {
            for (t, duration) in nodes(ends[1] - ends[0], 40.0) {
                exposure.add(attitude_at(ends[0] + t), duration);
            }
        }
        attitude_at(0.0).conjugate() * exposure.mean(&attitude_at(0.0))
    }

    fn off(found: &Quaternion<f64>, exact: Vector) -> f64 {
        (rotation_vector(&Quaternion::new(1.0, 0.0, 0.0, 0.0), found) - exact).norm()
    }

    #[test]
    fn a_constant_rate_gives_the_middle() {
        // Valid for a fast rate too.
        for rate in [1e-3, 0.05, 3.0] {
            let found = mean(&[-0.25, 0.1, 0.25], |t| Vector::new(0.6, -0.8, 0.5) * (rate * t));
            assert!(off(&found, Vector::zeros()) < 4e-16, "{rate}");
        }
    }

    #[test]
    fn accelerations_vibrations_and_jumps_smear_as_in_closed_form() {
        let (e, along) = (0.5, Vector::new(0.6, 0.0, -0.8));
        let ends = [-0.5 * e, 0.5 * e];
        // alpha t²/2 has the mean alpha e²/24.
        let found = mean(&ends, |t| along * (0.05 * t * t + 0.02 * t));
        assert!(off(&found, along * (0.1 * e * e / 24.0)) < 3e-16);
        for w in [0.3, 5.0, 12.566, 40.0] {
            let (amplitude, phase) = (1e-3, 0.7);
            let vibration = |t: f64| amplitude * libm::cos(w * t + phase);
            let factor = libm::sin(0.5 * w * e) / (0.5 * w * e);
            let found = mean(&ends, |t| along * (vibration(t) - vibration(0.0)));
            assert!(off(&found, along * (vibration(0.0) * (factor - 1.0))) < 3e-16, "{w}");
        }
        // Acceleration that starts d after the middle: alpha (e/2 - d)³/6 of e.
        let (alpha, d) = (0.02, 0.07);
        let found = mean(&[ends[0], d, ends[1]], |t| along * (0.5 * alpha * (t - d).max(0.0) * (t - d)));
        let late = ends[1] - d;
        assert!(off(&found, along * (alpha * late * late * late / 6.0 / e)) < 3e-16);
        // In one piece it is not exact.
        let found = mean(&ends, |t| along * (0.5 * alpha * (t - d).max(0.0) * (t - d)));
        assert!(off(&found, along * (alpha * late * late * late / 6.0 / e)) > 1e-9);
    }

    /// Checks that about changing axes the mean is that of the quaternions up to third-order terms.
    #[test]
    fn the_mean_is_that_of_the_chords() {
        for size in [0.01, 0.04] {
            let angle_at = |t: f64| Vector::new(t, 1.5 * t * t, libm::sin(3.0 * t) - t) * (size / 0.25);
            let found = mean(&[-0.25, 0.25], angle_at);
            let sum = nodes(0.5, 40.0).into_iter().fold(Quaternion::default(), |sum, (t, duration)| {
                sum + rotation(&angle_at(t - 0.25)) * duration
            });
            let apart = rotation_vector(&(sum / sum.norm()), &found).norm();
            assert!(apart < 0.05 * size * size * size && apart > 0.0, "{size} {apart:e}");
        }
    }

    #[test]
    fn nothing_seen_is_the_middle() {
        let middle = rotation(&Vector::new(0.1, 0.2, 0.3));
        assert_eq!(ExposureMean::default().mean(&middle), middle);
    }
}
