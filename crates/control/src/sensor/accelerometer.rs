//! An accelerometer at a point: the specific force along its axes, with noise, bias random walk, rounding, latency and
//! failures.

use std::collections::VecDeque;

use flexsc_formats::document;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, NonNegative, Time};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::axes::PerAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::tachometer::NoMeasurement;
use super::{MeasuredQuantity, Sensor, SensorFailure, SensorSpec, Subject, stream};
use crate::offers::Offers;
use crate::quantity::QuantityShape;
use crate::requirement::Requirements;

/// An accelerometer on a `[spacecraft]` in free fall. It measures the acceleration of its mounting point due to forces,
/// rotation and vibration.
///
/// A value is one number for all of its axes, or a list of three.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Accelerometer {
    /// Must be true: no law or estimator reads an accelerometer; its readings are only logged.
    #[serde(default)]
    pub watch_only: bool,
    /// Point of the structure at which it is mounted; default: the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Period of its samples (s).
    pub period: Span,
    /// Measurement directions: one to three, of any length, in the hub's axes with the structure undeformed; default: x, y
    /// and z.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub along: Vec<[Finite; 3]>,
    /// Standard deviation of the white noise along each (m/s²).
    #[serde(default)]
    pub noise: PerAxis<NonNegative>,
    /// Constant error along each (m/s²).
    #[serde(default)]
    pub bias: PerAxis<Finite>,
    /// Random walk of the bias along each (m/s² per square root of a second).
    #[serde(default)]
    pub bias_random_walk: PerAxis<NonNegative>,
    /// Quantum of the output along each (m/s²); 0 for none.
    #[serde(default)]
    pub resolution: PerAxis<NonNegative>,
    /// Relative error of the scale along each.
    #[serde(default)]
    pub scale: PerAxis<Finite>,
    /// Time from a sample to its output (s).
    #[serde(default)]
    pub latency: Time,
    /// Intervals in which the accelerometer fails.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

impl SensorSpec for Accelerometer {
    fn start(&self, _: usize, _: Seed, _: usize) -> Box<dyn Sensor> {
        Box::new(NoMeasurement)
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        None
    }

    fn own_period(&self) -> Option<Span> {
        Some(self.period)
    }

    fn subject(&self) -> Subject {
        Subject::Other
    }

    fn point(&self) -> Option<&str> {
        self.point.as_deref()
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }

    fn validate(&self) -> Option<document::ConfigError> {
        if !self.watch_only {
            let why = "must be true: an accelerometer is only logged, and the law does not use it";
            return Some(document::ConfigError::new("watch_only", why));
        }
        if self.along.len() > 3 {
            let why = format!("must be one to three directions, got {}", self.along.len());
            return Some(document::ConfigError::new("along", why));
        }
        let none = self.along.iter().position(|along| along.iter().all(|part| part.get() == 0.0))?;
        Some(document::ConfigError::new(format!("along[{none}]"), "must not be zero, got [0, 0, 0]"))
    }

    fn requires(&self, _: usize, offers: &Offers, needs: &mut Requirements) {
        needs.require(
            offers.body.is_spacecraft,
            "",
            "measures at a point of a `[spacecraft]`, whose mass and centre of mass are known, and whose modes act back on it",
        );
        needs.require(
            offers.sensors.motion_sensors > 0,
            "",
            "is not used by the law: list a sensor of the body beside it, such as \"continuous\", which gives the exact motion",
        );
        needs.require(
            !offers.body.turns_appendages,
            "",
            "cannot be used with appendages that turn, on drives or hinges: the acceleration by their modes is not computed",
        );
    }

    fn measured_quantities(&self, _: bool, _: usize) -> Vec<MeasuredQuantity> {
        let (shape, meaning) =
            (QuantityShape::List(self.axis_count()), "specific force along the axes of the sensor");
        vec![MeasuredQuantity::vector("specific_force", "m/s²", shape, meaning)]
    }
}

