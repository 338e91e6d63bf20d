//! Bias instability as exponentially correlated noise about a mean, a first-order Gauss-Markov process (\[Gelb74\]).
//!
//! b' = -b/T + n has the stationary standard deviation s. Over D, b changes to e^(-D/T) b + s sqrt(1 - e^(-2D/T)) n;
//! its mean over D, given both ends, is (b + b') tanh(z)/2z, and normal about that with the variance s² (z - tanh z)/z²
//! with z = D/2T. Both are exact, and approach those of a random walk for short D.

use flexsc_numerics::random::Stream;
use flexsc_numerics::time::Instant;

use super::Gyro;

/// Correlated part of a gyro's bias.
#[derive(Clone, Debug, Default)]
pub(super) struct GaussMarkovBias {
    /// Time of the last evaluation.
    read: Option<Instant>,
    /// Current value about each axis (rad/s).
    pub bias: [f64; 3],
}

impl GaussMarkovBias {
    /// Advances the time to `now`. Returns the time since the last evaluation (s).
    pub fn advance(&mut self, now: Instant) -> f64 {
        self.read.replace(now).map_or(0.0, |then| now.since(then).seconds())
    }

    /// Returns the bias about an axis (rad/s) `seconds` after the last evaluation.
    #[inline(never)]
    pub fn value(&mut self, gyro: &Gyro, axis: usize, seconds: f64, noise: &mut Stream) -> f64 {
        if let Some((deviation, time)) = gyro.bias_instability(axis).filter(|_| seconds > 0.0) {
            let decay_factor = libm::exp(-seconds / time);
            let spread = f64::sqrt(-libm::expm1(-2.0 * seconds / time));
            self.bias[axis] = decay_factor * self.bias[axis] + deviation * spread * noise.normal();
        }
        self.bias[axis]
    }

    /// Returns the mean of the bias (rad/s) over the time since the last evaluation. Not inlined: otherwise the
    /// compiler computes the divisions and exponentials before the check for a correlated bias.
    #[inline(never)]
    pub fn mean(&mut self, gyro: &Gyro, axis: usize, seconds: f64, noise: &mut Stream) -> f64 {
        let Some((deviation, time)) = gyro.bias_instability(axis).filter(|_| seconds > 0.0) else {
            return self.bias[axis];
        };
        let before = self.bias[axis];
        let sum = before + self.value(gyro, axis, seconds, noise);
        let z = 0.5 * seconds / time;
        let (tanh, decay_factor) = (libm::tanh(z), beyond_tanh(z));
        0.5 * sum * tanh / z + deviation * f64::sqrt(decay_factor) / z * noise.normal()
    }
}

/// Returns x - tanh x.
fn beyond_tanh(x: f64) -> f64 {
    if x > 0.25 {
        return x - libm::tanh(x);
    }
    // Taylor series; the next term is below 1e-15 of it.
    let square = x * x;
    let parts = [
        1.0 / 3.0,
        -2.0 / 15.0,
        17.0 / 315.0,
        -62.0 / 2835.0,
        1382.0 / 155_925.0,
        -21_844.0 / 6_081_075.0,
        929_569.0 / 638_512_875.0,
        -6_404_582.0 / 10_854_718_875.0,
        443_861_162.0 / 1_856_156_927_625.0,
        -18_888_466_084.0 / 194_896_477_400_625.0,
    ];
    x * square * parts.iter().rev().fold(0.0, |sum, part| sum * square + part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::random::Seed;
    use flexsc_numerics::time::Span;

    #[test]
    fn a_wandering_bias_has_the_variances_of_its_process() {
        // Means over D of the stationary process have the variance 2 s² (T/D)² (D/T - 1 + e^(-D/T)).
        for (period, time) in [(0.25, 20.0), (1.0, 2.0), (5.0, 1.0)] {
            let keys = format!("bias_instability = 3e-5\ncorrelation_time = {time}");
            let gyro: Gyro = flexsc_formats::document::from_text(&keys).unwrap();
            let mut noise = Seed { scenario: 3, run: 1 }.stream("wander");
            let (mut wander, count) = (GaussMarkovBias::default(), 400_000);
            let (mut ends, mut means, mut products) = (0.0, 0.0, 0.0);
            for _ in 0..(20.0 * time / period) as usize {
                wander.mean(&gyro, 1, period, &mut noise);
            }
            for _ in 0..count {
                let before = wander.bias[1];
                let mean = wander.mean(&gyro, 1, period, &mut noise) / 3e-5;
                let after = wander.bias[1] / 3e-5;
                ends += after * after / f64::from(count);
                means += mean * mean / f64::from(count);
                products += after * before / 3e-5 / f64::from(count);
            }
            let ratio: f64 = period / time;
            let exact = 2.0 * (ratio - 1.0 + libm::exp(-ratio)) / (ratio * ratio);
            // Three standard errors of draws that are correlated over 2T/D of them.
            let three = 3.0 * f64::sqrt(2.0 * (1.0 + 1.0 / ratio) / f64::from(count));
            assert!((ends - 1.0).abs() < three, "{ends}");
            assert!((means / exact - 1.0).abs() < three, "{means} {exact}");
            assert!((products - libm::exp(-ratio)).abs() < three, "{products}");
            assert_eq!([wander.bias[0], wander.bias[2]], [0.0; 2]);
        }
    }

    #[test]
    fn what_tanh_leaves_is_exact_on_both_sides_of_the_series() {
        // Reference values of 40 digits, by mpmath.
        for (x, exact) in [
            (1e-3, 3.333_332_000_000_54e-10),
            (0.25, 5.081_337_596_290_871e-3),
            (0.3, 8.687_387_548_409_093e-3),
            (3.0, 2.004_945_246_313_269_6),
        ] {
            assert!((beyond_tanh(x) / exact - 1.0).abs() < 1e-12, "{x} {:e}", beyond_tanh(x));
        }
        // The time between readings is returned.
        let mut wander = GaussMarkovBias::default();
        assert_eq!(wander.advance(Instant::START), 0.0);
        assert_eq!(wander.advance(Instant::START + Span::from_seconds(0.5)), 0.5);
    }
}
