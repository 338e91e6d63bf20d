//! A sensor of a vector with a known reference in inertial axes: errors, latency and failures.

use std::fmt;

use flexsc_formats::document;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, NonNegative};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::axes::PerAxis;
use flexsc_spacecraft::environment::{EnvironmentObservation, to_body};
use nalgebra::Matrix3;

use super::failure::with_failures;
use super::latency_queue::LatencyQueue;
use super::{Orientation, Reading, Sensor, SensorSpec, Subject, Truth, VectorMeasurement, stream};
use crate::part::Part;

/// Errors of a vector measurement in the sensor's axes: y = M v + bias + noise, then rounded.
#[derive(Copy, Clone, Debug)]
pub(super) struct VectorErrors {
    pub noise: PerAxis<NonNegative>,
    pub bias: PerAxis<Finite>,
    pub resolution: PerAxis<NonNegative>,
    pub scale: PerAxis<Finite>,
    pub misalignment: [[Finite; 3]; 3],
}

impl VectorErrors {
    /// Returns the measurement of a vector, with these normal random numbers.
    fn measured(&self, v: &Vector, draws: &[f64; 3]) -> Vector {
        Vector::from_fn(|axis, _| {
            let row = &self.misalignment[axis];
            let twisted: f64 = row.iter().zip(v).map(|(part, v)| part.get() * v).sum();
            let own = v[axis] + self.scale.about(axis).get() * v[axis] + twisted;
            let found = own + self.bias.about(axis).get() + self.noise.about(axis).get() * draws[axis];
            let quantum = self.resolution.about(axis).get();
            if quantum > 0.0 { libm::round(found / quantum) * quantum } else { found }
        })
    }

    /// Returns the standard deviation along an axis, including quantisation.
    pub fn deviation(&self, axis: usize) -> f64 {
        let (noise, quantum) = (self.noise.about(axis).get(), self.resolution.about(axis).get());
        f64::sqrt(noise * noise + quantum * quantum / 12.0)
    }

    /// Returns the covariance of the errors.
    pub fn covariance(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector::from_fn(|axis, _| self.deviation(axis) * self.deviation(axis)))
    }

    /// Checks that the misalignment has a zero diagonal; returns the key and the reason if not.
    pub fn validate(&self) -> Option<document::ConfigError> {
        let rows = &self.misalignment;
        let axis = (0..3).find(|axis| rows[*axis][*axis].get() != 0.0)?;
        let why = format!("must be 0, because `scale` gives that error, got {}", rows[axis][axis].get());
        Some(document::ConfigError::new(format!("misalignment[{axis}][{axis}]"), why))
    }
}

/// Interface of a specific vector sensor.
pub(super) trait VectorSensor: SensorSpec + Clone + fmt::Debug + 'static {
    /// Name of the random streams of the noise.
    const STREAM: &'static str;

    /// Returns the reference vector in inertial axes, if there is one.
    fn inertial_vector(&self, sky: &EnvironmentObservation) -> Option<Vector>;

    /// Returns the output for the true vector `exact` and the measured one, in the body's axes; `None` outside the
    /// field of view.
    fn reading(&self, exact: &Vector, measured: Vector) -> Option<Vector>;

    /// Returns the errors of the measurement.
    fn errors(&self) -> VectorErrors;

    /// Returns period and latency.
    fn timing(&self) -> [Span; 2];
}

/// Run-time state of a vector sensor.
#[derive(Clone, Debug)]
pub(super) struct VectorSensorState<S> {
    sensor: S,
    errors: VectorErrors,
    noise: [Stream; 3],
    late: LatencyQueue,
}

impl<S: VectorSensor> VectorSensorState<S> {
    /// Creates the run-time state; `ordinal` counts earlier sensors of the same kind.
    pub fn new(sensor: &S, seed: Seed, ordinal: usize) -> Self {
        let [period, latency] = sensor.timing();
        Self {
            errors: sensor.errors(),
            noise: [0, 1, 2].map(|axis| stream(S::STREAM, (axis, 3), ordinal, seed)),
            late: LatencyQueue::new(period, latency),
            sensor: sensor.clone(),
        }
    }

    fn measure(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        // Random numbers are drawn during a failure too, so that later ones do not depend on it.
        let draws: [f64; 3] = std::array::from_fn(|axis| self.noise[axis].normal());
        let Orientation::Attitude(attitude) = truth.orientation.rotated_by(truth.sensor_angles()) else {
            return None;
        };
        let reading = self.sensor.inertial_vector(&truth.environment).and_then(|inertial| {
            let exact = to_body(&attitude, &inertial);
            let vector = self.sensor.reading(&exact, self.errors.measured(&exact, &draws))?;
            let is_direction = self.sensor.subject() == Subject::Direction;
            let vector_measurement = VectorMeasurement { vector, inertial, is_direction };
            Some(Reading { at: truth.orientation, rate: None, sight: Some(vector_measurement) })
        });
        with_failures(self.sensor.faults(), now, reading, last)
    }
}

impl<S: VectorSensor> Part for VectorSensorState<S> {}

impl<S: VectorSensor> Sensor for VectorSensorState<S> {
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        if self.late.samples_now(now) {
            let reading = self.measure(now, truth, last);
            self.late.push(now, reading);
        }
        self.late.take_due(now)
    }

    fn next_due(&mut self, _: Instant, _: Span) -> Instant {
        self.late.next_due()
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(self.clone())
    }
}
