//! A gyro at a point of the structure, whose elastic motion it measures.

use std::collections::VecDeque;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::axes::PerAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::failure::with_failures;
use super::gauss_markov_bias::GaussMarkovBias;
use super::linear_noise::{KeyNoise, SensorNoise, Side, diagonal, existing, padded, rounding, wander_noise};
use super::rate_integrator::{self, RateIntegrator};
use super::{LinearMeasurement, Reading, Sensor, SensorFailure, SensorSpec, Truth, stream};
use crate::offers::Offers;
use crate::part::Part;
use crate::requirement::{ONE_NUMBER, Requirements};

/// A gyro. A gyro that samples the rate is read once per cycle of the law: y = w + sum phi_i(r) q_i' + bias + noise, then
/// rounded (\[Timakov14\]). A gyro with a random walk integrates: its output is the mean rate over each of its periods.
///
/// A value is one number for all axes, or a list of three.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gyro {
    /// Point of the structure at which it is mounted, on a body with three axes; default: the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Period of its samples (s); default: that of the law, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// Standard deviation of the white noise about each axis (rad/s).
    #[serde(default)]
    pub noise: PerAxis<NonNegative>,
    /// Constant error about each axis (rad/s).
    #[serde(default)]
    pub bias: PerAxis<Finite>,
    /// Quantum of the output about each axis (rad/s); 0 for none.
    #[serde(default)]
    pub resolution: PerAxis<NonNegative>,
    /// Angle random walk of an integrating gyro about each axis (rad/sqrt(s)).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub angle_random_walk: PerAxis<NonNegative>,
    /// Rate random walk of the bias of an integrating gyro about each axis (rad/s^1.5).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rate_random_walk: PerAxis<NonNegative>,
    /// Quantum of the angle of an integrating gyro about each axis (rad); the remainder carries over to the next sample; 0 for
    /// none.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub quantum: PerAxis<NonNegative>,
    /// Standard deviation of the part of the bias about each axis that wanders, exponentially correlated (rad/s); 0 for none. It
    /// is 0 at the start.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub bias_instability: PerAxis<NonNegative>,
    /// Correlation time of that part (s), required with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlation_time: Option<Positive>,
    /// How late it reports a rate (s), a whole number of periods; until the first report it gives the rate of the
    /// start. Default: 0.
    #[serde(default, skip_serializing_if = "is_prompt")]
    pub latency: Time,
    /// Relative error of the scale about each axis.
    #[serde(default, skip_serializing_if = "is_none")]
    pub scale: PerAxis<Finite>,
    /// Misalignment (rad), on a body with three axes: row i gives what axis i measures of the rates about the other axes; the
    /// diagonal is 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub misalignment: Option<Box<[[Finite; 3]; 3]>>,
    /// Largest rate that it outputs about each axis (rad/s), at which it clips; default: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<PerAxis<Positive>>,
    /// Intervals in which the gyro fails; star trackers still give the attitude.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

