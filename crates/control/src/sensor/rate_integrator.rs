//! Errors of an integrating gyro: random walks, and a quantum of the angle whose remainder carries over.
//!
//! Over a period D the mean rate is y = M w + (b + b')/2 + v: the bias walks from b to b' = b + s_u sqrt(D) n, and v
//! has the variance s_v²/D + s_u² D/12. That is the exact integral of b' = n_u and y = w + b + n_v over D, with white
//! n_v and n_u of the densities s_v² and s_u² (\[LeffertsMarkleyShuster82\]).

use flexsc_numerics::random::Stream;
use flexsc_numerics::time::Instant;

use super::gauss_markov_bias::GaussMarkovBias;
use super::{Gyro, Truth};

/// Run-time state of the rate integrator.
#[derive(Clone, Debug)]
pub(super) struct RateIntegrator {
    /// Time of the last reading, and the integrals of the rates then (rad).
    read: Option<(Instant, [f64; 3])>,
    /// Period of the last reading (s).
    period: f64,
    /// Standard deviations of the bias's walk and of v over this period, about each axis (rad/s).
    deviations: [[f64; 2]; 3],
    /// Current bias (rad/s).
    pub bias: [f64; 3],
    /// Remainder of the angle that is added to the next reading (rad).
    remainder: [f64; 3],
}

/// Returns the standard deviation of the mean rate over a period about an axis (rad/s), including the quantum.
pub(super) fn deviation(gyro: &Gyro, axis: usize, period: f64) -> f64 {
    let [white, walk, quantum] =
        [gyro.angle_random_walk, gyro.rate_random_walk, gyro.quantum].map(|each| each.about(axis).get());
    // One rounding now and one before.
    f64::sqrt(spread(white, walk, period) + quantum * quantum / (6.0 * period * period))
}

/// Returns the variance of v.
fn spread(white: f64, walk: f64, period: f64) -> f64 {
    white * white / period + walk * walk * period / 12.0
}

/// Returns the standard deviations of the bias's walk and of v over a period about an axis (rad/s).
fn deviations(gyro: &Gyro, axis: usize, period: f64) -> [f64; 2] {
    let [white, walk] = [gyro.angle_random_walk, gyro.rate_random_walk].map(|each| each.about(axis).get());
    [walk * f64::sqrt(period), f64::sqrt(spread(white, walk, period))]
}

impl RateIntegrator {
    /// Creates the integrator before the first reading.
    pub fn new(gyro: &Gyro) -> Self {
        let bias = [0, 1, 2].map(|axis| gyro.bias.about(axis).get());
        Self { read: None, period: 0.0, deviations: [[0.0; 2]; 3], bias, remainder: [0.0; 3] }
    }

    /// Returns the mean rates since the last reading (rad/s); the current rates at the first reading.
    pub fn mean_rate(&mut self, gyro: &Gyro, now: Instant, truth: &Truth) -> [f64; 3] {
        let before = self.read.replace((now, truth.rate_integral));
        let period = before.map_or(0.0, |(then, _)| now.since(then).seconds());
        if period.to_bits() != self.period.to_bits() {
            self.period = period;
            self.deviations = [0, 1, 2].map(|axis| deviations(gyro, axis, period));
        }
        match before {
            Some((_, angle)) if self.period > 0.0 => {
                std::array::from_fn(|axis| (truth.rate_integral[axis] - angle[axis]) / self.period)
            }
            _ => truth.rate,
        }
    }

    /// Returns the reading for these mean rates (rad/s), with all errors.
    pub fn quantize(
        &mut self,
        gyro: &Gyro,
        mean: [f64; 3],
        (noise, wander): (&mut [Stream], &mut GaussMarkovBias),
    ) -> [f64; 3] {
        let mut rate = [0.0; 3];
        for (axis, noise) in noise.iter_mut().enumerate() {
            rate[axis] = gyro.apply_scale_factor(axis, &mean) + self.bias[axis];
            if self.period > 0.0 {
                rate[axis] += self.walk(axis, noise);
                if gyro.bias_instability(axis).is_some() {
                    rate[axis] += wander.mean(gyro, axis, self.period, noise);
                }
                rate[axis] = self.round(rate[axis], gyro.quantum.about(axis).get(), axis);
            }
        }
        rate
    }

    /// Advances the bias; returns its contribution and that of the white noise to the rate, beyond the bias before
    /// (rad/s).
    fn walk(&mut self, axis: usize, noise: &mut Stream) -> f64 {
        let [walk, white] = self.deviations[axis];
        let step = walk * noise.normal();
        self.bias[axis] += step;
        0.5 * step + white * noise.normal()
    }

