//! Kalman filters of a control system: measured angles in, estimated angles and rates out.

use flexsc_core::Scenario;
use flexsc_core::control::estimator::{EstimateOutputs, LinearFilter, linear_filters};
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::numerics::random::Seed;
use flexsc_flight::kalman::KalmanSample;
use flexsc_flight::kalman_axis::{KalmanAxis, KalmanFeed, reset};

use super::{CallLayout, Channel, WordReader};

/// Kalman filter about an axis.
#[derive(Clone, Debug)]
pub struct AxisFilter {
    /// Estimate.
    pub estimate: KalmanAxis,
    /// Model of the motion.
    pub model: Vec<f64>,
    /// Mean of the state.
    pub mean: Vec<f64>,
    /// Covariance of the state, column by column.
    pub covariance: Vec<f64>,
    /// Frequency of the dominant mode (rad/s).
    pub frequency: f64,
    /// Sample without its numbers.
    pub sample: KalmanSample,
    /// Number of measurements in a sample.
    pub measurements: u32,
    /// Variances of the state at the start.
    pub variances: Vec<f64>,
    /// Mean of the state at the start of the run.
    pub prior: Vec<f64>,
    buffer: Vec<f64>,
}

/// Kalman filter about each axis.
#[derive(Clone, Debug)]
pub struct KalmanUnit {
    /// Filters.
    pub axes: Vec<AxisFilter>,
    /// True if the law reads the dominant mode.
    pub gives_mode: bool,
}

impl AxisFilter {
    /// Creates a filter with a mean of zero.
    fn new(axis: &LinearFilter) -> Self {
        let filter = &axis.filter;
        let (angle_noise, rate_noise) = filter.measurement_noise();
        let (motion, measurements) = (filter.model().motion_states(), 1 + u32::from(rate_noise.is_some()));
        let feed = match axis.feeds {
            EstimateOutputs::Modes => KalmanFeed::Measured,
            EstimateOutputs::Hub => KalmanFeed::Hub,
            EstimateOutputs::Rigid => KalmanFeed::Rigid,
        };
        let order = filter.mean().len();
        Self {
            estimate: KalmanAxis::new(feed, motion, filter.mode(), measurements),
            model: filter.linear_model().to_vec(),
            mean: vec![0.0; order],
            covariance: filter.covariance().as_slice().to_vec(),
            frequency: filter.dominant().frequency,
            sample: KalmanSample {
                is_measured: false,
                angle: 0.0,
                rate: 0.0,
                angle_noise,
                has_rate: rate_noise.is_some(),
                rate_noise: rate_noise.unwrap_or(0.0),
                motion,
                is_gated: false,
            },
            measurements,
            variances: filter.covariance().diagonal().as_slice().to_vec(),
            prior: filter.mean().as_slice().to_vec(),
            buffer: vec![0.0; order * (1 + 2 * order)],
        }
    }

    /// Starts the filter with a mean.
    fn start(&mut self, mean: &[f64]) {
        let KalmanAxis { feed, motion, mode, .. } = self.estimate;
        self.estimate = KalmanAxis::new(feed, motion, mode, self.measurements);
        reset(mean, 0, &self.variances, &mut self.mean, &mut self.covariance);
    }
}

impl KalmanUnit {
    /// Returns the linear Kalman filters that the laws of a scenario read; `None` if they read something else, or if the dominant
    /// mode may change: then the estimates are inputs.
    pub(super) fn new(scenario: &Scenario, gives_mode: bool) -> Option<Self> {
        let seed = Seed { scenario: scenario.seed, run: 0 };
        let filters = linear_filters(&scenario.estimator_context(), seed)?;
        Some(Self { axes: filters.iter().map(AxisFilter::new).collect(), gives_mode })
    }

    /// Returns the number of functions.
    pub(super) fn call_count(&self) -> usize {
        if self.axes.len() == 3 { 3 } else { 2 }
    }