fn is_zero(each: &PerAxis<NonNegative>) -> bool {
    *each == PerAxis::default()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_prompt(latency: &Time) -> bool {
    *latency == Time::default()
}

fn is_none(each: &PerAxis<Finite>) -> bool {
    *each == PerAxis::default()
}

/// Run-time state of a gyro, with a stream of noise for each axis.
#[derive(Clone, Debug)]
pub struct GyroState {
    gyro: Gyro,
    noise: Vec<Stream>,
    counter: Option<RateIntegrator>,
    wander: GaussMarkovBias,
    /// Rates of the last reading, and later ones in the latency queue (rad/s).
    last_rates: Option<[f64; 3]>,
    waiting: VecDeque<[f64; 3]>,
}

/// Largest latency of a gyro (periods).
const LATEST: u64 = 10_000;

impl SensorSpec for Gyro {
    fn start(&self, axes: usize, seed: Seed, ordinal: usize) -> Box<dyn Sensor> {
        let draws = |axis: usize| stream("gyro", (axis, axes), ordinal, seed);
        let counter = self.integrates().then(|| RateIntegrator::new(self));
        Box::new(GyroState {
            gyro: self.clone(),
            noise: (0..axes).map(draws).collect(),
            counter,
            wander: GaussMarkovBias::default(),
            last_rates: None,
            waiting: VecDeque::new(),
        })
    }

    fn period(&self, law: Option<Span>) -> Option<Span> {
        self.period.or(law)
    }

    fn point(&self) -> Option<&str> {
        self.point.as_deref()
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }

    fn validate(&self) -> Option<ConfigError> {
        let samples = [("noise", is_zero(&self.noise)), ("resolution", is_zero(&self.resolution))];
        if self.integrates() {
            if let Some((key, _)) = samples.into_iter().find(|(_, zero)| !zero) {
                let why = "applies only to a gyro that samples the rate: one with a random walk or a `quantum` integrates it";
                return Some(ConfigError::new(key, why));
            }
            if self.period.is_none() {
                return Some(ConfigError::new("period", "must be given for a gyro that integrates"));
            }
        }
        if !is_zero(&self.bias_instability) && self.correlation_time.is_none() {
            return Some(ConfigError::new("correlation_time", "must be given with `bias_instability`"));
        }
        if self.correlation_time.is_some() && is_zero(&self.bias_instability) {
            return Some(ConfigError::new(
                "correlation_time",
                "is that of `bias_instability`, which is not given",
            ));
        }
        if let Some(fault) = self.validate_latency() {
            return Some(fault);
        }
        let rows = self.misalignment.as_ref()?;
        let axis = (0..3).find(|axis| rows[*axis][*axis].get() != 0.0)?;
        let why = format!("must be 0, because `scale` gives that error, got {}", rows[axis][axis].get());
        Some(ConfigError::new(format!("misalignment[{axis}][{axis}]"), why))
    }

    fn requires(&self, _: usize, offers: &Offers, needs: &mut Requirements) {
        if let Some(key) = self.three_axis_key() {
            needs.require_axes(offers.body.axes == 3, key, ONE_NUMBER);
        }
    }

    fn integrates(&self) -> bool {
        !(is_zero(&self.angle_random_walk) && is_zero(&self.rate_random_walk) && is_zero(&self.quantum))
    }

    fn rate_latency(&self) -> Span {
        Span::from_seconds(self.latency.get())
    }

    fn rate_noise(&self, axis: usize) -> Option<f64> {
        if self.integrates() {
            let period = self.period.map_or(1.0, Span::seconds);
            return Some(rate_integrator::deviation(self, axis, period));
        }
        let (noise, resolution) = (self.noise.about(axis).get(), self.resolution.about(axis).get());
        Some(f64::sqrt(noise * noise + resolution * resolution / 12.0))
    }

    fn linear_measurement(&self) -> Option<LinearMeasurement> {
        Some(LinearMeasurement::Motion)
    }

    fn linear_noise(&self, axes: usize, period: f64) -> Option<Vec<KeyNoise>> {
        let rate = |deviation: &dyn Fn(usize) -> f64| diagonal(axes, deviation).map(SensorNoise::Rate);
        let walk = diagonal(axes, |axis| self.rate_random_walk.about(axis).get()).map(|walk| {
            let (change, white) = (&walk * f64::sqrt(period), walk * f64::sqrt(period / 12.0));
            SensorNoise::Walk { change: padded(&change, Side::Left), white: padded(&white, Side::Right) }
        });
        let quantum = diagonal(axes, |axis| rounding(self.quantum.about(axis).get()) / period);
        let wander =
            diagonal(axes, |axis| self.bias_instability(axis).map_or(0.0, |(deviation, _)| deviation));
        let wander = wander.zip(self.correlation_time).map(|(deviation, correlation)| {
            wander_noise(&deviation, period / correlation.get(), self.integrates())
        });
        Some(existing([
            ("noise", rate(&|axis| self.noise.about(axis).get())),
            ("resolution", rate(&|axis| rounding(self.resolution.about(axis).get()))),
            ("angle_random_walk", rate(&|axis| self.angle_random_walk.about(axis).get() / f64::sqrt(period))),
            ("rate_random_walk", walk),
            ("quantum", quantum.map(SensorNoise::Remainder)),
            ("bias_instability", wander),
        ]))
    }

    fn noise_fault(&self, period: Span) -> Option<(&'static str, &'static str)> {
        if self.integrates() {
            let why = "is that of a gyro that integrates the rate: its noise has a linear model only with an attitude filter";
            return Some(("period", why));
        }
        let differs = self.period.is_some_and(|own| own != period);
        differs.then_some(("period", "is not that of the law: the noise of a linear loop has one period"))
    }

    fn gyro(&self) -> Option<&Gyro> {
        Some(self)
    }
}

impl Gyro {
    /// Returns the first key that is given for each of three axes, if there is one.
    fn three_axis_key(&self) -> Option<&'static str> {
        let keys = [
            ("noise", self.noise.is_three()),
            ("bias", self.bias.is_three()),
            ("resolution", self.resolution.is_three()),
            ("angle_random_walk", self.angle_random_walk.is_three()),
            ("rate_random_walk", self.rate_random_walk.is_three()),
            ("quantum", self.quantum.is_three()),
            ("bias_instability", self.bias_instability.is_three()),
            ("scale", self.scale.is_three()),
            ("misalignment", self.misalignment.is_some()),
            ("range", self.range.is_some_and(|range| range.is_three())),
        ];
        keys.into_iter().find(|(_, three)| *three).map(|(key, _)| key)
    }

    /// Returns the latency in periods.
    fn late(&self) -> u64 {
        let (Some(period), latency) = (self.period, self.rate_latency()) else { return 0 };
        (latency.seconds() / period.seconds()).round() as u64
    }

    /// Returns standard deviation (rad/s) and correlation time (s) of the correlated part of the bias about an axis, if
    /// any.
    pub fn bias_instability(&self, axis: usize) -> Option<(f64, f64)> {
        let deviation = self.bias_instability.about(axis).get();
        self.correlation_time.filter(|_| deviation > 0.0).map(|time| (deviation, time.get()))
    }

    /// Returns the random walk of the bias about an axis (rad/s^1.5), including the correlated part's at short times.
    pub fn bias_random_walk(&self, axis: usize) -> f64 {
        let own = self.rate_random_walk.about(axis).get();
        self.bias_instability(axis)
            .map_or(own, |(deviation, time)| f64::sqrt(own * own + 2.0 * deviation * deviation / time))
    }

    /// Returns the rate measured about an axis for these rates, with scale error and misalignment (rad/s).
    pub(super) fn apply_scale_factor(&self, axis: usize, rates: &[f64; 3]) -> f64 {
        let own = rates[axis] + self.scale.about(axis).get() * rates[axis];
        self.misalignment.as_ref().map_or(own, |rows| {
            rows[axis].iter().zip(rates).fold(own, |sum, (part, rate)| sum + part.get() * rate)
        })
    }

    /// Checks the latency; returns the key and the reason.
    fn validate_latency(&self) -> Option<ConfigError> {
        let latency = self.rate_latency();
        if latency == Span::ZERO {
            return None;
        }
        let Some(period) = self.period else {
            return Some(ConfigError::new("period", "must be given for a gyro with a `latency`"));
        };
        let (late, seconds) = (self.late(), latency.seconds());
        if late > LATEST {
            return Some(ConfigError::new(
                "latency",
                format!("must be at most {LATEST} periods, got {seconds} s"),
            ));
        }
        let mut whole = Span::ZERO;
        for _ in 0..late {
            whole = whole + period;
        }
        let why = || format!("must be a whole number of periods of {} s, got {seconds} s", period.seconds());
        (whole != latency).then(|| ConfigError::new("latency", why()))
    }
}