impl Accelerometer {
    /// Returns the number of measurement axes.
    pub fn axis_count(&self) -> usize {
        if self.along.is_empty() { 3 } else { self.along.len() }
    }

    /// Returns the unit vectors of the measurement axes.
    fn axes(&self) -> Vec<Vector> {
        if self.along.is_empty() {
            return vec![Vector::x(), Vector::y(), Vector::z()];
        }
        self.along.iter().map(|along| flexsc_numerics::attitude::vector(along).normalize()).collect()
    }
}

/// Measurement along an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct MeasuredAcceleration {
    /// Measured specific force (m/s²).
    pub measured: f64,
    /// True specific force (m/s²).
    pub exact: f64,
    /// Bias (m/s²).
    pub bias: f64,
}

impl MeasuredAcceleration {
    /// Returns the row of the measurement.
    pub fn row(&self) -> flexsc_record::Acceleration {
        flexsc_record::Acceleration {
            measured_m_s2: self.measured,
            true_m_s2: self.exact,
            bias_m_s2: self.bias,
        }
    }
}

/// Run-time state of an accelerometer.
#[derive(Clone, Debug)]
pub struct AccelerometerState {
    spec: Accelerometer,
    axes: Vec<Vector>,
    noise: Vec<Stream>,
    walk: Vec<Stream>,
    bias: Vec<f64>,
    /// Time of the next sample.
    exposes: Instant,
    /// Samples in the latency queue, with the times of their output.
    waiting: VecDeque<(Instant, Vec<MeasuredAcceleration>)>,
    /// Last measured values.
    last: Option<Vec<f64>>,
}

impl AccelerometerState {
    /// Creates the run-time state; `ordinal` counts earlier accelerometers.
    pub fn new(spec: &Accelerometer, seed: Seed, ordinal: usize) -> Self {
        let axes = spec.axes();
        let draws = |name: &str| -> Vec<Stream> {
            (0..axes.len()).map(|axis| stream(name, (axis, 3), ordinal, seed)).collect()
        };
        Self {
            noise: draws("accelerometer"),
            walk: draws("accelerometer bias"),
            bias: (0..axes.len()).map(|axis| spec.bias.about(axis).get()).collect(),
            exposes: Instant::START,
            waiting: VecDeque::new(),
            last: None,
            axes,
            spec: spec.clone(),
        }
    }

    /// Returns the next time of a sample or an output.
    pub fn due(&self) -> Instant {
        self.waiting.front().map_or(self.exposes, |(available, _)| self.exposes.min(*available))
    }

    /// Returns true if the accelerometer samples at `now`.
    pub fn samples_now(&self, now: Instant) -> bool {
        self.exposes <= now
    }

    /// Samples the specific force `force` in the hub's axes, rotated with the mount (m/s²).
    pub fn sample(&mut self, now: Instant, force: &Vector) {
        let Self { spec, axes, noise, walk, bias, .. } = self;
        self.exposes = now + spec.period;
        let step = if now == Instant::START { 0.0 } else { f64::sqrt(spec.period.seconds()) };
        let mut sensed = Vec::with_capacity(axes.len());
        for (index, axis) in axes.iter().enumerate() {
            // Random numbers are drawn during a failure too, so that later ones do not depend on it.
            let draws = [walk[index].normal(), noise[index].normal()];
            bias[index] += spec.bias_random_walk.about(index).get() * step * draws[0];
            let exact = axis.dot(force);
            let scaled = exact + spec.scale.about(index).get() * exact;
            let found = scaled + bias[index] + spec.noise.about(index).get() * draws[1];
            let quantum = spec.resolution.about(index).get();
            let measured = if quantum > 0.0 { libm::round(found / quantum) * quantum } else { found };
            sensed.push(MeasuredAcceleration { measured, exact, bias: bias[index] });
        }
        match spec.faults.iter().find(|fault| fault.interval().contains(now)) {
            Some(SensorFailure::Silent(_)) => return,
            Some(SensorFailure::Stuck(_)) => {
                let held = self.last.iter().flatten();
                sensed.iter_mut().zip(held).for_each(|(sample, held)| sample.measured = *held);
            }
            // Other kinds are refused.
            _ => {}
        }
        self.last = Some(sensed.iter().map(|sample| sample.measured).collect());
        let reported = now + Span::from_seconds(spec.latency.get());
        self.waiting.push_back((reported, sensed));
    }