    fn round(&mut self, rate: f64, quantum: f64, axis: usize) -> f64 {
        if quantum <= 0.0 {
            return rate;
        }
        let angle = rate * self.period + self.remainder[axis];
        let counted = libm::floor(angle / quantum + 0.5) * quantum;
        self.remainder[axis] = angle - counted;
        counted / self.period
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{Orientation, SensorSpec};
    use flexsc_numerics::random::Seed;
    use flexsc_numerics::time::Span;

    const PERIOD: f64 = 0.25;

    fn readings(keys: &str, count: usize, rate: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
        let gyro: Gyro = flexsc_formats::document::from_text(&format!("period = {PERIOD}\n{keys}")).unwrap();
        assert_eq!(gyro.validate(), None);
        let mut gyro = gyro.start(3, Seed { scenario: 5, run: 0 }, 0);
        let (mut reported, mut biases) = (Vec::new(), Vec::new());
        for k in 0..=count {
            let t = PERIOD * k as f64;
            let truth = Truth {
                orientation: Orientation::Angle(0.0),
                elastic: [0.0; 3],
                rate,
                rigid_rate: rate,
                rate_integral: rate.map(|rate| rate * t),
                environment: flexsc_spacecraft::environment::EnvironmentObservation::default(),
            };
            let now = Instant::START + Span::from_seconds(t);
            reported.push(gyro.read(now, &truth, None).unwrap().rate.unwrap());
            biases.push(gyro.true_bias().unwrap());
        }
        (reported, biases)
    }

    #[test]
    fn walks_have_their_variances() {
        let (white, walk) = (2e-4, 3e-5);
        let keys = format!("angle_random_walk = {white}\nrate_random_walk = {walk}\nbias = 1e-3");
        let count = 40_000;
        let (reported, biases) = readings(&keys, count, [0.01, 0.0, -0.02]);
        let mean = |value_of: &dyn Fn(usize) -> f64| (1..=count).map(value_of).sum::<f64>() / count as f64;
        for axis in 0..3 {
            let step = mean(&|k| libm::pow(biases[k][axis] - biases[k - 1][axis], 2.0));
            // Three standard errors of a variance are 3 sqrt(2/n) of it: 2.1 %.
            assert!((step / (walk * walk * PERIOD) - 1.0).abs() < 0.022, "{step}");
            let rate = [0.01, 0.0, -0.02][axis];
            let noise = |k: usize| reported[k][axis] - rate - 0.5 * (biases[k][axis] + biases[k - 1][axis]);
            let variance = mean(&|k| noise(k) * noise(k));
            let exact = white * white / PERIOD + walk * walk * PERIOD / 12.0;
            assert!((variance / exact - 1.0).abs() < 0.022, "{variance} {exact}");
        }
        assert_eq!(biases[0], [1e-3; 3]);
    }

    #[test]
    fn nothing_is_lost_of_a_quantum() {
        let quantum = 1e-6;
        let rate = [1.234_567e-5, -3.3e-7, 0.0];
        let (reported, _) = readings(&format!("quantum = {quantum}"), 1000, rate);
        for axis in 0..3 {
            let sum: f64 = reported[1..].iter().map(|rate| rate[axis] * PERIOD).sum();
            assert!((sum - 250.0 * rate[axis]).abs() <= 0.5 * quantum + 1e-12, "{sum}");
            assert!(reported[1..].iter().all(|reported| {
                let counts = reported[axis] * PERIOD / quantum;
                (counts - libm::round(counts)).abs() < 1e-9
            }));
        }
    }

    #[test]
    fn scale_and_misalignment_mix_the_rates() {
        let keys =
            "quantum = 1e-12\nscale = [1e-3, 0, 0]\nmisalignment = [[0, 2e-3, 0], [0, 0, 0], [-1e-3, 0, 0]]";
        let (reported, _) = readings(keys, 4, [0.1, 0.2, 0.3]);
        for (found, exact) in reported[4].into_iter().zip([0.1 + 1e-4 + 4e-4, 0.2, 0.3 - 1e-4]) {
            assert!((found - exact).abs() < 1e-11, "{found} {exact}");
        }
        let refused = |keys: &str| {
            let gyro: Gyro = flexsc_formats::document::from_text(keys).unwrap();
            gyro.validate().unwrap().to_string()
        };
        assert!(
            refused("noise = 1e-5\nquantum = 1e-6\nperiod = 0.1")
                .starts_with("`noise` applies only to a gyro")
        );
        assert!(refused("quantum = 1e-6").starts_with("`period` must be given"));
        let twisted = "misalignment = [[0, 0, 0], [0, 1e-3, 0], [0, 0, 0]]";
        assert!(refused(twisted).starts_with("`misalignment[1][1]` must be 0"));
    }
}