impl Part for GyroState {}

impl Sensor for GyroState {
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        // Random numbers are drawn and rates are integrated during a failure too, so that later readings do not depend
        // on it.
        let rate = self.rates(now, truth);
        let rate = self.queued(rate);
        let reading = Reading { at: truth.orientation, rate: Some(rate), sight: None };
        let reported = with_failures(&self.gyro.faults, now, Some(reading), last)?;
        Some(Reading { at: truth.orientation, ..reported })
    }

    fn true_bias(&self) -> Option<[f64; 3]> {
        let constant = [0, 1, 2].map(|axis| self.gyro.bias.about(axis).get());
        let bias = self.counter.as_ref().map_or(constant, |counter| counter.bias);
        Some([0, 1, 2].map(|axis| bias[axis] + self.wander.bias[axis]))
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(self.clone())
    }
}

impl GyroState {
    /// Queues the measured rates; returns those measured one latency earlier, or the first ones until then.
    fn queued(&mut self, rate: [f64; 3]) -> [f64; 3] {
        let late = self.gyro.late();
        let Some(reported) = &mut self.last_rates else { return *self.last_rates.insert(rate) };
        self.waiting.push_back(rate);
        if self.waiting.len() as u64 > late {
            *reported = self.waiting.pop_front().unwrap_or(rate);
        }
        *reported
    }