    /// Returns the sample whose latency has elapsed, if any.
    pub fn take_due(&mut self, now: Instant) -> Option<Vec<MeasuredAcceleration>> {
        self.waiting.front().filter(|(available, _)| *available <= now)?;
        self.waiting.pop_front().map(|(_, sample)| sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(keys: &str) -> AccelerometerState {
        let spec: Accelerometer =
            toml::from_str(&format!("watch_only = true\nperiod = 0.5\n{keys}")).unwrap();
        assert_eq!(spec.validate(), None);
        AccelerometerState::new(&spec, Seed { scenario: 3, run: 0 }, 0)
    }

    fn run(
        state: &mut AccelerometerState,
        samples: usize,
        force: Vector,
    ) -> Vec<(f64, Vec<MeasuredAcceleration>)> {
        let mut reported = Vec::new();
        for _ in 0..samples {
            let now = state.due();
            if state.samples_now(now) {
                state.sample(now, &force);
            }
            reported.extend(state.take_due(now).map(|samples| (now.seconds(), samples)));
        }
        reported
    }

    #[test]
    fn errors_are_those_that_are_asked_for() {
        let keys = "along = [[0, 0, 2], [3, 0, 4]]\nscale = 0.1\nbias = [0.5, -0.5, 0]\nresolution = 0.25";
        let reported = run(&mut start(keys), 1, Vector::new(1.0, 2.0, 3.0));
        let measured: Vec<f64> = reported[0].1.iter().map(|sample| sample.measured).collect();
        // 3.3 + 0.5 and 3 * 1.1 - 0.5, in quarters.
        assert_eq!(measured, [3.75, 2.75]);
        assert!((reported[0].1[1].exact - 3.0).abs() < 1e-15);
    }

    #[test]
    fn the_bias_walks_and_noise_is_white() {
        let reported = run(&mut start("noise = 0.3\nbias_random_walk = 0.2"), 40_000, Vector::zeros());
        let mean = |value_of: &dyn Fn(usize) -> f64| {
            (1..reported.len()).map(value_of).sum::<f64>() / (reported.len() - 1) as f64
        };
        let step = mean(&|k| libm::pow(reported[k].1[0].bias - reported[k - 1].1[0].bias, 2.0));
        assert!((step / (0.04 * 0.5) - 1.0).abs() < 0.022, "{step}");
        let noise = mean(&|k| libm::pow(reported[k].1[0].measured - reported[k].1[0].bias, 2.0));
        assert!((noise / 0.09 - 1.0).abs() < 0.022, "{noise}");
    }

    #[test]
    fn it_tells_late_sticks_and_falls_silent() {
        let keys = "latency = 0.2\nbias_random_walk = 1.0\nfaults = [{ stuck = { from = 1.0, to = 2.0 } }, { silent = { from = 3.0, to = 4.0 } }]";
        let reported = run(&mut start(keys), 20, Vector::zeros());
        let times: Vec<f64> = reported.iter().map(|(t, _)| *t).collect();
        assert_eq!(times[..7], [0.2, 0.7, 1.2, 1.7, 2.2, 2.7, 4.2]);
        let measured = |k: usize| reported[k].1[0].measured;
        assert!(measured(2) == measured(1) && measured(3) == measured(1) && measured(4) != measured(1));
        let loud: Accelerometer = toml::from_str("period = 0.5").unwrap();
        assert!(loud.validate().unwrap().to_string().contains("`watch_only` must be true"));
    }
}
