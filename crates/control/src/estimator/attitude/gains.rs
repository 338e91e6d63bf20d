//! Attitude filters with constant gains: the steady state of the optimal filter, and a complementary filter.
//!
//! For one axis, with theta' = -beta between corrections of period T and theta- before a correction, a correction gives
//! theta+ = (1 - k) theta-, beta+ = beta - b theta-. The two poles have the product 1 - k and the sum 2 - k + b T.

use flexsc_numerics::quantity::Positive;
use nalgebra::{Matrix3, Matrix6x3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::GyroNoise;

/// How the gains are computed.
#[derive(Copy, Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Form")]
pub enum GainMethod {
    /// From the covariance, at each measurement.
    #[default]
    Extended,
    /// Constant: the steady-state gains of the optimal filter for a body at rest, with one attitude sensor.
    Steady,
    /// Constant: from a bandwidth and a damping ratio of the error.
    Complementary(Complementary),
}

/// A complementary filter.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Complementary {
    /// Bandwidth (rad/s): below it the attitude follows the sensors, above it the gyro.
    pub bandwidth: Positive,
    /// Damping ratio.
    #[serde(default = "damping")]
    pub damping: Positive,
}

fn damping() -> Positive {
    Positive::new(0.7).unwrap_or(Positive::ONE)
}

impl Complementary {
    /// Returns k and b (1/s) for this period of corrections (s): the poles are those of the continuous error, sampled.
    fn gains(&self, period: f64) -> [f64; 2] {
        let (angle, ratio) = (self.bandwidth.get() * period, self.damping.get());
        let decay = libm::exp(-ratio * angle);
        let damped_part = 1.0 - ratio * ratio;
        let part = angle * f64::sqrt(damped_part.abs());
        let half = decay * if damped_part > 0.0 { libm::cos(part) } else { libm::cosh(part) };
        let k = 1.0 - decay * decay;
        [k, (2.0 * half - 2.0 + k) / period]
    }
}

/// Returns k and b (1/s) of the optimal filter in steady state, for corrections of this period (s) and standard
/// deviation (rad).
fn steady(noise: &GyroNoise, period: f64, deviation: f64) -> [f64; 2] {
    let (white, walk) = (noise.angle_random_walk, noise.rate_random_walk);
    let (sv, su) = (white * f64::sqrt(period) / deviation, walk * f64::sqrt(period) * period / deviation);
    // [Farrenkopf78] in the form of Markley and Crassidis: theta- has the variance deviation² (z² - 1).
    let g = f64::sqrt(1.0 + sv * sv / 4.0 + su * su / 48.0);
    let z = g + su / 4.0 + 0.5 * f64::sqrt(2.0 * g * su + sv * sv + su * su / 3.0);
    [1.0 - 1.0 / (z * z), -su / (z * period)]
}

impl GainMethod {
    /// Returns the constant gain from a measured angle relative to the estimate, in body axes, to attitude and bias;
    /// `None` of the extended filter. `period` (s) is that of corrections, `covariance` (rad²) that of their errors.
    pub fn gain(&self, noise: &GyroNoise, period: f64, covariance: &Matrix3<f64>) -> Option<Matrix6x3<f64>> {
        let assemble = |attitude: Matrix3<f64>, bias: Matrix3<f64>| {
            let mut gain = Matrix6x3::zeros();
            gain.fixed_rows_mut::<3>(0).copy_from(&attitude);
            gain.fixed_rows_mut::<3>(3).copy_from(&bias);
            gain
        };
        match self {
            Self::Extended => None,
            Self::Complementary(filter) => {
                let gains = filter.gains(period).map(Matrix3::from_diagonal_element);
                Some(assemble(gains[0], gains[1]))
            }
            Self::Steady => {
                // Gains are computed about the principal axes of the covariance, in which errors are independent.
                let axes = covariance.symmetric_eigen();
                let steady_sd = |variance: f64| steady(noise, period, f64::sqrt(variance));
                let [attitude, bias] = [0, 1].map(|part| {
                    let diagonal =
                        Matrix3::from_diagonal(&axes.eigenvalues.map(|variance| steady_sd(variance)[part]));
                    axes.eigenvectors * diagonal * axes.eigenvectors.transpose()
                });
                Some(assemble(attitude, bias))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_flight::attitude_filter::AttitudeBiasFilter;
    use flexsc_flight::quaternion::Quaternion;
    use flexsc_flight::vector3::Vector3;
    use flexsc_numerics::attitude::Vector;
    use flexsc_numerics::flight_types::{from_matrix6, to_matrix3};

    #[test]
    fn steady_gains_are_those_that_the_covariance_has_in_the_end() {
        let noise = GyroNoise { angle_random_walk: 3e-6, rate_random_walk: 1e-8 };
        let (period, tracker) = (0.5, Vector::new(2.4e-5, 5e-5, 1.5e-4));
        let covariance = Matrix3::from_diagonal(&tracker.component_mul(&tracker));
        let still = Quaternion::IDENTITY;
        let mut filter = AttitudeBiasFilter::new(still, Vector3::ZERO, 1e-3, 1e-5);
        for _ in 0..40_000 {
            filter.correct(&still, &to_matrix3(&covariance), f64::INFINITY);
            filter.predict(&Vector3::ZERO, period, &noise);
        }
        let before = from_matrix6(&filter.covariance).fixed_columns::<3>(0).into_owned();
        let sum = before.fixed_rows::<3>(0) + covariance;
        let found = GainMethod::Steady.gain(&noise, period, &covariance).unwrap();
        for axis in 0..3 {
            for (row, size) in [(axis, 1.0_f64), (axis + 3, 1e-3)] {
                let exact = before[(row, axis)] / sum[(axis, axis)];
                let off = (found[(row, axis)] - exact).abs();
                assert!(off < 1e-9 * size.max(exact.abs()), "{axis} {row} {} {exact}", found[(row, axis)]);
            }
        }
    }

    #[test]
    fn a_complementary_filter_has_the_poles_that_are_asked_for() {
        for (bandwidth, ratio, period) in [(0.02, 0.7, 1.0), (0.5, 0.9, 1.0), (0.1, 1.5, 2.0)] {
            let positive = |value: f64| Positive::new(value).unwrap();
            let filter = Complementary { bandwidth: positive(bandwidth), damping: positive(ratio) };
            let [k, b] = filter.gains(period);
            assert!((1.0 - k - libm::exp(-2.0 * ratio * bandwidth * period)).abs() < 1e-15);
            // A free error of the attitude decays as the continuous filter's error at the samples.
            let (mut theta, mut beta) = (1.0, 0.0);
            let mut angles = vec![theta];
            for _ in 0..50 {
                let before: f64 = theta - period * beta;
                theta = before - k * before;
                beta -= b * before;
                angles.push(theta);
            }
            let product = libm::exp(-2.0 * ratio * bandwidth * period);
            let part = bandwidth * period * f64::sqrt((1.0 - ratio * ratio).abs());
            let half = if ratio < 1.0 { libm::cos(part) } else { libm::cosh(part) };
            let sum = 2.0 * libm::exp(-ratio * bandwidth * period) * half;
            for x in angles.windows(3) {
                assert!((x[2] - sum * x[1] + product * x[0]).abs() < 1e-13, "{x:?}");
            }
        }
    }
}
