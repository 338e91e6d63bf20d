//! A sensor of a vector that is known in inertial axes: its errors, its latency and its failures.

use std::fmt;

use nalgebra::Matrix3;

use super::late::{Late, failing};
use super::{Fault, Orientation, Reading, Sense, Truth, VectorSight, stream};
use crate::attitude::Vector;
use crate::axes::Each;
use crate::document;
use crate::environment::{SkySight, into};
use crate::quantity::{Finite, NonNegative};
use crate::random::{Seed, Stream};
use crate::time::{Instant, Span};

/// What a sensor makes of a vector along its axes: y = M v + bias + noise, then rounded.
#[derive(Copy, Clone, Debug)]
pub(super) struct Errors {
    pub noise: Each<NonNegative>,
    pub bias: Each<Finite>,
    pub resolution: Each<NonNegative>,
    pub scale: Each<Finite>,
    pub misalignment: [[Finite; 3]; 3],
}

impl Errors {
    /// What is measured of a vector, with these draws.
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

    /// Standard deviation along an axis, that of the rounding included.
    pub fn deviation(&self, axis: usize) -> f64 {
        let (noise, quantum) = (self.noise.about(axis).get(), self.resolution.about(axis).get());
        f64::sqrt(noise * noise + quantum * quantum / 12.0)
    }

    /// Their covariance.
    pub fn covariance(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector::from_fn(|axis, _| self.deviation(axis) * self.deviation(axis)))
    }

    /// A misalignment with a diagonal: the key, and why that is wrong.
    pub fn fault(&self) -> Option<document::Fault> {
        let rows = &self.misalignment;
        let axis = (0..3).find(|axis| rows[*axis][*axis].get() != 0.0)?;
        let why = format!("must be 0, because `scale` gives that error, got {}", rows[axis][axis].get());
        Some(document::Fault::new(format!("misalignment[{axis}][{axis}]"), why))
    }
}

/// What is special to a sensor of a vector.
pub(super) trait Measures: Clone + fmt::Debug + Send + Sync + 'static {
    /// The name of its streams of noise.
    const STREAM: &'static str;

    /// The vector that there is to measure, in inertial axes.
    fn of(&self, sky: &SkySight) -> Option<Vector>;

    /// What is told of a vector that is this in the sensor's axes and measured as this; nothing of what it does not see.
    fn told(&self, exact: &Vector, measured: Vector) -> Option<Vector>;

    /// Whether the direction alone is told.
    fn is_direction(&self) -> bool;

    /// Its errors.
    fn errors(&self) -> Errors;

    /// Its period and its latency.
    fn timing(&self) -> [Span; 2];

    /// Its failures.
    fn faults(&self) -> &[Fault];
}

/// Such a sensor at work.
#[derive(Clone, Debug)]
pub(super) struct Looking<S> {
    sensor: S,
    errors: Errors,
    noise: [Stream; 3],
    late: Late,
}

impl<S: Measures> Looking<S> {
    /// The sensor in a run, after so many others of its kind.
    pub fn new(sensor: &S, seed: Seed, ordinal: usize) -> Self {
        let [period, latency] = sensor.timing();
        Self {
            errors: sensor.errors(),
            noise: [0, 1, 2].map(|axis| stream(S::STREAM, (axis, 3), ordinal, seed)),
            late: Late::new(period, latency),
            sensor: sensor.clone(),
        }
    }

    fn look(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        // Draws are made in a failure too: those after it do not depend on it.
        let draws: [f64; 3] = std::array::from_fn(|axis| self.noise[axis].normal());
        let Orientation::Attitude(attitude) = truth.orientation.at(truth.seen()) else { return None };
        let seen = self.sensor.of(&truth.sky).and_then(|inertial| {
            let exact = into(&attitude, &inertial);
            let vector = self.sensor.told(&exact, self.errors.measured(&exact, &draws))?;
            let sight = VectorSight { vector, inertial, is_direction: self.sensor.is_direction() };
            Some(Reading { at: truth.orientation, rate: None, sight: Some(sight) })
        });
        failing(self.sensor.faults(), now, seen, last)
    }
}

impl<S: Measures> Sense for Looking<S> {
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        if self.late.exposes(now) {
            let seen = self.look(now, truth, last);
            self.late.take(now, seen);
        }
        self.late.told(now)
    }

    fn after(&mut self, _: Instant, _: Span) -> Instant {
        self.late.next()
    }

    fn copy(&self) -> Box<dyn Sense> {
        Box::new(self.clone())
    }
}