    /// Returns the functions: the start, a sample of the sensors, and about three axes a change of the target.
    pub(super) fn calls(&self) -> Vec<CallLayout> {
        let axes = self.axes.len();
        let angle = |about: &str, scale| Channel::real("angle", about, axes, scale);
        let states: usize = self.axes.iter().map(|axis| axis.mean.len()).sum();
        let about = "State of each axis: angle (rad), rate (rad/s), then displacement (rad) and rate (rad/s) of each mode";
        let start = CallLayout {
            is_start: true,
            inputs: vec![Channel::real("mean", about, states, 1e-3)],
            outputs: vec![angle("Rigid angle about each axis (rad)", 1.0)],
            ..CallLayout::new("start", "Starts the Kalman filters with the mean of their state.")
        };
        let moment = "Mean torque over inertia about each axis since the sample before (rad/s\u{b2})";
        let mut outputs = vec![
            angle("Estimated angle about each axis (rad)", 1.0),
            Channel::from_quantity(FlightQuantity::Rate, axes, 1.0),
        ];
        if self.gives_mode {
            outputs.push(Channel::from_quantity(FlightQuantity::Displacement, axes, 1.0));
            outputs.push(Channel::from_quantity(FlightQuantity::DisplacementRate, axes, 1.0));
        }
        outputs.push(Channel::flag("has_lost_lock", "True if the filter has lost lock", axes));
        let sample = CallLayout {
            inputs: vec![
                Channel::real("moment", moment, axes, 1e-4),
                Channel::flag("is_measured", "True if there is a measurement", 1),
                angle("Measured angle from the target about each axis (rad)", 1e-3),
                Channel::real("rate", "Measured rate about each axis (rad/s)", axes, 1e-3),
            ],
            outputs,
            ..CallLayout::new("sample", "Takes a sample of the sensors, at their period.")
        };
        let shift = CallLayout {
            inputs: vec![Channel::real("shift", "Change of the angle about each axis (rad)", axes, 1e-3)],
            outputs: vec![angle("Estimated angle about each axis (rad)", 1.0)],
            ..CallLayout::new(
                "shift",
                "Shifts the angles when a new target begins, before a sample or step of that time.",
            )
        };
        if axes == 3 { vec![start, sample, shift] } else { vec![start, sample] }
    }

    /// Calls the function with this index, and returns the words of its outputs.
    pub(super) fn call(&mut self, call: usize, inputs: &[u64]) -> Vec<u64> {
        let mut words = WordReader::new(inputs);
        match call {
            0 => {
                self.axes.iter_mut().for_each(|axis| {
                    let mean = words.list(axis.mean.len());
                    axis.start(&mean);
                });
                self.axes.iter().map(|axis| axis.mean[0].to_bits()).collect()
            }
            1 => self.sample(words),
            _ => {
                let shift = |axis: &mut AxisFilter| {
                    axis.estimate.shift(words.real(), &mut axis.mean);
                    axis.estimate.angle.to_bits()
                };
                self.axes.iter_mut().map(shift).collect()
            }
        }
    }

    /// Takes a sample, and returns the words of the outputs.
    fn sample(&mut self, mut words: WordReader<'_>) -> Vec<u64> {
        let axes = self.axes.len();
        let (moments, is_measured) = (words.list(axes), words.flag());
        let (angles, rates) = (words.list(axes), words.list(axes));
        for (index, axis) in self.axes.iter_mut().enumerate() {
            let sample =
                KalmanSample { is_measured, angle: angles[index], rate: rates[index], ..axis.sample };
            let AxisFilter { estimate, model, mean, covariance, buffer, .. } = axis;
            estimate.take(model, moments[index], &sample, mean, covariance, buffer);
        }
        let each = |value: fn(&KalmanAxis) -> f64| -> Vec<u64> {
            self.axes.iter().map(|axis| value(&axis.estimate).to_bits()).collect()
        };
        let mut outputs = each(|axis| axis.angle);
        outputs.extend(each(|axis| axis.rate));
        if self.gives_mode {
            outputs.extend(each(|axis| axis.displacement));
            outputs.extend(each(|axis| axis.displacement_rate));
        }
        outputs.extend(self.axes.iter().map(|axis| u64::from(axis.estimate.has_lost_lock())));
        outputs
    }
}