    /// Returns the rates measured now (rad/s), clipped to the range.
    fn rates(&mut self, now: Instant, truth: &Truth) -> [f64; 3] {
        let rate = self.unlimited_rates(now, truth);
        let Some(range) = &self.gyro.range else { return rate };
        std::array::from_fn(|axis| {
            let most = range.about(axis).get();
            rate[axis].clamp(-most, most)
        })
    }

    /// Returns the rates that a gyro without a range would measure now (rad/s).
    fn unlimited_rates(&mut self, now: Instant, truth: &Truth) -> [f64; 3] {
        let Self { gyro, noise, counter, wander, .. } = self;
        if let Some(counter) = counter {
            let mean = counter.mean_rate(gyro, now, truth);
            return counter.quantize(gyro, mean, (noise, wander));
        }
        let seconds = wander.advance(now);
        let mut rate = truth.rate;
        for (axis, (rate, noise)) in rate.iter_mut().zip(noise).enumerate() {
            *rate = gyro.apply_scale_factor(axis, &truth.rate) + gyro.bias.about(axis).get();
            let (sd, quantum) = (gyro.noise.about(axis).get(), gyro.resolution.about(axis).get());
            if sd > 0.0 {
                *rate += sd * noise.normal();
            }
            *rate += wander.value(gyro, axis, seconds, noise);
            if quantum > 0.0 {
                *rate = libm::round(*rate / quantum) * quantum;
            }
        }
        rate
    }
}

#[cfg(test)]
mod tests {
    use flexsc_numerics::attitude::{Vector, rotation};
    use flexsc_spacecraft::environment::EnvironmentObservation;

    use super::*;
    use crate::sensor::Orientation;

    /// Returns what a gyro measures of these rates (rad/s) after one second of them.
    fn measured(text: &str, rate: [f64; 3]) -> [f64; 3] {
        let gyro: Gyro = flexsc_formats::document::from_text(text).unwrap();
        assert_eq!(gyro.validate(), None);
        let mut state = gyro.start(3, Seed { scenario: 1, run: 0 }, 0);
        let read = |state: &mut dyn Sensor, t: f64| {
            let rate_integral = rate.map(|rate| rate * t);
            let orientation = Orientation::Attitude(rotation(&Vector::from(rate_integral)));
            let sky = EnvironmentObservation::default();
            let truth = Truth {
                orientation,
                elastic: [0.0; 3],
                rate,
                rigid_rate: rate,
                rate_integral,
                environment: sky,
            };
            state.read(Instant::START + Span::from_seconds(t), &truth, None).unwrap().rate.unwrap()
        };
        read(&mut *state, 0.0);
        read(&mut *state, 1.0)
    }

    #[test]
    fn a_rate_beyond_the_range_is_clipped_after_the_errors() {
        let errors = "bias = [1e-3, 0, 0]\nscale = [0, 0.5, 0]\nrange = [0.02, 0.04, 0.05]";
        let sampled = format!("period = 1.0\n{errors}");
        let within = measured(&sampled, [0.018, -0.02, 0.049]);
        let exact = [0.019, -0.03, 0.049];
        assert!(within.iter().zip(exact).all(|(found, exact)| (found - exact).abs() < 1e-15), "{within:?}");
        assert_eq!(measured(&sampled, [0.0195, -0.03, 0.06]), [0.02, -0.04, 0.05]);
        assert_eq!(measured(&sampled, [-0.03, 0.03, -0.06]), [-0.02, 0.04, -0.05]);
        // A gyro that integrates clips the mean rate.
        let integrating = format!("period = 1.0\nquantum = 1e-9\n{errors}");
        assert_eq!(measured(&integrating, [0.03, -0.04, 0.06]), [0.02, -0.04, 0.05]);
    }
}
